"""Fit a parameter as a polynomial of the approach speed: through values, or through what was measured, by least squares."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import polynomial

from vibroimpact.arrays import Floats
from vibroimpact.calibration.matching import Tunable, derivatives, residual_scale
from vibroimpact.calibration.observations import Observations
from vibroimpact.calibration.speed_function import SpeedFunction
from vibroimpact.errors import ComputationError, InputError

_SWEEPS = 50
_WITHIN = 1e-10


@dataclass(frozen=True)
class Fit:
    """A fitted polynomial and how well it is known.

    Parameters
    ----------
    function : SpeedFunction
        The polynomial.
    covariance : array, shape (k, k)
        Of its coefficients; NaN if there are no more observations than coefficients, and the noise is not known.
    freedom : float
        Degrees of freedom of the estimate of the noise; infinite where the noise is known, and explains the residuals. Where it does
        not, the covariance is that of the residuals.
    scatter : float
        Standard deviation of the values about the polynomial, or of the residuals over their noise.
    """

    function: SpeedFunction
    covariance: Floats
    freedom: float
    scatter: float

    def quantile(self, confidence: float) -> float:
        """Return how many standard deviations an interval reaches to either side."""
        from scipy.stats import t as students_t  # which takes longer to load than a calibration

        return float(students_t.ppf(0.5 + 0.5 * confidence, self.freedom))

    def half_widths(self, confidence: float) -> Floats:
        """Return the half widths of the intervals of the coefficients."""
        return np.asarray(self.quantile(confidence) * np.sqrt(np.maximum(np.diag(self.covariance), 0.0)))

    def band(self, speeds: Floats, confidence: float) -> Floats:
        """Return the half width of the band of the polynomial at approach speeds [m/s]."""
        powers = _powers(np.asarray(speeds, dtype=float), self.function.degree)
        spread = np.einsum("ni,ij,nj->n", powers, self.covariance, powers)
        return np.asarray(self.quantile(confidence) * np.sqrt(np.maximum(spread, 0.0)))


def check_degree(speeds: Floats, degree: int) -> None:
    """Raise unless there are enough different speeds for a polynomial.

    Raises
    ------
    InputError
        If there are not.
    """
    different = distinct(speeds)
    if degree >= different:
        have = "one speed is" if different == 1 else f"{different} that differ by more than 1 % of the largest are"
        needs = f"a polynomial of degree {degree} needs {degree + 1} speeds"
        raise InputError(f"{needs}, and {have} there; take {different - 1} at most", "degree")


def distinct(speeds: Floats) -> int:
    """Return how many speeds differ by more than a hundredth of the largest.

    Examples
    --------
    >>> distinct(np.array([1.0, 1.001, 2.0]))
    2
    """
    return 1 + int(np.count_nonzero(np.diff(np.sort(speeds)) > 0.01 * speeds.max()))


def fit_values(speeds: Floats, values: Floats, degree: int) -> Fit:
    """Fit values that are exact, all alike.

    What is left over is not noise but what the polynomial can't follow.

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
    left = values - powers @ coefficients
    scatter = float(np.sqrt((left @ left) / freedom)) if freedom else np.nan
    return Fit(_function(coefficients, speeds), scatter**2 * covariance, freedom, scatter)


