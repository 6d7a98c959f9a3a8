"""Fit parameters of the friction law to measured oblique impacts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.calibration.fitting import half_width, misfits
from vibroimpact.calibration.friction.doubts import friction_doubts, rebound_doubts
from vibroimpact.calibration.friction.intervals import bootstrap_intervals, profile_intervals
from vibroimpact.calibration.friction.least_squares import Bounds, Minimum, Residuals, minimize
from vibroimpact.calibration.friction.measured import ObliqueImpacts
from vibroimpact.calibration.friction.parameters import (
    FrictionParameters,
    ImpactModel,
    friction_parameters,
    impact_model,
)
from vibroimpact.calibration.noise import standard_deviations
from vibroimpact.calibration.observations import Observations, with_noise_scale
from vibroimpact.calibration.section import FRICTION
from vibroimpact.dynamics.problem import Problem, StatesProblem
from vibroimpact.errors import ComputationError, InputError

_NEARLY = 0.999  # gravity acts too
_ALIKE = 1e-6  # relative difference of sums of squares
_STARTS = 3  # of the best combinations of values, from which the search goes on


@dataclass(frozen=True)
class FrictionCalibration:
    """Parameters of a friction law fitted to measured oblique impacts.

    Parameters
    ----------
    problem : Problem
        The drop with its laws as given.
    parameters : FrictionParameters
        What was fitted.
    impacts : ObliqueImpacts
        The measured impacts.
    weights : mapping of str to float
        Weights of the matched quantities, by the names of `ALONG_PLATE`.
    model : ImpactModel
        The impacts as a function of the parameters.
    values : array, shape (K,)
        The values with the least sum of squares.
    intervals : array, shape (K, 2), optional
        Their confidence intervals; an end is infinite, or that of the range, where the measurement
        sets none. None: nothing tells the noise.
    outcomes : mapping of str to array, shape (n,)
        Quantities of the impacts computed with these values.
    given : array, shape (K,)
        The values of the case; NaN where it gives none.
    as_given : mapping of str to array, shape (n,)
        Quantities of the impacts computed with the values of the case; empty where it does not give
        all.
    freedom : float
        Degrees of freedom of the estimate of the noise; infinite where its magnitude is known and
        agrees with the residuals.
    scatter : float
        Standard deviation of the residuals over that of the noise; NaN if there are no more
        measured values than parameters.
    confidence : float
        Confidence level of the intervals.
    bootstrap : int
        Number of bootstrap samples; 0 if the intervals are those of the profile of the sum of
        squares.
    doubts : tuple of str
        Warnings about the validity of the result, as sentences.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> seen = vi.Observations(
    ...     speeds=np.full(3, 3.0),
    ...     wanted={"separation_velocity_x": np.array([3.92, 4.93, 5.91])},
    ...     speed_noise=np.zeros((3, 3)),
    ...     noise={"separation_velocity_x": 0.02 * np.eye(3)},
    ... )
    >>> impacts = vi.ObliqueImpacts(seen, np.array([5.0, 6.0, 7.0]), np.zeros(3), seen.wanted)
    >>> found = vi.calibrate_friction(
    ...     vi.read_case(
    ...         {
    ...             "sphere": {"radius": 0.01, "material": "glass"},
    ...             "plate": {"material": "steel"},
    ...             "drop": {"speed": 3.0, "angle": 0.5},
    ...             "contact": {
    ...                 "law": "newton",
    ...                 "restitution": 0.8,
    ...                 "friction": {"law": "coulomb", "coefficient": 0.1},
    ...             },
    ...             "run": {"impacts": 1},
    ...         }
    ...     ),
    ...     impacts,
    ...     ["friction.coefficient"],
    ... )
    >>> found.names, found.values.round(2).tolist(), found.slips.tolist()
    (('friction.coefficient',), [0.2], [True, True, True])
    """

    problem: Problem = field(repr=False)
    parameters: FrictionParameters
    impacts: ObliqueImpacts = field(repr=False)
    weights: Mapping[str, float]
    model: ImpactModel = field(repr=False)
    values: Floats
    intervals: Floats | None
    outcomes: Mapping[str, Floats] = field(repr=False)
    given: Floats
    as_given: Mapping[str, Floats] = field(repr=False)
    freedom: float
    scatter: float
    confidence: float
    bootstrap: int
    doubts: tuple[str, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, as [calibrate] has them."""
        return tuple(f"{FRICTION}{name}" for name in self.parameters.names)

    @property
    def slips(self) -> Bools:
        """Which impacts slip throughout with the values found, (n,): friction changes
        their velocity as much as it can.
        """
        return _slips(self.parameters, self.values, self.impacts, self.outcomes)


