r"""Sliding of contacts with tangential compliance along one direction, driven by their normal motion.

With the displacement s over kappa and the integral I (`contact.friction.law`)

.. math:: \ddot s = -\frac{2 G^* \sqrt R}{m_t}\, I + \frac{g_t}{\kappa}

for the effective mass :math:`m_t` of the tangential motion, 2/7 of that of a solid sphere. A contact that slides from first touch on is
not integrated before it may stick: until then the normal impulse gives its velocity. The rest is `TangentialMotion`.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Drops, Floats, put
from vibroimpact.contact.friction.cubics import cubic_at
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.contact.pair import hertz_stiffness
from vibroimpact.dynamics.oblique.normal_motion import NormalMotion
from vibroimpact.dynamics.oblique.sliding_springs import SlidingSprings
from vibroimpact.dynamics.oblique.slip_at_rim import SlipAtRim
from vibroimpact.dynamics.oblique.tangential_steps import Drive, sliding_integral

_LEAST, _MOST = 1e-9, 1e6
"""Bounds of kappa in slip per depth: contacts with less friction slide freely, and those with more stick."""

_ROUNDING = 1e-5
"""Error of the rate of the depth at release, as a part of the largest."""

_PRESSED = 1e-7
"""Part of the largest normal force below which it is the error of the normal motion."""

_MOST_TURNING, _MOST_PARTS = 0.6, 16
"""Angle by which the free oscillation of a contact that sticks turns in a step at most [rad], and parts of a step for that at most."""


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
    pressed = normal.force > _PRESSED * normal.force.max(axis=0)
    depth = np.where(pressed, np.cbrt(normal.force / hertz) ** 2, 0.0)
    depth_slope = np.divide((2.0 / 3.0) * depth * normal.force_slope, normal.force, out=np.zeros_like(depth), where=pressed)
    if not depth[1:-1].all():  # no cubic to zero falls below it
        depth_slope[:-1] = np.where(depth[1:] > 0.0, depth_slope[:-1], np.maximum(depth_slope[:-1], -3.0 * depth[:-1]))
        depth_slope[1:] = np.where(depth[:-1] > 0.0, depth_slope[1:], np.minimum(depth_slope[1:], 3.0 * depth[1:]))
    deepest = depth.max(axis=0)
    scale = (np.abs(slip) + np.abs(pull) * normal.time[-1]) * normal.time[-1] / deepest
    asked = law.coefficient * modulus / shear
    kappa = np.clip(asked, _LEAST * scale, _MOST * scale)
    kappa[kappa == 0.0] = 1.0
    stiffness = np.where(asked < kappa, 0.0, 2.0 * shear * np.sqrt(radius))  # of the integral: none where friction is below the least
    per_force = (2.0 / 3.0) / hertz  # 2/3 of the depth to the power 3/2 is the integral
    most, swept = per_force * normal.force, per_force * normal.pressed
    path = _slide_throughout(normal, most, swept, slip / kappa, stiffness / mass, pull / kappa)
    least = law.least_rate(depth_slope > 0.0) * depth_slope
    may_stick = path[0] * normal.pace < least - _ROUNDING * depth_slope.max(axis=0)
    sticks = np.flatnonzero((stiffness > 0.0) & may_stick.any(axis=0))
    # in the order of their slip, in which contacts begin to stick and cease to
    sticks = sticks[np.argsort((np.abs(slip) * normal.time[-1] / (kappa * deepest))[sticks])]
    first = np.maximum(may_stick[:, sticks].argmax(axis=0) - 1, 0)
    first -= normal.steps[np.maximum(first - 1, 0)] == 0.0
    turning = (np.sqrt(stiffness / mass * np.sqrt(deepest)) * normal.pace.max(axis=0))[sticks]
    microslip, kind = np.zeros(len(slip)), SlipAtRim if law.slips_at_rim else SlidingSprings
    parts = 2 ** np.ceil(np.log2(np.clip(turning / _MOST_TURNING, 1.0, _MOST_PARTS))).astype(int)
    for number in np.unique(parts).tolist():
        some = np.flatnonzero(parts == number)
        here = sticks[some]
        joints, found, begins = normal.steps == 0.0, path.take(here, axis=2), _in_order(first[some])
        grid = np.empty((len(depth), 7, len(here)))
        for row, values in enumerate((normal.time, normal.pace, normal.pace_slope, depth, depth_slope, most, swept)):
            values.take(here, axis=1, out=grid[:, row], mode="clip")  # otherwise by way of a copy
        if number > 1:
            grid, joints = _refined(grid, joints, number), np.repeat(joints, number)
            found, begins = np.repeat(found, number, axis=1)[:, number - 1 :], begins * number
        motion = kind(law, grid, joints, found, begins, (stiffness / mass)[here], (pull / kappa)[here])
        microslip[here] = motion.follow()
        for whole, part in zip(path, found, strict=True):
            put(whole, here, part[::number])
    return path[0] * kappa, path[1] * kappa, stiffness * kappa * path[2], mass * kappa**2 * microslip


def _in_order(first: Drops) -> Drops:
    """Return numbers that are at most those given, and do not fall."""
    return np.minimum.accumulate(first[::-1])[::-1]


def _slide_throughout(normal: NormalMotion, most: Floats, swept: Floats, slip: Floats, stiffness: Floats, pull: Floats) -> Floats:
    """Return slip velocity, displacement and integral (3, G, B) of contacts whose every point slips all the time.

    So it is where nowhere the displacement grows more slowly than the depth, or shrinks faster than a part of it. `most`: the integral,
    `swept`: its integral over time so far.
    """
    found = np.empty((3, *most.shape))
    found[2] = most
    found[0] = slip + pull * normal.time - stiffness * swept
    found[1] = normal.integrals(found[0], normal.pace * (pull - stiffness * most))
    return found


def _refined(grid: Floats, joints: Floats, number: int) -> Floats:
    """Return the normal motion (G, 7, B) with `number` steps for each one, from the cubics between its points; see `Drive`."""
    inside = np.where(joints, 0.0, 1.0)[:, None, None]  # no slopes between two parts
    known = Drive(grid.transpose(1, 0, 2))
    values = np.stack([known.time, known.pace, known.depth, known.swept], axis=1)
    slopes = np.stack([known.pace, known.pace_slope, known.depth_slope, known.pace * known.most], axis=1)
    ends = np.stack([values[:-1], slopes[:-1] * inside, values[1:], slopes[1:] * inside])
    fine, rates = np.empty((2, number * len(joints) + 1, *values.shape[1:]))
    for part in range(number):
        fine[part:-1:number], rates[part:-1:number] = cubic_at(ends, part / number)
    fine[-1], rates[-1] = values[-1], slopes[-1]
    (time, pace, depth, swept), (_, bend, deepening, _) = fine.transpose(1, 0, 2), rates.transpose(1, 0, 2) / number
    depth = np.maximum(depth, 0.0)
    return np.stack([time, pace / number, bend / number, depth, deepening, sliding_integral(depth), swept], axis=1)
