"""Least-squares fit of a parameter as a polynomial of the approach speed.

It is fitted to values, or to measurements.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import polynomial
from scipy.sparse import vstack

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.matching import Tunable, derivatives, residual_scale
from vibroimpact.calibration.observed.noise import (
    Noise,
    no_noise,
    scaled,
    standard_deviations,
    whitened,
)
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.errors import ComputationError, InputError

_MOST_ITERATIONS = 50

_CONVERGED = 1e-10
"""Change of the values, relative to the largest, at which the Gauss-Newton iteration ends."""

_SCATTER_CONVERGED = 1e-6
"""Relative change of the scatter at which its iteration ends."""

_LEAST_SCATTER = 1e-9
"""Least scatter of residuals, in units of the noise, by which typed inputs are weighted."""


@dataclass(frozen=True)
class Fit:
    """A fitted polynomial and its uncertainty.

    Parameters
    ----------
    function : SpeedFunction
        The polynomial.
    covariance : array, shape (k, k)
        Covariance of the coefficients; NaN if there are no more observations than coefficients and
        the noise is unknown.
    freedom : float
        Degrees of freedom of the noise estimate; infinite if the noise is known and consistent with
        the residuals. If it is not consistent, the covariance is scaled by the residuals.
    scatter : float
        Standard deviation of the values about the polynomial, or of the residuals normalized by
        their noise.
    """

    function: SpeedFunction
    covariance: Floats
    freedom: float
    scatter: float

    def quantile(self, confidence: float) -> float:
        """Return the half width of a confidence interval in standard deviations (Student's t)."""
        return half_width(confidence, self.freedom)

    def half_widths(self, confidence: float) -> Floats:
        """Return the half widths of the confidence intervals of the coefficients."""
        return np.asarray(
            self.quantile(confidence) * np.sqrt(np.maximum(np.diag(self.covariance), 0.0))
        )

    def band(self, speeds: Floats, confidence: float) -> Floats:
        """Return the half width of the confidence band of the polynomial at speeds [m/s]."""
        powers = _powers(np.asarray(speeds, dtype=float), self.function.degree)
        variance = np.einsum("ni,ij,nj->n", powers, self.covariance, powers)
        return np.asarray(self.quantile(confidence) * np.sqrt(np.maximum(variance, 0.0)))


def half_width(confidence: float, freedom: float) -> float:
    """Return the half width of a confidence interval in standard deviations, by Student's t."""
    # imported late: it takes longer to load than a calibration
    from scipy.stats import t as students_t

    return float(students_t.ppf(0.5 + 0.5 * confidence, freedom))


def check_degree(speeds: Floats, degree: int) -> None:
    """Check that there are enough distinct speeds for a polynomial of a degree.

    Raises
    ------
    InputError
        If there are fewer than degree + 1.
    """
    distinct_count = distinct(speeds)
    if degree < distinct_count:
        return
    if distinct_count > 1:
        have = f"{distinct_count} that differ by more than 1 % of the largest are there"
    elif len(speeds) == 1:
        have = "one speed is there"
    else:
        have = "all that are there lie within 1 % of the largest"
    needs = f"a polynomial of degree {degree} needs {degree + 1} speeds"
    raise InputError(f"{needs}, and {have}; take {distinct_count - 1} at most", "degree")


def distinct(speeds: Floats) -> int:
    """Return how many of the speeds lie more than 1 % of the largest apart.

    Examples
    --------
    >>> distinct(np.array([1.0, 1.001, 2.0])), distinct(np.linspace(1.0, 2.0, 1000))
    (2, 50)
    """
    ordered = np.sort(speeds)
    step = 0.01 * speeds.max()
    count = 0
    index = 0
    while index < len(ordered):
        count += 1
        index = int(np.searchsorted(ordered, ordered[index] + step, side="right"))
    return count


def fit_values(speeds: Floats, values: Floats, degree: int) -> Fit:
    """Return the unweighted least-squares fit to exact values.

    The residuals are not noise but the error of the polynomial approximation.

    Examples
    --------
    >>> fit = fit_values(np.array([1.0, 2.0, 3.0]), np.array([2.0, 3.0, 4.0]), 1)
    >>> [round(value, 9) for value in fit.function.coefficients]
    [1.0, 1.0]
    """
    check_degree(speeds, degree)
    powers = _powers(speeds, degree)
    coefficients, covariance = _least_squares(powers, values)
    freedom = len(values) - degree - 1
    residual = values - powers @ coefficients
    scatter = _scatter(residual, freedom)
    return Fit(_function(coefficients, speeds), scatter**2 * covariance, freedom, scatter)


def fit_observations(
    tunable: Tunable,
    observations: Observations,
    weights: Mapping[str, float],
    degree: int,
    values: Floats,
) -> Fit:
    """Return the fit of the measured quantities themselves, by the Gauss-Newton method.

    Parameters
    ----------
    tunable : Tunable
        The parameter.
    observations : Observations
        The measurements with their noise.
    weights : mapping of str to float
        The quantities to be fitted; the weights are used only if the magnitude of the noise is
        unknown.
    degree : int
        Degree of the polynomial.
    values : array, shape (n,)
        Values that match each impact separately, for the initial guess; NaN where there is none.

    Raises
    ------
    ComputationError
        If the iteration does not converge.
    """
    speeds = observations.speeds
    check_degree(speeds, degree)
    powers = _powers(speeds, degree)
    start = tunable.allowed.clip(_initial_values(tunable, speeds, values, degree))
    if observations.deviations_known:
        try:
            coefficients, covariance, scatter, freedom = _gauss_newton(
                tunable, observations, weights, powers, start, noise_known=True
            )
        except ComputationError:
            if observations.effects is None:
                raise
        else:
            if not (freedom and misfits(scatter, freedom)):
                return Fit(_function(coefficients, speeds), covariance, np.inf, scatter)
    # the noise is not known, or larger than it is said to be
    coefficients, covariance, scatter, freedom = _gauss_newton(
        tunable, observations, weights, powers, start, noise_known=False
    )
    return Fit(_function(coefficients, speeds), covariance, freedom, scatter)


def _initial_values(tunable: Tunable, speeds: Floats, values: Floats, degree: int) -> Floats:
    """Return those of a polynomial through the values of the impacts that could be matched."""
    matched = np.isfinite(values)
    if not matched.any():
        return np.full(len(speeds), tunable.start)
    degree = min(degree, distinct(speeds[matched]) - 1)
    polynomial_values = fit_values(speeds[matched], values[matched], degree).function(speeds)
    return np.asarray(polynomial_values)


def _scatter(residual: Floats, freedom: int) -> float:
    """Return the standard deviation that residuals tell; NaN without a degree of freedom."""
    if not freedom:
        return np.nan
    return float(np.sqrt((residual @ residual) / freedom))


def _gauss_newton(
    tunable: Tunable,
    observations: Observations,
    weights: Mapping[str, float],
    powers: Floats,
    start: Floats,
    *,
    noise_known: bool,
) -> tuple[Floats, Floats, float, int]:
    """Return coefficients, their covariance, the scatter of the residuals, and its freedom.

    The scatter is in units of the noise; the freedom is the number of degrees of freedom.

    Parameters
    ----------
    tunable, observations, weights
        As in `fit_observations`.
    powers : array, shape (n, k)
        Powers of the approach speeds.
    start : array, shape (n,)
        Values of the parameter to begin with.
    noise_known : bool
        Whether the noise is as large as the observations have it; otherwise as large as the
        residuals.
    """
    coefficient_count = powers.shape[1]
    coefficients = _least_squares(powers, start)[0]
    values = start
    input_effects: list[Floats] = []
    for iteration in range(_MOST_ITERATIONS):
        impacts = derivatives(tunable, observations.speeds, values, observations.which)
        value_slope = polynomial.polyval(observations.speeds, polynomial.polyder(coefficients))
        rows = []
        targets = []
        noises = []
        for name, weight in weights.items():
            by_value = impacts.by_value[name]
            rows.append(by_value[:, None] * powers)
            targets.append(observations.wanted[name] - impacts.outcomes[name] + by_value * values)
            # noise of the approach speed also changes the value of the polynomial
            by_speed = impacts.by_speed[name] + by_value * value_slope
            noise = observations.noise[name] - scaled(by_speed, observations.speed_noise)
            if not observations.deviations_known:
                # then the weights alone say how far a quantity may be off
                noise = noise / np.sqrt(weight)
            noises.append(noise)
            # to first order, so that an input that noise is nothing to lets the fit settle
            if iteration == 0:
                input_effects.append(_input_effects(observations, name, by_speed))
        if not any(np.any(row) for row in rows):
            raise InputError(
                f"{tunable.name} has no influence on the measured "
                "quantities, which can't determine it",
                "parameter",
            )
        # whitened, so that readings shared by two impacts count once
        equations = np.column_stack(
            [np.concatenate(rows), np.concatenate(input_effects), np.concatenate(targets)]
        )
        independent = whitened(vstack(noises), equations)
        coefficients, covariance, scatter = _with_inputs(
            independent[:, :-1], independent[:, -1], coefficient_count, noise_known
        )
        previous = values
        values = tunable.allowed.clip(powers @ coefficients)
        if np.all(np.abs(values - previous) <= _CONVERGED * np.abs(values).max()):
            return coefficients, covariance, scatter, len(independent) - coefficient_count
    if coefficient_count < distinct(observations.speeds):
        # a polynomial far from exact measurements is the usual cause
        degree = "take a higher degree, or "
    elif coefficient_count > 1:
        degree = "take a lower degree, or "
    else:
        degree = ""
    raise ComputationError(
        f"the fit of {tunable.name} does not settle; {degree}look at the measurements"
    )


def _input_effects(observations: Observations, name: str, by_speed: Floats) -> Floats:
    """Return what one standard deviation of each typed input changes in residuals, (n, k).

    `name` is that of the quantity, and `by_speed` its derivative by the approach speed.
    """
    effects = observations.effects
    if effects is None:
        return np.zeros((len(observations.speeds), 0))
    return np.asarray(effects.wanted[name] - by_speed[:, None] * effects.speeds)


def _with_inputs(
    columns: Floats, targets: Floats, coefficient_count: int, noise_known: bool
) -> tuple[Floats, Floats, float]:
    """Return coefficients, their covariance, and the scatter of the residuals.

    The scatter is in units of the noise. Columns after those of the coefficients are typed inputs,
    each of which is off by an unknown part of its standard deviation: a coefficient that is
    expected to be 0 within 1. Noise of unknown magnitude is as large as the scatter.
    """
    input_count = columns.shape[1] - coefficient_count
    freedom = len(targets) - coefficient_count
    # an equation for each input, "0 within 1"
    prior = np.hstack([np.zeros((input_count, coefficient_count)), np.eye(input_count)])
    all_targets = np.append(targets, np.zeros(input_count))
    scatter = 1.0 if noise_known else np.nan
    for _ in range(_MOST_ITERATIONS):
        if noise_known:
            prior_weight = 1.0
        elif scatter > 0.0:
            prior_weight = max(scatter, _LEAST_SCATTER)
        else:  # without a scatter to begin with, inputs are taken as exact
            prior_weight = 1.0 / _LEAST_SCATTER
        rows = np.vstack([columns, prior_weight * prior])
        solution, inverse = _least_squares(rows, all_targets)
        residual = all_targets - rows @ solution
        previous = scatter
        scatter = _scatter(residual, freedom)
        if noise_known or not input_count or not scatter > 0.0:
            break
        if abs(scatter - previous) <= _SCATTER_CONVERGED * scatter:
            break
    variance = 1.0 if noise_known else scatter**2
    covariance = variance * inverse[:coefficient_count, :coefficient_count]
    return solution[:coefficient_count], covariance, scatter


def misfits(scatter: float, freedom: int) -> bool:
    """Return whether the residuals exceed the 99.9 % quantile expected from the given noise."""
    from scipy.stats import chi2

    return bool(scatter**2 * freedom > chi2.ppf(0.999, freedom))


def value_deviations(
    tunable: Tunable, observations: Observations, weights: Mapping[str, float], values: Floats
) -> tuple[Floats, Floats]:
    """Return the first-order standard deviation of the value that matches each impact, (n,).

    Further, its parts by typed inputs, (n, k). The value minimizes the weighted sum of squared
    deviations from the targets.
    """
    impacts = derivatives(
        tunable,
        observations.speeds,
        np.where(np.isfinite(values), values, tunable.start),
        observations.which,
    )
    gradient_noise: Noise = no_noise(*observations.speed_noise.shape)
    curvature = np.zeros(len(values))
    input_count = 0
    if observations.effects is not None:
        input_count = len(observations.effects.inputs)
    input_effects = np.zeros((len(values), input_count))
    for name, weight in weights.items():
        scale = residual_scale(name, observations.speeds, observations.wanted[name])
        by_speed = impacts.by_speed[name]
        by_value = impacts.by_value[name] / scale
        noise = observations.noise[name] - scaled(by_speed, observations.speed_noise)
        gradient_noise = gradient_noise + scaled(weight * by_value / scale, noise)
        curvature += weight * by_value**2
        input_weight = weight * impacts.by_value[name] / scale**2
        input_effects += input_weight[:, None] * _input_effects(observations, name, by_speed)
    with np.errstate(divide="ignore", invalid="ignore"):
        gradient_deviation = np.hypot(
            standard_deviations(gradient_noise), np.linalg.norm(input_effects, axis=1)
        )
        return (
            np.asarray(gradient_deviation / curvature),
            np.asarray(input_effects / curvature[:, None]),
        )


def _powers(speeds: Floats, degree: int) -> Floats:
    return np.vander(speeds, degree + 1, increasing=True)


def _least_squares(powers: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return the least-squares solution and the inverse of the normal matrix.

    Columns are normalized for conditioning.
    """
    norms = np.linalg.norm(powers, axis=0)
    inverse = np.linalg.pinv(powers / norms)
    return inverse @ values / norms, (inverse @ inverse.T) / np.outer(norms, norms)


def _function(coefficients: Floats, speeds: Floats) -> SpeedFunction:
    return SpeedFunction(tuple(coefficients.tolist()), float(speeds.min()), float(speeds.max()))
