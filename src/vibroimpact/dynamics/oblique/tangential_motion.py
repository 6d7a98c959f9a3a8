"""The tangential motion of contacts that stick, slip and slide, from point to point of a grid.

The contacts of a batch go on together. Where one begins or ceases to slip or to slide within a step, that place is located and the contact
takes the rest of the step from there. When that is, and what a contact does that slips, is of two kinds: `slip_at_rim` and
`sliding_springs`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.friction.cubics import cubic_at
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.dynamics.oblique.tangential_steps import TINY, Drive, Motion, between, stick

_MOST_TURNS = 6
"""Changes of a contact in one step at most."""

_SAME = 1e-6
"""Relative difference below which the depths where two parts of a contact meet are the same."""

Change = tuple[Drops, Floats, Floats]
"""Which of some contacts change in a step, at which places of it, and the directions in which they slip from then on."""

Rest = tuple[Drops, Drive, Drive]
"""Contacts, and both ends of what is left of a step."""


class TangentialMotion(ABC):
    """The tangential motion of B contacts, under way.

    Parameters
    ----------
    law : CompliantFriction
        The law of all of them.
    grid : array, shape (G, 7, B)
        Normal motion at G points, in the order of `Drive`.
    joints : array, shape (G - 1,)
        Where a step only joins two parts of a contact, between which the normal motion may jump.
    path : array, shape (3, G, B)
        Velocity, displacement and integral, known up to where contacts may stick; the rest is written.
    first : array, shape (B,)
        Points up to which contacts slide from first touch on, in order; 0 if they stick from then on.
    stiffness, pull : array, shape (B,)
        See `tangential_steps`.
    """

    def __init__(
        self, law: CompliantFriction, grid: Floats, joints: Bools, path: Floats, first: Drops, stiffness: Floats, pull: Floats
    ) -> None:
        self.law, self.grid, self.joints, self.path, self.first = law, grid, joints, path, first
        self.stiffness, self.pull = stiffness, pull
        self.growing, self.shrinking = law.stretching
        self.every = np.arange(len(first))
        self.motion = path[:, first, self.every]
        self.direction = np.where(first > 0, 1.0, 0.0)  # of slip; 0 for contacts that stick
        self.front = np.zeros(len(first))  # root of the depth at which the slip ends, of those that slip; 0 where all of them slides
        self.microslip = np.where(first > 0, 0.0, 0.5 * self.motion[0] ** 2)

    @abstractmethod
    def beginnings(self, drops: Drops, start: Drive, end: Drive, before: Motion, after: Motion, power: float) -> Change:
        """Return which contacts that stick begin to slip in a step, or otherwise change."""

    @abstractmethod
    def begin(self, drops: Drops, known: Drive, direction: Floats) -> None:
        """Let contacts that stick slip from now on."""

    @abstractmethod
    def grow(self, drops: Drops, depth: Floats, displacement: Floats, integral: Floats) -> None:
        """Record depth, displacement and integral of contacts that stick."""

    @abstractmethod
    def slip(self, here: Drops | slice, start: Drive, end: Drive, last: bool) -> list[Rest]:
        """Take contacts that slip to the end of a step, or to where they change; return what is then left. `last`: stay so."""

    @abstractmethod
    def cease(self, drops: Drops, known: Drive, slid: Bools) -> None:
        """Let contacts stick that slip, or that slide as `slid` tells."""

    @abstractmethod
    def settle(self, drops: Drops, start: Drive) -> None:
        """Let contacts begin or cease to slip at the start of a part, whose rates may be others than at the end of the one before."""

    @abstractmethod
    def jump(self, drops: Drops, start: Drive, end: Drive) -> None:
        """Change the depth of contacts at once; those that grow stick."""

    def follow(self) -> Floats:
        """Write the path, and return the energies lost while a part of the contact sticks, over mass and the square of kappa (B,)."""
        begins = True
        for point, joins in enumerate(self.joints):
            here = slice(int(np.searchsorted(self.first, point, side="right")))
            if not here.stop:
                continue
            start, end = Drive(self.grid[point, :, here]), Drive(self.grid[point + 1, :, here])
            if joins:
                self._join(self.every[here], start, end)
            else:
                some = np.flatnonzero((begins | (self.first[here] == point)) & (start.depth > 0.0))
                if some.size:
                    self.settle(some, start.take(some))
                self._advance(here, start, end)
            begins = bool(joins)
            self.path[:, point + 1, here] = self.motion[:, here]
        left = np.flatnonzero(~self.slides(self.every))
        self.count(left, -1.0, np.zeros(len(left)))  # what these store at the end is lost
        return self.microslip

    def slides(self, drops: Drops) -> Bools:
        """Return whether all of each contact slides."""
        return np.asarray((self.direction[drops] != 0.0) & (self.front[drops] == 0.0))

    def count(self, drops: Drops, sign: float, depth: Floats) -> None:
        """Add what contacts have to the energy lost in microslip, or subtract it, where they cease or begin to slide throughout.

        That is kinetic energy, that of the pull, and what they store as they slide.
        """
        velocity, displacement, integral = self.motion[:, drops]
        stored = self.law.sliding_energy * self.stiffness[drops] * np.abs(integral) * depth
        self.microslip[drops] += sign * (0.5 * velocity**2 - self.pull[drops] * displacement + stored)

    def go_back(self, drops: Drops, start: Drive, end: Drive, was: Motion, will: Motion, places: Floats) -> Drive:
        """Set velocity and displacement to those at places in a step; return the normal motion there."""
        pull, stiffness = self.pull[drops], self.stiffness[drops]
        rates = [drive.pace * (pull - stiffness * motion.integral) for drive, motion in ((start, was), (end, will))]
        ends = [
            [was.velocity, was.displacement],
            [rates[0], start.pace * was.velocity],
            [will.velocity, will.displacement],
            [rates[1], end.pace * will.velocity],
        ]
        self.motion[:2, drops], _ = cubic_at(np.array(ends), places)
        return between(start, end, places)

    def _advance(self, here: Drops | slice, start: Drive, end: Drive) -> None:
        """Take contacts to the end of a step, each from change to change."""
        for turns in range(_MOST_TURNS + 1):
            sticks, rest = self.direction[here] == 0.0, []
            for which, go in ((sticks, self._stick), (~sticks, self.slip)):
                if which.all():
                    rest += go(here, start, end, turns == _MOST_TURNS)
                elif which.any():
                    some = np.flatnonzero(which)
                    rest += go(self.every[here][some], start.take(some), end.take(some), turns == _MOST_TURNS)
            if not rest:
                return
            drops, starts, ends = zip(*rest, strict=True)
            here = np.concatenate(drops)
            start, end = (Drive(np.concatenate([drive.rows for drive in drives], axis=1)) for drives in (starts, ends))

    def _stick(self, here: Drops | slice, start: Drive, end: Drive, last: bool) -> list[Rest]:
        """Take contacts that stick to the end of a step, or to where they change; return what is then left. `last`: stay so."""
        power, drops = self.growing, self.every[here]
        if self.shrinking != self.growing:
            grows = rises(start) | (end.depth_slope > 0.0)
            if grows.any() and not grows.all():
                parts = (np.flatnonzero(grows), np.flatnonzero(~grows))
                return [one for some in parts for one in self._stick(drops[some], start.take(some), end.take(some), last)]
            power = self.growing if grows.all() else self.shrinking
        before, stiffness, pull = Motion(self.motion[:, here]), self.stiffness[here], self.pull[here]
        after = stick(start, end, before, stiffness, pull, power)
        some, places, direction = self.beginnings(drops, start, end, before, after, power)
        if last or not some.size:
            self.motion[:, here] = after.rows
            self.grow(drops, end.depth, after.displacement, after.integral)
            return []
        was, will, begin, finish, slips = before.take(some), after.take(some), start.take(some), end.take(some), drops[some]
        self.motion[:, here] = after.rows
        stays = np.ones(len(drops), dtype=bool)
        stays[some] = False
        self.grow(drops[stays], end.depth[stays], after.displacement[stays], after.integral[stays])
        known = self.go_back(slips, begin, finish, was, will, places)
        ends = was.integral, rate_of_integral(begin, was, power), will.integral, rate_of_integral(finish, will, power)
        self.motion[2, slips], _ = cubic_at(np.array(ends), places)
        self.begin(slips, known, direction)
        return [rest_of(slips, known, finish, places)]

    def _join(self, drops: Drops, start: Drive, end: Drive) -> None:
        """Change the depth of contacts at once, where two parts meet."""
        some = np.flatnonzero(np.abs(end.depth - start.depth) > _SAME * np.maximum(start.depth, end.depth))
        if not some.size:
            return
        drops, start, end = drops[some], start.take(some), end.take(some)
        slips = np.flatnonzero((end.depth > start.depth) & (self.direction[drops] != 0.0))
        if slips.size:
            self.cease(drops[slips], start.take(slips), self.slides(drops[slips]))
        self.jump(drops, start, end)


def rest_of(drops: Drops, known: Drive, end: Drive, places: Floats) -> Rest:
    """Return what is left of a step from places in it."""
    return drops, known.shortened(1.0 - places), end.shortened(1.0 - places)


def rises(drive: Drive) -> Bools:
    """Return whether contacts grow, beyond rounding where they are largest."""
    return np.asarray(drive.depth_slope > 1e-9 * drive.depth)


def rate_of_integral(drive: Drive, motion: Motion, power: float) -> Floats:
    """Return the derivative of the integral of contacts that stick; `power`: see `tangential_steps.stick`."""
    stretched = 0.5 * power * drive.depth_slope * motion.integral / np.maximum(drive.depth, TINY)
    return np.asarray(drive.pace * np.sqrt(drive.depth) * motion.velocity + stretched)


def excess_depth(start: Drive, end: Drive, was: Motion, will: Motion, direction: Floats | float, least: Floats | float = 1.0) -> Floats:
    """Return a part of the depth, less the displacement in a direction, with its derivative, at both ends of a step (4, b).

    Where that ceases to rise, contacts that stick begin to slip in the direction; where it rises again, they cease to.
    """
    return np.array(
        [
            least * start.depth - direction * was.displacement,
            least * start.depth_slope - direction * start.pace * was.velocity,
            least * end.depth - direction * will.displacement,
            least * end.depth_slope - direction * end.pace * will.velocity,
        ]
    )
