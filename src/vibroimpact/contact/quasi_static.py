"""Quasi-static compliance in series with a contact law."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Array, Floats


@dataclass(frozen=True)
class QuasiStatic:
    r"""Quasi-static compliance in series with a contact law.

    Its indentation is

    .. math::

        s(F) = C F + c(a/R) \frac{F}{E R},\qquad c = c_0 + c_1 \ln x + c_2 x + c_3 x^2,\qquad
        x = a/R = (F/F_R)^{1/3}

    The first term is the residual compliance of the truncated modes or, where negative, the
    compliance that the modes already contain; the second corrects Hertz's half-space for the finite
    size of the sphere.

    Parameters
    ----------
    linear : float or array
        C [m/N], positive or negative.
    unit : float or array
        1/(E R) of the sphere [m/N]; zero for a rigid one.
    factors : tuple of four floats or arrays
        c0, c1, c2 and c3 [-].
    force : float or array
        F_R, at which Hertz's contact radius equals the radius of the sphere [N], > 0.

    Examples
    --------
    >>> f"{QuasiStatic(linear=1e-9).indentation(1e3):.3g} m"
    '1e-06 m'
    """

    linear: Array = 0.0
    unit: Array = 0.0
    factors: tuple[Array, Array, Array, Array] = (0.0, 0.0, 0.0, 0.0)
    force: Array = 1.0

    def __bool__(self) -> bool:
        """Is any of the compliances nonzero?"""
        return self._nonzero

    @cached_property
    def _nonzero(self) -> bool:
        return bool(np.any(self.linear) or np.any(self.unit))

    @property
    def coefficients(self) -> Floats:
        """C, 1/(E R), c0, c1, c2, c3 and F_R of a single compliance (7,)."""
        return np.array([self.linear, self.unit, *self.factors, self.force], dtype=float)

    def indentation(self, force: Array) -> Array:
        """Return s [m] at a force [N]."""
        x, log_x = self._relative_radius(force)
        return force * (self.linear + self.unit * self._factor(x, log_x))

    def linearised(self, force: Array) -> tuple[Array, Array]:
        """Return s [m] and ds/dF [m/N] at a force [N]."""
        x, log_x = self._relative_radius(force)
        indentation = force * (self.linear + self.unit * self._factor(x, log_x))
        # x grows as F^(1/3): d(F ln x)/dF = ln x + 1/3, and d(F x^k)/dF = (1 + k/3) x^k
        slope = self._factor(x, log_x + 1.0 / 3.0, (4.0 / 3.0, 5.0 / 3.0))
        return indentation, self.linear + self.unit * slope

    def energy(self, force: Array) -> Array:
        """Return the integral of F ds from zero to a force [J].

        It is negative for a negative compliance.
        """
        x, log_x = self._relative_radius(force)
        # the integral of F d(F c)/dF, over F^2/2: of ln x it is ln x + 1/6, of x^k it is
        # x^k (1 + k/3)/(1 + k/6)
        factor = self._factor(x, log_x + 1.0 / 6.0, (8.0 / 7.0, 1.25))
        return 0.5 * force * force * (self.linear + self.unit * factor)

    def _relative_radius(self, force: Array) -> tuple[Array, Array]:
        """Return x, at least 1e-9, and its logarithm."""
        x = np.maximum(np.cbrt(np.abs(force) / self.force), 1e-9)
        return x, np.log(x)

    def _factor(self, x: Array, log_x: Array, weights: tuple[float, float] = (1.0, 1.0)) -> Array:
        """Return c(x) with weighted terms of c2 and c3, and a logarithm that may be shifted.

        Weights and shift make it the derivative or the integral.
        """
        c0, c1, c2, c3 = self.factors
        return c0 + c1 * log_x + x * (weights[0] * c2 + weights[1] * c3 * x)
