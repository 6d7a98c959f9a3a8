"""Restitution as a function of the approach speed: constant, linear or a power, with intervals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fitting import half_width

CONSTANT, LINEAR, POWER = "constant", "linear", "power"

_ROUNDS = 200
_PASSES = 3


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
        first, second = (*self.coefficients, 0.0)[:2]
        return np.asarray(first * speed**second if self.name == POWER else first + second * speed)

    def intervals(self, confidence: float) -> Floats:
        """Return the confidence intervals of the coefficients, (k, 2)."""
        half = half_width(confidence, self.freedom) * np.sqrt(np.diag(self.covariance))
        ends = np.stack([self.coefficients - half, self.coefficients + half], axis=1)
        if self.name == POWER:
            ends[0] = self.coefficients[0] * np.exp([-half[0], half[0]])
        return ends

    def band(self, speed: Floats, confidence: float) -> tuple[Floats, Floats]:
        """Return the ends of the confidence band of the restitution at approach speeds [m/s]."""
        power = self.name == POWER
        design = np.vander(
            np.log(speed) if power else speed, len(self.coefficients), increasing=True
        )
        half = half_width(confidence, self.freedom) * np.sqrt(
            np.einsum("ni,ij,nj->n", design, self.covariance, design)
        )
        value = self(speed)
        return (
            (value * np.exp(-half), value * np.exp(half)) if power else (value - half, value + half)
        )


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
    """Return the fits to restitutions at several speeds: those with fewer coefficients than there
    are restitutions, the constant always.

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
    one = np.ones(len(speed)) if count is None else 1.0 / count
    of_value, of_speed = (
        np.zeros((2, 0, len(speed))) if shared is None else (shared[:, 0], shared[:, 1])
    )
    found = [
        _fitted(
            CONSTANT, np.ones((len(speed), 1)), restitution, covariance + of_value.T @ of_value, one
        )
    ]
    if len(speed) > 2 and np.ptp(speed) > 0.0:
        found.append(_along(LINEAR, speed, restitution, covariance, one, (of_value, of_speed)))
        relative = covariance / np.outer(restitution, restitution)
        found.append(
            _along(
                POWER,
                np.log(speed),
                np.log(restitution),
                relative,
                one,
                (of_value / restitution, of_speed / speed),
            )
        )
    return found


def _along(
    name: str,
    place: Floats,
    value: Floats,
    covariance: Floats,
    shares: Floats,
    shared: tuple[Floats, Floats],
) -> SpeedLaw:
    """Return a straight fit; what the inputs change in the places counts by the slope,
    which is found in a few rounds.
    """
    design, slope, (of_value, of_place) = np.vander(place, 2, increasing=True), 0.0, shared
    for _ in range(_PASSES):
        moved = of_value - slope * of_place
        fitted = _fitted(name, design, value, covariance + moved.T @ moved, shares)
        slope = float(fitted.coefficients[1])
    return fitted


def _fitted(
    name: str, design: Floats, value: Floats, covariance: Floats, shares: Floats
) -> SpeedLaw:
    """Return a fit; `shares`: parts of the variance of the scatter that the values have, (n,)."""
    freedom = len(value) - design.shape[1]

    def fit(added: float) -> tuple[Floats, Floats, float]:
        root = np.linalg.cholesky(covariance + added * np.diag(shares))
        white, target = np.linalg.solve(root, design), np.linalg.solve(root, value)
        inverse = np.linalg.pinv(white)
        solution = inverse @ target
        return solution, inverse @ inverse.T, float(np.sum((target - white @ solution) ** 2))

    added = _where(lambda one: fit(one)[2] - freedom, float(np.var(value))) if freedom else 0.0
    coefficients, spread, _ = fit(added)
    if name == POWER:
        coefficients = np.array([np.exp(coefficients[0]), coefficients[1]])
    return SpeedLaw(name, coefficients, spread, freedom if added else np.inf, float(np.sqrt(added)))


def _where(excess: Callable[[float], float], most: float) -> float:
    """Return where a falling function of the added variance is zero; 0 if it is not above
    zero there.
    """
    if excess(0.0) <= 0.0:
        return 0.0
    low, high = 0.0, most
    while excess(high) > 0.0:
        high *= 2.0
    for _ in range(_ROUNDS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        low, high = (middle, high) if excess(middle) > 0.0 else (low, middle)
    return high
