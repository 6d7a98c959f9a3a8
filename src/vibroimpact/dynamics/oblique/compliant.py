r"""Sliding of contacts with tangential compliance along one direction, driven by their normal motion.

With the displacement s over kappa and the integral I of the law's memory (`contact.friction.law`)

.. math:: \ddot s = -\frac{2 G^* \sqrt R}{m_t}\, I + \frac{g_t}{\kappa}

for the effective mass :math:`m_t` of the tangential motion, 2/7 of that of a solid sphere. It is integrated over the parameter of the
normal motion with one evaluation of the force a step: the acceleration is the cubic with its values and slopes at both ends, for which the
step is first taken with one that changes evenly (`step_weights`). A contact that begins or ceases to stick, to slip or to slide within a
step takes it in parts, so that the method keeps its order of four.

A contact that slides from first touch on is not integrated before it may stick: until then the normal impulse gives its velocity. From
there on the contacts of a batch go on together, each at a place of its own, and leave when they are at the end.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats, put
from vibroimpact.contact.friction.law import CompliantFriction, Memory, Step
from vibroimpact.contact.pair import hertz_stiffness
from vibroimpact.dynamics.oblique.normal_motion import NormalMotion
from vibroimpact.dynamics.oblique.step_weights import before_and_after, cubic_at, slowed, step_weights

_LEAST, _MOST = 1e-9, 1e6
"""Bounds of kappa in slip per depth: contacts with less friction slide freely, and those with more stick."""

_ROUNDING = 1e-5
"""Error of the rate of the depth at release, as a part of the largest."""

_PRESSED = 1e-9
"""Part of the largest normal force below which it is rounding."""

_MOST_TURNING, _MOST_PARTS = 1.0, 16
"""Angle by which the free oscillation of a contact that sticks turns in a step at most [rad], and parts of a step for that at most."""

_MOST_TURNS, _LEAST_PART = 4, 1e-6
"""Parts of a step at most, beside the last one, and the least of them."""

_CORRECTIONS = 2
"""How often the end of a step is mended by the force there."""

_ALL = slice(None)

_SAME = 1e-6
"""Relative difference below which what two parts of a contact have where they meet is the same."""


def slide_compliant(
    law: CompliantFriction, normal: NormalMotion, slip: Floats, mass: Floats, pull: Floats
) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the sliding of contacts under a law with tangential compliance: what `Sliding` has beside the time.

    Parameters
    ----------
    law : CompliantFriction
        The law, of B contacts.
    normal : NormalMotion
        Their normal motion.
    slip : array, shape (B,)
        Slip velocities at first touch [m/s].
    mass : array, shape (B,)
        Effective masses of the tangential motion [kg].
    pull : array, shape (B,)
        Accelerations along the direction [m/s^2].
    """
    ones = np.ones(len(slip))
    modulus, shear, radius = (ones * value for value in (law.effective_modulus, law.effective_shear_modulus, law.effective_radius))
    hertz = hertz_stiffness(modulus, radius)
    depth = np.cbrt(normal.force / hertz) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        pressed = normal.force > _PRESSED * normal.force.max(axis=0)
        depth_slope = np.where(pressed, (2.0 / 3.0) * depth * normal.force_slope / normal.force, 0.0)
    scale = (np.abs(slip) + np.abs(pull) * normal.time[-1]) * normal.time[-1] / depth.max(axis=0)
    asked = law.coefficient * modulus / shear
    kappa = np.clip(asked, _LEAST * scale, _MOST * scale)
    kappa[kappa == 0.0] = 1.0
    stiffness = np.where(asked < kappa, 0.0, 2.0 * shear * np.sqrt(radius))  # of the integral: none where friction is below the least
    path = _slide_throughout(normal, hertz, slip / kappa, stiffness / mass, pull / kappa)
    flow, least = path[0] * normal.pace, np.where(depth_slope > 0.0, depth_slope, law.sliding_bound * depth_slope)
    sticks = np.flatnonzero((stiffness > 0.0) & (flow < least - _ROUNDING * depth_slope.max(axis=0)).any(axis=0))
    # what begins by sliding is followed from the last point but one at which it does, and not from between two parts
    first = np.maximum((flow < least).argmax(axis=0)[sticks] - 2, 0)
    first -= normal.steps[first] == 0.0
    turning = np.sqrt((stiffness / mass * np.sqrt(depth) * normal.pace**2).max(axis=0))[sticks]
    microslip = np.zeros(len(slip))
    parts = 2 ** np.ceil(np.log2(np.clip(turning / _MOST_TURNING, 1.0, _MOST_PARTS))).astype(int)
    for number in np.unique(parts).tolist():
        some = parts == number
        here = sticks[some]
        pairs = [
            (one.take(here, axis=1), slope.take(here, axis=1)) for one, slope in ((normal.pace, normal.pace_slope), (depth, depth_slope))
        ]
        steps, found = normal.steps, path.take(here, axis=2)
        if number > 1:
            pairs = [_refined(steps, one, number) for one in pairs]
            steps, found = np.repeat(steps, number), np.ascontiguousarray(np.repeat(found, number, axis=1)[:, number - 1 :])
            pairs[0] = pairs[0][0] / number, pairs[0][1] / number
        driven = (values[here] for values in (stiffness / mass, pull / kappa))
        way = _Way(law.memory(len(here)), law.sliding_energy, steps, np.stack(pairs), found, first[some] * number, *driven)
        while way.drops.size:
            way.go()
        put(path, here, found[:, ::number])
        microslip[here] = way.microslip
    return path[0] * kappa, path[1] * kappa, stiffness * kappa * path[2], mass * kappa**2 * microslip


