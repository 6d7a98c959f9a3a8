"""Signals behind anti-alias filters against SciPy's, applied to samples that are taken many times
faster without one.

Several impacts with micro-contacts on a plate that rings on, modes without damping, critically
damped and overdamped, before and after the run's blocks: what the chain computes in closed form
must be what is computed by brute force."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import signal

import vibroimpact as vi
from agreement import Against, Agrees
from support import one_in
from vibrating import STIFFNESS, drop_on, modes_of, random_modes
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH, kernel
from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor

AGAINST = Against(
    "SciPy filters on oversampled signals",
    "other program",
    "sensors and signals",
    "scipy.signal: Butterworth sections, Kaiser windows, bilinear integrators",
)
FORM = Against(
    "specified filter response, closed form",
    "closed form",
    "sensors and signals",
    "pass band, stop band, and quasi-static response of a stiff mode",
)


RATE, FINER = 20e3, 64
HERTZ = Hertz(stiffness=STIFFNESS)


@pytest.fixture(scope="module", params=one_in(4, [0.0, 0.01, 1.0, 1.7]))
def response(request: pytest.FixtureRequest) -> vi.Response:
    plate = random_modes(4, 25, 100.0, 60e3, 1.2, request.param)
    law = LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.6)
    return vi.simulate(drop_on(law, plate, height=0.03, impacts=None, duration=0.12))


def decimated(value: np.ndarray, kind: str) -> np.ndarray:
    if kind == "butterworth":
        value = signal.sosfilt(signal.butter(8, 0.4 * RATE, fs=FINER * RATE, output="sos"), value)
    else:
        taps = signal.firwin(
            2 * HALF_LENGTH * FINER + 1, 0.5 * RATE, window=("kaiser", 10.4), fs=FINER * RATE
        )
        value = signal.fftconvolve(np.pad(value, HALF_LENGTH * FINER), taps, "valid")
    return np.asarray(value[::FINER])


@pytest.mark.parametrize("kind", ["sigma-delta", "butterworth"])
@pytest.mark.parametrize("quantity", one_in(2, ["displacement", "velocity", "acceleration"]))
def test_signals_of_several_impacts(
    agrees: Agrees, response: vi.Response, kind: str, quantity: str
) -> None:
    assert len(response.impacts["impact"]) > 1
    seen = "displacement" if quantity == "displacement" else "velocity"
    full = response.signals(Sensor("a", seen, rate=FINER * RATE, filter="none"))["a"].value  # type: ignore[arg-type]
    # what lays a sphere down is an impulse, which samples of the velocity show
    if quantity == "acceleration":
        full = np.gradient(full) * FINER * RATE
    found = response.signals(Sensor("a", quantity, rate=RATE, filter=kind))["a"].value  # type: ignore[arg-type]
    exact = decimated(full, kind)[: len(found)]
    # a converter hears what comes after the run
    heard = slice(None) if kind == "butterworth" else slice(0, -HALF_LENGTH)
    largest = float(np.abs(exact).max())
    case = f"several impacts, filter {kind}"
    agrees(
        case,
        f"{quantity} signal, normalized by its maximum",
        found[heard] / largest,
        exact[heard] / largest,
        absolute=2e-3,
    )


@pytest.fixture(scope="module", params=one_in(2, [0.03, 0.001]))
def at_rest(request: pytest.FixtureRequest) -> tuple[vi.Response, np.ndarray, np.ndarray]:
    """A sphere that lies on a plate which still moves: instants, 32 a sample, and the
    deflection under it as the history has it.
    """
    plate = modes_of([6.0, 240.0, 900.0], [1.2, 1.5, -1.0], request.param)
    law = LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.5)
    response = vi.simulate(drop_on(law, plate, height=0.18, impacts=None, duration=1.4))
    begun = float(response.rest.time[0])
    first = round((begun - 0.02) * RATE)
    times = first / RATE + np.arange(round(0.1 * RATE) * 32) / (32 * RATE)
    assert np.abs(response.rest.lying[0].force(np.zeros(1)) - 0.0903 * 9.8).max() > 1e-3  # type: ignore[union-attr]
    return response, times, response.at(times)["plate_deflection_m"]


@pytest.mark.parametrize("kind", ["sigma-delta", "butterworth", "none"])
@pytest.mark.parametrize("resonance", one_in(2, [5e3, None]))
@pytest.mark.parametrize("order", one_in(2, [0, 1, 2]))
def test_a_plate_that_carries_the_sphere(
    agrees: Agrees,
    at_rest: tuple[vi.Response, np.ndarray, np.ndarray],
    order: int,
    resonance: float | None,
    kind: str,
) -> None:
    """It moves with the sphere, about where its weight has put both, from before it is
    laid down on.
    """
    response, times, value = at_rest
    if resonance and order < 2:
        return  # of an accelerometer
    meter, fine = None if resonance is None else Accelerometer(resonance, 0.1), 32 * RATE
    for _ in range(order):
        value = np.gradient(value) * fine
    if resonance:
        omega = 2.0 * np.pi * resonance
        ratio = signal.cont2discrete(
            ([omega**2], [1.0, 0.2 * omega, omega**2]), 1.0 / fine, method="foh"
        )
        value = signal.lfilter(np.ravel(ratio[0]), ratio[1], value)
    if kind == "butterworth":
        sos = signal.butter(8, 0.4 * RATE, fs=fine, output="sos")
        value = signal.sosfilt(sos, value, zi=signal.sosfilt_zi(sos) * value[0])[0]
    if kind == "sigma-delta":
        taps = signal.firwin(64 * HALF_LENGTH + 1, 0.5 * RATE, window=("kaiser", 10.4), fs=fine)
        value = signal.fftconvolve(value, taps, "same")
    quantity = ("displacement", "velocity", "acceleration")[order]
    sensor = Sensor("a", quantity, rate=RATE, filter=kind, instrument=meter)  # type: ignore[arg-type]
    found = response.signals(sensor)["a"].value[round(times[0] * RATE) :]
    begun = float(response.rest.time[0])
    windows = [
        (np.abs(times - begun - 0.02) < 0.03, 2e-3),
        (np.abs(times - begun - 0.04) < 0.03, 1e-4),
    ]
    if order == 2 and response.problem.plate.modes.damping_ratios[0] < 0.01:  # type: ignore[union-attr]
        del windows[0]  # before it lies it rattles, which differences of samples do not resolve
    for heard, most in windows:
        heard = heard[::32]
        exact, part = value[::32][heard], found[: len(heard)][heard]
        case = (
            f"sphere {'coming to rest' if most > 1e-3 else 'at rest'} on "
            f"a vibrating plate, filter {kind}"
        )
        agrees(case, "sensor signal", part, exact, rms=most)


@pytest.mark.parametrize("kind", one_in(3, ["sigma-delta", "butterworth", "none"]))
def test_an_overdriven_accelerometer(agrees: Agrees, response: vi.Response, kind: str) -> None:
    meter, end = {"resonance": 30e3, "damping_ratio": 0.1}, 200.0
    full = response.signals(
        Sensor("a", rate=FINER * RATE, filter="none", instrument=Accelerometer(**meter))
    )["a"].value
    assert np.abs(full).max() > 2.0 * end
    clipped = np.clip(full, -end, end)
    exact = clipped[::FINER] if kind == "none" else decimated(clipped, kind)
    found = response.signals(
        Sensor("a", rate=RATE, filter=kind, instrument=Accelerometer(**meter, range=end))
    )["a"]
    heard = slice(0, -HALF_LENGTH) if kind == "sigma-delta" else slice(None)
    expected = exact[: len(found.value)][heard]
    agrees(
        f"accelerometer beyond its range, filter {kind}",
        "sensor signal",
        found.value[heard],
        expected,
        unit="m/s²",
        absolute=0.01 * end,
    )
    assert found.peak == pytest.approx(np.abs(full).max(), rel=0.02)
    assert found.overload_time == pytest.approx(
        (np.abs(full) > end).sum() / (FINER * RATE), rel=0.03
    )


def test_the_filter_of_a_converter_is_what_is_said() -> None:
    """Flat to 0.45 of the rate within 0.001 dB, and 100 dB down from 0.55 on."""
    x = np.arange(-HALF_LENGTH * 16, HALF_LENGTH * 16 + 1) / 16.0
    frequency, gain = signal.freqz(kernel(x) / 16.0, worN=2**16, fs=16.0)
    decibels = 20.0 * np.log10(np.abs(gain))
    assert np.abs(decibels[frequency <= 0.45]).max() < 1e-3
    assert decibels[frequency >= 0.55].max() < -100.0


@pytest.mark.parametrize(
    ("frequency", "seen"), [(4e3, 1.0), (8.9e3, 1.0), (11.1e3, 0.0), (19e3, 0.0), (46e3, 0.0)]
)
def test_a_tone_passes_or_is_stopped(agrees: Agrees, frequency: float, seen: float) -> None:
    """One mode that rings on: in band it passes as it is, above it nothing is left, and
    none is folded into the band.
    """
    response = vi.simulate(drop_on(HERTZ, modes_of([frequency], [0.3]), gravity=0.0, duration=0.02))
    found, bare = (
        response.signals(Sensor("a", rate=RATE, filter=kind))["a"]
        for kind in ("sigma-delta", "none")
    )
    later = found.time > 2.0 * HALF_LENGTH / RATE
    largest = float(np.abs(bare.value).max())
    case = "tones in the pass band and in the stop band"
    agrees(
        case,
        "signal, normalized by its maximum",
        found.value[later] / largest,
        seen * bare.value[later] / largest,
        against=FORM,
        absolute=2e-4,
    )


def test_a_mode_above_half_the_rate_acts_in_band_as_below_its_resonance(agrees: Agrees) -> None:
    """Far above it, as a spring: its share in the displacement is that of its compliance
    under the filtered force.
    """
    plate = modes_of([900.0, 80e3], [0.4, 20.0])
    plate.points["stiff"] = np.outer([0.0, 20.0], [0.0, 0.0, 1.0])  # type: ignore[index]
    response = vi.simulate(drop_on(HERTZ, plate, gravity=0.0, duration=0.01, speed=0.2))
    rate = 10e3
    found = response.signals(Sensor("stiff", "displacement", rate=rate))["stiff"].value
    fine = np.arange(0, 0.01, 1e-7)
    force = response.at(fine)["force_N"]
    times = np.arange(len(found)) / rate
    filtered = np.array(
        [(force * kernel(rate * (time - fine))).sum() * rate * 1e-7 for time in times]
    )
    compliance = (20.0 / (2.0 * np.pi * 80e3)) ** 2
    case, exact = (
        "mode far above the Nyquist frequency, quasi-static response",
        -compliance * filtered,
    )
    agrees(
        case,
        "displacement signal",
        found,
        exact,
        unit="m",
        against=FORM,
        absolute=0.01 * compliance * filtered.max(),
    )
    assert np.abs(found).max() > 0.1 * compliance * force.max()
