"""Impacts on an elastic plate whose records are identified: simulated with more modes
than the model that identifies them has.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

import vibroimpact as vi
from vibroimpact.cases.rigid.rigid_problem import rigid_problem
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.identification.plate import Plate, compliance_error, plate_of, with_compliance
from vibroimpact.identification.setup import Setup, SetupErrors
from vibroimpact.signals.record import Record

RATE, WINDOW, DELAY = 25600.0, 5e-3, 4e-3
"""Samples per second [Hz]; time that is used, and time from the start to first touch [s]."""
SENSORS = {"a": (0.17, 0.05), "b": (-0.13, 0.11), "c": (-0.03, -0.14)}
THICKNESS = 0.010
FITTED = (
    "place_x_m",
    "place_y_m",
    "radius_m",
    "speed_m_s",
    "first_touch_s",
    "max_force_N",
    "impulse_N_s",
)
"""Estimates from the contact that is fitted to the records."""
FROM_RECORDS = ("recovered_max_force_N", "recovered_impulse_N_s")
"""Estimates from the records alone."""


def a_case(modes: int = 140, **changed: Any) -> vi.Case:
    """A sphere of coal on a plate with three accelerometers; the modes reach beyond what
    they hear.
    """
    table: dict[str, Any] = {
        "name": "coal on a plate",
        "sphere": {
            "radius": 0.02,
            "material": {"density": 1380.0, "youngs_modulus": 2.26e9, "poissons_ratio": 0.28},
        },
        "plate": {
            "size": [0.5, 0.4, THICKNESS],
            "material": {"density": 7850.0, "youngs_modulus": 210e9, "poissons_ratio": 0.3},
            "model": "elastic",
            "modes": modes,
            "damping": 0.01,
            "supports": "simply-supported",
        },
        "drop": {"speed": 3.0},
        "contact": {"law": "tsuji", "restitution": 0.6},
        "sensors": [
            {"name": name, "position": list(place), "rate": RATE} for name, place in SENSORS.items()
        ],
    }
    return vi.case_of({**table, **changed})


@cache
def plate(modes: int = 140) -> Plate:
    """The plate of the case, with its modes."""
    return plate_of(a_case(modes), WINDOW)


@dataclass(frozen=True)
class Impact:
    """What happened: radius [m], speed [m/s], place [m], first touch [s]; and the run."""

    radius: float
    speed: float
    place: tuple[float, float]
    response: Response

    @property
    def peak(self) -> float:
        return float(self.response.impacts["max_force_N"][0])

    @property
    def impulse(self) -> float:
        nodes, weights = np.polynomial.legendre.leggauss(200)
        duration = float(self.response.impacts["duration_s"][0])
        force = self.response.at(DELAY + 0.5 * duration * (1.0 + nodes), ["force_N"])["force_N"]
        return float(0.5 * duration * weights @ force)


def an_impact(
    radius: float,
    speed: float,
    place: tuple[float, float],
    modes: int = 280,
    off: np.random.Generator | None = None,
) -> Impact:
    """A sphere that touches the plate first at `DELAY`; the plate is off its model by
    what the model states of its own errors, if asked.
    """
    there = plate(modes).at(place)
    if off is not None:
        there = off_by_its_errors(plate(modes), there, off)
    return _dropped(plate(modes), there, radius, speed, place)


def _dropped(
    on: Plate, there: Problem, radius: float, speed: float, place: tuple[float, float]
) -> Impact:
    case = on.touched
    rigid = rigid_problem(
        case.model_copy(update={"sphere": case.sphere.model_copy(update={"radius": radius})})
    )
    gravity = float(there.gravity)
    height = radius + speed * DELAY - 0.5 * gravity * DELAY**2
    falling = {
        "speed": None,
        "height": height,
        "velocity": gravity * DELAY - speed,
        "impacts": None,
        "duration": DELAY + 2.0 * WINDOW,
    }
    return Impact(
        radius,
        speed,
        place,
        vi.simulate(replace(there, sphere=rigid.sphere, laws=rigid.laws, **falling)),
    )


def off_by_its_errors(plate: Plate, problem: Problem, random: np.random.Generator) -> Problem:
    """A problem with frequencies and static compliance drawn from the errors that the
    model of its plate states.
    """
    mean, deviation = compliance_error(plate, problem)
    modes = problem.plate.modes
    assert modes is not None
    frequencies = modes.frequencies * (
        1.0 + plate.frequency_errors * random.standard_normal(len(modes.frequencies))
    )
    softer = with_compliance(problem, mean + deviation * random.standard_normal())
    return replace(
        softer, plate=replace(problem.plate, modes=replace(modes, frequencies=frequencies))
    )


def records_of(impact: Impact, decibels: float, seed: int) -> list[Record]:
    """What the sensors record, with white noise so many decibels below the rms value
    after first touch.
    """
    random, found = np.random.default_rng(seed), []
    for name, signal in impact.response.signals().items():
        from_touch = signal.value[round(DELAY * RATE) : round((DELAY + WINDOW) * RATE)]
        noise = 10.0 ** (-decibels / 20.0) * np.sqrt(np.mean(from_touch**2))
        found.append(
            Record(
                name, signal.value + noise * random.standard_normal(len(signal.value)), RATE, "m/s2"
            )
        )
    return found


LABORATORY = SetupErrors(sensor_place=5e-3, gain=0.02, thickness=0.01, modulus=0.03, resonance=0.05)
"""Errors of a laboratory."""


@cache
def mounted(modes: int = 140, errors: SetupErrors | None = None) -> Plate:
    """The plate with accelerometers that have a mounted resonance."""
    sensors = [
        {"name": name, "position": list(at), "rate": RATE, "accelerometer": {"resonance": 30e3}}
        for name, at in SENSORS.items()
    ]
    return plate_of(a_case(modes, sensors=sensors), WINDOW, errors=errors)


def in_laboratory(
    radius: float,
    speed: float,
    place: tuple[float, float],
    random: np.random.Generator,
    errors: SetupErrors = LABORATORY,
) -> tuple[Impact, Setup]:
    """An impact on a plate and sensors that differ from the case by random errors, and
    how they do; gains are those of `heard_by`.
    """
    setup = Setup.of(errors.deviations(len(SENSORS)) * random.standard_normal(2 + 4 * len(SENSORS)))
    there = mounted(280).under(setup, list(SENSORS))
    return _dropped(there, there.at(place), radius, speed, place), setup


def heard_by(setup: Setup, records: list[Record]) -> list[Record]:
    """Records through amplifiers whose gains are those of a set-up."""
    return [
        replace(record, value=(1.0 + gain) * record.value)
        for record, gain in zip(records, setup.gain, strict=True)
    ]


def drawn(number: int, seed: int) -> list[tuple[float, float, tuple[float, float]]]:
    """Radii, speeds and places in the middle of the plate."""
    random = np.random.default_rng(seed)
    radii, speeds = random.uniform(0.012, 0.03, number), random.uniform(1.0, 6.0, number)
    places = random.uniform(-1.0, 1.0, (number, 2)) * [0.12, 0.1]
    return [
        (float(r), float(v), (float(x), float(y)))
        for r, v, (x, y) in zip(radii, speeds, places, strict=True)
    ]
