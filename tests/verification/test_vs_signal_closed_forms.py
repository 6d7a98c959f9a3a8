"""Features of signals whose features are known in closed form: tones, damped tones,
pulses, impulses, bursts, bounces, white noise.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import beta

import vibroimpact as vi
from agreement import Against, Agrees

AGAINST = Against(
    "signal features, closed form",
    "closed form",
    "sensors and signals",
    "tones, damped tones, Gaussian bursts, half-sine pulses, impulses, white noise",
)


EULER = 0.5772156649015329
UNITS = {
    **dict.fromkeys(("decay_time", "duration", "temporal_centroid", "bounce_interval"), "s"),
    **dict.fromkeys(
        ("spectral_centroid", "spectral_bandwidth", "spectral_roll_off", "peak_frequency"), "Hz"
    ),
}


def features_of(signal: np.ndarray, rate: float, **settings: float) -> dict[str, float]:
    table = vi.signals.feature_table(np.asarray(signal)[None], rate, **settings)
    return dict(zip(table.names, table.values[0].tolist(), strict=True))


def test_a_tone(agrees: Agrees) -> None:
    # no sample of a period is that of another
    rate, samples, periods, amplitude = 20e3, 8192, 401, 3.0
    length, frequency = samples / rate, periods * rate / samples
    found = features_of(
        amplitude * np.sin(2.0 * np.pi * frequency * np.arange(samples) / rate), rate
    )
    root = beta(0.75, 0.5) / math.pi  # mean root of |sin|
    exact = {
        "peak": amplitude,
        "peak_to_peak": 2.0 * amplitude,
        "mean": 0.0,
        "mean_magnitude": 2.0 * amplitude / math.pi,
        "rms": amplitude / math.sqrt(2.0),
        "standard_deviation": amplitude / math.sqrt(2.0),
        "energy": amplitude**2 * length / 2.0,
        "crest_factor": math.sqrt(2.0),
        "shape_factor": math.pi / math.sqrt(8.0),
        "impulse_factor": math.pi / 2.0,
        "clearance_factor": 1.0 / root**2,
        "skewness": 0.0,
        "kurtosis": 1.5,
        "zero_crossing_rate": 2.0 * frequency,
        "impulses": periods,
        "packets": 1,
        "spectral_centroid": frequency,
        "spectral_bandwidth": 0.0,
        "spectral_roll_off": frequency,
        "peak_frequency": frequency,
        "spectral_entropy": 0.0,
        "octave_band_4": 1.0,  # 625 to 1250 Hz
        "octave_band_1": 0.0,
        # the energy to come falls linearly
        "decay_time": 2.0 * length * (10.0**-0.5 - 10.0**-2.5) / math.log(100.0),
        "temporal_centroid": length / 2.0,
        "duration": length,
        "clipped_part": 0.0,
    }
    for name, value in exact.items():
        # within the sampling of a period: 20 samples
        if name == "zero_crossing_rate":  # to one crossing
            agrees(
                "harmonic tone",
                name.replace("_", " "),
                found[name],
                value,
                unit="1/s",
                absolute=1.01 * rate / samples,
            )
            continue
        close = (
            1e-3
            if name
            in ("peak", "peak_to_peak", "clearance_factor", "crest_factor", "impulse_factor")
            else 2e-4
        )
        within = max(close * abs(value), 1e-5)
        agrees(
            "harmonic tone",
            name.replace("_", " "),
            found[name],
            value,
            unit=UNITS.get(name, ""),
            absolute=within,
        )
    assert found["spectral_flatness"] < 1e-20


def test_a_damped_tone(agrees: Agrees) -> None:
    rate, constant, frequency = 100e3, 4e-3, 3e3
    time = np.arange(8192) / rate  # twenty time constants
    found = features_of(
        2.0 * np.exp(-time / constant) * np.sin(2.0 * np.pi * frequency * time), rate
    )
    turn = 2.0 * math.pi * frequency
    # the integral of exp(-2 t/T) sin^2(w t)
    energy = (
        4.0
        * 0.5
        * (constant / 2.0 - (2.0 / constant) / ((2.0 / constant) ** 2 + (2.0 * turn) ** 2))
    )
    agrees("damped tone", "energy", found["energy"], energy, relative=1e-4)
    agrees("damped tone", "rms", found["rms"], math.sqrt(energy * rate / 8192), relative=1e-4)
    agrees("damped tone", "decay time", found["decay_time"], constant, unit="s", relative=1e-2)
    assert found["temporal_centroid"] == pytest.approx(constant / 2.0, rel=1e-2)
    # down to a tenth of the largest value of the envelope
    assert found["duration"] == pytest.approx(constant * math.log(10.0), abs=2.0 / frequency)
    assert found["impulses"] == pytest.approx(frequency * constant * math.log(10.0), abs=2)
    assert found["peak_frequency"] == pytest.approx(frequency, abs=rate / 8192)
    assert found["rise_time"] <= 1.0 / frequency
    # half the energy of a resonance lies within 1/(2 pi T) of its frequency on both sides: -10 dB
    # at three times that
    assert found["cut_off_10_dB"] == pytest.approx(
        frequency + 3.0 / (2.0 * math.pi * constant), rel=5e-3
    )


def test_a_burst_with_a_gaussian_envelope(agrees: Agrees) -> None:
    rate, width, frequency = 100e3, 1e-3, 10e3
    time = np.arange(4096) / rate - 20e-3
    found = features_of(
        np.exp(-(time**2) / (2.0 * width**2)) * np.cos(2.0 * np.pi * frequency * time), rate
    )
    reach = width * math.sqrt(2.0 * math.log(10.0))
    assert found["rise_time"] == pytest.approx(reach, abs=1.1 / rate)
    assert found["duration"] == pytest.approx(2.0 * reach, abs=2.1 / rate)
    assert found["temporal_centroid"] == pytest.approx(reach, abs=1.1 / rate)
    assert found["energy"] == pytest.approx(width * math.sqrt(math.pi) / 2.0, rel=1e-6)
    assert found["spectral_centroid"] == pytest.approx(frequency, rel=1e-6)
    assert found["amplitude_centroid"] == pytest.approx(frequency, rel=1e-6)
    bandwidth = 1.0 / (math.sqrt(8.0) * math.pi * width)
    agrees(
        "Gaussian burst",
        "spectral bandwidth",
        found["spectral_bandwidth"],
        bandwidth,
        unit="Hz",
        relative=1e-6,
    )
    assert found["cut_off_10_dB"] == pytest.approx(
        frequency + math.sqrt(math.log(10.0)) / (2.0 * math.pi * width), rel=1e-4
    )


def test_a_half_sine(agrees: Agrees) -> None:
    rate, contact = 1e6, 1e-3
    time = np.arange(2**15) / rate
    found = features_of(5.0 * np.where(time < contact, np.sin(np.pi * time / contact), 0.0), rate)
    share = contact * rate / 2**15
    falls = brentq(lambda f: abs(math.cos(math.pi * f) / (1.0 - 4.0 * f**2)) - 10.0**-0.5, 0.6, 1.4)
    agrees(
        "half-sine pulse",
        "-10 dB cut-off frequency, times pulse duration",
        found["cut_off_10_dB"] * contact,
        falls,
        relative=1e-3,
    )
    assert found["peak"] == pytest.approx(5.0, rel=1e-5)
    assert found["mean"] == pytest.approx(5.0 * 2.0 / math.pi * share, rel=1e-5)
    assert found["rms"] == pytest.approx(5.0 * math.sqrt(share / 2.0), rel=1e-5)
    assert found["energy"] == pytest.approx(25.0 * contact / 2.0, rel=1e-5)
    assert found["impulses"] == found["packets"] == 1
    assert found["peak_frequency"] == found["zero_crossing_rate"] == 0.0


def test_the_force_of_hertz(agrees: Agrees) -> None:
    """Its spectrum is 10 dB down at 1.16 over the contact time, by an integration of our
    own of m x'' = -k x^1.5.
    """
    whole = solve_ivp(
        lambda t, y: (y[1], -(max(y[0], 0.0) ** 1.5)),
        (0.0, 4.0),
        (0.0, 1.0),
        rtol=1e-10,
        atol=1e-12,
        dense_output=True,
        max_step=0.01,
    )
    contact = brentq(lambda t: whole.sol(t)[0], 2.0, 4.0)
    time = np.arange(2**15) / 1000.0
    force = np.maximum(whole.sol(np.minimum(time, contact))[0], 0.0) ** 1.5
    found = features_of(force, 1000.0)["cut_off_10_dB"] * contact
    agrees(
        "Hertz pulse", "-10 dB cut-off frequency, times pulse duration", found, 1.16, absolute=0.005
    )


def test_impulses(agrees: Agrees) -> None:
    samples, number = 4096, 8
    train = np.zeros(samples)
    train[100 + 512 * np.arange(number)] = 1.0
    found = features_of(train, 10e3, threshold=0.5)
    part = number / samples
    spread = part * (1.0 - part)
    exact = {
        "rms": math.sqrt(part),
        "crest_factor": math.sqrt(1.0 / part),
        "shape_factor": math.sqrt(1.0 / part),
        "impulse_factor": 1.0 / part,
        "clearance_factor": 1.0 / part**2,
        "skewness": (1.0 - 2.0 * part) / math.sqrt(spread),
        "kurtosis": (1.0 - 3.0 * spread) / spread,
        "packets": number,
        "impulses": number,
        "peak_ratio": 1.0,
        "bounce_interval": 512 / 10e3,
        "bounce_restitution": 1.0,
        "standard_deviation": math.sqrt(spread),
    }
    for name, value in exact.items():
        agrees(
            "eight impulses",
            name.replace("_", " "),
            found[name],
            value,
            unit=UNITS.get(name, ""),
            relative=1e-10,
        )


def test_one_impulse_has_all_frequencies() -> None:
    one = np.zeros(1024)
    one[500] = 1.0
    found = features_of(one, 2048.0)
    # zero and half the rate count half
    assert found["spectral_flatness"] == pytest.approx(1.0, abs=2e-3)
    assert found["spectral_entropy"] == pytest.approx(1.0, abs=2e-3)
    assert found["spectral_centroid"] == pytest.approx(512.0, rel=1e-10)
    assert found["spectral_bandwidth"] == pytest.approx(1024.0 / math.sqrt(12.0), rel=1e-3)
    assert [found[f"octave_band_{number}"] for number in range(1, 7)] == pytest.approx(
        [0.5**number for number in range(1, 7)], abs=2e-3
    )
    assert sum(found[f"wavelet_packet_{number}"] for number in range(1, 9)) == pytest.approx(
        1.0, abs=1e-12
    )
    # the same level in all bands but for the logarithm of their equal widths
    assert [found[f"cepstrum_{number}"] for number in range(1, 9)] == pytest.approx(
        8 * [0.0], abs=0.02
    )


@pytest.mark.parametrize("restitution", [0.5, 0.65, 0.8])
def test_a_bouncing_ball(agrees: Agrees, restitution: float) -> None:
    rate, first = 50e3, 0.15
    times = 0.02 + np.cumsum([0.0, first, first * restitution, first * restitution**2])
    time = np.arange(int(0.5 * rate)) / rate
    signal = sum(
        restitution**number
        * np.where(
            time >= at,
            np.exp(-np.maximum(time - at, 0.0) / 1e-3) * np.sin(4e3 * np.pi * (time - at)),
            0.0,
        )
        for number, at in enumerate(times)
    )
    found = features_of(signal, rate, threshold=0.05)
    assert found["packets"] == 4
    # a smaller sine reaches the threshold later, within a quarter of its period
    assert found["bounce_interval"] == pytest.approx(first, abs=1e-4)
    agrees(
        "signal of a bouncing ball",
        "coefficient of restitution",
        found["bounce_restitution"],
        restitution,
        absolute=2e-4 / first,
    )
    assert found["peak_ratio"] == pytest.approx(restitution, rel=0.02)


def test_two_tones_are_two_intrinsic_modes() -> None:
    time = np.arange(4096) / 4096.0
    found = features_of(
        np.sin(2.0 * np.pi * 128.0 * time) + 0.5 * np.sin(2.0 * np.pi * 9.0 * time), 4096.0
    )
    assert found["intrinsic_mode_1"] == pytest.approx(0.8, abs=0.01)
    assert found["intrinsic_mode_2"] == pytest.approx(0.2, abs=0.01)
    assert found["intrinsic_mode_3"] + found["intrinsic_mode_4"] < 0.002


@pytest.mark.parametrize("level", [0.3, 0.7, 0.95])
def test_a_clipped_tone(level: float) -> None:
    """A tone is beyond a level for 1 - 2 asin(level)/pi of the time."""
    found = features_of(
        np.clip(np.sin(2.0 * np.pi * 0.00123 * np.arange(2**15)), -level, level), 1.0
    )
    assert found["clipped_part"] == pytest.approx(1.0 - 2.0 * math.asin(level) / math.pi, abs=0.01)
    assert found["peak"] == level


def test_entropy_of_wavelet_packets() -> None:
    """Of a slow tone all energy lies in one packet of eight, of white noise as much in each."""
    slow = features_of(np.sin(2.0 * np.pi * 8.0 * np.arange(4096) / 4096.0), 1.0)
    assert slow["wavelet_packet_1"] == pytest.approx(1.0, abs=1e-6)
    assert slow["wavelet_entropy"] == pytest.approx(0.0, abs=1e-4)
    noise = features_of(np.random.default_rng(3).standard_normal(2**16), 1.0)
    parts = np.array([noise[f"wavelet_packet_{number}"] for number in range(1, 9)])
    assert noise["wavelet_entropy"] == pytest.approx(
        -np.sum(parts * np.log(parts)) / math.log(8.0), rel=1e-12
    )
    assert noise["wavelet_entropy"] == pytest.approx(1.0, abs=1e-3)


@pytest.mark.slow
def test_white_noise() -> None:
    """Means over 300 signals, within five standard errors of theory and its bias of one
    over the number of samples.
    """
    rate, samples, number = 1000.0, 4096, 300
    table = vi.signals.feature_table(
        np.random.default_rng(7).standard_normal((number, samples)), rate
    )
    frequencies = samples // 2
    exact = {
        "mean": 0.0,
        "rms": 1.0,
        "mean_magnitude": math.sqrt(2.0 / math.pi),
        "shape_factor": math.sqrt(math.pi / 2.0),
        "skewness": 0.0,
        "kurtosis": 3.0,
        "energy": samples / rate,
        "zero_crossing_rate": rate / 2.0,
        "spectral_centroid": rate / 4.0,
        "amplitude_centroid": rate / 4.0,
        "spectral_bandwidth": rate / 2.0 / math.sqrt(12.0),
        "spectral_roll_off": 0.85 * rate / 2.0,
        # the energy at a frequency has an exponential distribution
        "spectral_flatness": math.exp(-EULER),
        "spectral_entropy": 1.0 - (1.0 - EULER) / math.log(frequencies),
        **{f"octave_band_{band}": 0.5**band for band in range(1, 7)},
        **{f"wavelet_packet_{node}": 1.0 / 8.0 for node in range(1, 9)},
    }
    for name, value in exact.items():
        error = table[name].std(ddof=1) / math.sqrt(number)
        assert abs(table[name].mean() - value) < 5.0 * error + 2.0 / samples * max(
            1.0, abs(value)
        ), name
    # the spread of skewness and kurtosis of a signal, and of its mean
    for name, variance in {
        "skewness": 6.0 / samples,
        "kurtosis": 24.0 / samples,
        "mean": 1.0 / samples,
    }.items():
        assert table[name].var(ddof=1) == pytest.approx(
            variance, rel=5.0 * math.sqrt(2.0 / number)
        ), name
