"""Sensors on a struck plate that is shaken, against the same chain at two million samples a second.

The oracle gets the contact force, and the modes that the program keeps for the vibration that it
excites. The motion of the supports drives all modes of Kirchhoff's plate in closed form, from rest
on, slowly, until the plate moves steadily; it has a slow part, one above the first mode, and one
above half the rate of the sensors."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.measuring_chain import RATE, Floats, SimplySupported, driven, sampled, seismic
from support import supported_plate
from vibroimpact.dynamics.sensors.instruments.sensor import Accelerometer, Sensor

AGAINST = Against(
    "measuring chain sampled at 2 MHz, shaken supports",
    "own independent computation",
    "sensors and signals",
    "tests/oracles/measuring_chain.py: contact force and kept modes of the package, the "
    "modes above in closed form, SciPy filters",
)

pytestmark = pytest.mark.slow

SIZE, DENSITY, MODULUS, POISSON, RATIO = (0.18, 0.15, 0.006), 7850.0, 210e9, 0.3, 0.05
SPOT, PLACE, DURATION, SAMPLES = (-0.011, -0.0147), (0.023, 0.0301), 3e-3, 20e3
BEFORE, AFTER = 0.04, 3e-3
FREQUENCIES, STRENGTHS, PHASES = (
    np.array([170.0, 2400.0, 11e3]),
    np.array([400.0, 250.0, 600.0]),
    np.array([0.3, 2.0, -1.0]),
)
DIRECTION = (0.0, 0.6, 0.8)
EARLIER = 160
"""Samples of the sensors before the run that go through the filters with it."""


@pytest.fixture(scope="module")
def response() -> vi.Response:
    case = {
        "sphere": {"radius": 5e-3, "material": "steel"},
        "plate": {
            **supported_plate(SIZE, RATIO),
            "max_frequency": 50e3,
            "mesh": {"theory": "thin"},
        },
        "drop": {"speed": 0.5, "position": list(SPOT)},
        "contact": {"law": "hertz"},
        "run": {"duration": DURATION},
        "sensors": [{"name": "one", "position": list(PLACE), "rate": SAMPLES}],
    }
    amplitudes = STRENGTHS / (2.0 * np.pi * FREQUENCIES) ** 2
    motion = vi.PlateMotion(
        amplitude=amplitudes, frequency=FREQUENCIES, phase=PHASES, direction=DIRECTION
    )
    return vi.simulate(replace(vi.case_of(case).to_problem(), motion=motion))


@pytest.fixture(scope="module")
def motion(response: vi.Response) -> dict[str, Floats]:
    """What the point does upwards from `EARLIER` samples before the run on."""
    plate, kept = (
        SimplySupported(SIZE, DENSITY, MODULUS, POISSON, 400e3),
        response.problem.plate.modes,
    )
    assert kept is not None
    above = plate.omega > kept.angular_frequencies[-1]
    lead, count = round(BEFORE * RATE), round((DURATION + AFTER) * RATE) + 1
    times = np.arange(-lead, count) / RATE
    history = response.at(np.clip(times, 0.0, response.end_time[0]))
    force = np.where(times < 0.0, 0.0, history["force_N"])
    assert force.max() > 0.0
    omega = np.append(kept.angular_frequencies, plate.omega[above])
    point = np.append(kept.points["one"][:, 2], plate.at(*PLACE)[above])[None]
    found = driven(omega, RATIO, np.append(kept.contact, plate.at(*SPOT)[above]), point, force)
    # the supports: the momentum of a mode of a simply supported plate is its mean, over all of the
    # mass
    odd = (plate.m % 2 == 1) & (plate.n % 2 == 1) & (plate.omega < 2.0 * np.pi * 200e3)
    along = 8.0 * np.sqrt(plate.mass) / (np.pi**2 * plate.m * plate.n)[odd]
    driving = 2.0 * np.pi * FREQUENCIES
    turned = DIRECTION[2] * STRENGTHS * np.exp(1j * (driving * times[:, None] + PHASES))
    begun = 0.5 * (1.0 - np.cos(np.pi * np.minimum((times - times[0]) / (0.25 * BEFORE), 1.0)))
    relative = driven(
        plate.omega[odd],
        RATIO,
        along,
        plate.at(*PLACE)[None, odd],
        -begun * turned.imag.sum(axis=1),
    )
    supports = {
        "displacement": turned / driving**2,
        "velocity": 1j * turned / driving,
        "acceleration": -turned,
    }
    first = lead - round(EARLIER * RATE / SAMPLES)
    return {
        name: (found[name][0] + relative[name][0] + supports[name].imag.sum(axis=1))[first:]
        for name in found
    }


def heard(response: vi.Response, sensor: Sensor, exact: Floats) -> tuple[Floats, Floats]:
    """The signal of a sensor, and the exact one over the same time."""
    found = response.signals(sensor)["one"].value
    return found, exact[EARLIER : EARLIER + len(found)]


@pytest.mark.parametrize("quantity", ["acceleration", "velocity", "displacement"])
@pytest.mark.parametrize("filtered", ["sigma-delta", "butterworth", "none"])
def test_points(
    agrees: Agrees, response: vi.Response, motion: dict[str, Floats], quantity: Any, filtered: str
) -> None:
    """Without a filter the modes left out matter for an acceleration, within half as much
    again of what is estimated.
    """
    sensor = Sensor("one", quantity, rate=SAMPLES, filter=filtered)
    doubt = response.signals(sensor)["one"].uncertainty if filtered == "none" else 0.0
    within = 0.005 if doubt < 0.005 else 1.5 * doubt
    agrees(
        f"ideal sensors, filter {filtered}",
        f"{quantity} signal",
        *heard(response, sensor, sampled(motion[quantity], SAMPLES, filtered)),
        rms=within,
    )


@pytest.mark.parametrize("filtered", ["sigma-delta", "butterworth"])
@pytest.mark.parametrize(
    "meter",
    [
        {"resonance": 30e3},
        {"resonance": 8e3, "damping_ratio": 0.7},
        {"resonance": 20e3, "range": 600.0, "damping_ratio": 0.1},
    ],
)
def test_accelerometers(
    agrees: Agrees,
    response: vi.Response,
    motion: dict[str, Floats],
    filtered: str,
    meter: dict[str, float],
) -> None:
    """The last is driven beyond its range by the supports alone, before the run too."""
    exact = seismic(motion["acceleration"], meter["resonance"], meter.get("damping_ratio", 0.02))
    end = meter.get("range", np.inf)
    sensor = Sensor("one", rate=SAMPLES, filter=filtered, instrument=Accelerometer(**meter))
    clipped = sampled(np.clip(exact, -end, end), SAMPLES, filtered)
    case = (
        f"accelerometers {'beyond' if np.isfinite(end) else 'within'} "
        f"their range, filter {filtered}"
    )
    agrees(case, "acceleration signal", *heard(response, sensor, clipped), unit="m/s²", rms=0.01)
    signal, begin = response.signals(sensor)["one"], round(EARLIER * RATE / SAMPLES)
    within = np.abs(exact[begin : begin + round(DURATION * RATE)])
    if np.isfinite(end):
        assert signal.peak == pytest.approx(within.max(), rel=0.02)
        assert signal.overload_time == pytest.approx((within > end).sum() / RATE, rel=0.02)
