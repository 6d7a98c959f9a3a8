"""Instruments behind the plate's motion against SciPy's filters on samples taken many
times faster, and against closed forms.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import signal
from scipy.interpolate import make_interp_spline

import vibroimpact as vi
from agreement import Against, Agrees
from support import one_in
from vibrating import STIFFNESS, drop_on, modes_of, random_modes
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH, kernel
from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.electronics import Amplifier, Converter
from vibroimpact.dynamics.sensors.instruments.geophone import Geophone
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.structures.modal_model import ModalBasis

AGAINST = Against(
    "SciPy filters, geophone",
    "other program",
    "sensors and signals",
    "scipy.signal.cont2discrete and butter, on 512-fold oversampled signals",
)
FORM = Against(
    "geophone response, closed form",
    "closed form",
    "sensors and signals",
    "frequency response and velocity step response of a moving-coil geophone",
)


RATE, FINER = 20e3, 128
HERTZ = Hertz(stiffness=STIFFNESS)
GEOPHONE = Geophone(natural_frequency=10.0, sensitivity=27.6)
GEOPHONES = [
    GEOPHONE,
    replace(GEOPHONE, natural_frequency=340.0, damping_ratio=0.2),
    replace(GEOPHONE, low_pass=1500.0),
]


@pytest.fixture(scope="module", params=one_in(3, [0.001, 0.01, 1.3]))
def response(request: pytest.FixtureRequest) -> vi.Response:
    """A few impacts, of a contact of 0.5 ms, so that the samples that SciPy's filters get tell it
    to 1e-7.

    Filters hear the contact force, and the samples are those of the velocity: the two differ by
    what the tolerance lets the run be off.
    """
    law = Hertz(stiffness=1e-2 * STIFFNESS)
    plate = random_modes(4, 12, 60.0, 8e3, 1.2, request.param)
    return vi.simulate(
        drop_on(law, plate, speed=0.5, impacts=None, duration=0.095, tolerance=1e-11)
    )


def filtered(value: np.ndarray, rate: float, *systems: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """A signal behind analogue filters: taken between its samples four times more often
    from a spline, as linear in between.
    """
    finer = 4
    value = make_interp_spline(np.arange(len(value)), value, k=5)(
        np.arange((len(value) - 1) * finer + 1) / finer
    )
    for system in systems:
        b, a, _ = signal.cont2discrete(system, 1.0 / (finer * rate), method="foh")
        value = signal.lfilter(np.ravel(b), a, value)
    return np.asarray(value[::finer])


def systems_of(geophone: Geophone, kind: str) -> list[tuple[np.ndarray, np.ndarray]]:
    """Numerators and denominators of a geophone and a filter behind it."""
    omega = 2.0 * np.pi * geophone.natural_frequency
    found = [
        (
            np.array([geophone.sensitivity, 0.0, 0.0]),
            np.array([1.0, 2.0 * geophone.damping_ratio * omega, omega**2]),
        )
    ]
    if geophone.low_pass is not None:
        found.append(signal.butter(2, 2.0 * np.pi * geophone.low_pass, analog=True))
    if kind == "butterworth":
        sections = signal.butter(8, 2.0 * np.pi * 0.4 * RATE, analog=True, output="sos")
        found += [(one[5:], one[3:]) for one in sections]  # each with a gain of one
    return found


@pytest.mark.parametrize("geophone", one_in(6, GEOPHONES))
@pytest.mark.parametrize("kind", ["none", "sigma-delta", "butterworth"])
def test_geophone(agrees: Agrees, response: vi.Response, geophone: Geophone, kind: str) -> None:
    assert len(response.impacts["impact"]) > 1
    fine = response.signals(Sensor("a", "velocity", rate=FINER * RATE, filter="none"))["a"].value
    exact = filtered(fine, FINER * RATE, *systems_of(geophone, kind))
    if kind == "sigma-delta":
        taps = kernel(np.arange(-HALF_LENGTH * FINER, HALF_LENGTH * FINER + 1) / FINER) / FINER
        exact = signal.fftconvolve(np.pad(exact, HALF_LENGTH * FINER), taps, "valid")
    found = response.signals(Sensor("a", "voltage", rate=RATE, filter=kind, instrument=geophone))[
        "a"
    ].value
    heard = slice(0, -HALF_LENGTH) if kind == "sigma-delta" else slice(None)
    largest, expected = float(np.abs(exact).max()), exact[::FINER][: len(found)]
    agrees(
        f"several impacts, filter {kind}",
        "voltage, normalized by its maximum",
        found[heard] / largest,
        expected[heard] / largest,
        absolute=1e-6,
    )


@pytest.mark.parametrize("frequency", [3.0, 10.0, 40.0, 2e3])
def test_gain_and_phase_of_a_geophone(agrees: Agrees, frequency: float) -> None:
    """Its steady answer to a mode that rings on, against the closed form."""
    geophone = replace(GEOPHONE, low_pass=500.0)
    response = vi.simulate(drop_on(HERTZ, modes_of([frequency], [0.3]), gravity=0.0, duration=2.0))
    seen = {
        "velocity": Sensor("a", "velocity", rate=8e3),
        "voltage": Sensor("a", "voltage", rate=8e3, instrument=geophone),
    }
    signals = {name: response.signals(sensor)["a"] for name, sensor in seen.items()}
    later = signals["voltage"].time > 1.0  # its own ringing has died down
    waves = np.exp(2j * np.pi * frequency * signals["voltage"].time[later])
    basis = np.stack([waves.real, waves.imag], axis=1)
    before, after = (
        complex(*np.linalg.lstsq(basis, one.value[later], rcond=None)[0])
        for one in signals.values()
    )
    s, omega, corner = 2j * np.pi * frequency, 2.0 * np.pi * 10.0, 2.0 * np.pi * 500.0
    gain = (
        27.6
        * s**2
        / (s**2 + 1.2 * omega * s + omega**2)
        * corner**2
        / (s**2 + np.sqrt(2.0) * corner * s + corner**2)
    )
    off = np.conj(after) / np.conj(before) / gain - 1.0
    agrees(
        "frequency response, 3 Hz to 2 kHz",
        "relative difference of the complex gain",
        abs(off),
        0.0,
        against=FORM,
        absolute=1e-6,
    )


@pytest.mark.parametrize("kind", ["none", "sigma-delta"])
def test_a_geophone_on_a_plate_that_moves_on(agrees: Agrees, kind: str) -> None:
    """A free plate gets its velocity in far less than a period of the coil, which then
    comes to rest in it: the closed form of a step.
    """
    heave, along = np.array([0.3**-0.5]), np.array([0.0, 0.0, 1.0])
    rigid = ModalBasis(
        np.zeros(1),
        np.zeros(1),
        heave,
        np.outer(1.0 / heave, along),
        {"a": np.outer(heave, along)},
        0.3,
    )
    plate = vi.Body(
        mass=np.inf, contact_offset=0.0, modes=modes_of([900.0], [1e-6], 0.05), rigid=rigid
    )
    response = vi.simulate(replace(drop_on(HERTZ, gravity=0.0, duration=0.3), plate=plate))
    speed = response.at(np.array([0.2]))["plate_velocity_m_s"][0]
    found = response.signals(Sensor("a", "voltage", instrument=GEOPHONE, filter=kind))["a"]
    since = found.time - 0.5 * float(response.impacts["duration_s"][0])
    omega, ratio = 2.0 * np.pi * 10.0, 0.6
    root = np.sqrt(1.0 - ratio**2)
    exact = (
        27.6
        * speed
        * np.exp(-ratio * omega * since)
        * (np.cos(root * omega * since) - ratio / root * np.sin(root * omega * since))
    )
    later = found.time > float(response.impacts["duration_s"][0]) + (
        0.0 if kind == "none" else HALF_LENGTH / 50e3
    )
    part = abs(27.6 * speed)
    agrees(
        "response to a velocity step",
        "voltage, normalized by its maximum",
        found.value[later] / part,
        exact[later] / part,
        against=FORM,
        absolute=1e-4,
    )


def noisy(**parts: object) -> np.ndarray:
    """A plate hardly struck, so that what is read is what the electronics add."""
    response = vi.simulate(drop_on(HERTZ, modes_of([400.0], [1e-9]), gravity=0.0, duration=2.0))
    return response.signals(Sensor("a", "voltage", rate=5e3, instrument=GEOPHONE, **parts))[
        "a"
    ].value  # type: ignore[arg-type]


def test_noise_and_hum_of_an_amplifier() -> None:
    noise = noisy(amplifier=Amplifier(gain=10.0, noise=2e-6))
    assert noise.std() == pytest.approx(20e-6, rel=0.03)
    assert abs(np.corrcoef(noise[1:], noise[:-1])[0, 1]) < 0.03  # white
    np.testing.assert_array_equal(noise, noisy(amplifier=Amplifier(gain=10.0, noise=2e-6)))
    assert (
        np.abs(np.corrcoef(noise, noisy(amplifier=Amplifier(gain=10.0, noise=2e-6, seed=1)))[0, 1])
        < 0.05
    )
    times = np.arange(len(noise)) / 5e3
    phases = []
    for seed in (0, 1):
        hum = noisy(amplifier=Amplifier(gain=10.0, hum=1e-3, mains=60.0, seed=seed))
        waves = np.exp(2j * np.pi * 60.0 * times)
        found, left, *_ = np.linalg.lstsq(
            np.stack([waves.real, waves.imag], axis=1), hum, rcond=None
        )
        assert np.hypot(*found) == pytest.approx(10e-3, rel=1e-4)
        assert left[0] < 1e-12
        phases.append(np.arctan2(*found))
    assert abs(phases[0] - phases[1]) > 0.01
    behind = noisy(amplifier=Amplifier(hum=1e-3, mains=60.0), filter="butterworth", corner=60.0)
    assert np.abs(behind).max() == pytest.approx(1e-3 / np.sqrt(2.0), rel=1e-4)


def test_converter() -> None:
    response = vi.simulate(
        drop_on(HERTZ, modes_of([400.0, 900.0], [1.0, 2.0], 0.01), gravity=0.0, duration=0.05)
    )
    bare = Sensor("a", "voltage", instrument=GEOPHONE)
    plain = response.signals(bare)["a"].value
    amplifier, converter = Amplifier(gain=0.5), Converter(range=2.0, bits=12)
    read = response.signals(replace(bare, amplifier=amplifier, converter=converter))["a"].value
    assert np.abs(0.5 * plain).max() > 2.0
    np.testing.assert_allclose(
        read, np.clip(0.5 * plain, -2.0, 2.0 - 2.0**-10), rtol=0.0, atol=2.0**-11 + 1e-12
    )
    np.testing.assert_array_equal(read * 2**10, np.round(read * 2**10))
    clipped = response.signals(replace(bare, converter=Converter(range=1.0)))["a"].value
    np.testing.assert_array_equal(clipped, np.clip(plain, -1.0, 1.0))


def test_voltage_of_an_accelerometer() -> None:
    """Its noise and range are accelerations; the sensitivity comes behind them."""
    response = vi.simulate(
        drop_on(HERTZ, modes_of([400.0, 900.0], [1.0, 2.0], 0.01), gravity=0.0, duration=0.05)
    )
    meter = Accelerometer(resonance=20e3, range=500.0, noise=2.0)
    plain = response.signals(Sensor("a", instrument=meter))["a"]
    volts = response.signals(Sensor("a", "voltage", instrument=replace(meter, sensitivity=0.01)))[
        "a"
    ]
    np.testing.assert_array_equal(volts.value, 0.01 * plain.value)
    assert (volts.sensor.unit, plain.sensor.unit) == ("V", "m/s2")
    assert volts.peak == plain.peak
    with pytest.raises(
        vi.InputError, match="the output of the instrument is voltage, and not acceleration"
    ):
        Sensor("a", instrument=GEOPHONE)
