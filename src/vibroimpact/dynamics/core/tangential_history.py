r"""The tangential contact of elastic spheres under way, for displacements in two directions.

A law with a single spring keeps its force Q. As the radius a of the contact changes, Q goes with
the power :math:`\gamma` of it, and a
displacement s adds :math:`dQ = 2 G^* a\, ds`: with :math:`\gamma` = 1 the displacement of the
spring is kept, with 0 its force.

By the method of dimensionality reduction the contact is a row of independent springs, side by side
on a line through it,
:math:`|x| \le a = \sqrt{R D}`. Each has the stiffness :math:`G^*` per unit length, follows the
displacement of the surfaces while it is in
contact, and slips where its force would exceed :math:`\mu E^* (D - x^2 / R)` per unit length. Along
one direction this is what
`turning_points` follows exactly; that has no counterpart where the direction turns.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled

SPRINGS = 200
"""Springs in the radius of the largest contact: the friction force is then within 1e-4 of
that of infinitely many.
"""

_TINY = 1e-300


class TangentialHistory(NamedTuple):
    """Law, and state of one contact under way in two directions; it does not change, so that a way
    may be tried.

    at_rim: is it a row of springs, and not a single one? growing, shrinking: powers of the radius
    of a single spring. hertz: Hertz's stiffness [N/m^1.5]. radius: effective radius [m]. stiffness:
    2 G* [Pa]. coefficient: of friction. ratio: mu E*/G* [-]. sliding_energy: elastic work of a
    contact as it grows while all of it slides, over mu F mu E*/G* D. width: of a spring [m].

    depth: D [m]. stretch (2, N): displacement of each spring of one half, integrated over its width
    in contact [m^2]. force (2,): of friction [N]. slid: how far all of the contact slid on the way
    to here [m]; nothing if a part of it sticks.
    """

    at_rim: bool
    growing: float
    shrinking: float
    hertz: float
    radius: float
    stiffness: float
    coefficient: float
    ratio: float
    sliding_energy: float
    width: float
    depth: float
    stretch: Matrix
    force: Vector
    slid: float


@compiled
def with_state(
    history: TangentialHistory, depth: float, stretch: Matrix, force: Vector, slid: float
) -> TangentialHistory:
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
        history.sliding_energy,
        history.width,
        depth,
        stretch,
        force,
        slid,
    )


@compiled
def pressed_up_to(history: TangentialHistory, place: float, depth: float) -> float:
    """Return the integral of D - x^2/R up to a place x [m^2]."""
    return float(place * (depth - place * place / (3.0 * history.radius)))


@compiled
def move_springs(
    history: TangentialHistory,
    stretch: Matrix,
    before: float,
    depth: float,
    moved_x: float,
    moved_y: float,
) -> tuple[float, float, float]:
    """Stretch a row of springs from a depth to another [m], while the surfaces move past each other
    [m]; `stretch`: that of the springs.

    Return the friction along x and y [N], and how far all of the contact slid [m].
    """
    width = history.width
    rim = math.sqrt(history.radius * depth)
    rim_before = math.sqrt(history.radius * before)
    force_x = 0.0
    force_y = 0.0
    slid = 0.0
    pressed = 0.0
    for spring in range(min(int(max(rim, rim_before) / width) + 1, stretch.shape[1])):
        left = width * spring
        if left >= rim:
            stretch[0, spring] = 0.0
            stretch[1, spring] = 0.0
            continue
        right = min(left + width, rim)
        covered = right - left
        covered_before = min(max(rim_before - left, 0.0), width)
        pressed_before = pressed
        pressed = pressed_up_to(history, right, depth)
        x = stretch[0, spring]
        y = stretch[1, spring]
        follows = covered
        if covered > covered_before and depth > before:
            # depth and displacement grow evenly: what comes into contact on the way follows for the
            # rest of it
            entering = pressed - pressed_up_to(history, left + covered_before, depth)
            follows = covered_before + entering / (depth - before)
        elif covered < covered_before:
            x *= covered / covered_before
            y *= covered / covered_before
        x += moved_x * follows
        y += moved_y * follows
        # the bound of its stretch: mu E*/G* times the integral of D - x^2/R over the spring
        most = history.ratio * (pressed - pressed_before)
        square = x * x + y * y
        if square > most * most:
            length = math.sqrt(square)
            if spring == 0:  # the one in the middle sticks longest
                slid = (length - most) / max(covered, _TINY)
            x *= most / length
            y *= most / length
        stretch[0, spring] = x
        stretch[1, spring] = y
        force_x += x
        force_y += y
    return history.stiffness * force_x, history.stiffness * force_y, slid


@compiled
def springs_for(history: TangentialHistory, depth: float) -> Matrix:
    """Return the stretch of the springs, with room for those of a contact of a depth [m]."""
    number = int(math.sqrt(history.radius * depth) / history.width) + 1
    known = history.stretch.shape[1]
    stretch = np.zeros((2, max(number, known)))
    for direction in range(2):
        for spring in range(known):
            stretch[direction, spring] = history.stretch[direction, spring]
    return stretch


@compiled
def spring_after(
    history: TangentialHistory, depth: float, most: float, moved_x: float, moved_y: float
) -> TangentialHistory:
    """Return a single spring at another depth [m], after the surfaces have moved past
    each other [m]; `most`: its largest force [N].
    """
    contact_radius = math.sqrt(history.radius * depth)
    radius_before = math.sqrt(history.radius * history.depth)
    power = history.shrinking
    if contact_radius >= radius_before:
        power = history.growing
    kept = 0.0
    if radius_before > 0.0:
        kept = (contact_radius / radius_before) ** power
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


@compiled
def depth_under(history: TangentialHistory, normal_force: float) -> float:
    """Return the depth of Hertz's contact under a normal force [m]."""
    # F = k D^(3/2)
    return float((max(normal_force, 0.0) / history.hertz) ** (2.0 / 3.0))


