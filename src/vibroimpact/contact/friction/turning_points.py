r"""Memory of a Hertzian contact under varying normal and tangential forces: the turning points of its history.

By the method of dimensionality reduction the contact is a row of independent springs, each of stiffness :math:`G^* dx`. That at x
touches at the depth :math:`c = x^2/R` and slips where its displacement reaches :math:`\kappa (D - c)`: this gives the force of Cattaneo's
and Mindlin's contact, under any history (V. L. Popov and M. Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction,
Springer 2015, chapter 5; J. Jaeger, New Solutions in Contact Mechanics, WIT Press 2005).

The displacements of all springs are a curve: with s the displacement of the sphere over kappa, a spring that does not slip keeps the
displacement S(c) at which it would be free of force. For slip in the direction :math:`r = \pm 1` the coordinate

.. math:: x = c - r S

rises along the curve, which ends at the present :math:`D - r s`. When that falls, every spring slips whose x is larger, and those
that stick are as they were when the rim of the contact was where the slip ends. So with the integral I of the friction force
(`contact.friction.law`) and its largest value :math:`\tfrac23 D^{3/2}`

.. math:: r I = \tfrac23 D^{3/2} - H(x),\qquad H = \tfrac23 c^{3/2} - r I(c),\qquad \frac{dH}{dx} = \sqrt c

where H(x) is known of the points of the curve. When the slip ends, what slipped is replaced by a straight line.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Drops, Floats, Indices

_TINY, _SHORT = 1e-300, 1e-9  # a length, and that of a piece over its depth, which is none

_LAYERS = 32
"""Points of each curve for which there is room at first."""

_MOST_SHARE = 2.0
"""How far H is extended from the last piece of a curve, in lengths of it from its lower end."""


class TurningPoints:
    """Curves of B contacts, each a stack of points from the middle of the contact to its rim; see the module.

    Depths, displacements and integrals are as in `CompliantFriction`.

    Parameters
    ----------
    size : int
        B, the number of contacts.

    Examples
    --------
    A contact is pressed to the depth 1, then displaced by 0.19: the force is Cattaneo's, :math:`1 - (1 - s)^{3/2}` of that of sliding.

    >>> curves, first, one = TurningPoints(1), np.array([0]), np.ones(1)
    >>> curves.push(first, one, 0.0 * one, 0.0 * one)
    >>> curves.begin(first)
    >>> held, front = curves.held(first, one, one - 0.19)
    >>> (1.0 - 1.5 * held).round(6).tolist(), round(1 - (1 - 0.19) ** 1.5, 6)
    ([0.271], 0.271)
    """

    def __init__(self, size: int) -> None:
        # layer upon layer, each with one point of every contact; those of the middle are the lowest
        self.size, self.points, self.top = size, np.zeros((3, _LAYERS * size)), np.arange(size)  # depth, displacement, integral
        self.below = np.arange(size)  # the point below which, or at which, the slip ends

    def push(self, drops: Drops, depth: Floats, displacement: Floats, integral: Floats) -> None:
        """Add the present rims of contacts to their curves."""
        self._put(drops, self.top[drops] + self.size, depth, displacement, integral)

    def _put(self, drops: Drops, at: Indices, depth: Floats, displacement: Floats, integral: Floats) -> None:
        """Put the highest points of curves at some places."""
        if at.size and at.max() >= self.points.shape[1]:
            self.points = np.concatenate([self.points, np.zeros_like(self.points)], axis=1)
        self.top[drops] = at
        for row, values in zip(self.points, (depth, displacement, integral), strict=True):
            row[at] = values

    def begin(self, drops: Drops) -> None:
        """Let contacts begin to slip at their rims."""
        self.below[drops] = np.maximum(self.top[drops] - self.size, drops)

    def middle(self, drops: Drops, direction: Floats) -> Floats:
        """Return the x below which all of a contact slides."""
        return np.asarray(-direction * self.points[1].take(drops))

    def held(self, drops: Drops, direction: Floats, x: Floats) -> tuple[Floats, Floats]:
        """Return H of contacts that slip, and its derivative, the root of the depth at which the slip ends.

        Between two points c is taken as linear in x, and H has its value at both.
        """
        below, size, (depths, displacements, integrals) = self.below.take(drops), self.size, self.points
        low, moved = depths.take(below), displacements.take(below)
        left = np.flatnonzero((x < low - direction * moved) & (below >= size))
        while left.size:
            at = below[left] - size
            below[left], low[left], moved[left] = at, depths.take(at), displacements.take(at)
            left = left[(x[left] < low[left] - direction[left] * moved[left]) & (at >= size)]
        self.below[drops] = below
        high, change = depths.take(below + size), displacements.take(below + size) - moved
        pulled = integrals.take(below)
        root_low, root_high = np.sqrt(low), np.sqrt(high)
        deep = high - low
        length = deep - direction * change
        share = (x - low + direction * moved) / np.maximum(length, _SHORT * deep + _TINY)
        share = np.minimum(np.maximum(share, 0.0), _MOST_SHARE)  # 0 where all of the contact slides
        slope = (2.0 / 3.0) * length / np.maximum(deep, _TINY)
        depth = low + share * deep
        root = np.sqrt(depth)
        cube_low, cube_high = low * root_low, high * root_high
        # what H changes by between the points, beside what it would if c were linear
        excess = (2.0 / 3.0 - slope) * (cube_high - cube_low) - direction * (integrals.take(below + size) - pulled)
        found = (2.0 / 3.0) * cube_low - direction * pulled + slope * (depth * root - cube_low)
        return found + excess * share**2 * (3.0 - 2.0 * share), root

    def turn(self, drops: Drops, direction: Floats, known: tuple[Floats, Floats], rim: tuple[Floats, Floats, Floats]) -> None:
        """Let contacts cease to slip: a straight line leads from where the slip ended to the rim.

        Parameters
        ----------
        drops : array, shape (b,)
            The contacts.
        direction : array, shape (b,)
            Of the slip, 1 or -1.
        known : tuple of two arrays, shape (b,)
            H, and the root of the depth at which the slip ends.
        rim : tuple of three arrays, shape (b,)
            Depth, displacement and integral now.
        """
        (held, root), (depth, displacement, _) = known, rim
        front, slides = root**2, root == 0.0
        at = np.where(slides, drops, self.below.take(drops) + self.size)
        self._put(drops, at, front, displacement - direction * (depth - front), direction * ((2.0 / 3.0) * front * root - held))
        self.push(drops, *rim)
