"""Sensors on a plate that is hit obliquely, twice and at two places, against the same chain at two
million samples a second.

The oracle gets normal force, friction and the modes that the program keeps; those left out it takes
from Kirchhoff's closed form. Friction drives them by its moment about the plate's middle, half a
thickness below its face."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.measuring_chain import RATE, Floats, SimplySupported, driven, rms, sampled, seismic
from support import supported_plate
from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor

AGAINST = Against(
    "measuring chain sampled at 2 MHz, oblique impacts",
    "own independent computation",
    "sensors and signals",
    "tests/oracles/measuring_chain.py: contact force and kept modes of the package, the "
    "modes above in closed form, SciPy filters",
)


SIZE, DENSITY, MODULUS, POISSON, RATIO = (0.18, 0.15, 0.006), 7850.0, 210e9, 0.3, 0.002
SPOT, AWAY, DURATION, SAMPLES = (-0.041, -0.0147), (-0.06, 0.02), 3e-3, 50e3
AFTER = 1.7e-3
STEP = 1e-5


@pytest.fixture(scope="module")
def response() -> vi.Response:
    """Gravity brings the sphere back within a millisecond, some 5 mm farther on."""
    plate = supported_plate(SIZE, RATIO)
    case = {
        "sphere": {"radius": 5e-3, "material": "steel"},
        "plate": {**plate, "max_frequency": 50e3, "mesh": {"theory": "thin"}},
        "drop": {
            "velocity": [8.0, 3.0, -1.0],
            "spin": [0.0, 300.0, 0.0],
            "position": list(SPOT),
            "gravity": 800.0,
        },
        "contact": {"law": "hertz", "friction": {"law": "mdr", "coefficient": 0.25}},
        "run": {"duration": DURATION, "impacts": 2},
        "sensors": [{"name": "two", "position": list(AWAY)}],
    }
    return vi.simulate(vi.case_of(case))


@pytest.fixture(scope="module")
def motion(response: vi.Response) -> dict[str, Floats]:
    plate = SimplySupported(SIZE, DENSITY, MODULUS, POISSON, 400e3)
    end = float(response.end_time[0])
    times = np.arange(round((end + AFTER) * RATE) + 1) / RATE
    history = response.at(np.minimum(times, end))
    places = np.stack([response.impacts["position_x_m"], response.impacts["position_y_m"]], axis=1)
    assert len(places) == 2
    assert np.hypot(*(places[1] - places[0])) > 3e-3
    later = times > 0.5 * (response.impacts["time_s"][0] + response.impacts["time_s"][1])
    found: dict[str, Floats] = {}
    kept, at_place = response.problem.plate.modes, response.problem.at_place
    assert kept is not None
    assert at_place is not None
    above = plate.omega > kept.angular_frequencies[-1]
    omega = np.append(kept.angular_frequencies, plate.omega[above])
    point = np.append(kept.points["two"][:, 2], plate.at(*AWAY)[above])[None]
    for number, (x, y) in enumerate(places):
        there = at_place((float(x), float(y))).plate.modes
        assert there is not None
        assert there.along is not None
        slopes = [
            (plate.at(x + STEP * a, y + STEP * b) - plate.at(x - STEP * a, y - STEP * b))
            / (2.0 * STEP)
            for a, b in ((1, 0), (0, 1))
        ]
        shapes = [plate.at(x, y), *(-0.5 * SIZE[2] * slope for slope in slopes)]
        modal = [there.contact, *there.along.T]
        forces = [history["force_N"], history["friction_x_N"], history["friction_y_N"]]
        inputs = [
            (np.append(low, high[above]), force)
            for low, high, force in zip(modal, shapes, forces, strict=True)
        ]
        for shape, force in inputs:
            once = driven(omega, RATIO, shape, point, np.where(later == bool(number), force, 0.0))
            found = {name: found.get(name, 0.0) + values[0] for name, values in once.items()}
    return found


def off(response: vi.Response, sensor: Sensor, exact: Floats) -> float:
    found = response.signals(sensor)["two"].value
    return rms(found - exact[: len(found)]) / rms(exact[: len(found)])


@pytest.mark.slow
@pytest.mark.parametrize("quantity", ["acceleration", "velocity", "displacement"])
def test_points(
    agrees: Agrees, response: vi.Response, motion: dict[str, Floats], quantity: str
) -> None:
    sensor = Sensor("two", quantity)  # type: ignore[arg-type]
    found, exact = (
        response.signals(sensor)["two"].value,
        sampled(motion[quantity], SAMPLES, "sigma-delta"),
    )
    agrees(
        "ideal sensors, two oblique impacts",
        f"{quantity} signal",
        found,
        exact[: len(found)],
        rms=0.01,
    )


@pytest.mark.slow
@pytest.mark.parametrize("filtered", ["sigma-delta", "butterworth"])
def test_accelerometers(
    agrees: Agrees, response: vi.Response, motion: dict[str, Floats], filtered: str
) -> None:
    exact = seismic(motion["acceleration"], 30e3, 0.02)
    sensor = Sensor("two", filter=filtered, instrument=Accelerometer(resonance=30e3))  # type: ignore[arg-type]
    found = response.signals(sensor)["two"].value
    agrees(
        f"accelerometers, filter {filtered}",
        "acceleration signal",
        found,
        sampled(exact, SAMPLES, filtered)[: len(found)],
        unit="m/s²",
        rms=0.01,
    )


def test_friction_is_heard(response: vi.Response) -> None:
    """Its moment is a part of the signal: without friction it is another one."""
    case = vi.case_of({**response.problem.source, "contact": {"law": "hertz"}})  # type: ignore[dict-item]
    without = vi.simulate(case).signals(Sensor("two"))["two"].value
    value = response.signals(Sensor("two"))["two"].value
    part = slice(0, round(0.5e-3 * SAMPLES))
    assert rms(value[part] - without[part]) > 0.02 * rms(value[part])
