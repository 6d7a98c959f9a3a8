"""Uncertainty of calibrated values: bootstrap intervals, and warnings about values and fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.polynomial import polynomial

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.calibrated_drops import impact_count, is_other_drop
from vibroimpact.calibration.fitting import Fit
from vibroimpact.calibration.matching import Tunable, match
from vibroimpact.calibration.observations import Observations
from vibroimpact.calibration.single_impacts import first_approach_speed
from vibroimpact.dynamics.problem import Problem
from vibroimpact.units.display import known_text

_DRAWN_VALUES = 2000  # values computed by the default bootstrap, so that it takes seconds
_FEWEST_DRAWS, _MOST_DRAWS = 100, 400
_MOST_IMPACTS = 20
_WIDE = 0.25
_DETERMINED = 1.0
"""Fractions of a value: two standard deviations above which first-order intervals are not trusted,
and the width of an interval above which the value counts as undetermined.
"""

_FOLLOWS = 0.02
"""Deviation of the polynomial above which a warning is given, as a fraction of the
largest value.
"""

_AT_ONCE = 500
_MOST_TOLD = 5


def default_draws(values: Floats, deviations: Floats) -> int:
    """Return the default number of bootstrap samples: 0 unless the noise is too large for
    first-order intervals.

    With many impacts the aim is the polynomial, for which first order suffices.
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
    """Return intervals of the values, (n, 2), and the fit with the covariance of its coefficients,
    by a parametric bootstrap.

    Samples are the measurement plus a realization of its noise, matched like the measurement. A
    sample that no value matches counts as the nearest end of the range.

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
    random, number = np.random.default_rng(seed), len(observations.speeds)
    values, speeds, at_once = [], [], max(1, _AT_ONCE // number)
    for begin in range(0, draws, at_once):
        drawn = [observations.redrawn(random) for _ in range(min(at_once, draws - begin))]
        fast = np.concatenate([one[0] for one in drawn])
        wanted = {name: np.concatenate([one[1][name] for one in drawn]) for name in weights}
        which = np.tile(observations.which, len(drawn))
        found = match(tunable, fast, wanted, weights, which).values
        values.append(
            with_nearest_bound(tunable, found, fast, wanted, weights, which).reshape(
                len(drawn), number
            )
        )
        speeds.append(fast.reshape(len(drawn), number))
        progress(min(1.0, (begin + at_once) / draws))
    every, fast = np.concatenate(values), np.concatenate(speeds)
    tails = 50.0 * (1.0 - confidence)
    ends = np.percentile(every, [tails, 100.0 - tails], axis=0).T
    # the samples assume a known noise; widen the intervals where it is only estimated (Student's t
    # over normal quantile)
    wider = fit.quantile(confidence) / replace(fit, freedom=np.inf).quantile(confidence)
    intervals = np.median(every, axis=0)[:, None] + wider * (
        ends - np.median(every, axis=0)[:, None]
    )
    counts = 1.0 / deviations
    coefficients = [
        polynomial.polyfit(at, row, fit.function.degree, w=counts)
        for at, row in zip(fast, every, strict=True)
    ]
    return intervals, replace(fit, covariance=np.atleast_2d(np.cov(np.array(coefficients).T)))


def with_nearest_bound(
    tunable: Tunable,
    values: Floats,
    speeds: Floats,
    wanted: Mapping[str, Floats],
    weights: Mapping[str, float],
    which: Indices,
) -> Floats:
    """Return values with NaN replaced by the end of the allowed range that deviates least
    from the target.
    """
    missing = np.flatnonzero(np.isnan(values))
    if not missing.size:
        return values
    ends = [tunable.allowed.clip(np.full(missing.size, side)) for side in (-np.inf, np.inf)]
    ends = [end for end in ends if np.isfinite(end).all()]
    misses = []
    for end in ends:
        found = tunable.respond(speeds[missing], end, which[missing])
        misses.append(
            sum(
                weight * (found[name] / wanted[name][missing] - 1.0) ** 2
                for name, weight in weights.items()
            )
        )
    filled = values.copy()
    filled[missing] = np.choose(np.argmin(np.array(misses), axis=0), ends) if ends else np.nan
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
    told, percent = [], f"{100.0 * confidence:g} %"
    if intervals is None:
        if fit.freedom > 0:
            told.append(
                f"{tunable.name} has no influence on one of the impacts, so "
                "that there are no intervals"
            )
        else:
            told.append(
                "there are no more measured values than coefficients, and no standard "
                "deviations: their uncertainty is unknown"
            )
        return told
    wide = np.flatnonzero(intervals[:, 1] - intervals[:, 0] > _DETERMINED * np.abs(values))
    for row in wide[:_MOST_TOLD]:
        half = 0.5 * float(np.ptp(intervals[row]))
        low, high = (
            known_text(float(end), half, 4) for end in tunable.allowed.bounded(intervals[row])
        )
        value = f"{known_text(float(values[row]), half, 4)} {tunable.unit}".rstrip()
        ends = f"{low} to {high} {tunable.unit}".rstrip()
        told.append(
            f"{observations.labels[row]} does not determine {tunable.name}: {value}, but "
            f"{ends} at {percent}"
        )
    if len(wide) > _MOST_TOLD:
        more = len(wide) - _MOST_TOLD
        told.append(f"the same holds for {more} more impact{'s' if more > 1 else ''}")
    highest, half = fit.function.coefficients[-1], fit.half_widths(confidence)[-1]
    if fit.function.degree and not abs(highest) > half:
        known = f"the highest coefficient is {highest:.3g}, known to {half:.2g} at {percent}"
        told.append(
            f"the measurement does not justify degree {fit.function.degree}: {known}; use "
            "a lower degree"
        )
    return told


def other_drop_doubts(problem: Problem, tunable: Tunable, seen: Observations) -> list[str]:
    """Return a warning if successive impacts were measured of another drop than that of
    the case.
    """
    if not is_other_drop(problem, seen):
        return []
    own, in_place = (
        first_approach_speed(problem),
        " in place of drop.height" if problem.height is not None else "",
    )
    has = (
        "the value of the polynomial at its own first speed"
        if "." in tunable.name
        else "the values of the polynomial at its own speeds"
    )
    return [
        f"the first impact that was measured is at {seen.speeds[0]:.4g} m/s, and that of "
        f"the drop at {own:.4g} m/s: the calibrated case "
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
    """Return warnings about a poor fit of the polynomial, its extrapolation, and impacts on bodies
    that still vibrate.

    `speeds`: the approach speeds of the drop [m/s].
    """
    told, function = [], fit.function
    if np.isfinite(fit.freedom) and seen.deviations_known and fit.freedom > 0:
        told.append(
            f"residuals are {fit.scatter:.3g} times as large as their standard deviations: "
            f"a polynomial of degree {function.degree} does "
            "not fit the measurement, or its noise is larger; the intervals of the "
            "polynomial are widened accordingly"
        )
    if curve is not None:
        off, size = function.misfit(*curve), np.nanmax(np.abs(curve[1]), initial=0.0)
        if off > _FOLLOWS * size:
            told.append(
                f"the polynomial of degree {function.degree} deviates by up to {off:.3g} "
                "from values of up to "
                f"{f'{size:.3g} {tunable.unit}'.rstrip()}; use a higher degree, which "
                "takes calibrate.speeds where the impacts are too "
                "few, or a narrower range of speeds"
            )
    beyond = function.beyond(speeds)
    if beyond.size and function.degree:
        outside = (beyond[beyond < function.slowest], beyond[beyond > function.fastest])
        where = " and ".join(_range_words(some) for some in outside if some.size)
        told.append(
            f"the drop has {'impacts' if beyond.size > 1 else 'an impact'} at {where} m/s, "
            "and the polynomial was fitted over "
            f"{function.slowest:.4g} to {function.fastest:.4g} m/s: there it is an extrapolation"
        )
    rings = (
        problem.sphere.modes is not None
        or problem.plate.modes is not None
        or problem.local_element is not None
    )
    if rings and impact_count(problem) > 1:
        told.append(
            f"{tunable.name} is matched on bodies at rest; at later impacts they may still "
            "vibrate, and the rebound then differs"
        )
    return told


def _range_words(speeds: Floats) -> str:
    first, last = (f"{end:.4g}" for end in (speeds.min(), speeds.max()))
    return first if first == last else f"{first} to {last}"
