"""Match a parameter to a target, impact by impact, and fit its polynomial of the approach speed.

The target is a drop under another contact law, or a measurement.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.calibrated_drops import impact_count, limited_to
from vibroimpact.calibration.fitting import (
    Fit,
    distinct,
    fit_observations,
    fit_values,
    value_deviations,
)
from vibroimpact.calibration.inputs import guessed_doubt
from vibroimpact.calibration.matchable import MATCHABLE
from vibroimpact.calibration.matching import Tunable, match
from vibroimpact.calibration.observations import Effects, Observations, with_noise_scale
from vibroimpact.calibration.single_impacts import batched_law, return_speeds, single_impacts
from vibroimpact.calibration.typed_inputs import Moved, effects_of
from vibroimpact.calibration.uncertainty import (
    bootstrap_intervals,
    default_draws,
    undetermined_doubts,
    with_nearest_bound,
)
from vibroimpact.calibration.unreachable import check_reached
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.errors import InputError

_CURVE_POINTS = 41
"""Number of speeds at which the exact value is computed for comparison with the polynomial."""

_PASSES = 20
_MOSTLY = 0.5
"""Part of a variance from which on a single input is named as the origin of it."""


class MatchedTarget(NamedTuple):
    """Matched impacts, the value of each, their fit and its uncertainty; fields as in
    `Calibration`.
    """

    seen: Observations
    values: Floats
    fit: Fit
    intervals: Floats | None = None
    curve: tuple[Floats, Floats] | None = None
    draws: int = 0
    doubts: Sequence[str] = ()


def match_drop(
    tuned: Tunable,
    problem: Problem,
    target: Problem,
    weights: Mapping[str, float],
    degree: int | None,
    speeds: Sequence[float] | Floats | None,
    tell: Callable[[float], None],
) -> MatchedTarget:
    """Return the values with which the impacts match those of another problem, `target`,
    with another law.
    """
    table = simulate(limited_to(target, impact_count(problem))).impacts
    # below this separation speed the sphere is at rest
    least = float(simulate(limited_to(problem, 1)).rest.speed[0])
    at = table["approach_speed_m_s"][table["separation_speed_m_s"] > least]
    if not len(at):
        raise InputError(
            "under the law of the target the sphere comes to rest in the first impact; "
            "there is no rebound to match",
            "target",
        )

    for name in weights:
        column = MATCHABLE[name].column
        if not np.all(table[column][: len(at)] > 0.0):
            if name == "rebound_height" and target.gravity == 0.0:
                raise InputError(
                    "without gravity a sphere rises for ever; there is no rebound height to match",
                    "match",
                )
            raise InputError(
                f"{name} does not follow from the target, {target.laws[0].name}; match "
                "something else",
                "match",
            )

    def wanted_at(fast: Floats) -> tuple[Observations, Floats]:
        outcomes = single_impacts(target, batched_law(target.laws, len(fast)), fast)
        labels = tuple(f"impact {number + 1}" for number in range(len(fast)))
        seen = Observations(fast, {name: outcomes[name] for name in weights}, labels=labels)
        return seen, check_reached(
            tuned, problem, seen, weights, match(tuned, fast, seen.wanted, weights, seen.which)
        )

    for _ in range(_PASSES):
        seen, values = wanted_at(at)
        tell(0.3)
        if set(weights) != {"separation_speed"}:
            # the rebound is not matched exactly: the approach speeds remain those of the target
            break
        # under a law that releases before the overlap has vanished the sphere comes back slightly
        # slower than it separated
        after = return_speeds(
            problem, tuned.respond(at, values, np.arange(len(at)))["next_speed"][:-1]
        )
        if np.allclose(after, at[1:], rtol=1e-10, atol=0.0):
            break
        at = np.append(at[0], after)
    # exact values over a range of speeds need one law for all impacts
    over, curve = None, None
    alike = len(target.laws) == 1 and _alike(problem, tuned)
    if speeds is not None:
        over = np.asarray(speeds, dtype=float)
        if not alike:
            raise InputError(
                "the contact law has one value per impact, and over a range of speeds it "
                "must have one for all; leave this out",
                "speeds",
            )
    elif len(at) > 1 and len(weights) == 1 and not problem.vibrates and alike:
        over = np.linspace(at.min(), at.max(), _CURVE_POINTS)
    if over is not None:
        curve = (over, _along(tuned, problem, target, weights, over, required=speeds is not None))
    along, through = curve if curve is not None and speeds is not None else (seen.speeds, values)
    return MatchedTarget(
        seen, values, fit_values(along, through, _degree(along, degree)), curve=curve
    )


def _along(
    tuned: Tunable,
    problem: Problem,
    target: Problem,
    weights: Mapping[str, float],
    speeds: Floats,
    *,
    required: bool,
) -> Floats:
    """Return the values at approach speeds with the first laws; without a solution NaN,
    or an error if the user gave the speeds.
    """
    outcomes = single_impacts(target, target.laws[0], speeds)
    labels = tuple(f"an impact at {speed:.4g} m/s" for speed in speeds)
    seen = Observations(
        speeds, {name: outcomes[name] for name in weights}, labels=labels, of_the_drop=False
    )
    found = match(tuned, speeds, seen.wanted, weights, seen.which)
    return check_reached(tuned, problem, seen, weights, found) if required else found.values


def _alike(problem: Problem, tuned: Tunable) -> bool:
    """Return whether the contact law is the same at each impact except for the tuned parameter."""
    first = problem.laws[0]
    return all(
        getattr(law, item.name) == getattr(first, item.name)
        for law in problem.laws
        for item in fields(law)
        if item.name != tuned.name
    )


def match_measurement(
    tuned: Tunable,
    problem: Problem,
    seen: Observations,
    weights: Mapping[str, float],
    degree: int | None,
    confidence: float,
    bootstrap: int | None,
    seed: int,
    tell: Callable[[float], None],
    moved: Sequence[Moved],
) -> MatchedTarget:
    """Return the values with which the impacts match a measurement, with confidence intervals."""
    missing = [name for name in weights if name not in seen.wanted]
    if missing:
        were = "was" if len(missing) == 1 else "were"
        raise InputError(
            f"{', '.join(missing)} {were} not measured; there is {', '.join(seen.wanted)}", "match"
        )
    found = match(tuned, seen.speeds, seen.wanted, weights, seen.which)
    alone = check_reached(tuned, problem, seen, weights, found)
    tell(0.3)
    values = with_nearest_bound(tuned, alone, seen.speeds, seen.wanted, weights, seen.which)
    seen = replace(seen, effects=effects_of(moved, tuned, seen, weights, values))
    fit = fit_observations(tuned, seen, weights, _degree(seen.speeds, degree), alone)
    tell(0.5)
    doubts = list(seen.doubts) + [
        f"{label}: no {tuned.name} meets it exactly, though one does within the noise; the "
        "nearest that is allowed, "
        f"{f'{nearest:.5g} {tuned.unit}'.rstrip()}, is taken"
        for label, value, nearest in zip(seen.labels, alone, values, strict=True)
        if np.isnan(value)
    ]
    sized = seen if seen.deviations_known else with_noise_scale(seen, fit.scatter, weights)
    deviations, by_input = value_deviations(tuned, sized, weights, values)
    if seen.effects is not None:
        doubts += _guessed_inputs(seen.effects, seen.labels, deviations, by_input)
    half, draws = fit.quantile(confidence) * deviations, 0
    intervals = (
        np.stack([values - half, values + half], axis=1) if np.isfinite(half).all() else None
    )
    if intervals is not None:
        draws = default_draws(values, deviations) if bootstrap is None else bootstrap
    if draws:
        intervals, fit = bootstrap_intervals(
            tuned,
            sized,
            weights,
            fit,
            deviations,
            draws,
            confidence,
            seed,
            lambda done: tell(0.5 + 0.4 * done),
        )
        # the samples have the noise as given, and the residuals are larger
        if seen.deviations_known and np.isfinite(fit.freedom):
            fit = replace(fit, covariance=fit.scatter**2 * fit.covariance)
    doubts += undetermined_doubts(tuned, values, intervals, seen, fit, confidence)
    within = None if intervals is None else tuned.allowed.bounded(intervals)
    return MatchedTarget(seen, values, fit, within, None, draws, doubts)


def _guessed_inputs(
    effects: Effects, labels: Sequence[str], deviations: Floats, by_input: Floats
) -> list[str]:
    """Return warnings about inputs of unstated uncertainty that most of the interval of a
    value is from.
    """
    parts = np.nan_to_num(by_input**2 / deviations[:, None] ** 2)
    told = []
    for number, one in enumerate(effects.inputs):
        most = int(np.argmax(parts[:, number]))
        if not one.value.stated and parts[most, number] > _MOSTLY:
            several = np.count_nonzero(parts[:, number] > _MOSTLY) - 1
            told.append(
                guessed_doubt(one, f"{labels[most]}{f' and of {several} more' if several else ''}")
            )
    return told


def _degree(speeds: Floats, degree: int | None) -> int:
    """Return the given degree, or by default 2, less if there are fewer than three
    distinct speeds.
    """
    return min(2, distinct(speeds) - 1) if degree is None else degree
