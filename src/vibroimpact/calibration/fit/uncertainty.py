"""Uncertainty of calibrated values: bootstrap intervals, and warnings about values and fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.polynomial import polynomial

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.fit.calibrated_drops import impact_count, is_other_drop
from vibroimpact.calibration.fit.fitting import Fit
from vibroimpact.calibration.fit.matching import Tunable, match
from vibroimpact.calibration.fit.single_impacts import first_approach_speed
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.units.display import known_text

_DRAWN_VALUES = 2000  # values computed by the default bootstrap, so that it takes seconds
_FEWEST_DRAWS = 100
_MOST_DRAWS = 400

_MOST_IMPACTS = 20
"""Number of impacts above which the default is no bootstrap."""

_WIDE = 0.25
"""Two standard deviations above which first-order intervals are not trusted, as a fraction of the
value.
"""

_UNDETERMINED = 1.0
"""Width of an interval above which the value counts as undetermined, as a fraction of the value."""

_FOLLOWS = 0.02
"""Deviation of the polynomial above which a warning is given, as a fraction of the
largest value.
"""

_AT_ONCE = 500
"""Number of impacts that are matched at once."""

_MOST_NAMED = 5
"""Number of impacts that are named in warnings of the same kind."""


def default_draws(values: Floats, deviations: Floats) -> int:
    """Return the default number of bootstrap samples.

    It is 0 unless the noise is too large for first-order intervals. With many impacts the aim is
    the polynomial, for which first order suffices.
    """
    if len(values) > _MOST_IMPACTS or np.all(2.0 * deviations <= _WIDE * np.abs(values)):
        return 0
    return int(np.clip(_DRAWN_VALUES // len(values), _FEWEST_DRAWS, _MOST_DRAWS))


def bootstrap_intervals(
    tunable: Tunable,
    observations: Observations,
    weights: Mapping[str, float],
    fit: Fit,
    deviations: Floats,
    draws: int,
    confidence: float,
    seed: int,
    progress: Callable[[float], None],
) -> tuple[Floats, Fit]:
    """Return intervals of the values, (n, 2), and the fit, by a parametric bootstrap.

    The fit has the covariance of its coefficients. Samples are the measurement plus a realization
    of its noise, matched like the measurement. A sample that no value matches counts as the nearest
    end of the range.

    Parameters
    ----------
    tunable : Tunable
        The parameter.
    observations : Observations
        The measurement, with noise of known magnitude.
    weights : mapping of str to float
        Weights of the matched quantities.
    fit : Fit
        The fit to the measurement.
    deviations : array, shape (n,)
        First-order standard deviations of the values, whose inverses weight the polynomials fitted
        to the samples.
    draws : int
        Number of samples.
    confidence : float
        Confidence level of the intervals.
    seed : int
        Seed of the random numbers.
    progress : callable
        Called with the fraction done.
    """
    sampled_values, sampled_speeds = _bootstrap_samples(
        tunable, observations, weights, draws, np.random.default_rng(seed), progress
    )
    tail = 50.0 * (1.0 - confidence)
    ends = np.percentile(sampled_values, [tail, 100.0 - tail], axis=0).T
    # the samples assume a known noise; widen the intervals where it is only estimated (Student's t
    # over normal quantile)
    widening = fit.quantile(confidence) / replace(fit, freedom=np.inf).quantile(confidence)
    median = np.median(sampled_values, axis=0)[:, None]
    intervals = median + widening * (ends - median)
    coefficients = [
        polynomial.polyfit(speeds, values, fit.function.degree, w=1.0 / deviations)
        for speeds, values in zip(sampled_speeds, sampled_values, strict=True)
    ]
    return intervals, replace(fit, covariance=np.atleast_2d(np.cov(np.array(coefficients).T)))


def _bootstrap_samples(
    tunable: Tunable,
    observations: Observations,
    weights: Mapping[str, float],
    draws: int,
    random: np.random.Generator,
    progress: Callable[[float], None],
) -> tuple[Floats, Floats]:
    """Return the values that match samples of the measurement, and their approach speeds [m/s].

    Both have the shape (draws, n).
    """
    impact_count = len(observations.speeds)
    draws_at_once = max(1, _AT_ONCE // impact_count)
    blocks_of_values = []
    blocks_of_speeds = []
    for begin in range(0, draws, draws_at_once):
        samples = [observations.redrawn(random) for _ in range(min(draws_at_once, draws - begin))]
        speeds = np.concatenate([sample_speeds for sample_speeds, _ in samples])
        wanted = {
            name: np.concatenate([sample_wanted[name] for _, sample_wanted in samples])
            for name in weights
        }
        which = np.tile(observations.which, len(samples))
        values = match(tunable, speeds, wanted, weights, which).values
        values = with_nearest_bound(tunable, values, speeds, wanted, weights, which)
        blocks_of_values.append(values.reshape(len(samples), impact_count))
        blocks_of_speeds.append(speeds.reshape(len(samples), impact_count))
        progress(min(1.0, (begin + draws_at_once) / draws))
    return np.concatenate(blocks_of_values), np.concatenate(blocks_of_speeds)


def with_nearest_bound(
    tunable: Tunable,
    values: Floats,
    speeds: Floats,
    wanted: Mapping[str, Floats],
    weights: Mapping[str, float],
    which: Indices,
) -> Floats:
    """Return values with NaN replaced by the end of the range that deviates least."""
    missing = np.flatnonzero(np.isnan(values))
    if not missing.size:
        return values
    lowest = tunable.allowed.clip(np.full(missing.size, -np.inf))
    highest = tunable.allowed.clip(np.full(missing.size, np.inf))
    # a range that is open on one side has no end there
    ends = [end for end in (lowest, highest) if np.isfinite(end).all()]
    if not ends:
        return values
    costs = []
    for end in ends:
        outcomes = tunable.respond(speeds[missing], end, which[missing])
        costs.append(
            sum(
                weight * (outcomes[name] / wanted[name][missing] - 1.0) ** 2
                for name, weight in weights.items()
            )
        )
    filled = values.copy()
    filled[missing] = np.choose(np.argmin(np.array(costs), axis=0), ends)
    return filled


def undetermined_doubts(
    tunable: Tunable,
    values: Floats,
    intervals: Floats | None,
    observations: Observations,
    fit: Fit,
    confidence: float,
) -> list[str]:
    """Return warnings about values and coefficients that the measurement does not determine."""
    if intervals is None:
        if fit.freedom > 0:
            return [
                f"{tunable.name} has no influence on one of the impacts, so "
                "that there are no intervals"
            ]
        return [
            "there are no more measured values than coefficients, and no standard "
            "deviations: their uncertainty is unknown"
        ]
    percent = f"{100.0 * confidence:g} %"
    doubts = []
    widths = intervals[:, 1] - intervals[:, 0]
    undetermined = np.flatnonzero(widths > _UNDETERMINED * np.abs(values))
    for impact in undetermined[:_MOST_NAMED]:
        half = 0.5 * float(np.ptp(intervals[impact]))
        low, high = tunable.allowed.bounded(intervals[impact])
        ends = f"{known_text(float(low), half, 4)} to {known_text(float(high), half, 4)}"
        value = f"{known_text(float(values[impact]), half, 4)} {tunable.unit}".rstrip()
        doubts.append(
            f"{observations.labels[impact]} does not determine {tunable.name}: {value}, but "
            f"{f'{ends} {tunable.unit}'.rstrip()} at {percent}"
        )
    if len(undetermined) > _MOST_NAMED:
        more = len(undetermined) - _MOST_NAMED
        impacts = "impacts" if more > 1 else "impact"
        doubts.append(f"the same holds for {more} more {impacts}")
    highest = fit.function.coefficients[-1]
    half = fit.half_widths(confidence)[-1]
    if fit.function.degree and not abs(highest) > half:
        known = f"the highest coefficient is {highest:.3g}, known to {half:.2g} at {percent}"
        doubts.append(
            f"the measurement does not justify degree {fit.function.degree}: {known}; use "
            "a lower degree"
        )
    return doubts


def other_drop_doubts(problem: Problem, tunable: Tunable, seen: Observations) -> list[str]:
    """Return a warning if successive impacts were measured of another drop than the case's."""
    if not is_other_drop(problem, seen):
        return []
    if "." in tunable.name:
        has = "the value of the polynomial at its own first speed"
    else:
        has = "the values of the polynomial at its own speeds"
    in_place = ""
    if problem.height is not None:
        in_place = " in place of drop.height"
    return [
        f"the first impact that was measured is at {seen.speeds[0]:.4g} m/s, and that of "
        f"the drop at {first_approach_speed(problem):.4g} m/s: the calibrated case "
        f"has {has}; drop.speed = {seen.speeds[0]:.4g}{in_place} makes it the drop measured"
    ]