@compiled
def history_after(
    history: TangentialHistory, normal_force: float, moved_x: float, moved_y: float
) -> TangentialHistory:
    """Return the history at another normal force [N], after the surfaces have moved past
    each other along x and y [m].
    """
    depth = depth_under(history, normal_force)
    if not history.at_rim:
        return spring_after(
            history, depth, history.coefficient * max(normal_force, 0.0), moved_x, moved_y
        )
    stretch = springs_for(history, depth)
    force = np.empty(2)
    force[0], force[1], slid = move_springs(
        history, stretch, history.depth, depth, moved_x, moved_y
    )
    return with_state(history, depth, stretch, force, slid)


@compiled
def follow_history(
    history: TangentialHistory, normal: Vector, moved: Matrix, friction: Matrix, slid: Vector
) -> TangentialHistory:
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
    if not history.at_rim:
        for step in range(len(normal)):
            history = history_after(history, normal[step], moved[step, 0], moved[step, 1])
            friction[step, 0] = history.force[0]
            friction[step, 1] = history.force[1]
            slid[step] = history.slid
        return history
    deepest = 0.0
    for step in range(len(normal)):
        deepest = max(deepest, depth_under(history, normal[step]))
    stretch = springs_for(history, deepest)
    before = history.depth
    for step in range(len(normal)):
        depth = depth_under(history, normal[step])
        x, y, slid[step] = move_springs(
            history, stretch, before, depth, moved[step, 0], moved[step, 1]
        )
        friction[step, 0] = x
        friction[step, 1] = y
        before = depth
    last = len(normal) - 1
    return with_state(history, before, stretch, friction[last].copy(), slid[last])


@compiled
def energy_in_sliding(history: TangentialHistory, load: float) -> float:
    """Return the work that stretches a contact along the plate, while all of it slides up
    to a normal force [J].
    """
    return float(
        history.sliding_energy
        * history.coefficient
        * load
        * history.ratio
        * depth_under(history, load)
    )


@compiled
def lost_in_microslip(
    history: TangentialHistory, normal: Vector, friction: Matrix, moved: Matrix, slid: Vector
) -> float:
    """Return what friction took on a way of T steps [J], but while all of the contact slid.

    Less its elastic energy, where it slides at the end.

    Parameters
    ----------
    history : TangentialHistory
        The law.
    normal : array, shape (T + 1,)
        Normal forces at the ends of the steps [N].
    friction : array, shape (T + 1, 2)
        Friction forces there [N].
    moved : array, shape (T, 2)
        Displacement of the surfaces past each other in each step [m].
    slid : array, shape (T + 1,)
        How far all of the contact slid in the step before [m].
    """
    lost = 0.0
    for step in range(len(moved)):
        load_before = max(normal[step], 0.0)
        load = max(normal[step + 1], 0.0)
        slides_before = slid[step] > 0.0 or load_before == 0.0
        slides = slid[step + 1] > 0.0 or load == 0.0
        if slides and slides_before:
            lost += energy_in_sliding(history, load) - energy_in_sliding(history, load_before)
            continue
        # the work of friction by the trapezoidal rule, less that while all of the contact slid
        for direction in range(2):
            lost += (
                0.5
                * (friction[step + 1, direction] + friction[step, direction])
                * moved[step, direction]
            )
        lost -= history.coefficient * 0.5 * (load + load_before) * slid[step + 1]
    return lost
