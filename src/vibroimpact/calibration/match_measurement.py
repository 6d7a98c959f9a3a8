"""Match impacts that were measured."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from vibroimpact.calibration.fitting import fit_observations, value_noise
from vibroimpact.calibration.match_result import Matched, degree_of
from vibroimpact.calibration.matching import Tunable, match
from vibroimpact.calibration.observations import Observations, scaled
from vibroimpact.calibration.uncertainty import default_draws, redrawn, undetermined, with_nearest_end
from vibroimpact.calibration.unreachable import check_reached
from vibroimpact.dynamics.problem import Problem
from vibroimpact.errors import InputError


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
) -> Matched:
    """Return the values with which impacts come out as they were measured, and how well they are known."""
    missing = [name for name in weights if name not in seen.wanted]
    if missing:
        raise InputError(f"{', '.join(missing)} was not measured; there is {', '.join(seen.wanted)}", "match")
    found = match(tuned, seen.speeds, seen.wanted, weights, seen.which)
    alone = check_reached(tuned, problem, seen, weights, found)
    tell(0.3)
    fit = fit_observations(tuned, seen, weights, degree_of(seen.speeds, degree), alone)
    tell(0.5)
    values = with_nearest_end(tuned, alone, seen.speeds, seen.wanted, weights, seen.which)
    doubts = list(seen.doubts) + [
        f"{label}: no {tuned.name} meets it, which noise explains; {nearest:.5g}, as near as {tuned.name} can come, stands for it"
        for label, value, nearest in zip(seen.labels, alone, values, strict=True)
        if np.isnan(value)
    ]
    sized = seen if seen.deviations_known else scaled(seen, fit.scatter, weights)
    deviations = np.linalg.norm(value_noise(tuned, sized, weights, values), axis=1)
    half, draws = fit.quantile(confidence) * deviations, 0
    intervals = np.stack([values - half, values + half], axis=1) if np.isfinite(half).all() else None
    if intervals is not None:
        draws = default_draws(values, deviations) if bootstrap is None else bootstrap
    if draws:
        intervals, fit = redrawn(tuned, sized, weights, fit, deviations, draws, confidence, seed, lambda done: tell(0.5 + 0.4 * done))
    doubts += undetermined(tuned, values, intervals, seen, fit, confidence)
    within = None if intervals is None else tuned.allowed.bounded(intervals)
    return Matched(seen, values, fit, within, None, draws, doubts)
