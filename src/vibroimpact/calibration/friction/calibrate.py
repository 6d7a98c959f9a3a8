"""Fit parameters of the friction law to measured oblique impacts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.calibration.contact_law.calibration import sections_of_case
from vibroimpact.calibration.fit.fitting import half_width, misfits
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
from vibroimpact.calibration.observed.noise import standard_deviations
from vibroimpact.calibration.observed.observations import (
    Observations,
    impact_label,
    with_noise_scale,
)
from vibroimpact.calibration.observed.section import FRICTION
from vibroimpact.cases.case import Case
from vibroimpact.cases.reader import case_of
from vibroimpact.dynamics.statement.problem import Problem, StatesProblem
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.report.reported import Reported

_NEARLY = 0.999
"""Fraction of the largest impulse of friction from which an impact slips throughout; gravity acts
too.
"""

_EQUAL = 1e-6
"""Relative difference of sums of squares that count as equal."""

_STARTS = 3
"""Number of the best combinations of values, from which the search goes on."""


@dataclass(frozen=True)
class FrictionCalibration(Reported, reported_in="vibroimpact.calibration.report"):
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
    >>> drop = {"speed": 3.0, "angle": 0.5}
    >>> coulomb = {"law": "coulomb", "coefficient": 0.1}
    >>> case = vi.load_case("paper:type1-theory", {"drop": drop, "contact.friction": coulomb})
    >>> wanted = {"separation_velocity_x": np.array([3.92, 4.93, 5.91])}
    >>> noise = {"separation_velocity_x": 0.02 * np.eye(3)}
    >>> seen = vi.calibration.Observations(np.full(3, 3.0), wanted, np.zeros((3, 3)), noise)
    >>> velocity = np.array([5.0, 6.0, 7.0])
    >>> impacts = vi.calibration.ObliqueImpacts(seen, velocity, np.zeros(3), wanted)
    >>> found = vi.calibration.calibrate_friction(case, impacts, ["friction.coefficient"])
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
    def calibrated_case(self) -> Case:
        """The case with the calibrated values of the friction law, ready to run.

        Raises
        ------
        InputError
            If the drop was stated in Python, and has no case.
        """
        table = sections_of_case(self.problem)
        contact = table["contact"]
        values = dict(zip(self.parameters.names, self.values.tolist(), strict=True))
        friction = {**contact["friction"], **values}
        return case_of({**table, "contact": {**contact, "friction": friction}})

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, as [calibrate] has them."""
        return tuple(f"{FRICTION}{name}" for name in self.parameters.names)

    @property
    def slips(self) -> Bools:
        """Which impacts slip throughout with the values found, (n,).

        Friction changes their velocity as much as it can.
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
    >>> case = vi.case_of(
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
    >>> seen = vi.calibration.Observations(
    ...     speeds=np.full(3, 3.0),
    ...     wanted={"separation_velocity_x": np.array([3.92, 4.93, 5.91])},
    ...     speed_noise=np.zeros((3, 3)),
    ...     noise={"separation_velocity_x": 0.02 * np.eye(3)},
    ... )
    >>> impacts = vi.calibration.ObliqueImpacts(
    ...     seen, np.array([5.0, 6.0, 7.0]), np.zeros(3), seen.wanted
    ... )
    >>> vi.calibration.calibrate_friction(case, impacts, ["friction.coefficient"]).values.round(
    ...     3
    ... ).tolist()
    [0.2]
    """
    report_progress = progress or (lambda fraction: None)
    stated = problem.to_problem()
    _check(stated, bootstrap)
    parameters = friction_parameters(stated, names)
    model = impact_model(stated, parameters, impacts)
    if weights is None:
        weights = dict.fromkeys(impacts.seen.wanted, 1.0)
    misfit = _Misfit(model, impacts.seen, weights)
    report_progress(0.1)
    best = _best_fit(misfit, parameters)
    report_progress(0.3)
    freedom = float(len(weights) * len(impacts.seen.speeds) - len(names))
    scatter = np.nan
    if freedom > 0:
        scatter = float(np.sqrt(best.cost[0] / freedom))
    # noise that is stated too small counts as unknown
    known = impacts.seen.deviations_known and not (freedom > 0 and misfits(scatter, int(freedom)))
    # the quantile is the normal one under known noise, and Student's under noise that is estimated
    known_freedom = np.inf if known else freedom
    intervals = None
    if known or freedom > 0:
        quantile = half_width(confidence, known_freedom)
        noise_scale = 1.0 if known else scatter
        rise = quantile * noise_scale
        intervals = profile_intervals(misfit.of_measurement, best, parameters.bounds, rise)
        open_ends = _open_ends(intervals, parameters.bounds)
        report_progress(0.5)
        if bootstrap:
            noisy = impacts.seen
            if not known:
                relative_weights = weights
                if impacts.seen.deviations_known:
                    relative_weights = {}
                noisy = with_noise_scale(impacts.seen, scatter, relative_weights)
            ends = bootstrap_intervals(
                misfit.of_samples(_samples(noisy, bootstrap, seed)),
                best,
                parameters.bounds,
                bootstrap,
                confidence,
                lambda fraction: report_progress(0.5 + 0.4 * fraction),
            )
            # the samples assume a known noise; widen the intervals where it is only estimated
            best_values = best.values[0][:, None]
            widening = quantile / half_width(confidence, np.inf)
            ends = best_values + widening * (ends - best_values)
            intervals = np.where(open_ends, intervals, ends)
        intervals = np.where(open_ends, parameters.allowed, intervals)
        best = _with_undetermined_as_given(misfit, best, parameters, open_ends)
    values = best.values[0]
    outcomes = _outcomes(model, values)
    slips = _slips(parameters, values, impacts, outcomes)
    doubts = friction_doubts(
        parameters,
        values,
        intervals,
        impacts.seen,
        confidence,
        freedom,
        scatter,
        slips,
        known=known,
    )
    return FrictionCalibration(
        problem=stated,
        parameters=parameters,
        impacts=impacts,
        weights=dict(weights),
        model=model,
        values=values,
        intervals=intervals,
        outcomes=outcomes,
        given=parameters.given,
        as_given=_outcomes(model, parameters.given),
        freedom=known_freedom,
        scatter=scatter,
        confidence=confidence,
        bootstrap=bootstrap,
        doubts=(
            *rebound_doubts(impacts, outcomes["separation_speed"], stated.laws[0].name),
            *doubts,
        ),
    )


