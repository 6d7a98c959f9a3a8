r"""Sliding of contacts with tangential compliance along one direction, driven by their normal motion.

With the displacement s over kappa and the integral I of the law's memory (`contact.friction.law`)

.. math:: \ddot s = -\frac{2 G^* \sqrt R}{m_t}\, I + \frac{g_t}{\kappa}

for the effective mass :math:`m_t` of the tangential motion, 2/7 of that of a solid sphere. It is integrated over the parameter of the
normal motion by a two-step predictor of order four and the trapezoidal rule with end derivatives, with one evaluation of the force a
step. Where the rim stops slipping within a step, the way leads over that point.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.law import CompliantFriction, Memory
from vibroimpact.contact.friction.turning_points import integral_of_line
from vibroimpact.contact.pair import hertz_stiffness
from vibroimpact.dynamics.oblique.normal_motion import NormalMotion

_LEAST, _MOST = 1e-9, 1e6
"""Bounds of kappa in slip per depth: contacts with less friction slide freely, and those with more stick."""

_ROUNDING = 1e-5
"""Error of the rate of the depth at release, as a part of the largest."""

_SAME = 1e-6
"""Relative difference below which what two parts of a contact have where they meet is the same."""


def slide_compliant(
    law: CompliantFriction, normal: NormalMotion, slip: Floats, mass: Floats, pull: Floats
) -> tuple[Floats, Floats, Floats]:
    """Return slip velocity [m/s], displacement [m] and friction force [N] of contacts under a law with tangential compliance, each (G, B).

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
        depth_slope = np.where(normal.force > 0.0, (2.0 / 3.0) * depth * normal.force_slope / normal.force, 0.0)
    scale = (np.abs(slip) + np.abs(pull) * normal.time[-1]) * normal.time[-1] / depth.max(axis=0)
    asked = law.coefficient * modulus / shear
    kappa = np.clip(asked, _LEAST * scale, _MOST * scale)
    kappa[kappa == 0.0] = 1.0
    stiffness = np.where(asked < kappa, 0.0, 2.0 * shear * np.sqrt(radius))  # of the integral: none where friction is below the least
    path = _slide_throughout(normal, hertz, slip / kappa, stiffness / mass, pull / kappa)
    least = np.where(depth_slope > 0.0, depth_slope, law.sliding_bound * depth_slope)
    sticks = np.flatnonzero((path[0] * normal.pace < least - _ROUNDING * depth_slope.max(axis=0)).any(axis=0))
    if sticks.size:
        memory, rest = law.memory(len(sticks), 2 * len(normal.time)), normal.take(sticks)
        arrays = (slip / kappa, stiffness / mass, pull / kappa)
        path[:, :, sticks] = _integrate(memory, rest, depth[:, sticks], depth_slope[:, sticks], *(values[sticks] for values in arrays))
    return path[0] * kappa, path[1] * kappa, stiffness * kappa * path[2]


def _slide_throughout(normal: NormalMotion, hertz: Floats, slip: Floats, stiffness: Floats, pull: Floats) -> Floats:
    """Return slip velocity, displacement and integral (3, G, B) of contacts whose every point slips all the time.

    So it is where nowhere the displacement grows more slowly than the depth, or shrinks faster than a part of it. `hertz`: Hertz's
    stiffness [N/m^1.5].
    """
    found, step = np.empty((3, *normal.force.shape)), normal.steps[:, None]
    per_force = (2.0 / 3.0) / hertz  # 2/3 of the depth to the power 3/2 is the integral
    found[2] = per_force * normal.force
    found[0] = slip + pull * normal.time - stiffness * per_force * normal.impulse
    rate = normal.pace * found[0]
    bend = normal.pace_slope * found[0] + normal.pace**2 * (pull - stiffness * found[2])
    found[1, 0] = 0.0
    np.cumsum(0.5 * step * (rate[1:] + rate[:-1]) + step**2 / 12.0 * (bend[:-1] - bend[1:]), axis=0, out=found[1, 1:])
    return found


