r"""Transfer functions at the poles of linear oscillators, in real arithmetic for any damping.

The free motion of an oscillator, :math:`\ddot q = -\omega^2 q - d\,\dot q`, is the exponential of
the matrix A of its state :math:`(q, \dot q)`. The forced output of a linear system driven by that
motion is the first row of :math:`f(A)\,(q, \dot q)^T`, with the system's transfer function f. Since
:math:`A^2 = -\omega^2 - d A`, any :math:`f(A) = a + b A`, and the output is :math:`a q + b \dot q`.
Elements (a, b) of n oscillators are arrays of shape (2, ..., n).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats

Section = tuple[float, float]
"""A pair of poles, by the coefficients (stiffness, damping) of s^2 + damping s + stiffness."""


@dataclass(frozen=True)
class PolePairs:
    """The poles of oscillators, as the coefficients of s^2 + damping s + stiffness, (n,) each."""

    stiffness: Floats
    damping: Floats

    def power(self, order: int) -> Floats:
        """Return the element of the derivative of an order from 0 to 3, that power of A, (2, n)."""
        ones = np.ones_like(self.stiffness)
        zeros = np.zeros_like(self.stiffness)
        powers = (
            (ones, zeros),
            (zeros, ones),
            (-self.stiffness, -self.damping),
            (self.damping * self.stiffness, self.damping**2 - self.stiffness),
        )
        return np.stack(powers[order])

    def quadratic(self, stiffness: float, damping: float) -> Floats:
        """Return the polynomial s^2 + damping s + stiffness at these poles, (2, n).

        It is that of another oscillator.
        """
        return np.stack([stiffness - self.stiffness, damping - self.damping])

    def product(self, first: Floats, second: Floats) -> Floats:
        """Return the product of two elements."""
        a, b = first
        c, d = second
        return np.stack([a * c - b * d * self.stiffness, a * d + b * c - b * d * self.damping])

    def inverse(self, element: Floats) -> Floats:
        """Return the inverse of an element."""
        a, b = element
        determinant = a * a - self.damping * a * b + self.stiffness * b * b
        return np.asarray(np.stack([a - self.damping * b, -b]) / determinant)

    def low_pass(self, sections: Sequence[Section]) -> Floats:
        """Return the low-pass of other pairs of poles (stiffness, damping) in series, (2, n).

        It has unit gain at frequency zero.
        """
        passed = math.prod(stiffness for stiffness, _ in sections) * self.power(0)
        for stiffness, damping in sections:
            passed = self.product(passed, self.inverse(self.quadratic(stiffness, damping)))
        return np.asarray(passed)