def fit_doubts(
    problem: Problem,
    tunable: Tunable,
    seen: Observations,
    fit: Fit,
    curve: tuple[Floats, Floats] | None,
    speeds: Floats,
) -> list[str]:
    """Return warnings about the polynomial and about impacts on bodies that still vibrate.

    They are about a poor fit of the polynomial, and its extrapolation. `speeds`: the approach
    speeds of the drop [m/s].
    """
    function = fit.function
    doubts = []
    if np.isfinite(fit.freedom) and seen.deviations_known and fit.freedom > 0:
        doubts.append(
            f"residuals are {fit.scatter:.3g} times as large as their standard deviations: "
            f"a polynomial of degree {function.degree} does "
            "not fit the measurement, or its noise is larger; the intervals of the "
            "polynomial are widened accordingly"
        )
    if curve is not None:
        curve_speeds, curve_values = curve
        deviation = function.misfit(curve_speeds, curve_values)
        largest = np.nanmax(np.abs(curve_values), initial=0.0)
        if deviation > _FOLLOWS * largest:
            doubts.append(
                f"the polynomial of degree {function.degree} deviates by up to {deviation:.3g} "
                "from values of up to "
                f"{f'{largest:.3g} {tunable.unit}'.rstrip()}; use a higher degree, which "
                "takes calibrate.speeds where the impacts are too "
                "few, or a narrower range of speeds"
            )
    beyond = function.beyond(speeds)
    if beyond.size and function.degree:
        slower = beyond[beyond < function.slowest]
        faster = beyond[beyond > function.fastest]
        ranges = " and ".join(_range_text(speeds) for speeds in (slower, faster) if speeds.size)
        impacts = "impacts" if beyond.size > 1 else "an impact"
        doubts.append(
            f"the drop has {impacts} at {ranges} m/s, "
            "and the polynomial was fitted over "
            f"{function.slowest:.4g} to {function.fastest:.4g} m/s: there it is an extrapolation"
        )
    vibrates = (
        problem.sphere.modes is not None
        or problem.plate.modes is not None
        or problem.local_element is not None
    )
    if vibrates and impact_count(problem) > 1:
        doubts.append(
            f"{tunable.name} is matched on bodies at rest; at later impacts they may still "
            "vibrate, and the rebound then differs"
        )
    return doubts


def _range_text(speeds: Floats) -> str:
    lowest = f"{speeds.min():.4g}"
    highest = f"{speeds.max():.4g}"
    if lowest == highest:
        return lowest
    return f"{lowest} to {highest}"
