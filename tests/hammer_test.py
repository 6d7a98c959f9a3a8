"""A plate that a hammer hits: its records by a modal superposition of SciPy, sampled
finely and decimated, and what is done to them.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import signal

import vibroimpact as vi
from vibroimpact.cases.build import problem_of
from vibroimpact.signals.record import Record

RATE = 12800.0
FINE = 16
PLATE = {
    "size": [0.4, 0.3, 0.012],
    "material": "steel",
    "model": "elastic",
    "modes": 8,
    "supports": "simply-supported",
    "damping": 0.008,
}
TABLE: dict[str, Any] = {
    "name": "hammered plate",
    "sphere": {"radius": 0.012, "material": "steel"},
    "plate": PLATE,
    "drop": {"speed": 0.5, "position": [0.07, 0.04]},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1},
    "sensors": [
        {"name": "a1", "position": [0.12, 0.08], "rate": 25.6e3},
        {"name": "a2", "position": [-0.05, 0.06], "rate": 25.6e3},
    ],
}
Array = NDArray[np.float64]


def a_case(**plate: Any) -> vi.Case:
    """The case, with another plate."""
    return vi.case_of({**TABLE, "plate": {**PLATE, **plate}})


@cache
def hammered(
    hits: tuple[float, ...] = (0.02,),
    duration: float = 0.4,
    damping: float = 0.008,
    delay: float = 0.0,
) -> tuple[Array, Array]:
    """The force (samples,) and the accelerations (2, samples) of half-sine pulses of 1 ms
    at some times, `delay` seconds later.
    """
    problem = problem_of(a_case(damping=damping))
    modes = problem.plate.modes
    assert modes is not None
    time = np.arange(round(duration * RATE) * FINE) / (RATE * FINE)
    force = np.zeros(len(time))
    for at in hits:
        part = (time - at - delay) / 1e-3
        force += 100.0 * np.sin(np.pi * part) * ((part > 0.0) & (part < 1.0))
    value = np.zeros((2, len(time)))
    names = [one["name"] for one in TABLE["sensors"]]
    for number, (omega, ratio) in enumerate(
        zip(modes.angular_frequencies, modes.damping_ratios, strict=True)
    ):
        # of the force, which is piecewise linear, exactly
        system = signal.cont2discrete(
            ([1.0, 0.0, 0.0], [1.0, 2.0 * ratio * omega, omega**2]),
            1.0 / (RATE * FINE),
            method="foh",
        )
        answer = signal.lfilter(np.ravel(system[0]), system[1], force)
        for row, name in enumerate(names):
            value[row] -= modes.contact[number] * modes.points[name][number, 2] * answer
    # what the modes left out answer with at once
    bend = np.gradient(np.gradient(force, time), time)
    for row, name in enumerate(names):
        value[row] -= modes.residuals[name][2] * bend
    sampled = [
        signal.resample_poly(one, 1, FINE, axis=-1, window=("kaiser", 12.0))
        for one in (force, value)
    ]
    return sampled[0], sampled[1]


def records(
    value: Array, decibels: float | None = 40.0, seed: int = 0, rate: float = RATE
) -> list[Record]:
    """The accelerations as records, with white noise so many decibels below their rms value."""
    random = np.random.default_rng(seed)
    names = [one["name"] for one in TABLE["sensors"]]
    level = 0.0 if decibels is None else 10.0 ** (-decibels / 20.0)
    noise = (
        level
        * np.sqrt(np.mean(value**2, axis=1, keepdims=True))
        * random.standard_normal(value.shape)
    )
    return [Record(name, one, rate, "m/s2") for name, one in zip(names, value + noise, strict=True)]


KNOCKED_RATE = 25600.0
SOFT = {"density": 7850.0, "youngs_modulus": "8 GPa", "poissons_ratio": 0.4}


def knocked_case(
    radius: float, material: Any = SOFT, damping: float = 0.005, modulus: float = 206e9
) -> vi.Case:
    """A plate of 40 modes under a sphere whose contact force has zeros at lower
    frequencies the larger and softer it is.
    """
    steel = {"density": 7850.0, "youngs_modulus": modulus, "poissons_ratio": 0.3}
    return vi.case_of(
        {
            **TABLE,
            "sphere": {"radius": radius, "material": material},
            "plate": {**PLATE, "material": steel, "modes": 40, "damping": damping},
            "drop": {"speed": 1.0, "position": TABLE["drop"]["position"]},
            "run": {"impacts": 1, "duration": 0.35},
            "sensors": [{**one, "rate": KNOCKED_RATE} for one in TABLE["sensors"]],
        }
    )


def knocked(case: vi.Case, level: float = 1e-3) -> tuple[list[Record], Record]:
    """The records of an impact with white noise, relative to their peaks, and its force,
    through a filter as they are.
    """
    response = vi.simulate(case)
    value = np.stack([response.signals()[one["name"]].value for one in TABLE["sensors"]])
    duration = float(response.impacts["duration_s"][0])
    time = np.arange(value.shape[1] * FINE) / (KNOCKED_RATE * FINE)
    force = np.where(time < duration, response.at(np.minimum(time, duration))["force_N"], 0.0)
    force = signal.resample_poly(force, 1, FINE, window=("kaiser", 10.0))
    quiet = np.zeros((3, round(0.02 * KNOCKED_RATE)))
    whole = np.concatenate([quiet, np.vstack([value, force])], axis=1)
    noise = (
        level
        * np.abs(whole).max(axis=1, keepdims=True)
        * np.random.default_rng(1).standard_normal(whole.shape)
    )
    noise[2] = 0.0
    *motions, push = whole + noise
    named = [
        Record(one["name"], motion, KNOCKED_RATE, "m/s2")
        for one, motion in zip(TABLE["sensors"], motions, strict=True)
    ]
    return named, Record("hammer", push, KNOCKED_RATE, "N")