def calibrate_friction(
    problem: StatesProblem,
    impacts: ObliqueImpacts,
    names: Sequence[str],
    *,
    weights: Mapping[str, float] | None = None,
    confidence: float = 0.95,
    bootstrap: int = 0,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> FrictionCalibration:
    r"""Return the parameters of the friction law that agree best with measured oblique impacts.

    The sum of squares of computed less measured quantities, over their standard deviations, is
    minimized over all parameters together. Where no standard deviations are given, they are
    estimated from the residuals. The interval of a parameter has the values with which the sum of
    squares, minimized over the others, rises by at most :math:`t^2`, where t is the quantile of
    Student's distribution: so an interval may be open to one side, as that of the coefficient where
    all contacts stick.

    Parameters
    ----------
    problem : Problem or Case
        The drop whose friction law is calibrated.
    impacts : ObliqueImpacts
        The measured impacts.
    names : sequence of str
        The parameters, such as "friction.coefficient".
    weights : mapping of str to float, optional
        Weights of the matched quantities, used where no standard deviations are known; by default
        1.
    confidence : float, default 0.95
        Confidence level of the intervals.
    bootstrap : int, default 0
        Number of samples of a parametric bootstrap, from which the closed ends of the intervals are
        then taken.
    seed : int, default 0
        Seed of the bootstrap.
    progress : callable, optional
        Called with the fraction done, in [0, 1].

    Raises
    ------
    InputError
        If the friction law has no such parameter, or bodies deform, or the plate is moved.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> case = vi.read_case(
    ...     {
    ...         "sphere": {"radius": 0.01, "material": "glass"},
    ...         "plate": {"material": "steel"},
    ...         "drop": {"speed": 3.0, "angle": 0.5},
    ...         "contact": {
    ...             "law": "newton",
    ...             "restitution": 0.8,
    ...             "friction": {"law": "coulomb", "coefficient": 0.1},
    ...         },
    ...         "run": {"impacts": 1},
    ...     }
    ... )
    >>> seen = vi.Observations(
    ...     speeds=np.full(3, 3.0),
    ...     wanted={"separation_velocity_x": np.array([3.92, 4.93, 5.91])},
    ...     speed_noise=np.zeros((3, 3)),
    ...     noise={"separation_velocity_x": 0.02 * np.eye(3)},
    ... )
    >>> impacts = vi.ObliqueImpacts(seen, np.array([5.0, 6.0, 7.0]), np.zeros(3), seen.wanted)
    >>> vi.calibrate_friction(case, impacts, ["friction.coefficient"]).values.round(3).tolist()
    [0.2]
    """
    tell, stated = progress or (lambda done: None), problem.to_problem()
    if stated.shape != ():
        raise InputError("one drop is calibrated at a time; take one of the batch")
    if stated.vibrates or stated.motion is not None:
        words = "friction is fitted to single impacts of rigid bodies on a plate that lies still"
        raise InputError(
            f'{words}; leave out what deforms or moves, such as model = "elastic"', "parameter"
        )
    if bootstrap != 0 and not bootstrap >= 20:
        raise InputError(
            f"{bootstrap} draws give no interval; it must be 0, or at least 20", "bootstrap"
        )
    parameters = friction_parameters(stated, names)
    seen, bounds = impacts.seen, parameters.bounds
    model, counted = (
        impact_model(stated, parameters, impacts),
        dict.fromkeys(seen.wanted, 1.0) if weights is None else dict(weights),
    )
    sizes = {
        name: standard_deviations(seen.noise[name])
        / (1.0 if seen.deviations_known else np.sqrt(weight))
        for name, weight in counted.items()
    }

    def off(values: Floats, wanted: Mapping[str, Floats]) -> Floats:
        found = model(values)
        return np.concatenate(
            [(found[name] - wanted[name]) / size for name, size in sizes.items()], axis=1
        )

    def measured(values: Floats, _: Indices) -> Floats:
        return off(values, seen.wanted)

    begin = parameters.starts()
    costs = (off(begin, seen.wanted) ** 2).sum(axis=1)
    best = begin[np.argsort(np.where(np.isnan(costs), np.inf, costs), kind="stable")[:_STARTS]]
    tell(0.1)
    found = minimize(measured, best, bounds)
    at = int(np.argmin(found.cost))
    if not np.isfinite(found.cost[at]):
        raise ComputationError(
            _not_computed(
                seen,
                np.isnan(off(found.values[[at]], seen.wanted)[0])
                .reshape(len(sizes), -1)
                .any(axis=0),
            )
        )
    least = _as_given(
        measured, Minimum(found.values[[at]], found.cost[[at]]), parameters.given, bounds
    )
    tell(0.3)
    freedom = float(len(sizes) * len(seen.speeds) - len(names))
    scatter = float(np.sqrt(least.cost[0] / freedom)) if freedom > 0 else np.nan
    known = seen.deviations_known and not (freedom > 0 and misfits(scatter, int(freedom)))
    intervals = None
    if known or freedom > 0:
        width = half_width(confidence, np.inf if known else freedom)
        intervals = profile_intervals(measured, least, bounds, width * (1.0 if known else scatter))
        open_ends = np.stack(
            [intervals[:, 0] <= bounds.least, intervals[:, 1] >= bounds.most], axis=1
        )
        tell(0.5)
        if bootstrap:
            noisy = (
                seen
                if known
                else with_noise_scale(seen, scatter, {} if seen.deviations_known else counted)
            )
            drawn = _samples(noisy, bootstrap, seed)

            def sampled(values: Floats, chains: Indices) -> Floats:
                return off(values, {name: rows[chains] for name, rows in drawn.items()})

            ends = bootstrap_intervals(
                sampled, least, bounds, bootstrap, confidence, lambda done: tell(0.5 + 0.4 * done)
            )
            # the samples assume a known noise; widen the intervals where it is only estimated
            best_values = least.values[0][:, None]
            ends = best_values + width / half_width(confidence, np.inf) * (ends - best_values)
            intervals = np.where(open_ends, intervals, ends)
        intervals = np.where(open_ends, parameters.allowed, intervals)
        idle = np.atleast_2d(open_ends.all(axis=1))
        if idle.any():  # what the measurement does not determine stays as it is
            start = np.where(idle, parameters.given, least.values)
            least = minimize(measured, start, bounds, idle)
    values, given = least.values[0], parameters.given
    outcomes = _one(model, values)
    slips = _slips(parameters, values, impacts, outcomes)
    doubts = friction_doubts(
        parameters, values, intervals, seen, confidence, freedom, scatter, slips, known=known
    )
    return FrictionCalibration(
        problem=stated,
        parameters=parameters,
        impacts=impacts,
        weights=counted,
        model=model,
        values=values,
        intervals=intervals,
        outcomes=outcomes,
        given=given,
        as_given=_one(model, given),
        freedom=np.inf if known else freedom,
        scatter=scatter,
        confidence=confidence,
        bootstrap=bootstrap,
        doubts=(
            *rebound_doubts(impacts, outcomes["separation_speed"], stated.laws[0].name),
            *doubts,
        ),
    )


def _not_computed(seen: Observations, failed: Bools) -> str:
    """Return in words which impacts could not be computed; `failed`: whether each could
    not, (n,).
    """
    number, first = int(failed.sum()), int(np.argmax(failed))
    which = seen.labels[first] if seen.labels else f"impact {first + 1}"
    words = f"{number} of these {len(failed)} impacts could not be computed, the first {which}"
    if len(failed) == 1:
        words = f"{which} could not be computed"
    return f"{words}; look at the measured speeds, and at the case"


def _slips(
    parameters: FrictionParameters,
    values: Floats,
    impacts: ObliqueImpacts,
    outcomes: Mapping[str, Floats],
) -> Bools:
    """Return which impacts slip throughout, (n,)."""
    taken = np.abs(outcomes["separation_velocity_x"] - impacts.velocity)
    coefficient = parameters.with_values(values).coefficient
    return np.asarray(
        taken >= _NEARLY * coefficient * (impacts.seen.speeds + outcomes["separation_speed"])
    )


def _as_given(residuals: Residuals, best: Minimum, given: Floats, bounds: Bounds) -> Minimum:
    """Return a minimum that is as low, in which parameters are as given whose values make
    no difference.
    """
    fixed = np.zeros((1, len(given)), dtype=bool)
    for place in range(len(given)):
        start = best.values.copy()
        start[0, place] = given[place]
        fixed[0, place] = True
        found = minimize(residuals, start, bounds, fixed)
        fixed[0, place] = found.cost[0] <= best.cost[0] * (1.0 + _ALIKE) + _ALIKE**2
        best = found if fixed[0, place] else best
    return best


def _samples(seen: Observations, number: int, seed: int) -> dict[str, Floats]:
    """Return measured quantities with realizations of their noise, (number, n)."""
    random = np.random.default_rng(seed)
    rows = [seen.redrawn(random)[1] for _ in range(number)]
    return {name: np.stack([row[name] for row in rows]) for name in seen.wanted}


def _one(model: ImpactModel, values: Floats) -> dict[str, Floats]:
    return {name: column[0] for name, column in model(values[None]).items()}
