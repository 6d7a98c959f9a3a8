r"""Memory of a Hertzian contact under varying normal and tangential forces: the turning points of its history.

By the method of dimensionality reduction the contact is a row of independent springs, each of stiffness :math:`G^* dx`. That at x
touches at the depth :math:`c = x^2/R` and slips where its displacement reaches :math:`\kappa (D - c)`: this gives the force of Cattaneo's
and Mindlin's contact, under any history (V. L. Popov and M. Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction,
Springer 2015, chapter 5; J. Jaeger, New Solutions in Contact Mechanics, WIT Press 2005).

The displacements of all springs are a curve: with s the displacement of the sphere over kappa, a spring that does not slip keeps the
displacement S(c) at which it would be free of force. In the coordinates

.. math:: q = c - S,\qquad p = c + S

the curve rises in both, and ends at the present :math:`(D - s, D + s)`. When that moves on, every spring slips whose q or p is larger than
that of the end: the curve is cut there, and closed by a straight line. What is kept of it are its corners, the turning points of the
history.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Drops, Floats
from vibroimpact.contact.friction.law import Pair

_FIRST = 2  # rows below the first corner: one that nothing passes, and the middle of the contact


class TurningPoints:
    """Curves of B contacts, each a stack of corners; see the module.

    Parameters
    ----------
    size : int
        Number of contacts.
    steps : int
        Number of times that they will be advanced.

    Examples
    --------
    A contact is pressed to the depth 1, then displaced by 0.19: the force is Cattaneo's, :math:`1 - (1 - s)^{3/2}` of that of sliding.

    >>> memory, first = TurningPoints(1, 2), np.array([0])
    >>> for depth, displacement in ((1.0, 0.0), (1.0, 0.19)):
    ...     there = np.array([depth]), np.array([displacement])
    ...     integral, _ = memory.advance(first, *there, there[1], (np.zeros(1), np.ones(1)))
    >>> (1.5 * integral).round(6).tolist(), round(1 - (1 - 0.19) ** 1.5, 6)
    ([0.271], 0.271)
    """

    def __init__(self, size: int, steps: int) -> None:
        self.size = size
        # one row after the other in a flat array: the corner below another one is `size` before it
        self.q, self.p, self.integral = (np.zeros((steps + _FIRST + 1) * size) for _ in range(3))
        self.q[:size] = self.p[:size] = -np.inf
        self.top = np.arange(size) + size

    def advance(self, drops: Drops, depth: Floats, displacement: Floats, sticking: Floats, rates: Pair) -> Pair:
        """Go on to another depth and displacement; return the integral of the displacements, and its rate. See `Memory`."""
        q, p, top = depth - displacement, depth + displacement, self.top[drops]
        rim = np.sqrt(depth)
        integral, front, direction = sticking.copy(), rim.copy(), np.zeros(len(q))
        slips = np.flatnonzero((q < self.q[top]) | (p < self.p[top]))
        if slips.size:
            below = self._below(top[slips] - self.size, q[slips], p[slips])
            top[slips] = below + self.size
            integral[slips], front[slips], direction[slips] = self._cut(below, q[slips], p[slips], rim[slips])
        top += self.size
        self.q[top], self.p[top], self.integral[top], self.top[drops] = q, p, integral, top
        of_depth, of_displacement = rates
        return integral, front * of_displacement + direction * (rim - front) * of_depth

    def _below(self, at: Drops, q: Floats, p: Floats) -> Drops:
        """Return the places of the last corners, at or before those given, that the ends (q, p) do not cut off."""
        left = np.flatnonzero((self.q[at] > q) | (self.p[at] > p))
        while left.size:
            at[left] -= self.size
            here = at[left]
            left = left[(self.q[here] > q[left]) | (self.p[here] > p[left])]
        return at

    def _cut(self, below: Drops, q: Floats, p: Floats, rim: Floats) -> tuple[Floats, Floats, Floats]:
        """Cut the curves between corners and the next ones, put a corner there, and return integrals, fronts and directions of slip."""
        above = below + self.size
        q0, p0 = self.q[below], self.p[below]
        rise_q, rise_p = self.q[above] - q0, self.p[above] - p0
        with np.errstate(all="ignore"):
            part_q, part_p = np.where(rise_q > 0.0, (q - q0) / rise_q, np.inf), np.where(rise_p > 0.0, (p - p0) / rise_p, np.inf)
            part = np.minimum(np.minimum(part_q, part_p), 1.0)
            q_cut, p_cut = q0 + part * rise_q, p0 + part * rise_p
        forward = part_q <= part_p
        sliding = np.flatnonzero(below < self.size)  # no spring sticks: the middle of the contact itself moves on
        if sliding.size:
            forward[sliding] = q[sliding] < self.q[above[sliding]]
            middle = np.where(forward[sliding], q[sliding], -p[sliding])
            q_cut[sliding] = q0[sliding] = middle
            p_cut[sliding] = p0[sliding] = -middle
        inner, front = (np.sqrt(np.maximum(0.5 * (one + other), 0.0)) for one, other in ((q0, p0), (q_cut, p_cut)))
        kept = self.integral[below] + integral_of_line(0.5 * ((p_cut - p0) - (q_cut - q0)), inner, front)
        kept[sliding] = 0.0
        self.q[above], self.p[above], self.integral[above] = q_cut, p_cut, kept
        integral = kept + integral_of_line(0.5 * ((p - p_cut) - (q - q_cut)), front, rim)
        return integral, front, np.where(forward, 1.0, -1.0)


def integral_of_line(change: Floats, inner: Floats, outer: Floats) -> Floats:
    r"""Return :math:`\int x\, dS` where S changes linearly with the square of x, from one x to another."""
    total = inner + outer
    return np.asarray(change * (2.0 / 3.0) * (total - inner * outer / (total + 1e-300)))
