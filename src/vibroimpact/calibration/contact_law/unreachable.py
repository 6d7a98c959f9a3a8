"""Targets outside the attainable range: messages, and other parameters that would match them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.matching import GRID, Match, Tunable, derivatives, match
from vibroimpact.calibration.fit.tunables import law_parameter
from vibroimpact.calibration.observed.matchable import MATCHABLE, REBOUNDS
from vibroimpact.calibration.observed.noise import standard_deviations
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.calibration.observed.restitution_limit import (
    measured_restitutions,
    restitution_limit,
)
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError

_BEYOND_NOISE = 3.0
"""Standard deviations by which noise puts a target out of reach."""

_LOSSLESS = 1e-4
"""Relative margin to the lossless rebound that the law must attain for a restitution above 1 to
count as noise.
"""

_NEAR = 3
"""Steps by a factor of four from the value of the case in the search for another parameter."""


def check_reached(
    tunable: Tunable,
    problem: Problem,
    seen: Observations,
    weights: Mapping[str, float],
    match: Match,
) -> Floats:
    """Return the values found, NaN where noise puts the target out of reach.

    Raises
    ------
    InputError
        If a target is out of reach by more than noise.
    """
    unmatched = np.flatnonzero(np.isnan(match.values))
    if len(weights) > 1:
        if unmatched.size:
            raise InputError(
                f"{seen.labels[unmatched[0]]}: no {tunable.name} was found with which the "
                "matched quantities together deviate least; match one of them alone",
                "target",
            )
        return match.values
    (name,) = weights
    wanted = seen.wanted[name]
    for impact in (int(index) for index in unmatched):
        beyond = max(wanted[impact] - match.most[impact], match.least[impact] - wanted[impact])
        if 0.0 < beyond <= _noise_margin(tunable, problem, seen, name, impact):
            continue
        quantity = MATCHABLE[name]
        reach = _reach(tunable, name, wanted[impact], match.least[impact], match.most[impact])
        raise InputError(
            f"{seen.labels[impact]}: at an approach speed of {seen.speeds[impact]:.5g} m/s a "
            f"{quantity.phrase} of {wanted[impact]:.5g} {quantity.unit} is wanted, and "
            f"{problem.laws[0].name} gives {reach}"
            f"{_hint_of_others(tunable, problem, seen, weights, impact)}",
            "target",
        )
    return match.values


def _noise_margin(
    tunable: Tunable, problem: Problem, seen: Observations, name: str, impact: int
) -> float:
    """Return by how much noise may put a target out of reach."""
    return max(
        _BEYOND_NOISE * _deviation_of_target(tunable, seen, name, impact),
        _above_lossless(problem, seen, name, impact),
    )


def _reach(tunable: Tunable, name: str, wanted: float, least: float, most: float) -> str:
    """Return which values a quantity takes, of which the search has met `least` and `most`."""
    unit = MATCHABLE[name].unit
    if wanted > most and tunable.damps and name in REBOUNDS:
        return f"at most {most:.5g} {unit}, without any {tunable.name}"
    ends = list(dict.fromkeys([f"{least:.5g}", f"{most:.5g}"]))
    reach = f"{' to '.join(ends)} {unit}, {_tried(tunable, name)}"
    if least <= wanted <= most:
        return f"{reach}, but jumps over this one"
    return reach


def _hint_of_others(
    tunable: Tunable,
    problem: Problem,
    seen: Observations,
    weights: Mapping[str, float],
    impact: int,
) -> str:
    """Return which other parameters would match an impact; empty if there are none."""
    others = other_parameters(problem, tunable, seen, weights, row=impact)
    if not others:
        return ""
    # where the case gives no value of this one, it is the initial guess
    guess = ""
    if not np.isfinite(tunable.given).all():
        guess = f"{_parameter_text(problem, tunable.name, tunable.start)} and "
    values = [_parameter_text(problem, name, value) for name, value in others.items()]
    return f"; with {guess}the rest as given it would take {' or '.join(values)}"


def _tried(tunable: Tunable, name: str) -> str:
    """Return for which values of the parameter a quantity was computed."""
    if not tunable.damps or name in REBOUNDS:
        return f"whatever {tunable.name} is"
    low, high = tunable.allowed.clip(tunable.start * GRID[[0, -1]])
    return f"with {tunable.name} from {low:.3g} to {f'{high:.3g} {tunable.unit}'.rstrip()}"


def _above_lossless(problem: Problem, seen: Observations, name: str, impact: int) -> float:
    """Return the excess of a rebound over the lossless one, where that may be noise; else 0.

    It may be noise where the magnitude of the noise is unknown.
    """
    if seen.deviations_known or not seen.measured or name not in REBOUNDS:
        return 0.0
    radius = float(problem.sphere.contact_offset)
    gravity = float(problem.gravity)
    restitutions = measured_restitutions(seen, radius, gravity)
    if restitutions is None:
        return 0.0
    limit = restitution_limit(seen.speeds, restitutions, None).most[impact]
    if not 1.0 < restitutions[impact] <= limit:
        return 0.0
    speed = float(seen.speeds[impact])
    if name == "rebound_height":
        rise = 0.5 * speed**2 / gravity
        lossless = radius + rise
        scale = rise
    else:
        lossless = speed
        scale = speed
    return float(seen.wanted[name][impact]) - lossless + _LOSSLESS * scale


def _deviation_of_target(tunable: Tunable, seen: Observations, name: str, impact: int) -> float:
    """Return the standard deviation of the target minus the computed quantity.

    It is 0 if the magnitude of the noise is unknown.
    """
    if not seen.deviations_known:
        return 0.0
    almost_zero = tunable.allowed.clip(np.array([1e-3 * tunable.start]))
    near_zero = derivatives(tunable, seen.speeds[[impact]], almost_zero, seen.which[[impact]])
    noise = seen.noise[name][[impact]] - near_zero.by_speed[name][0] * seen.speed_noise[[impact]]
    return float(standard_deviations(noise)[0])


def other_parameters(
    problem: Problem,
    tunable: Tunable,
    seen: Observations,
    weights: Mapping[str, float],
    row: int = 0,
) -> dict[str, float]:
    """Return values of the other parameters of the law, each of which would match an impact.

    The rest is as given. Empty with several matched quantities, or with vibrating bodies.
    """
    law = problem.laws[0]
    if len(weights) > 1 or problem.vibrates or not isinstance(law, CompliantLaw):
        return {}
    wanted = {name: quantity[[row]] for name, quantity in seen.wanted.items()}
    matching_values = {}
    for field in fields(law):
        is_number = isinstance(getattr(law, field.name), float)
        if field.metadata["memory"] or field.name == tunable.name or not is_number:
            continue
        other = law_parameter(problem, field.name)
        matched = match(other, seen.speeds[[row]], wanted, weights, seen.which[[row]], _NEAR)
        if np.isfinite(matched.values[0]):
            matching_values[field.name] = float(matched.values[0])
    return matching_values


def _parameter_text(problem: Problem, name: str, value: float) -> str:
    return f"{name} = {value:.5g} {law_parameter(problem, name).unit}".rstrip()
