"""The parameter of a contact law with which a sphere bounces as it is wanted to, or as it was measured to."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from typing import NamedTuple

import numpy as np

from vibroimpact.calibration.calibration import Calibration
from vibroimpact.calibration.drops import by_function, drops_with, impacts_of, shortened
from vibroimpact.calibration.fitting import Fit, distinct, fit_observations, fit_values, value_noise
from vibroimpact.calibration.matching import Tunable, match
from vibroimpact.calibration.observations import Floats, Observations, scaled
from vibroimpact.calibration.one_impact import one_impact, stacked
from vibroimpact.calibration.outcomes import OUTCOMES, REBOUND, REBOUNDS, check_weights
from vibroimpact.calibration.reach import check_reached, other_parameters
from vibroimpact.calibration.tunables import law_parameter
from vibroimpact.calibration.uncertainty import default_draws, of_the_whole, redrawn, undetermined, with_nearest_end
from vibroimpact.dynamics.problem import Problem, StatesProblem
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.errors import InputError

_CURVE_POINTS = 41
_PASSES = 20
_MET = 1e-6  # of what is wanted


def calibrate(
    problem: StatesProblem,
    target: StatesProblem | Observations,
    *,
    tunable: Tunable | None = None,
    weights: Mapping[str, float] | None = None,
    degree: int | None = None,
    speeds: Sequence[float] | Floats | None = None,
    confidence: float = 0.95,
    bootstrap: int | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> Calibration:
    """Find the value of a contact law's parameter with which impacts come out as wanted, and fit it over the approach speed.

    Each impact is matched by itself, at the approach speed that it has, with gravity, to rounding. Where the target is a
    drop, a polynomial goes through the values of its impacts by least squares, all alike. Where it is a measurement, the
    polynomial is the one with which impacts are most likely to have been measured so, readings weighed by their noise.

    Parameters
    ----------
    problem : Problem or Case
        The drop whose contact law is calibrated.
    target : Problem, Case or Observations
        How it is to bounce: the same drop under another law, or what was measured.
    tunable : Tunable, optional
        What is tuned; by default the law's own free parameter.
    weights : mapping of str to float, optional
        What is matched, by the names of `OUTCOMES`: one, or several with their weights. By default the rebound; or all that was
        measured, if that was not.
    degree : int, optional
        Of the polynomial; by default 2, or less where there are fewer speeds.
    speeds : array, optional
        Approach speeds [m/s] that the polynomial is fitted over in place of those of the drop; not with a measurement.
    confidence : float, default 0.95
        Of all intervals.
    bootstrap : int, optional
        How many times the measurement is drawn again to find the intervals; 0: they are of first order. By default by
        bootstrap where those are wide.
    seed : int, default 0
        Of the drawing.
    progress : callable, optional
        Called with the fraction done, in [0, 1].

    Raises
    ------
    InputError
        If no value meets an impact: the message says which, what can be reached, and which other parameter would.

    References
    ----------
    The rebound matched impact by impact by the damping of Adams' IMPACT, and the polynomial of the approach speed: "Study on
    the Vibroimpact Response of the Particle Elastic Impact on the Metal Plate", Shock and Vibration.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> found = calibrate(vi.load_case("paper:type1-constant"), vi.load_case("paper:type1-theory"))
    >>> found.values.round(3).tolist()
    [179.79, 172.746, 166.419, 160.869, 156.663]
    >>> [float(f"{value:.5g}") for value in found.fit.function.coefficients]
    [139.41, 5.8629, -0.1456]
    """
    tell = progress or (lambda done: None)
    stated = problem.to_problem()
    if weights is None:
        seen = target.wanted if isinstance(target, Observations) else REBOUND
        weights = REBOUND if set(REBOUNDS) & set(seen) else dict.fromkeys(seen, 1.0)
    if isinstance(target, Observations) and "separation_speed" not in target.wanted and "rebound_height" in target.wanted:
        # two readings of one thing, of which the height was measured
        weights = {name.replace("separation_speed", "rebound_height"): weight for name, weight in weights.items()}
    check_weights(weights)
    _check(stated, confidence, bootstrap)
    tuned = law_parameter(stated) if tunable is None else tunable
    if isinstance(target, Observations):
        if speeds is not None:
            raise InputError("what was measured is known at its own speeds alone; leave the speeds out", "speeds")
        found = _from_measurement(tuned, stated, target, weights, degree, confidence, bootstrap, seed, tell)
    else:
        found = _from_drop(tuned, stated, target.to_problem(), weights, degree, speeds, tell)
    tell(0.9)
    along, values = by_function(tuned, stated, found.fit.function)
    chain = (found.seen.speeds, found.values) if found.seen.of_the_drop else (along, values)
    drops = drops_with(tuned, chain[1], values)
    along = along[: len(drops["function"]["impact"])]
    if not isinstance(target, Observations):
        drops = {"target": simulate(shortened(target.to_problem(), len(chain[1]))).impacts, **drops}
    rows = found.seen.which
    given = tuned.given[np.minimum(rows, len(tuned.given) - 1)]
    as_given = {} if np.isnan(given).any() else tuned.respond(found.seen.speeds, given, rows)
    missed = bool(as_given) and any(not np.allclose(as_given[name], found.seen.wanted[name], rtol=_MET, atol=0.0) for name in weights)
    tell(1.0)
    return Calibration(
        problem=stated,
        parameter=tuned.name,
        unit=tuned.unit,
        weights=dict(weights),
        observations=found.seen,
        values=found.values,
        intervals=found.intervals,
        outcomes=tuned.respond(found.seen.speeds, found.values, rows),
        given=given,
        as_given=as_given,
        others=other_parameters(stated, tuned, found.seen, weights) if missed else {},
        fit=found.fit,
        curve=found.curve,
        impacts=chain,
        drops=drops,
        confidence=confidence,
        bootstrap=found.draws,
        doubts=(*found.doubts, *of_the_whole(stated, tuned, found.seen, found.fit, found.curve, along)),
    )


class _Found(NamedTuple):
    seen: Observations
    values: Floats
    fit: Fit
    intervals: Floats | None = None
    curve: tuple[Floats, Floats] | None = None
    draws: int = 0
    doubts: Sequence[str] = ()


def _from_drop(
    tuned: Tunable,
    problem: Problem,
    target: Problem,
    weights: Mapping[str, float],
    degree: int | None,
    speeds: Sequence[float] | Floats | None,
    tell: Callable[[float], None],
) -> _Found:
    """Match the impacts of a drop under another law."""
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
    return _Found(seen, values, fit_values(along, through, _degree(along, degree)), curve=curve)


def _along(tuned: Tunable, problem: Problem, target: Problem, weights: Mapping[str, float], speeds: Floats, *, asked: bool) -> Floats:
    """Return the values at approach speeds, under the first laws; NaN where there is none, unless they were asked for."""
    outcomes = one_impact(target, target.laws[0], speeds)
    labels = tuple(f"an impact at {speed:.4g} m/s" for speed in speeds)
    seen = Observations(speeds, {name: outcomes[name] for name in weights}, labels=labels, of_the_drop=False)
    found = match(tuned, speeds, seen.wanted, weights, seen.which)
    return check_reached(tuned, problem, seen, weights, found) if asked else found.values


def _from_measurement(
    tuned: Tunable,
    problem: Problem,
    seen: Observations,
    weights: Mapping[str, float],
    degree: int | None,
    confidence: float,
    bootstrap: int | None,
    seed: int,
    tell: Callable[[float], None],
) -> _Found:
    """Match what was measured."""
    missing = [name for name in weights if name not in seen.wanted]
    if missing:
        raise InputError(f"{', '.join(missing)} was not measured; there is {', '.join(seen.wanted)}", "match")
    found = match(tuned, seen.speeds, seen.wanted, weights, seen.which)
    alone = check_reached(tuned, problem, seen, weights, found)
    tell(0.3)
    fit = fit_observations(tuned, seen, weights, _degree(seen.speeds, degree), alone)
    tell(0.5)
    values = with_nearest_end(tuned, alone, seen.speeds, seen.wanted, weights, seen.which)
    doubts = list(seen.doubts) + [
        f"{label}: nothing that {tuned.name} can be meets it, but its noise explains that"
        for label, value in zip(seen.labels, alone, strict=True)
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
    return _Found(seen, values, fit, intervals, None, draws, doubts)


def _check(problem: Problem, confidence: float, bootstrap: int | None) -> None:
    if problem.shape != ():
        raise InputError("one drop is calibrated at a time; take one of the batch")
    if not 0.0 < confidence < 1.0:
        raise InputError(f"{confidence:g} is not allowed; it must lie between 0 and 1", "confidence")
    if bootstrap is not None and bootstrap != 0 and not bootstrap >= 20:
        raise InputError(f"{bootstrap} draws tell no interval; it must be 0, or at least 20", "bootstrap")


def _alike(problem: Problem, tuned: Tunable) -> bool:
    """Is the contact law the same at each impact, but for what is tuned?"""
    first = problem.laws[0]
    return all(
        getattr(law, item.name) == getattr(first, item.name) for law in problem.laws for item in fields(law) if item.name != tuned.name
    )


def _degree(speeds: Floats, degree: int | None) -> int:
    return min(2, distinct(speeds) - 1) if degree is None else degree
