r"""The tangential contact of elastic spheres under way, for displacements in two directions.

A law with a single spring keeps its force Q. As the radius a of the contact changes, Q goes with the power :math:`\gamma` of it, and a
displacement s adds :math:`dQ = 2 G^* a\, ds`: with :math:`\gamma` = 1 the displacement of the spring is kept, with 0 its force.

By the method of dimensionality reduction the contact is a row of independent springs, side by side on a line through it,
:math:`|x| \le a = \sqrt{R D}`. Each has the stiffness :math:`G^*` per unit length, follows the displacement of the surfaces while it is in
contact, and slips where its force would exceed :math:`\mu E^* (D - x^2 / R)` per unit length. Along one direction this is what
`turning_points` follows exactly; that has no counterpart where the direction turns.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.records import Boolean, Matrix, Real, Vector

SPRINGS = 200
"""Springs in the radius of the largest contact: the friction force is then within 1e-4 of that of infinitely many."""

_TINY = 1e-300


class TangentialHistory(NamedTuple):
    """Law, and state of one contact under way in two directions; it does not change, so that a way may be tried.

    at_rim: is it a row of springs, and not a single one? growing, shrinking: powers of the radius of a single spring. hertz: Hertz's
    stiffness [N/m^1.5]. radius: effective radius [m]. stiffness: 2 G* [Pa]. coefficient: of friction. ratio: mu E*/G* [-]. width: of a
    spring [m].

    depth: D [m]. stretch (2, N): displacement of each spring of one half, integrated over its width in contact [m^2]. force (2,): of
    friction [N]. slid: how far all of the contact slid on the way to here [m]; nothing if a part of it sticks.
    """

    at_rim: Boolean
    growing: Real
    shrinking: Real
    hertz: Real
    radius: Real
    stiffness: Real
    coefficient: Real
    ratio: Real
    width: Real
    depth: Real
    stretch: Matrix
    force: Vector
    slid: Real


@compiled(lambda t: t.of(TangentialHistory)(t.of(TangentialHistory), t.real, t.matrix, t.vector, t.real))
def with_state(history: TangentialHistory, depth: float, stretch: Floats, force: Floats, slid: float) -> TangentialHistory:
    """Return a history with another state."""
    return TangentialHistory(
        history.at_rim,
        history.growing,
        history.shrinking,
        history.hertz,
        history.radius,
        history.stiffness,
        history.coefficient,
        history.ratio,
        history.width,
        depth,
        stretch,
        force,
        slid,
    )


@compiled(lambda t: t.real(t.of(TangentialHistory), t.real, t.real))
def pressed_up_to(history: TangentialHistory, place: float, depth: float) -> float:
    """Return the integral of D - x^2/R up to a place x [m^2]."""
    return float(place * (depth - place * place / (3.0 * history.radius)))


@compiled(lambda t: t.of(TangentialHistory)(t.of(TangentialHistory), t.real, t.real, t.real))
def springs_after(history: TangentialHistory, depth: float, moved_x: float, moved_y: float) -> TangentialHistory:
    """Return a row of springs at another depth [m], after the surfaces have moved past each other [m]."""
    before = history.depth
    width = history.width
    rim = math.sqrt(history.radius * depth)
    rim_before = math.sqrt(history.radius * before)
    number = max(int(rim / width) + 1, history.stretch.shape[1])
    stretch = np.zeros((2, number))
    force = np.zeros(2)
    slid = 0.0
    for spring in range(number):
        x = 0.0
        y = 0.0
        if spring < history.stretch.shape[1]:
            x = history.stretch[0, spring]
            y = history.stretch[1, spring]
        left = width * spring
        right = min(left + width, rim)
        covered = max(right - left, 0.0)
        covered_before = min(max(rim_before - left, 0.0), width)
        if covered == 0.0:
            continue
        if depth > before:
            # depth and displacement grow evenly: what comes into contact on the way follows for the rest of it
            reached = left + min(covered_before, covered)
            entering = (pressed_up_to(history, right, depth) - pressed_up_to(history, reached, depth)) / (depth - before)
            follows = reached - left + entering
        else:
            kept = covered / max(covered_before, _TINY)
            x *= kept
            y *= kept
            follows = covered
        x += moved_x * follows
        y += moved_y * follows
        most = history.ratio * (pressed_up_to(history, right, depth) - pressed_up_to(history, left, depth))
        length = math.hypot(x, y)
        if spring == 0:  # the one in the middle sticks longest
            slid = max(length - most, 0.0) / max(covered, _TINY)
        if length > most:
            x *= most / length
            y *= most / length
        stretch[0, spring] = x
        stretch[1, spring] = y
        force[0] += x
        force[1] += y
    force[0] *= history.stiffness
    force[1] *= history.stiffness
    return with_state(history, depth, stretch, force, slid)


@compiled(lambda t: t.of(TangentialHistory)(t.of(TangentialHistory), t.real, t.real, t.real, t.real))
def spring_after(history: TangentialHistory, depth: float, most: float, moved_x: float, moved_y: float) -> TangentialHistory:
    """Return a single spring at another depth [m], after the surfaces have moved past each other [m]; `most`: its largest force [N]."""
    contact_radius = math.sqrt(history.radius * depth)
    radius_before = math.sqrt(history.radius * history.depth)
    power = history.growing if contact_radius >= radius_before else history.shrinking
    kept = (contact_radius / radius_before) ** power if radius_before > 0.0 else 0.0
    # the mean of a^(1 - power) on the way, times a^power at its end
    stiffness = history.stiffness * contact_radius
    if power != 1.0:
        stiffness = 0.5 * history.stiffness * (contact_radius + radius_before * kept)
    force = np.empty(2)
    force[0] = kept * history.force[0] + stiffness * moved_x
    force[1] = kept * history.force[1] + stiffness * moved_y
    strength = math.hypot(force[0], force[1])
    slid = 0.0
    if strength > most:
        slid = (strength - most) / max(stiffness, _TINY)
        force[0] *= most / strength
        force[1] *= most / strength
    return with_state(history, depth, history.stretch, force, slid)


@compiled(lambda t: t.of(TangentialHistory)(t.of(TangentialHistory), t.real, t.real, t.real))
def history_after(history: TangentialHistory, normal_force: float, moved_x: float, moved_y: float) -> TangentialHistory:
    """Return the history at another normal force [N], after the surfaces have moved past each other along x and y [m]."""
    pressing = max(normal_force, 0.0)
    depth = (pressing / history.hertz) ** (2.0 / 3.0)
    if history.at_rim:
        return springs_after(history, depth, moved_x, moved_y)
    return spring_after(history, depth, history.coefficient * pressing, moved_x, moved_y)


@compiled(lambda t: t.of(TangentialHistory)(t.of(TangentialHistory), t.vector, t.matrix, t.matrix, t.vector))
def follow_history(history: TangentialHistory, normal: Floats, moved: Floats, friction: Floats, slid: Floats) -> TangentialHistory:
    """Return the history at the end of a way of T steps.

    Parameters
    ----------
    history : TangentialHistory
        At its start.
    normal : array, shape (T,)
        Normal forces at the ends of the steps [N].
    moved : array, shape (T, 2)
        Displacement of the surfaces past each other in each step, along x and y [m].
    friction : array, shape (T, 2)
        Room for the friction forces [N].
    slid : array, shape (T,)
        Room for how far all of the contact slid in each step [m].
    """
    for step in range(len(normal)):
        history = history_after(history, normal[step], moved[step, 0], moved[step, 1])
        friction[step, 0] = history.force[0]
        friction[step, 1] = history.force[1]
        slid[step] = history.slid
    return history