def _check(problem: Problem, bootstrap: int) -> None:
    if problem.shape != ():
        raise InputError("one drop is calibrated at a time; take one of the batch")
    if problem.vibrates or problem.motion is not None:
        raise InputError(
            "friction is fitted to single impacts of rigid bodies on a plate that lies still; "
            'leave out what deforms or moves, such as model = "elastic"',
            "parameter",
        )
    if bootstrap != 0 and not bootstrap >= 20:
        raise InputError(
            f"{bootstrap} draws give no interval; it must be 0, or at least 20", "bootstrap"
        )


class _Misfit:
    """Computed less measured quantities over their standard deviations, as functions of values.

    Residuals of S chains of values (S, K) have the shape (S, N): n impacts, quantity by quantity.
    """

    def __init__(
        self, model: ImpactModel, observations: Observations, weights: Mapping[str, float]
    ) -> None:
        self.model = model
        self.observations = observations
        self.deviations: dict[str, Floats] = {}
        for name, weight in weights.items():
            deviation = standard_deviations(observations.noise[name])
            if not observations.deviations_known:
                # then the weights alone say how far a quantity may be off
                deviation = deviation / np.sqrt(weight)
            self.deviations[name] = deviation

    def residuals(self, values: Floats, wanted: Mapping[str, Floats]) -> Floats:
        """Return the residuals from wanted quantities, (n,) or (S, n)."""
        computed = self.model(values)
        return np.concatenate(
            [
                (computed[name] - wanted[name]) / deviation
                for name, deviation in self.deviations.items()
            ],
            axis=1,
        )

    def of_measurement(self, values: Floats, _: Indices) -> Floats:
        """Return the residuals from what was measured, the same for all chains."""
        return self.residuals(values, self.observations.wanted)

    def of_samples(self, samples: Mapping[str, Floats]) -> Residuals:
        """Return the residuals from samples of the measurement, one for each chain."""

        def residuals(values: Floats, chains: Indices) -> Floats:
            wanted = {name: sample[chains] for name, sample in samples.items()}
            return self.residuals(values, wanted)

        return residuals


