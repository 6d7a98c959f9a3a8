"""Targets outside the attainable range: error messages, and other parameters that would
match them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.matchable import MATCHABLE, REBOUNDS
from vibroimpact.calibration.matching import GRID, Match, Tunable, derivatives, match
from vibroimpact.calibration.noise import standard_deviations
from vibroimpact.calibration.observations import Observations
from vibroimpact.calibration.restitution_limit import measured_restitutions, restitution_limit
from vibroimpact.calibration.tunables import law_parameter
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.problem import Problem
from vibroimpact.errors import InputError

_BEYOND_NOISE = 3.0  # standard deviations
# relative margin to the lossless rebound that the law must attain for a restitution above 1 to
# count as noise
_LOSSLESS = 1e-4

_NEAR = 3  # steps by a factor of four from the given value in the search for another parameter


def check_reached(
    tunable: Tunable,
    problem: Problem,
    seen: Observations,
    weights: Mapping[str, float],
    found: Match,
) -> Floats:
    """Return the values found, NaN where noise puts the target out of reach.

    Raises
    ------
    InputError
        If a target is out of reach by more than noise.
    """
    missed = np.flatnonzero(np.isnan(found.values))
    if len(weights) > 1:
        if missed.size:
            words = (
                f"no {tunable.name} was found with which the "
                "matched quantities together deviate least"
            )
            raise InputError(
                f"{seen.labels[missed[0]]}: {words}; match one of them alone", "target"
            )
        return found.values
    (name,) = weights
    wanted, (_, unit, words) = seen.wanted[name], MATCHABLE[name]
    for row in missed:
        beyond = max(wanted[row] - found.most[row], found.least[row] - wanted[row])
        if (
            0.0
            < beyond
            <= max(
                _BEYOND_NOISE * _noise_of(tunable, seen, name, int(row)),
                _above_one(problem, seen, name, int(row)),
            )
        ):
            continue
        others = other_parameters(problem, tunable, seen, weights, row=int(row))
        # where the case gives no value of this one, it is the initial guess
        guess = (
            ""
            if np.isfinite(tunable.given).all()
            else f"{_value(problem, tunable.name, tunable.start)} and "
        )
        would = (
            f"; with {guess}the rest as given it would take "
            f"{' or '.join(_value(problem, *item) for item in others.items())}"
        )
        hint = would if others else ""
        asked = (
            f"{seen.labels[row]}: at an approach speed of {seen.speeds[row]:.5g} m/s a {words} "
            f"of {wanted[row]:.5g} {unit} is wanted"
        )
        ends = list(dict.fromkeys(f"{end:.5g}" for end in (found.least[row], found.most[row])))
        reach = f"{' to '.join(ends)} {unit}, {_tried(tunable, name)}"
        if beyond <= 0.0:
            reach = f"{reach}, but jumps over this one"
        elif tunable.damps and name in REBOUNDS and wanted[row] > found.most[row]:
            reach = f"at most {found.most[row]:.5g} {unit}, without any {tunable.name}"
        raise InputError(f"{asked}, and {problem.laws[0].name} gives {reach}{hint}", "target")
    return found.values


def _tried(tunable: Tunable, name: str) -> str:
    """Return in words for which values of the parameter a quantity was computed."""
    if not tunable.damps or name in REBOUNDS:
        return f"whatever {tunable.name} is"
    low, high = tunable.allowed.clip(tunable.start * GRID[[0, -1]])
    return f"with {tunable.name} from {low:.3g} to {f'{high:.3g} {tunable.unit}'.rstrip()}"


def _above_one(problem: Problem, seen: Observations, name: str, row: int) -> float:
    """Return the excess of a rebound over the lossless one, where that may be noise of
    unknown magnitude; else 0.
    """
    if seen.deviations_known or not seen.measured or name not in REBOUNDS:
        return 0.0
    radius, gravity, speed = (
        float(problem.sphere.contact_offset),
        float(problem.gravity),
        float(seen.speeds[row]),
    )
    found = measured_restitutions(seen, radius, gravity)
    if (
        found is None
        or not 1.0 < found[row] <= restitution_limit(seen.speeds, found, None).most[row]
    ):
        return 0.0
    height = 0.5 * speed**2 / gravity if name == "rebound_height" else 0.0
    lossless, scale = (radius + height, height) if height else (speed, speed)
    return float(seen.wanted[name][row]) - lossless + _LOSSLESS * scale


def _noise_of(tunable: Tunable, seen: Observations, name: str, row: int) -> float:
    """Return the standard deviation of the target minus the computed quantity; 0 if the
    magnitude of the noise is unknown.
    """
    if not seen.deviations_known:
        return 0.0
    near = derivatives(
        tunable,
        seen.speeds[[row]],
        tunable.allowed.clip(np.array([1e-3 * tunable.start])),
        seen.which[[row]],
    )
    return float(
        standard_deviations(
            seen.noise[name][[row]] - near.by_speed[name][0] * seen.speed_noise[[row]]
        )[0]
    )


def other_parameters(
    problem: Problem,
    tunable: Tunable,
    seen: Observations,
    weights: Mapping[str, float],
    row: int = 0,
) -> dict[str, float]:
    """Return values of the other parameters of the law, each of which would match an impact with
    the rest as given.

    Empty with several matched quantities, or with vibrating bodies.
    """
    law = problem.laws[0]
    if len(weights) > 1 or problem.vibrates or not isinstance(law, CompliantLaw):
        return {}
    found = {}
    for item in fields(law):
        if (
            item.metadata["memory"]
            or item.name == tunable.name
            or not isinstance(getattr(law, item.name), float)
        ):
            continue
        other = law_parameter(problem, item.name)
        wanted = {name: values[[row]] for name, values in seen.wanted.items()}
        value = match(other, seen.speeds[[row]], wanted, weights, seen.which[[row]], _NEAR).values[
            0
        ]
        if np.isfinite(value):
            found[item.name] = float(value)
    return found


def _value(problem: Problem, name: str, value: float) -> str:
    return f"{name} = {value:.5g} {law_parameter(problem, name).unit}".rstrip()
