r"""Memory of a Hertzian contact under varying normal and tangential forces: the turning points of its history.

By the method of dimensionality reduction the contact is a row of independent springs, each of stiffness :math:`G^* dx`. That at x
touches at the depth :math:`c = x^2/R` and slips where its displacement reaches :math:`\kappa (D - c)`: this gives the force of Cattaneo's
and Mindlin's contact, under any history (V. L. Popov and M. Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction,
Springer 2015, chapter 5; J. Jaeger, New Solutions in Contact Mechanics, WIT Press 2005).

The displacements of all springs are a curve: with s the displacement of the sphere over kappa, a spring that does not slip keeps the
displacement S(c) at which it would be free of force. In the coordinates

.. math:: q = c - S,\qquad p = c + S

the curve rises in both, and ends at the present :math:`(D - s, D + s)`. When that moves on, every spring slips whose q or p is larger than
that of the end: the curve is cut there, and closed by a straight line. What is kept of it are points with slopes, between which it is a
cubic, and the straight lines that slip has left. On these the parameter rises with x, so that they are cubics too, as is the integral.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from vibroimpact.arrays import Drops, Floats, put
from vibroimpact.contact.friction.cubics import place_of_turn, place_of_value
from vibroimpact.contact.friction.law import Step

_VALUES, _FIRST, _LAST = slice(0, 3), slice(3, 6), slice(6, 9)
"""Rows of a point: depth, displacement and integral there, and their slopes at both ends of the piece of the curve that leads to it."""

_ROUNDING = 1e-9
"""Part of the depth that is none."""

_FAR, _CLOSE = 0.1, 0.25
"""Where the front of the slip comes to the middle of the contact within a step, from farther than the first part of the depth, the second
part of the way is left to a further step, since the force is not smooth at its end."""


class TurningPoints:
    """Curves of contacts, each a stack of points from the middle of the contact to its rim; see the module.

    Parameters
    ----------
    size : int
        Number of contacts.

    Examples
    --------
    A contact is pressed to the depth 1, then displaced by 0.19: the force is Cattaneo's, :math:`1 - (1 - s)^{3/2}` of that of sliding.

    >>> memory, first = TurningPoints(1), np.array([0])
    >>> for depth, displacement in (([0.0, 1.0], [0.0, 0.0]), ([1.0, 1.0], [0.0, 0.19])):
    ...     ends = [np.array([[start], [end - start], [end], [end - start]]) for start, end in (depth, displacement)]
    ...     integral, _, _ = memory.advance(first, Step(*ends, np.zeros((3, 1))))
    >>> (1.5 * integral).round(6).tolist(), round(1 - (1 - 0.19) ** 1.5, 6)
    ([0.271], 0.271)
    """

    power: ClassVar[int] = 1

    def __init__(self, size: int) -> None:
        # layer upon layer, each with one point of every contact; those of the middle are the lowest
        self.size, self.points, self.top, self.layers, self.fresh = size, np.empty((9, 64 * size)), np.arange(size), 1, True
        self.points[:, :size] = 0.0
        self.rises = np.zeros((2, size), dtype=bool)  # do depth less displacement and depth plus displacement rise?
        self.slides = np.zeros(size, dtype=bool)  # does the middle of the contact slide?
        self.next = np.zeros(size, dtype=np.intp)  # which of these three changes next; 3 if none does

    def slide(self, drops: Drops, depth: Floats, displacement: Floats, integral: Floats) -> Floats:
        """Let contacts begin that have slid so far; see `Memory`."""
        ends = np.concatenate([depth, depth]), np.concatenate([displacement, displacement])
        return self.advance(drops, Step(*ends, np.stack([integral, *np.zeros((2, len(drops)))])))

    def turns(self, drops: Drops, step: Step) -> tuple[Drops, Floats, Floats]:
        """Return which contacts begin or cease to slip at the rim, or begin to slide in the middle, and where; see `Memory`."""
        (before, _, depth, deepening), (start, _, displacement, rate) = step.depth, step.displacement
        middle, slides = self.points[1].take(drops), self.slides.take(drops)
        left, left_before = depth - np.abs(displacement - middle), before - np.abs(start - middle)
        rises = deepening > rate, deepening > -rate
        if self.fresh:
            self.rises, self.slides, self.fresh = np.stack(rises), left < 0.0, False
            slides = self.slides
        goes_on = depth > _ROUNDING * before  # not in the step that ends the contact
        changes = np.array([(now ^ row.take(drops)) & goes_on for now, row in zip(rises, self.rises, strict=True)])
        comes = left * before < 0.5 * left_before * depth
        comes &= (left_before > _ROUNDING * before) & ~slides
        some = np.flatnonzero(changes[0] | changes[1] | comes)
        if not some.size:
            return some, np.empty(0), np.empty(0)
        changes, ends, moved, who = changes[:, some], step.depth.take(some, axis=1), step.displacement.take(some, axis=1), drops[some]
        places, near = np.full((3, len(some)), np.inf), np.ones(len(some))
        for row, sign in enumerate((-1.0, 1.0)):
            here = np.flatnonzero(changes[row])
            if here.size:
                found = places[row, here] = place_of_turn(ends.take(here, axis=1) + sign * moved.take(here, axis=1))
                self.rises[row, who[here[found == 0.0]]] ^= True  # it changed before
        which = places.argmin(axis=0)
        here = np.flatnonzero(comes[some])
        if here.size:
            left, left_before, sign = left[some[here]], left_before[some[here]], np.sign(moved[2, here] - middle[some[here]])
            _, slope, _, slope_there = sign * moved[:, here] - ends[:, here]
            far = (left < _FAR * left_before) & (left_before > _FAR * ends[0, here])
            rest = np.where(far, _CLOSE * left_before, 0.0)
            found = np.where(far | (left < 0.0), place_of_value(left_before - left, slope, slope_there, rest - left), 1.0)
            first = found < places[:2, here].min(axis=0)
            places[2, here] = found
            near[here] = np.where(first, np.clip(np.where(far, _CLOSE, left / left_before), 0.0, 1.0), 1.0)
            which[here] = np.where(first, np.where(far, 3, 2), which[here])
        self.next[who] = which
        places = places.min(axis=0)
        kept = np.flatnonzero((places > 0.0) | (which > 1))
        return some[kept], places[kept], near[kept]

    def turn(self, drops: Drops, depth: Floats, force: Floats) -> Floats:
        """Let contacts begin or cease to slip, where both forces change steadily; see `Memory`."""
        which = self.next[drops]
        rim = which < 2
        self.rises[which[rim], drops[rim]] ^= True
        self.slides[drops[which == 2]] = True
        return force

    def advance(self, drops: Drops, step: Step) -> Floats:
        """Take a step; return the integral and its derivatives. See `Memory`."""
        (before, deepening_before, depth, deepening), (start, rate_before, displacement, rate) = step.depth, step.displacement
        self.layers += 1  # by no more grows a stack
        if self.layers * self.size > self.points.shape[1]:
            self.points = np.concatenate([self.points, np.empty_like(self.points)], axis=1)
        rim, offset = np.sqrt(depth), displacement - self.points[1].take(drops)
        slides = self.slides[drops] = np.abs(offset) > depth
        slips = np.abs(displacement - start) > depth - before
        integral = step.integral[0] + step.integral[2]
        found = np.array([integral, rim, np.zeros_like(rim)])
        sticks, part, whole = (np.flatnonzero(which) for which in (~(slips | slides), slips & ~slides, slides))
        if sticks.size:
            rows = (depth, displacement, integral, deepening_before, rate_before, step.integral[1], deepening, rate, rim * rate)
            self._push(drops[sticks], self.top[drops[sticks]], [row[sticks] for row in rows])
        for here, close in ((part, self._slip), (whole, self._slide)):
            if here.size:
                put(found, here, close(drops[here], depth[here], displacement[here], rim[here]))
        return found

    def _push(self, drops: Drops, below: Drops, values: Sequence[Floats]) -> None:
        """Put points on those below."""
        new = self.top[drops] = below + self.size
        for row, value in zip(self.points, values, strict=True):
            row[new] = value

    def _slide(self, drops: Drops, depth: Floats, displacement: Floats, rim: Floats) -> Floats:
        """Close curves by lines from the middle to the rim, and return integrals and derivatives."""
        sign = np.sign(displacement - self.points[1].take(drops))
        low = np.zeros((3, len(drops)))
        low[1] = self.points[1, drops] = displacement - sign * depth
        return self._close(drops, drops, low, depth, displacement, rim, sign)

    def _slip(self, drops: Drops, depth: Floats, displacement: Floats, rim: Floats) -> Floats:
        """Cut curves where they reach beyond the rim, close them by lines, and return integrals and derivatives."""
        q, p = depth - displacement, depth + displacement
        above = self._above(self.top[drops], q, p)
        low, piece = self.points[_VALUES].take(above - self.size, axis=1), self.points.take(above, axis=1)
        high, first, last = piece[_VALUES], piece[_FIRST], piece[_LAST]
        change = high - low
        # of the two coordinates, the one that cuts lower
        left_q, left_p = high[0] - high[1] - q, high[0] + high[1] - p
        forward = left_q * (change[0] + change[1]) >= left_p * (change[0] - change[1])
        sign = np.where(forward, 1.0, -1.0)
        rise, slope, slope_there = (one[0] - sign * one[1] for one in (change, first, last))
        place = place_of_value(rise, slope, slope_there, np.where(forward, left_q, left_p))
        bend, twist = 3.0 * change - 2.0 * first - last, first + last - 2.0 * change
        cut = low + place * (first + place * (bend + place * twist))
        last = (first + place * (2.0 * bend + 3.0 * place * twist)) * place
        put(self.points, above, np.concatenate([cut, first * place, last]))
        return self._close(drops, above, cut, depth, displacement, rim, sign)

    def _close(self, drops: Drops, below: Drops, low: Floats, depth: Floats, displacement: Floats, rim: Floats, sign: Floats) -> Floats:
        """Close curves by lines from points to the rim, and return integrals and derivatives.

        `below`, `low`: these points, and the values there (3, b); `sign`: the direction of slip.
        """
        front = np.sqrt(np.maximum(low[0], 0.0))
        width, total = rim - front, rim + front
        integral = low[2] + (displacement - low[1]) * (2.0 / 3.0) * (total - front * rim / (total + 1e-300))
        rise, rise_there = 2.0 * front * width, 2.0 * rim * width
        slopes = (rise, sign * rise, front * sign * rise, rise_there, sign * rise_there, rim * sign * rise_there)
        self._push(drops, below, (depth, displacement, integral, *slopes))
        return np.array([integral, front, sign * width])

    def _above(self, at: Drops, q: Floats, p: Floats) -> Drops:
        """Return the points, at or below those given, above which nothing is left of the curves."""
        left = np.arange(len(at))
        while left.size:
            below = at[left] - self.size
            depth, displacement = self.points[0].take(below), self.points[1].take(below)
            off = np.flatnonzero(((depth - displacement > q[left]) | (depth + displacement > p[left])) & (below >= self.size))
            left = left[off]
            at[left] = below[off]
        return at
