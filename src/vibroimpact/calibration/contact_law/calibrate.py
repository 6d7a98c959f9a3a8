"""Calibrate a parameter of a contact law so that impacts match a reference law or a measurement."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.contact_law.match_target import (
    MatchedTarget,
    match_drop,
    match_measurement,
)
from vibroimpact.calibration.contact_law.unreachable import other_parameters
from vibroimpact.calibration.fit.calibrated_drops import (
    impact_count,
    impact_tables,
    is_other_drop,
    limited_to,
    values_by_function,
)
from vibroimpact.calibration.fit.matching import Tunable
from vibroimpact.calibration.fit.overlay import overlays
from vibroimpact.calibration.fit.single_impacts import first_approach_speed
from vibroimpact.calibration.fit.tunables import law_parameter
from vibroimpact.calibration.fit.typed_inputs import Moved
from vibroimpact.calibration.fit.uncertainty import fit_doubts, other_drop_doubts
from vibroimpact.calibration.observed.matchable import (
    ALONG_PLATE,
    MATCHABLE,
    REBOUND,
    REBOUNDS,
    check_weights,
)
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem, StatesProblem
from vibroimpact.errors import InputError

_MET = 1e-6
"""Relative deviation below which the value of the case already meets the target."""


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
    """Return the parameter value with which each impact matches the target, and its fit.

    The fit is a polynomial of the approach speed. Each impact is matched separately at its own
    approach speed, including gravity, to rounding. If the target is a drop, the polynomial is
    fitted to the values by unweighted least squares. If it is a measurement, the polynomial is the
    maximum-likelihood estimate from the readings with their noise.

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
    >>> constant = vi.load_case("paper:type1-constant")
    >>> calibration = calibrate(constant, vi.load_case("paper:type1-theory"))
    >>> calibration.values.round(3).tolist()
    [179.79, 172.746, 166.419, 160.869, 156.663]
    >>> [float(f"{value:.5g}") for value in calibration.fit.function.coefficients]
    [139.41, 5.8629, -0.1456]
    """
    report_progress = progress or (lambda fraction: None)
    stated = problem.to_problem()
    weights = _checked_weights(weights, target)
    _check(stated, confidence, bootstrap)
    tuned = tunable
    if tuned is None:
        tuned = law_parameter(stated)
    if isinstance(target, Observations):
        if speeds is not None:
            raise InputError(
                "this target is matched at its own speeds alone; leave the speeds out", "speeds"
            )
        matched = match_measurement(
            tuned,
            stated,
            target,
            weights,
            degree,
            confidence,
            bootstrap,
            seed,
            report_progress,
            moved,
        )
    else:
        matched = match_drop(
            tuned, stated, target.to_problem(), weights, degree, speeds, report_progress
        )
    report_progress(0.9)
    seen = matched.seen
    sequences = _impact_sequences(stated, tuned, matched)
    drops = impact_tables(tuned, sequences.each, sequences.by_speed, seen)
    if not isinstance(target, Observations):
        limited = limited_to(target.to_problem(), len(sequences.each))
        drops = {"target": simulate(limited).impacts, **drops}
    given = tuned.given[np.minimum(seen.which, len(tuned.given) - 1)]
    as_given: dict[str, Floats] = {}
    if not np.isnan(given).any():
        as_given = tuned.respond(seen.speeds, given, seen.which)
    others = {}
    if _misses(as_given, seen, weights):
        others = other_parameters(stated, tuned, seen, weights)
    outcomes = tuned.respond(seen.speeds, matched.values, seen.which)
    overlaid = overlays(tuned, seen, matched.values, outcomes)
    drop_speeds = sequences.drop_speeds[: len(drops["function"]["impact"])]
    doubts = (
        *matched.doubts,
        *other_drop_doubts(stated, tuned, seen),
        *fit_doubts(stated, tuned, seen, matched.fit, matched.curve, drop_speeds),
    )
    report_progress(1.0)
    return Calibration(
        problem=stated,
        parameter=tuned.name,
        unit=tuned.unit,
        allowed=tuned.allowed,
        weights=dict(weights),
        observations=seen,
        values=matched.values,
        intervals=matched.intervals,
        outcomes=outcomes,
        given=given,
        as_given=as_given,
        others=others,
        fit=matched.fit,
        curve=matched.curve,
        impacts=sequences.of_the_drop,
        drops=drops,
        confidence=confidence,
        bootstrap=matched.draws,
        overlays=overlaid,
        doubts=doubts,
    )


def _checked_weights(
    weights: Mapping[str, float] | None, target: StatesProblem | Observations
) -> Mapping[str, float]:
    """Return the weights of the quantities to be matched, by default those of the rebound."""
    wanted = list(REBOUND)
    if isinstance(target, Observations):
        wanted = list(target.wanted)
    if weights is None:
        weights = dict.fromkeys(wanted, 1.0)
        if set(REBOUNDS) & set(wanted):
            weights = REBOUND
    if (
        isinstance(target, Observations)
        and "separation_speed" not in wanted
        and "rebound_height" in wanted
    ):
        # both describe the rebound; match the one that was measured
        weights = {
            name.replace("separation_speed", "rebound_height"): weight
            for name, weight in weights.items()
        }
    check_weights(weights)
    by_friction = [name for name in weights if name in ALONG_PLATE]
    if by_friction:
        verb = "follows" if len(by_friction) == 1 else "follow"
        raise InputError(
            f"{', '.join(by_friction)} {verb} from "
            "friction, and what is tuned is not of friction; match "
            f"{', '.join(MATCHABLE)}, or tune friction.coefficient",
            "match",
        )
    return weights


class _Sequences(NamedTuple):
    """Values of the parameter in successive impacts.

    `each` and `by_speed` are those of the impacts of the drop that is compared with the target, as
    matched and by the polynomial. `of_the_drop` are approach speeds [m/s] and values of the drop as
    stated. `drop_speeds` are its approach speeds with the polynomial [m/s].
    """

    each: Floats
    by_speed: Floats
    of_the_drop: tuple[Floats, Floats]
    drop_speeds: Floats


def _impact_sequences(stated: Problem, tuned: Tunable, matched: MatchedTarget) -> _Sequences:
    """Return the values of the drop as stated, and of the drop compared with the target."""
    seen = matched.seen
    function = matched.fit.function
    measured_first_speed = float(seen.speeds[0])
    first_speed = measured_first_speed
    if seen.flights is None:
        first_speed = first_approach_speed(stated)
    drop_speeds, drop_values = values_by_function(
        tuned, function, impact_count(stated), first_speed, seen.flights
    )
    if not seen.of_the_drop:
        return _Sequences(drop_values, drop_values, (drop_speeds, drop_values), drop_speeds)
    # compared with the target as it was measured, from its own first speed on
    _, by_speed = values_by_function(
        tuned, function, len(matched.values), measured_first_speed, seen.flights
    )
    of_the_drop = (seen.speeds, matched.values)
    if is_other_drop(stated, seen):
        of_the_drop = (drop_speeds, drop_values)
    return _Sequences(matched.values, by_speed, of_the_drop, drop_speeds)


def _misses(
    as_given: Mapping[str, Floats], seen: Observations, weights: Mapping[str, float]
) -> bool:
    """Return whether the value of the case misses the target, and the first impact is computed.

    `as_given` are the quantities of the impacts with that value; empty where there is none.
    """
    if not as_given:
        return False
    missed = any(
        not np.allclose(as_given[name], seen.wanted[name], rtol=_MET, atol=0.0) for name in weights
    )
    return missed and all(np.isfinite(as_given[name][0]) for name in weights)


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
