"""Sensors on a struck plate against the same chain at two million samples a second: ten times the
modes, SciPy's filters.

The ball and the plate are steel, 5 mm in radius and 6 mm thick; the contact lasts 35 us, so that
its force has a spectrum far beyond half of 50 kHz. The oracle gets the contact force and the modes
that the program keeps, which other tests hold against integrations and closed forms; those left out
it takes from Kirchhoff's closed form, and it follows all of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.measuring_chain import RATE, Floats, SimplySupported, driven, rms, sampled, seismic
from oracles.three_dimensional_plate import Elastic, thickness_modes
from support import supported_plate
from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor

AGAINST = Against(
    "measuring chain sampled at 2 MHz",
    "own independent computation",
    "sensors and signals",
    "tests/oracles/measuring_chain.py: contact force and kept modes of the package, the "
    "modes above in closed form, SciPy filters, ten times the number of modes",
)
THICK = Against(
    "all waves of an elastic layer, sampled at 2 MHz",
    "own independent computation",
    "sensors and signals",
    "tests/oracles/three_dimensional_plate.py and measuring_chain.py",
)


SIZE, DENSITY, MODULUS, POISSON, RATIO = (0.18, 0.15, 0.006), 7850.0, 210e9, 0.3, 0.002
SPOT, DURATION, SAMPLES = (-0.011, -0.0147), 2e-3, 50e3
AWAY = {"two": 2.0, "five": 5.0, "twelve": 12.0}
AFTER = 1.7e-3
"""How long the plate rings on [s] for the filter to look ahead at the end of the run."""
PROMISED = 0.01


def place(thicknesses: float) -> tuple[float, float]:
    return SPOT[0] + 0.8 * thicknesses * SIZE[2], SPOT[1] + 0.6 * thicknesses * SIZE[2]


def drop_watched(mesh: dict[str, Any], *more: dict[str, Any]) -> vi.Response:
    """A drop on the plate, whose sensors away from the contact are watched, and more of them."""
    sensors = [{"name": name, "position": list(place(apart))} for name, apart in AWAY.items()]
    plate = supported_plate(SIZE, RATIO)
    case = {
        "sphere": {"radius": 5e-3, "material": "steel"},
        "plate": {**plate, "max_frequency": 50e3, "mesh": mesh},
        "drop": {"speed": 1.0, "position": list(SPOT)},
        "contact": {"law": "hertz"},
        "run": {"duration": DURATION},
        "sensors": [*sensors, *more],
    }
    return vi.simulate(vi.case_of(case))


@pytest.fixture(scope="module")
def response() -> vi.Response:
    return drop_watched(
        {"theory": "thin"}, {"name": "under", "position": list(SPOT), "face": "lower"}
    )


@pytest.fixture(scope="module")
def motion(response: vi.Response) -> dict[str, dict[str, Floats]]:
    plate, kept = (
        SimplySupported(SIZE, DENSITY, MODULUS, POISSON, 600e3),
        response.problem.plate.modes,
    )
    assert kept is not None
    above = plate.omega > kept.angular_frequencies[-1]
    assert above.sum() > 8 * len(kept.frequencies)
    omega = np.append(kept.angular_frequencies, plate.omega[above])
    contact = np.append(kept.contact, plate.at(*SPOT)[above])
    apart = {**AWAY, "under": 0.0}
    points = np.stack(
        [
            np.append(kept.points[name][:, 2], plate.at(*place(far))[above])
            for name, far in apart.items()
        ]
    )
    times = np.arange(round((DURATION + AFTER) * RATE) + 1) / RATE
    force = response.at(np.minimum(times, response.end_time[0]))["force_N"]
    assert force[times > 0.1 * DURATION].max() == 0.0
    found = driven(omega, RATIO, contact, points, force)
    return {
        name: {quantity: values[number] for quantity, values in found.items()}
        for number, name in enumerate(apart)
    }


def compared(response: vi.Response, sensor: Sensor, exact: Floats) -> float:
    """How far a signal is off, as a part of its rms value."""
    found = response.signals(sensor)[sensor.name].value
    return rms(found - exact[: len(found)]) / rms(exact[: len(found)])


@pytest.mark.slow
@pytest.mark.parametrize("name", AWAY)
@pytest.mark.parametrize("quantity", ["acceleration", "velocity", "displacement"])
def test_bare_points(
    agrees: Agrees,
    response: vi.Response,
    motion: dict[str, dict[str, Floats]],
    name: str,
    quantity: Any,
) -> None:
    exact, signal = (
        sampled(motion[name][quantity], SAMPLES, "sigma-delta"),
        response.signals(Sensor(name, quantity))[name],
    )
    agrees(
        "ideal sensors, two to twelve plate thicknesses from the impact",
        f"{quantity} signal",
        signal.value,
        exact[: len(signal.value)],
        rms=PROMISED,
    )
    assert signal.uncertainty < PROMISED


@pytest.mark.slow
@pytest.mark.parametrize("rate", [20e3, 25e3, 40e3])
def test_rates(
    agrees: Agrees, response: vi.Response, motion: dict[str, dict[str, Floats]], rate: float
) -> None:
    """Down to where most modes lie above half of it: they pass in band what they do below
    their resonance.
    """
    found, exact = (
        response.signals(Sensor("two", rate=rate))["two"].value,
        sampled(motion["two"]["acceleration"], rate, "sigma-delta"),
    )
    agrees(
        "sampling rates 20 to 40 kHz",
        "acceleration signal",
        found,
        exact[: len(found)],
        unit="m/s²",
        rms=PROMISED,
    )


@pytest.mark.parametrize("filtered", ["sigma-delta", "butterworth"])
@pytest.mark.parametrize(
    "meter",
    [
        {"resonance": 30e3},
        {"resonance": 30e3, "range": 4000.0},
        {"resonance": 18e3, "damping_ratio": 0.7},
    ],
)
def test_accelerometers(
    agrees: Agrees,
    response: vi.Response,
    motion: dict[str, dict[str, Floats]],
    filtered: str,
    meter: dict[str, float],
) -> None:
    """A resonance above half the rate, driven beyond its range too: what is cut off there
    is what comes through in band.
    """
    exact = seismic(
        motion["two"]["acceleration"], meter["resonance"], meter.get("damping_ratio", 0.02)
    )
    end = meter.get("range", np.inf)
    sensor = Sensor("two", filter=filtered, instrument=Accelerometer(**meter))
    signal, clipped = (
        response.signals(sensor)["two"],
        sampled(np.clip(exact, -end, end), SAMPLES, filtered),
    )
    case = (
        f"accelerometers with a resonance, {'beyond' if np.isfinite(end) else 'within'} their "
        f"range, filter {filtered}"
    )
    agrees(
        case,
        "acceleration signal",
        signal.value,
        clipped[: len(signal.value)],
        unit="m/s²",
        rms=PROMISED,
    )
    if np.isfinite(end):
        within = np.abs(exact[: round(DURATION * RATE)])
        assert signal.peak == pytest.approx(within.max(), rel=0.02)
        assert signal.overload_time == pytest.approx((within > end).sum() / RATE, rel=0.02)
        assert np.abs(signal.value).max() < 0.6 * np.abs(exact).max()
    else:
        assert signal.overload_time == 0.0


def test_without_a_filter(response: vi.Response, motion: dict[str, dict[str, Floats]]) -> None:
    """What is there at the instants of the samples, which the modes left out matter more
    for: as much as is said.
    """
    for quantity in ("displacement", "velocity", "acceleration"):
        sensor = Sensor("two", quantity, filter="none")
        signal, exact = (
            response.signals(sensor)["two"],
            sampled(motion["two"][quantity], SAMPLES, "none"),
        )
        assert rms(signal.value - exact[: len(signal.value)]) < max(
            PROMISED, signal.uncertainty
        ) * rms(exact)
    assert signal.uncertainty > 0.1


def test_under_the_contact_the_doubt_holds(
    response: vi.Response, motion: dict[str, dict[str, Floats]]
) -> None:
    """Plate theory knows neither thickness nor face: a signal there may be off by what is
    said, and a sensor farther away has no doubt.
    """
    from vibroimpact.results.result import result_of

    off = compared(
        response, Sensor("under"), sampled(motion["under"]["acceleration"], SAMPLES, "sigma-delta")
    )
    found = result_of(response).doubts
    (doubt,) = (doubt for doubt in found if '"under"' in doubt)
    assert "0 thicknesses from the contact" in doubt
    assert off < float(doubt.split("by about ")[1].split(" %")[0]) / 100.0
    assert not any(f'"{name}"' in doubt for name in AWAY for doubt in found)


@pytest.fixture(scope="module")
def thick() -> tuple[vi.Response, dict[str, dict[str, Floats]]]:
    """Plate elements of the thick theory, and all waves of an elastic layer above the
    modes kept, through the thickness too.
    """
    response = drop_watched({"theory": "thick"})
    kept = response.problem.plate.modes
    assert kept is not None
    (length, width, thickness), layer = SIZE, Elastic(DENSITY, MODULUS, POISSON)
    m, n = (np.pi * np.arange(1, 81) / side for side in (length, width))

    def sines(x: float, y: float) -> Floats:
        return np.asarray(
            2.0
            / np.sqrt(length * width)
            * np.outer(np.sin(m * (x + 0.5 * length)), np.sin(n * (y + 0.5 * width))).ravel()
        )

    omegas, faces = zip(
        *(
            thickness_modes(np.hypot(m[:, None], n).ravel(), thickness, layer, even)
            for even in (False, True)
        ),
        strict=True,
    )
    omega, face = (np.concatenate(part, axis=1) for part in (omegas, faces))
    above = (omega > kept.angular_frequencies[-1]) & (omega < 2.0 * np.pi * 500e3)
    assert not above[-1].any()
    shapes = {
        name: (sines(*at)[:, None] * face)[above]
        for name, at in {"": SPOT, **{far: place(AWAY[far]) for far in AWAY}}.items()
    }
    points = np.stack([np.append(kept.points[name][:, 2], shapes[name]) for name in AWAY])
    times = np.arange(round((DURATION + AFTER) * RATE) + 1) / RATE
    force = response.at(np.minimum(times, response.end_time[0]))["force_N"]
    found = driven(
        np.append(kept.angular_frequencies, omega[above]),
        RATIO,
        np.append(kept.contact, shapes[""]),
        points,
        force,
    )
    return response, {
        name: {quantity: values[number] for quantity, values in found.items()}
        for number, name in enumerate(AWAY)
    }


@pytest.mark.slow
@pytest.mark.parametrize("name", AWAY)
@pytest.mark.parametrize("quantity", ["acceleration", "velocity", "displacement"])
def test_the_face_of_a_thick_plate(
    agrees: Agrees,
    thick: tuple[vi.Response, dict[str, dict[str, Floats]]],
    name: str,
    quantity: Any,
) -> None:
    response, motion = thick
    found, exact = (
        response.signals(Sensor(name, quantity))[name].value,
        sampled(motion[name][quantity], SAMPLES, "sigma-delta"),
    )
    agrees(
        "surface of a thick plate",
        f"{quantity} signal",
        found,
        exact[: len(found)],
        against=THICK,
        rms=PROMISED,
    )