def _integrate(
    memory: Memory, normal: NormalMotion, depth: Floats, depth_slope: Floats, slip: Floats, stiffness: Floats, pull: Floats
) -> Floats:
    """Return slip velocity, displacement and integral (3, G, B), of which the first two are over kappa."""
    every, pace, pace_slope = np.arange(len(slip)), normal.pace, normal.pace_slope
    radius = np.sqrt(depth)
    with np.errstate(divide="ignore", invalid="ignore"):
        radius_slope = np.where(radius > 0.0, 0.5 * depth_slope / radius, 0.0)
    found = np.zeros((3, *depth.shape))
    found[0, 0], nothing = slip, np.zeros(len(slip))
    if depth[0].any():  # the force begins with a jump
        memory.advance(every, depth[0], nothing, nothing, (nothing, nothing))
    # of the velocity by the parameter: the first two derivatives, at the last point and at the one before
    gain = pace[0] * pull
    gains, turns, before = gain, pace_slope[0] * pull, (gain, pace_slope[0] * pull)
    velocity, displacement, integral = slip, nothing, nothing
    for point, step in enumerate(normal.steps, start=1):
        last, square = point - 1, step * step / 12.0
        if step == 0.0 and np.allclose(depth[point], depth[last], rtol=_SAME, atol=0.0):  # parts that join without a jump
            found[:, point] = found[:, last]
            if not np.allclose(pace[point], pace[last], rtol=_SAME, atol=0.0):  # whose parameters run differently
                faster = pace[point] / pace[last]
                force = pull - stiffness * integral
                turns = pace_slope[point] * force + (turns - pace_slope[last] * force) * faster**2
                gains = gains * faster
                before = gains - normal.steps[point] * turns, turns
            continue
        rate, bend = pace[last] * velocity, pace_slope[last] * velocity + pace[last] * gains
        ahead = velocity + step * (1.5 * before[0] - 0.5 * gains) + square * (17.0 * turns + 7.0 * before[1])
        gains_ahead = gains + step * (1.5 * turns - 0.5 * before[1])
        rate_ahead, bend_ahead = pace[point] * ahead, pace_slope[point] * ahead + pace[point] * gains_ahead
        there = displacement + 0.5 * step * (rate + rate_ahead) + square * (bend - bend_ahead)
        flow, flow_ahead = radius[last] * rate, radius[point] * rate_ahead
        curve = radius_slope[last] * rate + radius[last] * bend
        curve -= radius_slope[point] * rate_ahead + radius[point] * bend_ahead
        sticking = integral + 0.5 * step * (flow + flow_ahead) + square * curve
        ends = (
            (depth[last], displacement, rate * step, depth_slope[last] * step),
            (depth[point], there, rate_ahead * step, depth_slope[point] * step),
        )
        _stop_slipping(memory, ends, integral, sticking)
        integral, swell = memory.advance(every, depth[point], there, sticking, (depth_slope[point], rate_ahead))
        gains_there = pace[point] * (pull - stiffness * integral)
        turns_there = pace_slope[point] * (pull - stiffness * integral) - pace[point] * stiffness * swell
        velocity = velocity + 0.5 * step * (gains + gains_there) + square * (turns - turns_there)
        if step > 0.0:
            before = gains, turns
        gains, turns, displacement = gains_there, turns_there, there
        found[:, point] = velocity, displacement, integral
    return found


Ends = tuple[Floats, Floats, Floats, Floats]
"""Depth and displacement at an end of a step, and what they would change by in the step at the rates of displacement and depth there."""


def _stop_slipping(memory: Memory, ends: tuple[Ends, Ends], integral: Floats, sticking: Floats) -> None:
    """Take contacts whose rim stops slipping within a step over the point where it does; `sticking` then counts from there."""
    (depth, displacement, rate, deepening), (depth_there, there, rate_there, deepening_there) = ends
    for direction in (1.0, -1.0):
        # the distance to slip, depth less displacement, has its minimum in the step
        slope, slope_there = deepening - direction * rate, deepening_there - direction * rate_there
        inside = np.flatnonzero((slope < 0.0) & (slope_there > 0.0))
        if not inside.size:
            continue
        start, finish = (depth - direction * displacement)[inside], (depth_there - direction * there)[inside]
        place = _place_of_minimum(start, finish, slope[inside], slope_there[inside])
        deep = _between(depth[inside], depth_there[inside], deepening[inside], deepening_there[inside], place)
        moved = _between(displacement[inside], there[inside], rate[inside], rate_there[inside], place)
        rims = np.sqrt(depth[inside]), np.sqrt(np.maximum(deep, 0.0)), np.sqrt(depth_there[inside])
        stuck = integral[inside] + integral_of_line(moved - displacement[inside], rims[0], rims[1])
        nothing = np.zeros(len(inside))
        so_far, _ = memory.advance(inside, rims[1] ** 2, moved, stuck, (nothing, nothing))
        sticking[inside] = so_far + integral_of_line(there[inside] - moved, rims[1], rims[2])


def _place_of_minimum(start: Floats, finish: Floats, slope: Floats, slope_there: Floats) -> Floats:
    """Return where between 0 and 1 a cubic with these values and slopes, falling first, is lowest, by one step of Newton's method."""
    excess, turn = finish - start - 0.5 * (slope + slope_there), slope_there - slope
    place = -slope / turn
    place = place - 6.0 * excess * place * (1.0 - place) / (turn + 6.0 * excess * (1.0 - 2.0 * place))
    return np.clip(place, 0.0, 1.0)


def _between(start: Floats, finish: Floats, slope: Floats, slope_there: Floats, place: Floats) -> Floats:
    """Return the value of a cubic with these values and slopes at 0 and 1."""
    excess = finish - start - 0.5 * (slope + slope_there)
    return np.asarray(start + place * (slope + 0.5 * (slope_there - slope) * place + excess * place * (3.0 - 2.0 * place)))
