"""Calibrate a parameter of a contact law so that impacts match a reference law or a measurement."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.calibrated_drops import (
    impact_count,
    impact_tables,
    is_other_drop,
    limited_to,
    values_by_function,
)
from vibroimpact.calibration.calibration import Calibration
from vibroimpact.calibration.match_target import match_drop, match_measurement
from vibroimpact.calibration.matchable import (
    ALONG_PLATE,
    MATCHABLE,
    REBOUND,
    REBOUNDS,
    check_weights,
)
from vibroimpact.calibration.matching import Tunable
from vibroimpact.calibration.observations import Observations
from vibroimpact.calibration.overlay import overlays
from vibroimpact.calibration.single_impacts import first_approach_speed
from vibroimpact.calibration.tunables import law_parameter
from vibroimpact.calibration.typed_inputs import Moved
from vibroimpact.calibration.uncertainty import fit_doubts, other_drop_doubts
from vibroimpact.calibration.unreachable import other_parameters
from vibroimpact.dynamics.problem import Problem, StatesProblem
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.errors import InputError

_MET = 1e-6  # relative deviation below which the given value already meets the target


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
    moved: Sequence[Moved] = (),
    progress: Callable[[float], None] | None = None,
) -> Calibration:
    """Return the parameter value with which each impact matches the target, and its fit over the
    approach speed.

    Each impact is matched separately at its own approach speed, including gravity, to rounding. If
    the target is a drop, a polynomial of the approach speed is fitted to the values by unweighted
    least squares. If it is a measurement, the polynomial is the maximum-likelihood estimate from
    the readings with their noise.

    Parameters
    ----------
    problem : Problem or Case
        The drop whose contact law is calibrated.
    target : Problem, Case or Observations
        The target: the same drop under another law, or a measurement.
    tunable : Tunable, optional
        The parameter to be tuned; by default the free parameter of the law.
    weights : mapping of str to float, optional
        The quantities to be matched, by the names of `MATCHABLE`: one, or several with weights. By
        default the rebound, or all measured quantities if no rebound was measured.
    degree : int, optional
        Degree of the polynomial; by default 2, or less if there are fewer distinct speeds.
    speeds : array, optional
        Approach speeds [m/s] at which the polynomial is fitted instead of those of the drop; not
        with a measurement.
    confidence : float, default 0.95
        Confidence level of all intervals.
    bootstrap : int, optional
        Number of bootstrap samples for the intervals; 0: intervals to first order. By default
        bootstrap only where the first-order intervals are wide.
    seed : int, default 0
        Seed of the bootstrap.
    moved : sequence of Moved, optional
        The measurement and the impacts with each uncertain number of the case changed a little, as
        `calibrate_case` has them.
    progress : callable, optional
        Called with the fraction done, in [0, 1].

    Raises
    ------
    InputError
        If no value matches an impact; the message names the impact, the attainable range, and other
        parameters that would match it.

    References
    ----------
    Matching the rebound impact by impact with the damping of Adams' IMPACT, and the polynomial of
    the approach speed: "Study on the Vibroimpact Response of the Particle Elastic Impact on the
    Metal Plate", Shock and Vibration.

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
        known = target.wanted if isinstance(target, Observations) else REBOUND
        weights = REBOUND if set(REBOUNDS) & set(known) else dict.fromkeys(known, 1.0)
    if (
        isinstance(target, Observations)
        and "separation_speed" not in target.wanted
        and "rebound_height" in target.wanted
    ):
        # both describe the rebound; match the one that was measured
        weights = {
            name.replace("separation_speed", "rebound_height"): weight
            for name, weight in weights.items()
        }
    check_weights(weights)
    if by_friction := [name for name in weights if name in ALONG_PLATE]:
        words = (
            f"{', '.join(by_friction)} follow{'s' if len(by_friction) == 1 else ''} from "
            "friction, and what is tuned is not of friction"
        )
        raise InputError(
            f"{words}; match {', '.join(MATCHABLE)}, or tune friction.coefficient", "match"
        )
    _check(stated, confidence, bootstrap)
    tuned = law_parameter(stated) if tunable is None else tunable
    if isinstance(target, Observations):
        if speeds is not None:
            raise InputError(
                "this target is matched at its own speeds alone; leave the speeds out", "speeds"
            )
        found = match_measurement(
            tuned, stated, target, weights, degree, confidence, bootstrap, seed, tell, moved
        )
    else:
        found = match_drop(tuned, stated, target.to_problem(), weights, degree, speeds, tell)
    tell(0.9)
    # the whole drop with the values found, and with those given, for comparison with the target
    seen, function = found.seen, found.fit.function
    first = first_approach_speed(stated) if seen.flights is None else float(seen.speeds[0])
    along, values = values_by_function(tuned, function, impact_count(stated), first, seen.flights)
    each, by_speed = values, values
    if seen.of_the_drop:  # compared with the target as it was measured, from its own first speed on
        each = found.values
        _, by_speed = values_by_function(
            tuned, function, len(each), float(seen.speeds[0]), seen.flights
        )
    chain = (
        (seen.speeds, each)
        if seen.of_the_drop and not is_other_drop(stated, seen)
        else (along, values)
    )
    drops = impact_tables(tuned, each, by_speed, seen)
    along = along[: len(drops["function"]["impact"])]
    if not isinstance(target, Observations):
        drops = {"target": simulate(limited_to(target.to_problem(), len(each))).impacts, **drops}
    rows = seen.which
    given = tuned.given[np.minimum(rows, len(tuned.given) - 1)]
    as_given = {} if np.isnan(given).any() else tuned.respond(seen.speeds, given, rows)
    missed = bool(as_given) and any(
        not np.allclose(as_given[name], seen.wanted[name], rtol=_MET, atol=0.0) for name in weights
    )
    computed = all(np.isfinite(as_given[name][0]) for name in weights) if as_given else False
    outcomes = tuned.respond(seen.speeds, found.values, rows)
    overlaid = overlays(tuned, seen, found.values, outcomes)
    tell(1.0)
    return Calibration(
        problem=stated,
        parameter=tuned.name,
        unit=tuned.unit,
        allowed=tuned.allowed,
        weights=dict(weights),
        observations=seen,
        values=found.values,
        intervals=found.intervals,
        outcomes=outcomes,
        given=given,
        as_given=as_given,
        others=other_parameters(stated, tuned, seen, weights) if missed and computed else {},
        fit=found.fit,
        curve=found.curve,
        impacts=chain,
        drops=drops,
        confidence=confidence,
        bootstrap=found.draws,
        overlays=overlaid,
        doubts=(
            *found.doubts,
            *other_drop_doubts(stated, tuned, seen),
            *fit_doubts(stated, tuned, seen, found.fit, found.curve, along),
        ),
    )


def _check(problem: Problem, confidence: float, bootstrap: int | None) -> None:
    if problem.shape != ():
        raise InputError("one drop is calibrated at a time; take one of the batch")
    if not 0.0 < confidence < 1.0:
        raise InputError(
            f"{confidence:g} is not allowed; it must lie between 0 and 1", "confidence"
        )
    if bootstrap is not None and bootstrap != 0 and not bootstrap >= 20:
        raise InputError(
            f"{bootstrap} draws give no interval; it must be 0, or at least 20", "bootstrap"
        )