def fit_observations(tunable: Tunable, observations: Observations, weights: Mapping[str, float], degree: int, values: Floats) -> Fit:
    """Fit the function with which impacts come out as they were measured, by Gauss and Newton's method.

    Parameters
    ----------
    tunable : Tunable
        The parameter.
    observations : Observations
        What was measured, with its noise.
    weights : mapping of str to float
        Outcomes that count; their weights only where the sizes of the noise are not known.
    degree : int
        Of the polynomial.
    values : array, shape (n,)
        What fits each alone, to begin with; NaN where nothing does.

    Raises
    ------
    ComputationError
        If it does not converge.
    """
    speeds, known = observations.speeds, observations.deviations_known
    check_degree(speeds, degree)
    powers = _powers(speeds, degree)
    some = np.isfinite(values)
    first = min(degree, distinct(speeds[some]) - 1) if some.any() else 0
    begin = fit_values(speeds[some], values[some], first).function(speeds) if some.any() else np.full(len(speeds), tunable.start)
    at = tunable.allowed.clip(begin)
    coefficients = _least_squares(powers, at)[0]
    for _ in range(_SWEEPS):
        found = derivatives(tunable, speeds, at, observations.which)
        rows, targets, noises = [], [], []
        for name, weight in weights.items():
            by_value = found.by_value[name]
            rows.append(by_value[:, None] * powers)
            targets.append(observations.wanted[name] - found.outcomes[name] + by_value * at)
            # at another approach speed the polynomial says another value, too
            along = found.by_speed[name] + by_value * polynomial.polyval(speeds, polynomial.polyder(coefficients))
            noise = observations.noise[name] - along[:, None] * observations.speed_noise
            noises.append(noise / (1.0 if known else np.sqrt(weight)))
        if not any(np.any(row) for row in rows):
            raise InputError(f"{tunable.name} has no influence on what was measured, which can't tell it", "parameter")
        noise = np.concatenate(noises)
        root = np.linalg.cholesky(noise @ noise.T)
        whitened = [np.linalg.solve(root, part) for part in (np.concatenate(rows), np.concatenate(targets))]
        coefficients, covariance = _least_squares(whitened[0], whitened[1])
        before, at = at, tunable.allowed.clip(powers @ coefficients)
        if np.all(np.abs(at - before) <= _WITHIN * np.abs(at).max()):
            break
    else:
        raise ComputationError(f"the fit of {tunable.name} does not settle; take a lower degree, or look at the measurements")
    left = whitened[1] - whitened[0] @ coefficients
    freedom = len(left) - degree - 1
    scatter = float(np.sqrt((left @ left) / freedom)) if freedom else np.nan
    if known and not (freedom and _misfits(scatter, freedom)):
        return Fit(_function(coefficients, speeds), covariance, np.inf, scatter)
    return Fit(_function(coefficients, speeds), scatter**2 * covariance, freedom, scatter)


def _misfits(scatter: float, freedom: int) -> bool:
    """Are residuals larger than noise of the given size would leave once in a thousand times?"""
    from scipy.stats import chi2

    return bool(scatter**2 * freedom > chi2.ppf(0.999, freedom))


def value_noise(tunable: Tunable, observations: Observations, weights: Mapping[str, float], values: Floats) -> Floats:
    """Return what each source of noise adds to the value that fits each impact alone, to first order, (n, m)."""
    found = derivatives(tunable, observations.speeds, np.where(np.isfinite(values), values, tunable.start), observations.which)
    above, below = np.zeros((len(values), observations.speed_noise.shape[1])), np.zeros((len(values), 1))
    for name, weight in weights.items():
        scale = residual_scale(name, observations.speeds, observations.wanted[name])
        by_value = (found.by_value[name] / scale)[:, None]
        noise = observations.noise[name] - found.by_speed[name][:, None] * observations.speed_noise
        above += weight * by_value * noise / scale[:, None]
        below += weight * by_value**2
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(above / below)


def _powers(speeds: Floats, degree: int) -> Floats:
    return np.vander(speeds, degree + 1, increasing=True)


def _least_squares(powers: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return the solution and the inverse of the normal matrix, from columns of length one."""
    length = np.linalg.norm(powers, axis=0)
    inverse = np.linalg.pinv(powers / length)
    return inverse @ values / length, (inverse @ inverse.T) / np.outer(length, length)


def _function(coefficients: Floats, speeds: Floats) -> SpeedFunction:
    return SpeedFunction(tuple(coefficients.tolist()), float(speeds.min()), float(speeds.max()))
