r"""What sensors record, against closed forms: Duhamel's integral of the contact force, and the gain
of a seismic mass.

.. math::

    q(t) = -\chi \int_0^t F(\tau)\, h(t - \tau)\, d\tau,\qquad
    h(t) = e^{-\zeta \omega t} \sin(\omega_d t) / \omega_d

and its like for damping that is critical or more (Meirovitch, L. (1986). Elements of Vibration
Analysis, 2nd ed., sections 1.7 and 2.6).
"""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

import vibroimpact as vi
from agreement import Against, Agrees
from vibrating import STIFFNESS, drop_on, modes_of, random_modes
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor

AGAINST = Against(
    "Duhamel's integral and the frequency response of a seismic accelerometer",
    "closed form",
    "sensors and signals",
    "Meirovitch, Elements of Vibration Analysis, 1986, sections 1.7 and 2.6",
)


HERTZ = Hertz(stiffness=STIFFNESS)
QUANTITIES: tuple[Literal["displacement", "velocity", "acceleration"], ...] = (
    "displacement",
    "velocity",
    "acceleration",
)


def answer(frequency: float, ratio: float, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The displacement after a unit impulse, and its rate."""
    omega = 2.0 * np.pi * frequency
    root = omega * np.sqrt(complex(1.0 - ratio**2))
    if abs(root) == 0.0:
        return time * np.exp(-omega * time), (1.0 - omega * time) * np.exp(-omega * time)
    up, down = (
        np.exp((1j * root - ratio * omega) * time),
        np.exp((-1j * root - ratio * omega) * time),
    )
    rates = (1j * root - ratio * omega) * up - (-1j * root - ratio * omega) * down
    return ((up - down) / (2j * root)).real, (rates / (2j * root)).real


@pytest.mark.parametrize("ratio", [0.0, 0.02, 1.0, 2.5])
def test_one_mode_against_duhamel(agrees: Agrees, ratio: float) -> None:
    """Displacement, velocity and acceleration within and after the contact, to 1e-9 of
    the largest.
    """
    frequency, shape, rate = 700.0, 1.5, 400e3
    problem = drop_on(HERTZ, modes_of([frequency], [shape], ratio), gravity=0.0, duration=0.01)
    response = vi.simulate(problem)
    assert response.impacts["contacts"][0] == 1
    signals = {
        quantity: response.signals(Sensor("a", quantity, rate=rate, filter="none"))["a"]
        for quantity in QUANTITIES
    }
    end = float(response.impacts["duration_s"][0])
    time = signals["velocity"].time
    time = time[time < 0.01][::20]
    nodes, weights = np.polynomial.legendre.leggauss(120)
    x = 0.5 * (nodes + 1.0)
    until = np.minimum(time, end)
    tau = until[:, None] * x**2 * (3.0 - 2.0 * x)  # smooth where the force begins and ends
    force = response.at(tau)["force_N"] * (3.0 * until[:, None] * x * (1.0 - x)) * weights
    displacement, velocity = answer(frequency, ratio, time[:, None] - tau)
    omega = 2.0 * np.pi * frequency
    expected = {
        "displacement": -shape * (force * displacement).sum(axis=1),
        "velocity": -shape * (force * velocity).sum(axis=1),
    }
    push = -shape * response.at(time)["force_N"]
    expected["acceleration"] = (
        push - 2.0 * ratio * omega * expected["velocity"] - omega**2 * expected["displacement"]
    )
    for quantity, signal in signals.items():
        found = signal.value[: 20 * len(time) : 20]
        largest = float(np.abs(signal.value).max())
        unit = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s²"}[quantity]
        agrees(
            f"one mode, damping ratio {ratio}",
            quantity,
            found,
            shape * expected[quantity],
            unit=unit,
            absolute=1e-8 * largest,
        )


def test_signals_are_the_modal_motion() -> None:
    """At every sample of a second of several impacts with micro-contacts: against
    histories and modal coordinates, asked for one by one.
    """
    plate = random_modes(4, 25, 100.0, 20e3, 1.2, 0.002)
    response = vi.simulate(
        drop_on(
            LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.6), plate, height=0.3, impacts=3
        )
    )
    assert response.impacts["contacts"].max() > 1
    signal = response.signals(Sensor("a", "displacement", rate=50e3, filter="none"))["a"]
    assert signal.time[-1] <= response.end_time[0] < signal.time[-1] + 1.0 / 50e3
    busy = np.flatnonzero(
        np.abs(signal.time[:, None] - response.impacts["time_s"]).min(axis=1) < 1e-3
    )
    for some in (busy, np.arange(0, len(signal.time), 501)):
        scale = np.abs(signal.value).max()
        found = response.at(signal.time[some])["plate_deflection_m"]
        np.testing.assert_allclose(signal.value[some], found, rtol=0.0, atol=1e-9 * scale)
        modal = response.modal(signal.time[some])["plate"] @ plate.contact
        np.testing.assert_allclose(signal.value[some], modal, rtol=0.0, atol=1e-9 * scale)


def test_velocity_and_acceleration_are_derivatives() -> None:
    """Of sums of modes, over contacts and all: integrated by Simpson's rule they give
    velocity and displacement back.
    """
    plate = random_modes(4, 10, 100.0, 5e3, 1.0, 0.01)
    response = vi.simulate(drop_on(HERTZ, plate, speed=2.0, impacts=2))
    of = {
        quantity: response.signals(Sensor("a", quantity, rate=1e6))["a"].value
        for quantity in QUANTITIES
    }
    for rate, level in (("velocity", "displacement"), ("acceleration", "velocity")):
        found = cumulative_simpson(of[rate], dx=1e-6, initial=0.0)
        np.testing.assert_allclose(
            found, of[level] - of[level][0], rtol=0.0, atol=1e-5 * np.abs(of[level]).max()
        )


def test_direction() -> None:
    plate = modes_of([400.0, 900.0], [1.0, 2.0])
    plate.points["b"] = np.array([[0.3, 0.0, 1.0], [0.0, -0.4, 2.0]])  # type: ignore[index]
    response = vi.simulate(drop_on(HERTZ, plate, duration=0.02))
    axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    parts = [response.signals(Sensor("b", "velocity", axis))["b"].value for axis in axes]
    slanted = response.signals(Sensor("b", "velocity", (0.6, 0.0, -0.8)))["b"].value
    np.testing.assert_allclose(slanted, 0.6 * parts[0] - 0.8 * parts[2], atol=1e-12)
    assert np.abs(parts[0]).max() > 0.0 < np.abs(parts[1]).max()


@pytest.mark.parametrize("frequency", [1e3, 8e3, 15e3, 20e3, 24e3])
def test_resonance_of_an_accelerometer(agrees: Agrees, frequency: float) -> None:
    """Its steady answer to a mode that rings on, behind the filter of a converter, whose
    delay is taken out: gain and phase to 1e-4.
    """
    resonance, ratio, rate = 20e3, 0.05, 60e3
    response = vi.simulate(drop_on(HERTZ, modes_of([frequency], [0.3]), gravity=0.0, duration=0.04))
    plain = response.signals(Sensor("a", rate=rate))["a"]
    read = response.signals(Sensor("a", rate=rate, instrument=Accelerometer(resonance, ratio)))["a"]
    np.testing.assert_array_equal(plain.time, read.time)
    later = plain.time > 0.02  # its own ringing has died down
    waves = np.exp(2j * np.pi * frequency * plain.time[later])
    basis = np.stack([waves.real, waves.imag], axis=1)
    before, after = (
        complex(*np.linalg.lstsq(basis, signal.value[later], rcond=None)[0])
        for signal in (plain, read)
    )
    r = frequency / resonance
    gain = 1.0 / (1.0 - r**2 + 2j * ratio * r)
    found = np.conj(after) / np.conj(before)
    case = "accelerometer with a resonance frequency of 20 kHz, harmonic excitation at 1 to 24 kHz"
    agrees(case, "gain", abs(found), abs(gain), relative=1e-4)
    agrees(case, "phase error", np.angle(found / gain), 0.0, unit="rad", absolute=1e-4)


def test_range_noise_and_resolution() -> None:
    response = vi.simulate(
        drop_on(HERTZ, modes_of([400.0, 900.0], [1.0, 2.0], 0.01), gravity=0.0, duration=0.5)
    )
    plain = response.signals(Sensor("a", filter="none"))["a"].value

    def reads(**meter: float) -> np.ndarray:
        return response.signals(Sensor("a", instrument=Accelerometer(**meter), filter="none"))[
            "a"
        ].value

    np.testing.assert_array_equal(reads(), plain)
    np.testing.assert_array_equal(reads(range=50.0), np.clip(plain, -50.0, 50.0))
    stepped = reads(resolution=0.5)
    np.testing.assert_allclose(stepped / 0.5, np.round(stepped / 0.5), atol=1e-9)
    assert np.abs(stepped - plain).max() <= 0.25 + 1e-12
    noise = reads(noise=3.0) - plain
    assert noise.std() == pytest.approx(3.0, rel=0.03)
    assert abs(noise.mean()) < 4.0 * 3.0 / np.sqrt(len(noise))
    assert abs(np.corrcoef(noise[1:], noise[:-1])[0, 1]) < 0.03  # white
    np.testing.assert_array_equal(reads(noise=3.0), plain + noise)  # and the same in every run
    # after the range
    np.testing.assert_allclose(
        reads(noise=3.0, range=50.0), np.clip(plain, -50.0, 50.0) + noise, atol=1e-9
    )


def test_what_can_not_be_recorded() -> None:
    plate = modes_of([400.0], [1.0])
    response = vi.simulate(drop_on(HERTZ, plate, duration=0.02))
    with pytest.raises(vi.InputError, match='"elsewhere"'):
        response.signals(Sensor("elsewhere"))
    with pytest.raises(vi.InputError, match="lower rate"):
        response.signals(Sensor("a", rate=1e12))
    rigid = vi.simulate(drop_on(HERTZ, sphere=plate, duration=0.02))
    with pytest.raises(vi.InputError, match="neither modes nor supports that move"):
        rigid.signals(Sensor("a"))