Pair = tuple[Floats, Floats]
"""Values and slopes on a grid (G, B)."""


def _slide_throughout(normal: NormalMotion, hertz: Floats, slip: Floats, stiffness: Floats, pull: Floats) -> Floats:
    """Return slip velocity, displacement and integral (3, G, B) of contacts whose every point slips all the time.

    So it is where nowhere the displacement grows more slowly than the depth, or shrinks faster than a part of it. `hertz`: Hertz's
    stiffness [N/m^1.5].
    """
    found = np.empty((3, *normal.force.shape))
    per_force = (2.0 / 3.0) / hertz  # 2/3 of the depth to the power 3/2 is the integral
    found[2] = per_force * normal.force
    found[0] = slip + pull * normal.time - stiffness * per_force * normal.impulse
    found[1] = normal.integrals(found[0], normal.pace * (pull - stiffness * found[2]))
    return found


def _refined(steps: Floats, known: Pair, number: int) -> Pair:
    """Return values and slopes on a grid with `number` steps for each one, from the cubics between them; its parameter counts these."""
    values, slopes = known
    inside = steps[:, None]  # without slopes between parts
    ends = np.stack([values[:-1], slopes[:-1] * inside, values[1:], slopes[1:] * inside])
    fine, fine_slopes = np.empty((2, number * len(steps) + 1, values.shape[1]))
    for part in range(number):
        fine[part:-1:number], fine_slopes[part:-1:number] = cubic_at(ends, part / number)
    fine[-1], fine_slopes[-1] = values[-1], slopes[-1]
    return fine, fine_slopes / number


class _Ahead(NamedTuple):
    """A step as it is with an acceleration that changes evenly.

    `velocity`: at its end (b,). `acceleration`: at its end, and its change over the step (2, b). `corrections`: see `step_weights`.
    """

    step: Step
    velocity: Floats
    acceleration: Floats
    corrections: Floats