def _best_fit(misfit: _Misfit, parameters: FrictionParameters) -> Minimum:
    """Return the values with the least sum of squares, from the best points of a grid.

    Values that make no difference are as given.
    """
    grid = parameters.starts()
    residuals = misfit.residuals(grid, misfit.observations.wanted)
    costs = (residuals**2).sum(axis=1)
    # from several points, as the sum of squares may have several minima
    order = np.argsort(np.where(np.isnan(costs), np.inf, costs), kind="stable")
    minima = minimize(misfit.of_measurement, grid[order[:_STARTS]], parameters.bounds)
    lowest = int(np.argmin(minima.cost))
    values = minima.values[[lowest]]
    if not np.isfinite(minima.cost[lowest]):
        residual = misfit.residuals(values, misfit.observations.wanted)[0]
        failed = np.isnan(residual).reshape(len(misfit.deviations), -1).any(axis=0)
        raise ComputationError(_not_computed(misfit.observations, failed))
    return _with_idle_as_given(
        misfit.of_measurement,
        Minimum(values, minima.cost[[lowest]]),
        parameters.given,
        parameters.bounds,
    )


def _open_ends(intervals: Floats, bounds: Bounds) -> Bools:
    """Return which ends of intervals the measurement does not set, (K, 2)."""
    return np.stack([intervals[:, 0] <= bounds.least, intervals[:, 1] >= bounds.most], axis=1)


def _with_undetermined_as_given(
    misfit: _Misfit, best: Minimum, parameters: FrictionParameters, open_ends: Bools
) -> Minimum:
    """Return the minimum with parameters as given that the measurement does not determine."""
    undetermined = np.atleast_2d(open_ends.all(axis=1))
    if not undetermined.any():
        return best
    start = np.where(undetermined, parameters.given, best.values)
    return minimize(misfit.of_measurement, start, parameters.bounds, undetermined)


def _not_computed(observations: Observations, failed: Bools) -> str:
    """Return which impacts could not be computed; `failed`: whether each could not, (n,)."""
    first = int(np.argmax(failed))
    label = impact_label(observations, first)
    if len(failed) == 1:
        sentence = f"{label} could not be computed"
    else:
        sentence = (
            f"{int(failed.sum())} of these {len(failed)} impacts could not be computed, "
            f"the first {label}"
        )
    return f"{sentence}; look at the measured speeds, and at the case"


def _slips(
    parameters: FrictionParameters,
    values: Floats,
    impacts: ObliqueImpacts,
    outcomes: Mapping[str, Floats],
) -> Bools:
    """Return which impacts slip throughout, (n,).

    Friction then changes the velocity by its coefficient times the change of the normal velocity.
    """
    velocity_change = np.abs(outcomes["separation_velocity_x"] - impacts.velocity)
    coefficient = parameters.with_values(values).coefficient
    return np.asarray(
        velocity_change
        >= _NEARLY * coefficient * (impacts.seen.speeds + outcomes["separation_speed"])
    )


def _with_idle_as_given(
    residuals: Residuals, best: Minimum, given: Floats, bounds: Bounds
) -> Minimum:
    """Return a minimum that is as low, with parameters as given that make no difference."""
    fixed = np.zeros((1, len(given)), dtype=bool)
    for parameter in range(len(given)):
        start = best.values.copy()
        start[0, parameter] = given[parameter]
        fixed[0, parameter] = True
        minimum = minimize(residuals, start, bounds, fixed)
        as_low = minimum.cost[0] <= best.cost[0] * (1.0 + _EQUAL) + _EQUAL**2
        fixed[0, parameter] = as_low
        if as_low:
            best = minimum
    return best


def _samples(observations: Observations, count: int, seed: int) -> dict[str, Floats]:
    """Return measured quantities with realizations of their noise, (count, n)."""
    random = np.random.default_rng(seed)
    samples = [observations.redrawn(random)[1] for _ in range(count)]
    return {name: np.stack([sample[name] for sample in samples]) for name in observations.wanted}


def _outcomes(model: ImpactModel, values: Floats) -> dict[str, Floats]:
    """Return the quantities of the impacts (n,) with values (K,) of the parameters."""
    return {name: rows[0] for name, rows in model(values[None]).items()}
