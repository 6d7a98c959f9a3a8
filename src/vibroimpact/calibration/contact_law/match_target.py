"""Match a parameter to a target, impact by impact, and fit its polynomial of the approach speed.

The target is a drop under another contact law, or a measurement.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.contact_law.unreachable import check_reached
from vibroimpact.calibration.fit.calibrated_drops import impact_count, limited_to
from vibroimpact.calibration.fit.fitting import (
    Fit,
    distinct,
    fit_observations,
    fit_values,
    value_deviations,
)
from vibroimpact.calibration.fit.matching import Tunable, match
from vibroimpact.calibration.fit.single_impacts import batched_law, return_speeds, single_impacts
from vibroimpact.calibration.fit.typed_inputs import Moved, effects_of
from vibroimpact.calibration.fit.uncertainty import (
    bootstrap_intervals,
    default_draws,
    undetermined_doubts,
    with_nearest_bound,
)
from vibroimpact.calibration.observed.inputs import guessed_doubt
from vibroimpact.calibration.observed.matchable import MATCHABLE
from vibroimpact.calibration.observed.observations import Effects, Observations, with_noise_scale
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError

_CURVE_POINTS = 41
"""Number of speeds at which the exact value is computed for comparison with the polynomial."""

_PASSES = 20
"""Largest number of corrections of the approach speeds."""

_MOSTLY = 0.5
"""Fraction of a variance from which on a single input is named as the origin of it."""


class MatchedTarget(NamedTuple):
    """Matched impacts, the value of each, their fit and its uncertainty.

    Fields are as in `Calibration`; `seen` are the matched impacts, `draws` bootstrap samples.
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
    """Return the values with which the impacts match those of `target`, with another law."""
    start = _target_speeds(problem, target, weights)
    seen, values = _matched_impacts(tuned, problem, target, weights, start, tell)
    # exact values over a range of speeds need one law for all impacts
    one_law = len(target.laws) == 1 and _alike(problem, tuned)
    if speeds is not None:
        if not one_law:
            raise InputError(
                "the contact law has one value per impact, and over a range of speeds it "
                "must have one for all; leave this out",
                "speeds",
            )
        curve_speeds = np.asarray(speeds, dtype=float)
        curve_values = _values_at(tuned, problem, target, weights, curve_speeds, required=True)
        fit = fit_values(curve_speeds, curve_values, _degree(curve_speeds, degree))
        return MatchedTarget(seen, values, fit, curve=(curve_speeds, curve_values))
    curve = None
    if len(seen.speeds) > 1 and len(weights) == 1 and not problem.vibrates and one_law:
        curve_speeds = np.linspace(seen.speeds.min(), seen.speeds.max(), _CURVE_POINTS)
        curve_values = _values_at(tuned, problem, target, weights, curve_speeds, required=False)
        curve = (curve_speeds, curve_values)
    fit = fit_values(seen.speeds, values, _degree(seen.speeds, degree))
    return MatchedTarget(seen, values, fit, curve=curve)


def _target_speeds(problem: Problem, target: Problem, weights: Mapping[str, float]) -> Floats:
    """Return the approach speeds of the impacts of the target with a rebound [m/s].

    Check that the quantities to be matched follow from it.
    """
    table = simulate(limited_to(target, impact_count(problem))).impacts
    # below this separation speed the sphere is at rest
    rest_speed = float(simulate(limited_to(problem, 1)).rest.speed[0])
    speeds = table["approach_speed_m_s"][table["separation_speed_m_s"] > rest_speed]
    if not len(speeds):
        raise InputError(
            "under the law of the target the sphere comes to rest in the first impact; "
            "there is no rebound to match",
            "target",
        )
    for name in weights:
        column = MATCHABLE[name].column
        if np.all(table[column][: len(speeds)] > 0.0):
            continue
        if name == "rebound_height" and target.gravity == 0.0:
            raise InputError(
                "without gravity a sphere rises for ever; there is no rebound height to match",
                "match",
            )
        raise InputError(
            f"{name} does not follow from the target, {target.laws[0].name}; match something else",
            "match",
        )
    return speeds


def _matched_impacts(
    tuned: Tunable,
    problem: Problem,
    target: Problem,
    weights: Mapping[str, float],
    speeds: Floats,
    tell: Callable[[float], None],
) -> tuple[Observations, Floats]:
    """Return the impacts of the target and the value that matches each.

    `speeds` are approach speeds to begin with [m/s].
    """
    for _ in range(_PASSES):
        outcomes = single_impacts(target, batched_law(target.laws, len(speeds)), speeds)
        seen = Observations(
            speeds,
            {name: outcomes[name] for name in weights},
            labels=tuple(f"impact {number + 1}" for number in range(len(speeds))),
        )
        matched = match(tuned, speeds, seen.wanted, weights, seen.which)
        values = check_reached(tuned, problem, seen, weights, matched)
        tell(0.3)
        if set(weights) != {"separation_speed"}:
            # the rebound is not matched exactly: the approach speeds remain those of the target
            break
        # under a law that releases before the overlap has vanished the sphere comes back slightly
        # slower than it separated
        next_speeds = tuned.respond(speeds, values, np.arange(len(speeds)))["next_speed"]
        later_speeds = return_speeds(problem, next_speeds[:-1])
        if np.allclose(later_speeds, speeds[1:], rtol=1e-10, atol=0.0):
            break
        speeds = np.append(speeds[0], later_speeds)
    return seen, values


