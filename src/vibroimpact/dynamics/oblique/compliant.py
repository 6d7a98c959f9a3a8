r"""Sliding of contacts with tangential compliance along one direction, driven by their normal motion.

With the displacement s over kappa and the integral I of the law's memory (`contact.friction.law`)

.. math:: \ddot s = -\frac{2 G^* \sqrt R}{m_t}\, I + \frac{g_t}{\kappa}

for the effective mass :math:`m_t` of the tangential motion, 2/7 of that of a solid sphere. It is integrated over the parameter of the
normal motion with one evaluation of the force a step: the acceleration is the cubic with its values and slopes at both ends, for which the
step is first taken with one that changes evenly (`step_weights`). A contact that begins or ceases to stick, to slip or to slide within a
step takes it in parts, so that the method keeps its order of four.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
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

_MOST_TURNS = 4
"""Parts of a step at most, beside the last one."""

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
    least = np.where(depth_slope > 0.0, depth_slope, law.sliding_bound * depth_slope)
    sticks = np.flatnonzero((stiffness > 0.0) & (path[0] * normal.pace < least - _ROUNDING * depth_slope.max(axis=0)).any(axis=0))
    arrays, microslip = (slip / kappa, stiffness / mass, pull / kappa), np.zeros(len(slip))
    turning = np.sqrt((arrays[1] * np.sqrt(depth) * normal.pace**2).max(axis=0))[sticks]
    parts = 2 ** np.ceil(np.log2(np.clip(turning / _MOST_TURNING, 1.0, _MOST_PARTS))).astype(int)
    for number in np.unique(parts).tolist():
        here = sticks[parts == number]
        steps, pace, deep = normal.steps, (normal.pace[:, here], normal.pace_slope[:, here]), (depth[:, here], depth_slope[:, here])
        if number > 1:
            pace, deep = _refined(steps, pace, number), _refined(steps, deep, number)
            steps, pace = np.repeat(steps, number), (pace[0] / number, pace[1] / number)
        way = _Way(law.memory(len(here)), law.sliding_energy, *(values[here] for values in arrays))
        path[:, :, here] = _integrate(way, steps, pace, deep)[:, ::number]
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


def _integrate(way: _Way, steps: Floats, pace: Pair, depth: Pair) -> Floats:
    """Return slip velocity, displacement and integral (3, G, B), of which the first two are over kappa.

    `pace`, `depth`: values and slopes of dt by the parameter and of the depth (G, B); `steps`: of the parameter.
    """
    deep = depth[0]
    if deep[0].any():  # the force begins with a jump
        way.jump(np.zeros_like(deep[0]), deep[0])
    found = np.empty((3, *deep.shape))
    found[:, 0] = way.state[[1, 0, 2]]
    paces, depths = np.stack(pace, axis=1), np.stack(depth, axis=1)
    for point, length in enumerate(steps, start=1):
        if length > 0.0:
            way.go(np.concatenate(paces[point - 1 : point + 1]), np.concatenate(depths[point - 1 : point + 1]))
        elif not np.allclose(deep[point - 1], deep[point], rtol=_SAME, atol=0.0):
            way.jump(deep[point - 1], deep[point])
        found[:, point] = way.state[[1, 0, 2]]
    if deep[-1].any():  # what it stores then is lost, as it slides back
        way.jump(deep[-1], np.zeros_like(deep[-1]))
    return found


class _Ahead(NamedTuple):
    """A step as it is with an acceleration that changes evenly.

    `velocity`: at its end (b,). `acceleration`: at its end, and its change over the step (2, b).
    """

    step: Step
    velocity: Floats
    acceleration: Floats


class _Way:
    """The motion of B contacts along the plate, under way.

    `state`: displacement and velocity, over kappa; integral, and its derivatives by displacement and by depth (5, B). `microslip`: energy
    lost while a part of the contact sticks, over the mass and the square of kappa (B,). `stored`: the law's `sliding_energy`.
    """

    def __init__(self, memory: Memory, stored: float, slip: Floats, stiffness: Floats, pull: Floats) -> None:
        self.memory, self.stiffness, self.pull, self.stored = memory, stiffness, pull, stored
        self.state, self.microslip = np.zeros((5, len(slip))), np.zeros(len(slip))
        self.state[1] = slip

    def jump(self, depth: Floats, depth_there: Floats) -> None:
        """Change the depth at once."""
        nothing, displacement, integral = np.zeros_like(depth), self.state[0], self.state[2]
        ends = (depth, nothing, depth_there, nothing), (displacement, nothing, displacement, nothing), (integral, nothing, nothing)
        before, slid = self.state[:3].copy(), self.memory.slides != 0
        self.state[2:] = self.memory.advance(_ALL, Step(*(np.stack(one) for one in ends)))
        self._lose(_ALL, before, slid, depth, depth_there)

    def go(self, pace: Floats, depth: Floats) -> None:
        """Take a step, from place to place with contacts that change within it; its pace and depth are changed to the last part."""
        weights, corrections = step_weights(pace, depth, self.memory.power)
        ahead = self._ahead(_ALL, pace, depth, weights)
        drops, places, near = self.memory.turns(_ALL, ahead.step)
        for _ in range(_MOST_TURNS):
            if not drops.size:
                break
            turned, paces, depths = self._go_to(drops, pace[:, drops], depth[:, drops], places, near)
            pace[:, drops], depth[:, drops] = paces, depths
            weights, corrections[..., drops] = step_weights(paces, depths, self.memory.power)
            left = self._ahead(drops, paces, depths, weights)
            for whole, part in zip(
                (*ahead.step, ahead.velocity, ahead.acceleration), (*left.step, left.velocity, left.acceleration), strict=True
            ):
                whole[..., drops] = part
            some, places, near = self.memory.turns(drops, left.step)
            again = turned[some]
            drops, places, near = drops[some[again]], places[again], near[again]
        self._arrive(_ALL, ahead, pace, corrections)

    def _go_to(self, drops: Drops, pace: Floats, depth: Floats, places: Floats, near: Floats) -> tuple[Bools, Floats, Floats]:
        """Take contacts to places within a step; return where there is something left of it, and pace and depth in what is left."""
        (pace_to, pace_left), (depth_to, depth_left) = before_and_after(pace, places), before_and_after(depth, places)
        pace_to, pace_left = places * pace_to, (1.0 - places) * pace_left
        depth_to[2] = depth_left[0] = np.maximum(depth_left[0], 0.0)
        pace_to, depth_to = slowed(pace_to, depth_to, near)
        turned = places < 1.0
        moves = np.flatnonzero(turned & (places > 0.0))
        pace_moved, depth_moved = pace_to[:, moves], depth_to[:, moves]
        weights, corrections = step_weights(pace_moved, depth_moved, self.memory.power)
        self._arrive(drops[moves], self._ahead(drops[moves], pace_moved, depth_moved, weights), pace_moved, corrections)
        self.state[2:, drops[turned]] = self.memory.turn(drops[turned], depth_left[:2, turned], self.state[2:, drops[turned]])
        return turned, np.where(turned, pace_left, pace_to), np.where(turned, depth_left, depth_to)

    def _ahead(self, drops: Drops | slice, pace: Floats, depth: Floats, weights: Floats) -> _Ahead:
        """Return a step with the acceleration that begins as it does now."""
        displacement, velocity, integral, by_displacement, by_depth = self.state[:, drops]
        stiffness, flow = self.stiffness[drops], pace[0] * velocity
        rate = by_displacement * flow + by_depth * depth[1]
        known = np.stack([velocity, self.pull[drops] - stiffness * integral, -stiffness * rate])
        moved, swept, later = np.einsum("oib,ib->ob", weights, known)
        known[1] += known[2]
        step = Step(depth, np.stack([displacement, flow, displacement + moved, pace[2] * later]), np.stack([integral, rate, swept]))
        return _Ahead(step, later, known[1:])

    def _arrive(self, drops: Drops | slice, ahead: _Ahead, pace: Floats, corrections: Floats) -> None:
        """End a step with the force that acts there, and with that which acts where it so leads to."""
        step, velocity, expected = ahead
        stiffness, pull = self.stiffness[drops], self.pull[drops]
        before, slid = self.state[:3, drops].copy(), self.memory.slides[drops] != 0
        integral, by_displacement, by_depth = self.memory.advance(drops, step)
        moved, faster = np.zeros((2, len(velocity)))
        for _ in range(_CORRECTIONS):
            rate = by_displacement * pace[2] * (velocity + faster) + by_depth * step.depth[3]
            more = np.stack([pull - stiffness * (integral + by_displacement * moved), -stiffness * rate]) - expected
            moved, faster = np.einsum("oib,ib->ob", corrections, more)
        integral = integral + by_displacement * moved
        self.state[:, drops] = step.displacement[2] + moved, velocity + faster, integral, by_displacement, by_depth
        self._lose(drops, before, slid, step.depth[0], step.depth[2])

    def _lose(self, drops: Drops | slice, before: Floats, slid: Bools, depth: Floats, depth_there: Floats) -> None:
        """Count what contacts took on a way on which they did not slide throughout, less what they store then.

        `before`: displacement, velocity and integral at its start (3, b); `slid`: do they slide there?
        """
        start, velocity, integral = before
        displacement, velocity_there, integral_there = self.state[:3, drops]
        taken = 0.5 * (velocity - velocity_there) * (velocity + velocity_there) + self.pull[drops] * (displacement - start)
        stored = self.stored * self.stiffness[drops] * (np.abs(integral_there) * depth_there - np.abs(integral) * depth)
        self.microslip[drops] += np.where(slid & (self.memory.slides[drops] != 0), stored, taken)
