"""Contacts whose friction is that of a single spring: they stick, or all of them slides."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.friction.cubics import place_of_turn, place_of_value
from vibroimpact.dynamics.oblique.tangential_motion import (
    Change,
    Rest,
    TangentialMotion,
    excess_depth,
    rate_of_integral,
    rest_of,
    rises,
)
from vibroimpact.dynamics.oblique.tangential_steps import TINY, Drive, Motion, between, slide, stick

_ROUNDS = 3
"""How often the place at which a spring begins to slide at the end of a contact is mended."""


class SlidingSprings(TangentialMotion):
    """The tangential motion of contacts under a law with a single spring; see `TangentialMotion`."""

    def beginnings(self, drops: Drops, start: Drive, end: Drive, before: Motion, after: Motion, power: float) -> Change:
        """Return which springs begin to slide in a step, or to shrink if that matters; see `TangentialMotion`."""
        sign = np.where(after.integral < 0.0, -1.0, 1.0)
        some = np.flatnonzero((sign * after.integral > end.most) | (end.depth <= 0.0))  # where the contact ends all of it slides
        begin, finish, was, will, sign = start.take(some), end.take(some), before.take(some), after.take(some), sign[some]
        left = []
        for drive, motion in ((begin, was), (finish, will)):
            left += [drive.most - sign * motion.integral]
            left += [np.sqrt(drive.depth) * drive.depth_slope - sign * rate_of_integral(drive, motion, power)]
        places = place_of_value(np.array(left), 0.0)
        ended = np.flatnonzero(finish.depth <= 0.0)
        if ended.size:
            stiffness, pull = (one[drops[some[ended]]] for one in (self.stiffness, self.pull))
            places[ended], sign[ended] = _last_slide(begin.take(ended), finish.take(ended), was.take(ended), stiffness, pull, power)
        if self.growing == self.shrinking:
            return some, places, sign
        found, direction = np.full(len(drops), np.inf), np.zeros(len(drops))
        found[some], direction[some] = places, sign
        peaks = np.flatnonzero(rises(start) & (end.depth_slope < 0.0))
        turn = place_of_turn(np.array([start.depth, start.depth_slope, end.depth, end.depth_slope])[:, peaks])
        earlier = turn < found[peaks]
        found[peaks[earlier]], direction[peaks[earlier]] = turn[earlier], 0.0
        some = np.flatnonzero(found < np.inf)
        return some, found[some], direction[some]

    def begin(self, drops: Drops, known: Drive, direction: Floats) -> None:
        """Let springs slide from now on, or stick on where the direction is 0; see `TangentialMotion`."""
        self.direction[drops] = direction
        slides = direction != 0.0
        self.count(drops[slides], -1.0, known.depth[slides])

    def grow(self, drops: Drops, depth: Floats, displacement: Floats, integral: Floats) -> None:
        """Record nothing: the stretch of a spring follows from its integral."""

    def slip(self, here: Drops | slice, start: Drive, end: Drive, last: bool) -> list[Rest]:
        """Take springs that slide to the end of a step, or to where they cease to; see `TangentialMotion`."""
        before, direction = Motion(self.motion[:, here]), self.direction[here]
        after = slide(start, end, before, self.stiffness[here], self.pull[here], direction)
        least = self.law.least_rate(rises(start) | (end.depth_slope > 0.0))
        turned = (direction * end.pace * after.velocity < least * end.depth_slope) & (end.depth > 0.0)
        some = np.flatnonzero(turned & (not last))
        was, will, begin, finish = before.take(some), after.take(some), start.take(some), end.take(some)
        self.motion[:, here] = after.rows
        if not some.size:
            return []
        places = place_of_turn(excess_depth(begin, finish, was, will, direction[some], least[some]))
        slips = self.every[here][some]
        known = self.go_back(slips, begin, finish, was, will, places)
        self.cease(slips, known, np.ones(len(slips), dtype=bool))
        return [rest_of(slips, known, finish, places)]

    def cease(self, drops: Drops, known: Drive, slid: Bools) -> None:
        """Let springs stick from now on; see `TangentialMotion`."""
        self.motion[2, drops] = self.direction[drops] * known.most
        self.direction[drops] = 0.0
        self.count(drops, 1.0, known.depth)

    def settle(self, drops: Drops, start: Drive) -> None:
        """Let springs cease to slide at the start of a part; see `TangentialMotion`."""
        direction = self.direction[drops]
        least = self.law.least_rate(start.depth_slope > 0.0)
        turned = direction * start.pace * self.motion[0, drops] < least * start.depth_slope
        some = np.flatnonzero((direction != 0.0) & turned)
        self.cease(drops[some], start.take(some), np.ones(len(some), dtype=bool))

    def jump(self, drops: Drops, start: Drive, end: Drive) -> None:
        """Stretch springs, or let them shrink, with a depth that jumps; see `TangentialMotion`."""
        power = np.where(end.depth > start.depth, self.growing, self.shrinking)
        ratio = np.divide(end.depth, start.depth, out=np.ones_like(end.depth), where=start.depth > 0.0)
        integral, slid = self.motion[2, drops] * ratio ** (0.5 * power), self.slides(drops)
        over = np.abs(integral) > end.most
        self.motion[2, drops] = np.clip(integral, -end.most, end.most)
        self.direction[drops[over]] = np.sign(integral[over])
        begins = over & ~slid
        self.count(drops[begins], -1.0, end.depth[begins])


def _last_slide(start: Drive, end: Drive, was: Motion, stiffness: Floats, pull: Floats, power: float) -> tuple[Floats, Floats]:
    """Return where springs begin to slide in the step at whose end the contact ends, and in which direction.

    Towards the end the integral goes like a power of the radius, which falls evenly to zero, and is more than its bound at last.
    """
    depth = np.array([start.depth, start.depth_slope, end.depth, end.depth_slope])
    deep, integral, places = start.depth, was.integral, np.zeros_like(start.depth)
    for _ in range(_ROUNDS):
        rim = (1.5 * np.abs(integral) / np.maximum(deep, TINY) ** (0.5 * power)) ** (1.0 / (3.0 - power))
        places = place_of_value(depth, np.minimum(rim**2, start.depth))
        there = between(start, end, places)
        deep, integral = there.depth, stick(start.shortened(places), there.shortened(places), was, stiffness, pull, power).integral
    return places, np.where(integral < 0.0, -1.0, 1.0)