def _values_at(
    tuned: Tunable,
    problem: Problem,
    target: Problem,
    weights: Mapping[str, float],
    speeds: Floats,
    *,
    required: bool,
) -> Floats:
    """Return the values at approach speeds with the first laws.

    Without a solution they are NaN, or if they are required there is an error.
    """
    outcomes = single_impacts(target, target.laws[0], speeds)
    labels = tuple(f"an impact at {speed:.4g} m/s" for speed in speeds)
    seen = Observations(
        speeds, {name: outcomes[name] for name in weights}, labels=labels, of_the_drop=False
    )
    matched = match(tuned, speeds, seen.wanted, weights, seen.which)
    if not required:
        return matched.values
    return check_reached(tuned, problem, seen, weights, matched)


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
    matched = match(tuned, seen.speeds, seen.wanted, weights, seen.which)
    exact_values = check_reached(tuned, problem, seen, weights, matched)
    tell(0.3)
    values = with_nearest_bound(tuned, exact_values, seen.speeds, seen.wanted, weights, seen.which)
    seen = replace(seen, effects=effects_of(moved, tuned, seen, weights, values))
    fit = fit_observations(tuned, seen, weights, _degree(seen.speeds, degree), exact_values)
    tell(0.5)
    doubts = [*seen.doubts, *_not_met_doubts(tuned, seen.labels, exact_values, values)]
    scaled = seen
    if not seen.deviations_known:
        scaled = with_noise_scale(seen, fit.scatter, weights)
    deviations, by_input = value_deviations(tuned, scaled, weights, values)
    if seen.effects is not None:
        doubts += _guessed_inputs(seen.effects, seen.labels, deviations, by_input)
    half_widths = fit.quantile(confidence) * deviations
    intervals = None
    draws = 0
    if np.isfinite(half_widths).all():
        intervals = np.stack([values - half_widths, values + half_widths], axis=1)
        draws = default_draws(values, deviations)
        if bootstrap is not None:
            draws = bootstrap
    if draws:
        intervals, fit = bootstrap_intervals(
            tuned,
            scaled,
            weights,
            fit,
            deviations,
            draws,
            confidence,
            seed,
            lambda fraction: tell(0.5 + 0.4 * fraction),
        )
        # the samples have the noise as given, and the residuals are larger
        if seen.deviations_known and np.isfinite(fit.freedom):
            fit = replace(fit, covariance=fit.scatter**2 * fit.covariance)
    doubts += undetermined_doubts(tuned, values, intervals, seen, fit, confidence)
    if intervals is not None:
        intervals = tuned.allowed.bounded(intervals)
    return MatchedTarget(seen, values, fit, intervals=intervals, draws=draws, doubts=doubts)


def _not_met_doubts(
    tuned: Tunable, labels: Sequence[str], exact_values: Floats, values: Floats
) -> list[str]:
    """Return warnings about impacts that no value meets exactly, where `exact_values` are NaN."""
    doubts = []
    for impact in np.flatnonzero(np.isnan(exact_values)):
        nearest = f"{values[impact]:.5g} {tuned.unit}".rstrip()
        doubts.append(
            f"{labels[int(impact)]}: no {tuned.name} meets it exactly, though one does within the "
            f"noise; the nearest that is allowed, {nearest}, is taken"
        )
    return doubts


def _guessed_inputs(
    effects: Effects, labels: Sequence[str], deviations: Floats, by_input: Floats
) -> list[str]:
    """Return warnings about inputs of unstated uncertainty that most of an interval is from."""
    fractions = np.nan_to_num(by_input**2 / deviations[:, None] ** 2)  # of the variances
    doubts = []
    for column, typed in enumerate(effects.inputs):
        largest = int(np.argmax(fractions[:, column]))
        if not typed.value.stated and fractions[largest, column] > _MOSTLY:
            more = np.count_nonzero(fractions[:, column] > _MOSTLY) - 1
            and_more = f" and of {more} more" if more else ""
            doubts.append(guessed_doubt(typed, f"{labels[largest]}{and_more}"))
    return doubts


def _degree(speeds: Floats, degree: int | None) -> int:
    """Return the stated degree, or by default 2, less with fewer than three distinct speeds."""
    if degree is None:
        return min(2, distinct(speeds) - 1)
    return degree
