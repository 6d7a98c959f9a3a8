"""Least-squares fit of a parameter as a polynomial of the approach speed, to values or to
measurements.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import polynomial
from scipy.sparse import vstack

from vibroimpact.arrays import Floats
from vibroimpact.calibration.matching import Tunable, derivatives, residual_scale
from vibroimpact.calibration.noise import Noise, no_noise, scaled, standard_deviations, whitened
from vibroimpact.calibration.observations import Observations
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.errors import ComputationError, InputError

_SWEEPS = 50
_WITHIN = 1e-10
_ROUNDS = 50
_LEAST = 1e-9


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
        """Return the half width of the confidence band of the polynomial at approach
        speeds [m/s].
        """
        powers = _powers(np.asarray(speeds, dtype=float), self.function.degree)
        spread = np.einsum("ni,ij,nj->n", powers, self.covariance, powers)
        return np.asarray(self.quantile(confidence) * np.sqrt(np.maximum(spread, 0.0)))


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
    different = distinct(speeds)
    if degree >= different:
        have = f"{different} that differ by more than 1 % of the largest are there"
        if different == 1:
            have = (
                "one speed is there"
                if len(speeds) == 1
                else "all that are there lie within 1 % of the largest"
            )
        needs = f"a polynomial of degree {degree} needs {degree + 1} speeds"
        raise InputError(f"{needs}, and {have}; take {different - 1} at most", "degree")


def distinct(speeds: Floats) -> int:
    """Return how many of the speeds lie more than 1 % of the largest apart.

    Examples
    --------
    >>> distinct(np.array([1.0, 1.001, 2.0])), distinct(np.linspace(1.0, 2.0, 1000))
    (2, 50)
    """
    ordered, step = np.sort(speeds), 0.01 * speeds.max()
    number, place = 0, 0
    while place < len(ordered):
        number += 1
        place = int(np.searchsorted(ordered, ordered[place] + step, side="right"))
    return number


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
    left = values - powers @ coefficients
    scatter = float(np.sqrt((left @ left) / freedom)) if freedom else np.nan
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
    speeds, known = observations.speeds, observations.deviations_known
    check_degree(speeds, degree)
    powers = _powers(speeds, degree)
    # initial guess: a polynomial through the values of the impacts that could be matched
    some = np.isfinite(values)
    first = min(degree, distinct(speeds[some]) - 1) if some.any() else 0
    begin = (
        fit_values(speeds[some], values[some], first).function(speeds)
        if some.any()
        else np.full(len(speeds), tunable.start)
    )
    at = tunable.allowed.clip(begin)
    if known:
        try:
            coefficients, covariance, scatter, freedom = _settled(
                tunable, observations, weights, powers, at, noise_known=True
            )
        except ComputationError:
            if observations.effects is None:
                raise
        else:
            if not (freedom and misfits(scatter, freedom)):
                return Fit(_function(coefficients, speeds), covariance, np.inf, scatter)
    # the noise is not known, or larger than it is said to be
    coefficients, covariance, scatter, freedom = _settled(
        tunable, observations, weights, powers, at, noise_known=False
    )
    return Fit(_function(coefficients, speeds), covariance, freedom, scatter)


def _settled(
    tunable: Tunable,
    observations: Observations,
    weights: Mapping[str, float],
    powers: Floats,
    at: Floats,
    *,
    noise_known: bool,
) -> tuple[Floats, Floats, float, int]:
    """Return coefficients, their covariance, the scatter of the residuals in units of the noise,
    and its degrees of freedom.

    Parameters
    ----------
    tunable, observations, weights
        As in `fit_observations`.
    powers : array, shape (n, k)
        Powers of the approach speeds.
    at : array, shape (n,)
        Values to begin with.
    noise_known : bool
        Whether the noise is as large as the observations have it; otherwise as large as the
        residuals.
    """
    speeds, coefficients, number = (
        observations.speeds,
        _least_squares(powers, at)[0],
        powers.shape[1],
    )
    shares: list[Floats] = []
    for sweep in range(_SWEEPS):
        found = derivatives(tunable, speeds, at, observations.which)
        rows, targets, noises = [], [], []
        for name, weight in weights.items():
            by_value = found.by_value[name]
            rows.append(by_value[:, None] * powers)
            targets.append(observations.wanted[name] - found.outcomes[name] + by_value * at)
            # noise of the approach speed also changes the value of the polynomial
            along = found.by_speed[name] + by_value * polynomial.polyval(
                speeds, polynomial.polyder(coefficients)
            )
            noise = observations.noise[name] - scaled(along, observations.speed_noise)
            noises.append(noise / (1.0 if observations.deviations_known else np.sqrt(weight)))
            # to first order, so that an input that noise is nothing to lets the fit settle
            if not sweep:
                shares.append(_shared(observations, name, along))
        if not any(np.any(row) for row in rows):
            raise InputError(
                f"{tunable.name} has no influence on the measured "
                "quantities, which can't determine it",
                "parameter",
            )
        # whitened, so that readings shared by two impacts count once
        independent = whitened(
            vstack(noises),
            np.column_stack([np.concatenate(part) for part in (rows, shares, targets)]),
        )
        coefficients, covariance, scatter = _with_inputs(
            independent[:, :-1], independent[:, -1], number, noise_known
        )
        before, at = at, tunable.allowed.clip(powers @ coefficients)
        if np.all(np.abs(at - before) <= _WITHIN * np.abs(at).max()):
            return coefficients, covariance, scatter, len(independent) - number
    lower = "take a lower degree, or " if number > 1 else ""
    raise ComputationError(
        f"the fit of {tunable.name} does not settle; {lower}look at the measurements"
    )


def _shared(observations: Observations, name: str, along: Floats) -> Floats:
    """Return what one standard deviation of each typed input changes in the residuals of
    a quantity, (n, k).
    """
    effects = observations.effects
    if effects is None:
        return np.zeros((len(observations.speeds), 0))
    return np.asarray(effects.wanted[name] - along[:, None] * effects.speeds)


def _with_inputs(
    columns: Floats, targets: Floats, number: int, known: bool
) -> tuple[Floats, Floats, float]:
    """Return coefficients, their covariance, and the scatter of the residuals in units of the
    noise.

    Columns after the first `number` are typed inputs, each of which is off by an unknown part of
    its standard deviation: a coefficient that is expected to be 0 within 1. Noise of unknown
    magnitude is as large as the scatter.
    """
    inputs, freedom = columns.shape[1] - number, len(targets) - number
    prior = np.hstack([np.zeros((inputs, number)), np.eye(inputs)])
    scatter, whole = (1.0 if known else np.nan), np.append(targets, np.zeros(inputs))
    for _ in range(_ROUNDS):
        # without a scatter to begin with, inputs are taken as exact
        stiff = 1.0 if known else max(scatter, _LEAST) if scatter > 0.0 else 1.0 / _LEAST
        rows = np.vstack([columns, stiff * prior])
        found, inverse = _least_squares(rows, whole)
        left = whole - rows @ found
        before, scatter = scatter, float(np.sqrt((left @ left) / freedom)) if freedom else np.nan
        if known or not inputs or not scatter > 0.0 or abs(scatter - before) <= 1e-6 * scatter:
            break
    return found[:number], (1.0 if known else scatter**2) * inverse[:number, :number], scatter


def misfits(scatter: float, freedom: int) -> bool:
    """Return whether the residuals exceed the 99.9 % quantile expected from the given noise."""
    from scipy.stats import chi2

    return bool(scatter**2 * freedom > chi2.ppf(0.999, freedom))


def value_deviations(
    tunable: Tunable, observations: Observations, weights: Mapping[str, float], values: Floats
) -> tuple[Floats, Floats]:
    """Return the first-order standard deviation of the value that matches each impact,
    (n,), and its parts by typed inputs, (n, k).
    """
    found = derivatives(
        tunable,
        observations.speeds,
        np.where(np.isfinite(values), values, tunable.start),
        observations.which,
    )
    above: Noise = no_noise(*observations.speed_noise.shape)
    below = np.zeros(len(values))
    for name, weight in weights.items():
        scale = residual_scale(name, observations.speeds, observations.wanted[name])
        by_value = found.by_value[name] / scale
        noise = observations.noise[name] - scaled(found.by_speed[name], observations.speed_noise)
        above = above + scaled(weight * by_value / scale, noise)
        below += weight * by_value**2
    effects = sum(
        (
            weight
            * found.by_value[name]
            / residual_scale(name, observations.speeds, observations.wanted[name]) ** 2
        )[:, None]
        * _shared(observations, name, found.by_speed[name])
        for name, weight in weights.items()
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        every = np.hypot(standard_deviations(above), np.linalg.norm(effects, axis=1)) / below
        return np.asarray(every), np.asarray(effects / below[:, None])


def _powers(speeds: Floats, degree: int) -> Floats:
    return np.vander(speeds, degree + 1, increasing=True)


def _least_squares(powers: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return the least-squares solution and the inverse of the normal matrix; columns are
    normalized for conditioning.
    """
    length = np.linalg.norm(powers, axis=0)
    inverse = np.linalg.pinv(powers / length)
    return inverse @ values / length, (inverse @ inverse.T) / np.outer(length, length)


def _function(coefficients: Floats, speeds: Floats) -> SpeedFunction:
    return SpeedFunction(tuple(coefficients.tolist()), float(speeds.min()), float(speeds.max()))
