"""Restitution as a function of the approach speed: constant, linear or a power, with intervals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.fitting import half_width

CONSTANT = "constant"
LINEAR = "linear"
POWER = "power"

_TINY = 1e-300  # an absolute error, which must not count
_ROUNDING = 1e-14  # relative: of a variance

_PASSES = 3
"""Number of fits, each with the slope of the previous one."""


@dataclass(frozen=True)
class SpeedLaw:
    r"""A restitution as a function of the approach speed, fitted by generalized least squares.

    Parameters
    ----------
    name : str
        "constant", :math:`e = a`; "linear", :math:`e = a + b v`; or "power", :math:`e = a v^b`.
    coefficients : array, shape (1,) or (2,)
        a, and b; of the power law those for v in m/s.
    covariance : array
        Their covariance; of the power law that of :math:`\ln a` and b.
    freedom : float
        Degrees of freedom of the scatter; infinite if the uncertainty of the restitutions explains
        it.
    scatter : float
        Standard deviation of the restitutions about the function beside their own uncertainty; of
        the power law relative.
    """

    name: str
    coefficients: Floats
    covariance: Floats
    freedom: float
    scatter: float

    def __call__(self, speed: Floats) -> Floats:
        """Return the restitution at approach speeds [m/s]."""
        first = self.coefficients[0]
        second = 0.0
        if len(self.coefficients) > 1:
            second = self.coefficients[1]
        if self.name == POWER:
            return np.asarray(first * speed**second)
        return np.asarray(first + second * speed)

    def intervals(self, confidence: float) -> Floats:
        """Return the confidence intervals of the coefficients, (k, 2)."""
        half = half_width(confidence, self.freedom) * np.sqrt(np.diag(self.covariance))
        ends = np.stack([self.coefficients - half, self.coefficients + half], axis=1)
        if self.name == POWER:
            ends[0] = self.coefficients[0] * np.exp([-half[0], half[0]])
        return ends

    def band(self, speed: Floats, confidence: float) -> tuple[Floats, Floats]:
        """Return the ends of the confidence band of the restitution at approach speeds [m/s]."""
        abscissa = speed
        if self.name == POWER:  # it is linear in logarithms
            abscissa = np.log(speed)
        design = np.vander(abscissa, len(self.coefficients), increasing=True)
        variance = np.einsum("ni,ij,nj->n", design, self.covariance, design)
        half = half_width(confidence, self.freedom) * np.sqrt(variance)
        restitution = self(speed)
        if self.name == POWER:
            return restitution * np.exp(-half), restitution * np.exp(half)
        return restitution - half, restitution + half


class Fitted(Protocol):
    """Restitutions at several approach speeds with their fits, from bounces or from a table."""

    @property
    def approach_speed(self) -> Floats:
        """Approach speeds [m/s], (n,)."""

    @property
    def restitution(self) -> Floats:
        """Restitutions, (n,)."""

    @property
    def intervals(self) -> Floats:
        """Their intervals, (n, 2)."""

    @property
    def laws(self) -> list[SpeedLaw]:
        """Fits over the approach speed."""

    @property
    def confidence(self) -> float:
        """Confidence level of intervals."""


def speed_laws(
    speed: Floats,
    restitution: Floats,
    covariance: Floats,
    count: Floats | None = None,
    shared: Floats | None = None,
) -> list[SpeedLaw]:
    """Return the fits to restitutions at several speeds.

    They are those with fewer coefficients than there are restitutions, the constant always.

    Real bounces scatter by more than times are uncertain: to their covariance that of a scatter is
    added, such that the sum of squared residuals is what is expected (Paule and Mandel 1982, J.
    Res. Natl. Bur. Stand. 87:377).

    Parameters
    ----------
    speed, restitution : array, shape (n,)
        Approach speeds [m/s] and restitutions.
    covariance : array, shape (n, n)
        Covariance of the restitutions.
    count : array, shape (n,), optional
        The number of impacts of which each restitution is the mean, of which the scatter is that of
        one; 1 by default.
    shared : array, shape (k, 2, n), optional
        What one standard deviation of each of k inputs, such as gravity, changes in the
        restitutions and in the speeds.

    Examples
    --------
    >>> speed = np.array([1.0, 2.0, 4.0, 8.0])
    >>> [
    ...     law.coefficients.round(6).tolist()
    ...     for law in speed_laws(speed, 0.8 * speed**-0.25, 1e-6 * np.eye(4))
    ... ][-1]
    [0.8, -0.25]
    """
    variance_shares = np.ones(len(speed))
    if count is not None:
        # a mean of several impacts has a part of the variance of the scatter of one
        variance_shares = 1.0 / count
    if shared is None:
        of_restitution = np.zeros((0, len(speed)))
        of_speed = np.zeros((0, len(speed)))
    else:
        of_restitution = shared[:, 0]
        of_speed = shared[:, 1]
    constant = np.ones((len(speed), 1))
    by_inputs = of_restitution.T @ of_restitution
    laws = [_fitted(CONSTANT, constant, restitution, covariance + by_inputs, variance_shares)]
    if len(speed) > 2 and np.ptp(speed) > 0.0:
        laws.append(
            _straight_fit(
                LINEAR, speed, restitution, covariance, variance_shares, of_restitution, of_speed
            )
        )
        laws.append(
            _straight_fit(
                POWER,
                np.log(speed),
                np.log(restitution),
                covariance / np.outer(restitution, restitution),
                variance_shares,
                of_restitution / restitution,
                of_speed / speed,
            )
        )
    return laws


def _straight_fit(
    name: str,
    abscissa: Floats,
    ordinate: Floats,
    covariance: Floats,
    variance_shares: Floats,
    of_ordinate: Floats,
    of_abscissa: Floats,
) -> SpeedLaw:
    """Return a straight fit; `of_ordinate` and `of_abscissa` are what inputs change, (k, n).

    What they change in the abscissa counts by the slope, which is found in a few passes.
    """
    design = np.vander(abscissa, 2, increasing=True)
    slope = 0.0
    for _ in range(_PASSES):
        of_residual = of_ordinate - slope * of_abscissa
        by_inputs = of_residual.T @ of_residual
        law = _fitted(name, design, ordinate, covariance + by_inputs, variance_shares)
        slope = float(law.coefficients[1])
    return law


def _fitted(
    name: str, design: Floats, ordinate: Floats, covariance: Floats, variance_shares: Floats
) -> SpeedLaw:
    """Return a fit by generalized least squares, with the variance of the scatter.

    `variance_shares`: parts of the variance of the scatter that the ordinates have, (n,).
    """
    freedom = len(ordinate) - design.shape[1]

    def fit(scatter_variance: float) -> tuple[Floats, Floats, float]:
        """Return coefficients, their covariance, and the sum of squared residuals."""
        root = np.linalg.cholesky(covariance + scatter_variance * np.diag(variance_shares))
        white_design = np.linalg.solve(root, design)
        white_ordinate = np.linalg.solve(root, ordinate)
        inverse = np.linalg.pinv(white_design)
        solution = inverse @ white_ordinate
        squares = float(np.sum((white_ordinate - white_design @ solution) ** 2))
        return solution, inverse @ inverse.T, squares

    def excess(scatter_variance: float) -> float:
        return float(fit(scatter_variance)[2] - freedom)

    # the sum of squares is that expected, the degrees of freedom (Paule and Mandel 1982)
    scatter_variance = 0.0
    if freedom:
        scatter_variance = _root_of_falling(excess, float(np.var(ordinate)))
    coefficients, coefficient_covariance, _ = fit(scatter_variance)
    if name == POWER:
        coefficients = np.array([np.exp(coefficients[0]), coefficients[1]])
    # without a scatter to estimate, the noise is known and its quantiles are those of a normal one
    own_freedom = freedom if scatter_variance else np.inf
    return SpeedLaw(
        name,
        coefficients,
        coefficient_covariance,
        freedom=own_freedom,
        scatter=float(np.sqrt(scatter_variance)),
    )


def _root_of_falling(function: Callable[[float], float], guess: float) -> float:
    """Return the positive root of a falling function; 0 if it is not above 0 at 0."""
    if function(0.0) <= 0.0:
        return 0.0
    high = guess
    while function(high) > 0.0:
        high *= 2.0
    from scipy.optimize import brentq  # takes a while to load

    return float(brentq(function, 0.0, high, xtol=_TINY, rtol=_ROUNDING))
