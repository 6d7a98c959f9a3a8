"""Match the impacts of a drop under another law."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.drops import impacts_of, shortened
from vibroimpact.calibration.fitting import fit_values
from vibroimpact.calibration.match_result import Matched, degree_of
from vibroimpact.calibration.matching import Tunable, match
from vibroimpact.calibration.observations import Observations
from vibroimpact.calibration.one_impact import one_impact, stacked
from vibroimpact.calibration.outcomes import OUTCOMES
from vibroimpact.calibration.unreachable import check_reached
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.errors import InputError

_CURVE_POINTS = 41
"""Speeds between the slowest and the fastest impact at which the exact value is found too, to compare the polynomial with."""

_PASSES = 20


def match_drop(
    tuned: Tunable,
    problem: Problem,
    target: Problem,
    weights: Mapping[str, float],
    degree: int | None,
    speeds: Sequence[float] | Floats | None,
    tell: Callable[[float], None],
) -> Matched:
    """Return the values with which impacts come out as they do under the law of another problem, `target`."""
    table = simulate(shortened(target, impacts_of(problem))).impacts
    least = float(simulate(shortened(problem, 1)).rest.speed[0])  # what leaves more slowly stays
    at = table["approach_speed_m_s"][table["separation_speed_m_s"] > least]
    if not len(at):
        raise InputError("under the law of the target the sphere does not leave the plate; there is no rebound to match", "target")

    for name in weights:
        column = OUTCOMES[name].column
        if not np.all(table[column][: len(at)] > 0.0):
            raise InputError(f"{name} is not told by the target, {target.laws[0].name}; match something else", "match")

    def wanted_at(fast: Floats) -> tuple[Observations, Floats]:
        outcomes = one_impact(target, stacked(target.laws, len(fast)), fast)
        labels = tuple(f"impact {number + 1}" for number in range(len(fast)))
        seen = Observations(fast, {name: outcomes[name] for name in weights}, labels=labels)
        return seen, check_reached(tuned, problem, seen, weights, match(tuned, fast, seen.wanted, weights, seen.which))

    for _ in range(_PASSES):
        seen, values = wanted_at(at)
        tell(0.3)
        if set(weights) != {"separation_speed"}:
            break  # it bounces otherwise than the target does, whose impacts are matched all the same
        # a law that lets go before the overlap is gone comes down again a little faster than it left
        after = tuned.respond(at, values, np.arange(len(at)))["next_speed"][:-1]
        if np.allclose(after, at[1:], rtol=1e-10, atol=0.0):
            break
        at = np.append(at[0], after)
    over, curve = None, None
    alike = len(target.laws) == 1 and _alike(problem, tuned)
    if speeds is not None:
        over = np.asarray(speeds, dtype=float)
        if not alike:
            raise InputError("a contact law has one value an impact, and over a range of speeds it must have one for all", "speeds")
    elif len(at) > 1 and len(weights) == 1 and not problem.vibrates and alike:
        over = np.linspace(at.min(), at.max(), _CURVE_POINTS)
    if over is not None:
        curve = (over, _along(tuned, problem, target, weights, over, asked=speeds is not None))
    along, through = curve if curve is not None and speeds is not None else (seen.speeds, values)
    return Matched(seen, values, fit_values(along, through, degree_of(along, degree)), curve=curve)


def _along(tuned: Tunable, problem: Problem, target: Problem, weights: Mapping[str, float], speeds: Floats, *, asked: bool) -> Floats:
    """Return the values at approach speeds, under the first laws; NaN where there is none, unless they were asked for."""
    outcomes = one_impact(target, target.laws[0], speeds)
    labels = tuple(f"an impact at {speed:.4g} m/s" for speed in speeds)
    seen = Observations(speeds, {name: outcomes[name] for name in weights}, labels=labels, of_the_drop=False)
    found = match(tuned, speeds, seen.wanted, weights, seen.which)
    return check_reached(tuned, problem, seen, weights, found) if asked else found.values


def _alike(problem: Problem, tuned: Tunable) -> bool:
    """Is the contact law the same at each impact, but for what is tuned?"""
    first = problem.laws[0]
    return all(
        getattr(law, item.name) == getattr(first, item.name) for law in problem.laws for item in fields(law) if item.name != tuned.name
    )
