r"""What a contact law does not carry of the quasi-static indentation, in series with it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Array


@dataclass(frozen=True)
class QuasiStatic:
    r"""Quasi-static compliance in series with a contact law.

    .. math:: s(F) = C F + c(a/R) \frac{F}{E R},\qquad c = c_0 + c_1 \ln x + c_2 x + c_3 x^2,\qquad x = a/R = (F/F_R)^{1/3}

    The first term holds what compliance the modes leave out, or, where it is negative, what they carry already; the
    second corrects Hertz's half-space to a sphere of finite size.

    Parameters
    ----------
    linear : float or array
        C [m/N], of either sign.
    unit : float or array
        1/(E R) of the sphere [m/N]; zero for a rigid one.
    factors : tuple of four floats or arrays
        c0, c1, c2 and c3 [-].
    force : float or array
        F_R, at which Hertz's contact radius would be the sphere's [N], > 0.

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
        """Is there any?"""
        return self._some

    @cached_property
    def _some(self) -> bool:
        return bool(np.any(self.linear) or np.any(self.unit))

    def indentation(self, force: Array) -> Array:
        """Return s [m] at a force [N]."""
        return force * (self.linear + self.unit * self._sum(force, 0.0, (1.0, 1.0, 1.0)))

    def compliance(self, force: Array) -> Array:
        """Return ds/dF [m/N] at a force [N]."""
        return self.linear + self.unit * self._sum(force, 1.0 / 3.0, (1.0, 4.0 / 3.0, 5.0 / 3.0))

    def energy(self, force: Array) -> Array:
        """Return the energy that it holds at a force, the integral of F ds [J]; negative where it is taken out."""
        return 0.5 * force * force * (self.linear + self.unit * self._sum(force, 1.0 / 6.0, (1.0, 8.0 / 7.0, 1.25)))

    def _sum(self, force: Array, shift: float, weights: tuple[float, float, float]) -> Array:
        """Return the sum of the terms of c, the logarithm shifted, and those of powers weighted."""
        constant, logarithm, linear, square = self.factors
        first, second, third = weights
        x = np.maximum(np.cbrt(np.abs(force) / self.force), 1e-9)  # there is no contact radius below that
        return first * constant + logarithm * (np.log(x) + shift) + x * (second * linear + third * square * x)