class _Way:
    """The motion of B contacts along the plate, under way, each at a place of its own.

    `grid`: pace above depth, each value above slope, at G points (2, 2, G B), where `path` is written (3, G B). `drops`: contacts that are
    not at the end (b,). `at`: the last point that they passed; `turns`: how often they have changed since (b,). `left`: what is left then
    of the step, values and slopes at both ends (2, 4, B). `state`: displacement and velocity, over kappa; integral, and its derivatives by
    displacement and by depth (5, b). `microslip`: energy lost while a part of the contact sticks, over the mass and the square of kappa
    (B,). `stored`: the law's `sliding_energy`.
    """

    def __init__(
        self, memory: Memory, stored: float, steps: Floats, grid: Floats, path: Floats, first: Drops, stiffness: Floats, pull: Floats
    ) -> None:
        self.memory, self.stored, self.stiffness, self.pull, self.size = memory, stored, stiffness, pull, len(first)
        self.grid, self.path = grid.reshape(2, 2, -1), path.reshape(3, -1)
        self.last, self.joints = len(steps) * self.size, np.flatnonzero(steps == 0.0) * self.size
        self.drops, self.turns, self.left = np.arange(self.size), np.zeros(self.size, dtype=np.intp), np.empty((2, 4, self.size))
        self.at = first * self.size + self.drops
        velocity, displacement, integral = self.path.take(self.at, axis=1)
        self.state = np.stack([displacement, velocity, np.where(first > 0, integral, 0.0), *np.zeros((2, self.size))])
        slide, start = np.flatnonzero(first), np.flatnonzero(first == 0)
        at = self.at[slide]
        moved = np.stack([displacement[slide], self.grid[0, 0, at] * velocity[slide]])
        self.state[2:, slide] = memory.slide(slide, self.grid[1].take(at, axis=1), moved, integral[slide])
        self.microslip = stored * stiffness * np.abs(self.state[2]) * self.grid[1, 0, self.at]
        self._jump(start, np.zeros(len(start)), self.grid[1, 0, start])  # where the force begins with a jump
        self._write(start)
        self._pass_joints()

    def go(self) -> None:
        """Take contacts to their next points, or to the places before where they change."""
        step = np.concatenate([self.grid.take(self.at, axis=2), self.grid.take(self.at + self.size, axis=2)], axis=1)
        within = np.flatnonzero(self.turns)
        if within.size:
            put(step, within, self.left.take(self.drops[within], axis=2))
        pace, depth = step
        ahead = self._ahead(_ALL, pace, depth)
        some, places, near = self.memory.turns(self.drops, ahead.step)
        turned = some
        if some.size:
            places = np.where(self.turns[some] < _MOST_TURNS, np.maximum(places, _LEAST_PART), 1.0)
            (pace_to, pace_left), (depth_to, depth_left) = (before_and_after(one.take(some, axis=1), places) for one in step)
            pace_to, pace_left = places * pace_to, (1.0 - places) * pace_left
            depth_to[2] = depth_left[0] = np.maximum(depth_left[0], 0.0)
            pace_to, depth_to = slowed(pace_to, depth_to, near)
            part = self._ahead(some, pace_to, depth_to)
            for whole, one in zip((pace, *ahead.step, *ahead[1:]), (pace_to, *part.step, *part[1:]), strict=True):
                put(whole, some, one)
            turns = places < 1.0
            turned, depth_left = some[turns], depth_left.compress(turns, axis=1)
            put(self.left, self.drops[turned], np.stack([pace_left.compress(turns, axis=1), depth_left]))
        self._arrive(ahead, pace)
        if turned.size:
            put(self.state[2:], turned, self.memory.turn(self.drops[turned], depth_left[:2], self.state[2:].take(turned, axis=1)))
        self._pass(turned)

    def _ahead(self, here: Drops | slice, pace: Floats, depth: Floats) -> _Ahead:
        """Return a step with the acceleration that begins as it does now."""
        weights, corrections = step_weights(pace, depth, self.memory.power)
        displacement, velocity, integral, by_displacement, by_depth = (row[here] for row in self.state)
        stiffness, flow = self.stiffness[here], pace[0] * velocity
        rate = by_displacement * flow + by_depth * depth[1]
        known = np.array([velocity, self.pull[here] - stiffness * integral, -stiffness * rate])
        moved, swept, later = np.einsum("oib,ib->ob", weights, known)
        known[1] += known[2]
        step = Step(depth, np.array([displacement, flow, displacement + moved, pace[2] * later]), np.array([integral, rate, swept]))
        return _Ahead(step, later, known[1:], corrections)

    def _arrive(self, ahead: _Ahead, pace: Floats) -> None:
        """End a step with the force that acts there, and with that which acts where it so leads to."""
        step, velocity, expected, corrections = ahead
        before, slid = self.state, self.memory.slides[self.drops] != 0
        integral, by_displacement, by_depth = self.memory.advance(self.drops, step)
        moved, faster = np.zeros((2, len(velocity)))
        for _ in range(_CORRECTIONS):
            rate = by_displacement * pace[2] * (velocity + faster) + by_depth * step.depth[3]
            more = np.array([self.pull - self.stiffness * (integral + by_displacement * moved), -self.stiffness * rate]) - expected
            moved, faster = np.einsum("oib,ib->ob", corrections, more)
        integral = integral + by_displacement * moved
        self.state = np.array([step.displacement[2] + moved, velocity + faster, integral, by_displacement, by_depth])
        self._lose(_ALL, before, slid, step.depth[0], step.depth[2])

    def _lose(self, here: Drops | slice, before: Floats, slid: Bools, depth: Floats, depth_there: Floats) -> None:
        """Count what contacts took on a way on which they did not slide throughout, less what they store then.

        `before`: their state at its start; `slid`: do they slide there?
        """
        start, velocity, integral = before[:3]
        displacement, velocity_there, integral_there = (row[here] for row in self.state[:3])
        taken = 0.5 * (velocity - velocity_there) * (velocity + velocity_there) + self.pull[here] * (displacement - start)
        stored = self.stored * self.stiffness[here] * (np.abs(integral_there) * depth_there - np.abs(integral) * depth)
        drops = self.drops[here]
        self.microslip[drops] += np.where(slid & (self.memory.slides[drops] != 0), stored, taken)

    def _pass(self, turned: Drops) -> None:
        """Let contacts pass the next points, but those that have changed before, and leave out those that came to the end."""
        turns = np.zeros_like(self.turns)
        turns[turned] = self.turns[turned] + 1
        self.turns = turns
        self.at += self.size
        self._write(_ALL)  # what is too early is written again
        self.at[turned] -= self.size
        self._pass_joints()
        goes = np.flatnonzero(self.at < self.last)
        if goes.size < len(self.at):
            ends = np.flatnonzero(self.at >= self.last)
            depth = self.grid[1, 0, self.at[ends]]
            self._jump(ends, depth, np.zeros_like(depth))  # what it stores then is lost, as it slides back
            self.drops, self.at, self.turns = self.drops[goes], self.at[goes], self.turns[goes]
            self.stiffness, self.pull = self.stiffness[goes], self.pull[goes]
            self.state = self.state.take(goes, axis=1)

    def _pass_joints(self) -> None:
        """Take contacts at the end of a part to the beginning of the next one, where the depth may be another."""
        for joint in self.joints:
            here = np.flatnonzero((self.at >= joint) & (self.at < joint + self.size))
            if here.size:
                before = self.grid[1, 0, self.at[here]]
                self.at[here] += self.size
                self._jump(here, before, self.grid[1, 0, self.at[here]])
                self._write(here)

    def _write(self, here: Drops | slice) -> None:
        """Write where contacts are into the path."""
        at = self.at[here]
        for row, value in zip(self.path, (1, 0, 2), strict=True):
            row[at] = self.state[value, here]

    def _jump(self, here: Drops, before: Floats, after: Floats) -> None:
        """Change the depth of contacts at once, where it becomes another."""
        jumps = np.abs(after - before) > _SAME * np.maximum(before, after)
        if not jumps.any():
            return
        here, before, after = here[jumps], before[jumps], after[jumps]
        drops, start, nothing = self.drops[here], self.state[:, here], np.zeros(len(here))
        ends = (before, nothing, after, nothing), (start[0], nothing, start[0], nothing), (start[2], nothing, nothing)
        slid = self.memory.slides[drops] != 0
        self.state[2:, here] = self.memory.advance(drops, Step(*(np.array(one) for one in ends)))
        self._lose(here, start, slid, before, after)
