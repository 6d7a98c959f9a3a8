"""Contacts that stick in their middle and slip at their rim; `contact.friction.turning_points` has their history."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats, put
from vibroimpact.contact.friction.cubics import cubic_at, place_of_turn, place_of_value
from vibroimpact.contact.friction.turning_points import TurningPoints
from vibroimpact.dynamics.oblique.tangential_motion import Change, Rest, TangentialMotion, excess_depth, rest_of
from vibroimpact.dynamics.oblique.tangential_steps import TINY, Drive, Motion, moved, slide, slip, swept_to_middle

_NEAR = 0.25
"""Part of the way of the slip to the middle of a contact that is left where its force is not smooth any more."""


class SlipAtRim(TangentialMotion):
    """The tangential motion of contacts of Cattaneo and Mindlin; see `TangentialMotion`."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.curves = TurningPoints(len(self.every))

    def beginnings(self, drops: Drops, start: Drive, end: Drive, before: Motion, after: Motion, power: float) -> Change:
        """Return which contacts begin to slip at their rim; see `TangentialMotion`."""
        some = np.flatnonzero(np.abs(end.pace * after.velocity) > end.depth_slope)
        if not some.size:
            return some, np.empty(0), np.empty(0)
        known = start.take(some), end.take(some), before.take(some), after.take(some)
        ways = [excess_depth(*known, direction) for direction in (1.0, -1.0)]
        places = np.array([np.where(ends[3] < 0.0, place_of_turn(ends), np.inf) for ends in ways])
        return some, places.min(axis=0), 1.0 - 2.0 * places.argmin(axis=0)

    def begin(self, drops: Drops, known: Drive, direction: Floats) -> None:
        """Let contacts slip at their rim from now on; see `TangentialMotion`."""
        self.grow(drops, known.depth, *self.motion[1:, drops])
        self.curves.begin(drops)
        self.direction[drops], self.front[drops] = direction, np.sqrt(known.depth)
        slides = known.depth == 0.0
        self.count(drops[slides], -1.0, known.depth[slides])

    def grow(self, drops: Drops, depth: Floats, displacement: Floats, integral: Floats) -> None:
        """Add the rims of contacts that stick to their curves; see `TangentialMotion`."""
        self.curves.push(drops, depth, displacement, integral)

    def slip(self, here: Drops | slice, start: Drive, end: Drive, last: bool) -> list[Rest]:
        """Take contacts that slip to the end of a step, or to where they cease to, or slide in their middle; see `TangentialMotion`."""
        before, stiffness, pull = Motion(self.motion[:, here]), self.stiffness[here], self.pull[here]
        direction, front, drops = self.direction[here], self.front[here], self.every[here]
        after, front_there = slip(start, end, before, front, partial(self.curves.held, drops, direction), stiffness, pull, direction)
        holds = front > 0.0
        if not holds.all():
            sliding = slide(start, end, before, stiffness, pull, direction)
            after, front_there = Motion(np.where(holds, after.rows, sliding.rows)), np.where(holds, front_there, 0.0)
        x, x_there = start.depth - direction * before.displacement, end.depth - direction * after.displacement
        middle = self.curves.middle(drops, direction)
        comes = holds & (x_there <= middle)
        near = np.flatnonzero(holds & (x_there - middle < _NEAR * (x - middle)) & ~comes)
        if near.size:
            mended, front_there[near] = self._mended(drops[near], start.take(near), end.take(near), before.take(near), after.take(near))
            put(after.rows, near, mended.rows)
        turned = (direction * end.pace * after.velocity < end.depth_slope) & (end.depth > 0.0)
        leaves = holds & (front_there**2 > end.depth)  # the slip ends at the rim, and begins there in the other direction
        some = np.flatnonzero((turned | comes | leaves) & (not last))
        was, will, begin, finish, sign = before.take(some), after.take(some), start.take(some), end.take(some), direction[some]
        slid, slips = front[some] == 0.0, drops[some]
        left, left_there = begin.depth - front[some] ** 2, finish.depth - front_there[some] ** 2
        self.motion[:, here], self.front[here] = after.rows, front_there
        if not some.size:
            return []
        ends = excess_depth(begin, finish, was, will, sign)
        turns = np.where(turned[some], place_of_turn(ends), np.inf)
        rims = np.where(leaves[some], np.clip(left / np.maximum(left - left_there, TINY), 0.0, 1.0), np.inf)
        places = np.minimum(turns, rims)
        arrivals = np.full_like(places, np.inf)
        if comes.any():
            arrivals = np.where(comes[some], place_of_value(ends, middle[some]), np.inf)
        arrives = arrivals < places
        places = np.minimum(places, arrivals)
        known = self.go_back(slips, begin, finish, was, will, places)
        arriving, ceasing = np.flatnonzero(arrives), np.flatnonzero(~arrives)
        if arriving.size:
            to = places[arriving]
            self._arrive(slips[arriving], begin.take(arriving), known.take(arriving), was.take(arriving), ends[:, arriving], to)
        if ceasing.size:
            self._turn(slips[ceasing], known.take(ceasing), slid[ceasing])
        return [rest_of(slips, known, finish, places)]

    def _mended(self, drops: Drops, start: Drive, end: Drive, was: Motion, will: Motion) -> tuple[Motion, Floats]:
        """Return motion and front at the end of a step of contacts that slip nearly to their middle, near where the force is not smooth."""
        stiffness, pull, direction = self.stiffness[drops], self.pull[drops], self.direction[drops]
        self.curves.begin(drops)
        held = partial(self.curves.held, drops, direction)
        swept = swept_to_middle(start, end, excess_depth(start, end, was, will, direction), held, direction)
        velocity = was.velocity + pull * (end.time - start.time) - stiffness * swept
        mended = moved(start, end, was, velocity, will.integral, stiffness, pull)
        keeps, front = held(end.depth - direction * mended.displacement)
        mended.rows[2] = direction * (end.most - keeps)
        return mended, front

    def _arrive(self, drops: Drops, start: Drive, known: Drive, was: Motion, ends: Floats, places: Floats) -> None:
        """Let contacts slide whose slip comes to their middle; `ends`: x at both ends of the step, with its derivatives (4, b)."""
        direction, (there, slope) = self.direction[drops], cubic_at(ends, places)
        self.curves.begin(drops)
        held = partial(self.curves.held, drops, direction)
        x = np.array([ends[0], ends[1] * places, there, slope * places])
        swept = swept_to_middle(start.shortened(places), known.shortened(places), x, held, direction)
        velocity = was.velocity + self.pull[drops] * (known.time - start.time) - self.stiffness[drops] * swept
        displacement = direction * (known.depth - self.curves.middle(drops, direction))
        self.motion[:, drops] = velocity, displacement, direction * known.most
        self.front[drops] = 0.0
        self.count(drops, -1.0, known.depth)

    def _turn(self, drops: Drops, known: Drive, slid: Bools) -> None:
        """Let contacts cease to slip; those that shrink slip in the other direction."""
        direction = self.direction[drops]
        self.cease(drops, known, slid)
        shrinks = np.flatnonzero(known.depth_slope < 0.0)
        here = drops[shrinks]
        self.curves.begin(here)
        self.direction[here], self.front[here] = -direction[shrinks], np.sqrt(known.depth[shrinks])

    def cease(self, drops: Drops, known: Drive, slid: Bools) -> None:
        """Let contacts cease to slip, and stick; see `TangentialMotion`."""
        direction, displacement = self.direction[drops], self.motion[1, drops]
        held, front, holds = np.zeros(len(drops)), np.zeros(len(drops)), np.flatnonzero(~slid)
        if holds.size:
            x = known.depth - direction * displacement
            self.curves.begin(drops[holds])
            held[holds], front[holds] = self.curves.held(drops[holds], direction[holds], x[holds])
        integral = direction * (known.most - held)
        self.curves.turn(drops, direction, (held, front), (known.depth, displacement, integral))
        self.motion[2, drops], self.direction[drops], self.front[drops] = integral, 0.0, 0.0
        self.count(drops[slid], 1.0, known.depth[slid])

    def settle(self, drops: Drops, start: Drive) -> None:
        """Let contacts begin or cease to slip at the start of a part; see `TangentialMotion`."""
        direction, rate = self.direction[drops], start.pace * self.motion[0, drops]
        begins = np.flatnonzero((direction == 0.0) & (np.abs(rate) > start.depth_slope))
        if begins.size:
            self.begin(drops[begins], start.take(begins), np.where(rate[begins] < 0.0, -1.0, 1.0))
        ceases = np.flatnonzero((direction != 0.0) & (direction * rate < start.depth_slope))
        if ceases.size:
            self._turn(drops[ceases], start.take(ceases), self.slides(drops[ceases]))

    def jump(self, drops: Drops, start: Drive, end: Drive) -> None:
        """Let contacts grow at once, or slip at their rims in the direction in which they slip deeper; see `TangentialMotion`."""
        grows = end.depth > start.depth
        here = drops[grows]
        self.grow(here, end.depth[grows], *self.motion[1:, here])
        drops, end = drops[~grows], end.take(np.flatnonzero(~grows))
        slid, displacement, sticks = self.slides(drops), self.motion[1, drops], self.direction[drops] == 0.0
        fronts = []
        for direction in (np.ones(len(drops)), -np.ones(len(drops))):
            self.curves.begin(drops)
            fronts.append(self.curves.held(drops, direction, end.depth - direction * displacement)[1])
        forward = np.where(sticks, fronts[0] <= fronts[1], self.direction[drops] > 0.0)
        sign = np.where(forward, 1.0, -1.0)
        self.curves.begin(drops)
        held, front = self.curves.held(drops, sign, end.depth - sign * displacement)
        held, front = np.where(slid, 0.0, held), np.where(slid, 0.0, front)
        self.direction[drops], self.front[drops], self.motion[2, drops] = sign, front, sign * (end.most - held)
        begins = ~slid & (front == 0.0)
        self.count(drops[begins], -1.0, end.depth[begins])
