r"""Contacts of rigid bodies in which rolling is resisted while friction is elastic, marched in
time.

With the slip s of the contact point, of which the spin makes the part w, the friction Q that the
law makes of the way of the slip, the normal force F, and the moment M of rolling resistance

.. math:: m \dot v = m g - Q,\qquad I \dot w = -R^2 Q - R M,\qquad s = v + w

M is :math:`\mu_r R F` against w, and where w is zero what keeps it so, up to that. Friction and
moment act together: a spin that the moment
holds leaves friction the whole mass to slow, one that it does not hold only the effective mass of
the contact point.

Each step is half a kick, a drift and half a kick (leapfrog, of order two). Each kick takes from w
what the moment can take of it, and no more, so that w ends at zero and stays there without a
special case.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.cubics import cubic_at
from vibroimpact.dynamics.core.friction_records import (
    HERTZ,
    KAPPA,
    MODULUS,
    RADIUS,
    SPRING,
    Cubic,
    Rubbing,
)
from vibroimpact.dynamics.core.normal_records import (
    FORCE,
    FORCE_SLOPE,
    IMPULSE,
    PACE,
    TIME,
    NormalPath,
)
from vibroimpact.dynamics.core.sphere_records import (
    RubbedSphere,
    SphereState,
    tangential_mass,
    turning_of,
    twisting_of,
)
from vibroimpact.dynamics.core.tangential_history import (
    SPRINGS,
    TangentialHistory,
    history_after,
    lost_in_microslip,
)
from vibroimpact.dynamics.core.twisting import slow_spin

_PARTS = 16
"""Steps in each of the normal motion's: spins after the contact are then within 1e-3 of the
largest; where the slip turns it is 3e-4.
"""

_MOST_PARTS = 1024
_MOST_TURNING = 0.2
"""Angle by which the free oscillation of a contact that sticks turns in a step at most [rad], until
there are `_MOST_PARTS`.
"""


class RollingSphere(NamedTuple):
    """A sphere whose rolling is resisted.

    mass [kg]. turn: radius squared over moment of inertia [1/kg]. rolling_coefficient. gravity
    (2,): along the plate [m/s^2].
    """

    mass: float
    turn: float
    rolling_coefficient: float
    gravity: Vector


class ResistedPath(NamedTuple):
    """The motion along the plate during a contact in which rolling is resisted, at G times.

    time: since first touch [s] (G,). moved (G, 2): way of the centre since then [m]. velocity,
    turning (G, 2): v and w [m/s]. spin (G,): about the normal [rad/s]. friction (G, 2): Q [N].
    microslip: energy lost while a part of the contact sticks [J].
    """

    time: Vector
    moved: Matrix
    velocity: Matrix
    turning: Matrix
    spin: Vector
    friction: Matrix
    microslip: float


@compiled
def slowed(turning_x: float, turning_y: float, most: float) -> tuple[float, float, float]:
    """Return what a moment leaves of w that can take `most` of it [m/s], and how much
    more it could have taken.
    """
    speed = math.hypot(turning_x, turning_y)
    if speed > most:
        kept = 1.0 - most / speed
        return turning_x * kept, turning_y * kept, 0.0
    return 0.0, 0.0, most - speed


@compiled
def march_resisted(
    sphere: RollingSphere,
    history: TangentialHistory,
    time: Vector,
    force: Vector,
    impulse: Vector,
    velocity: Matrix,
    turning: Matrix,
    friction: Matrix,
    moved: Matrix,
    slid: Vector,
) -> None:
    """Write the motion along the plate during a contact, at G times.

    Parameters
    ----------
    sphere : RollingSphere
        The sphere.
    history : TangentialHistory
        Of its contact at first touch.
    time, force, impulse : array, shape (G,)
        Time [s], normal force [N] and its impulse so far [N s].
    velocity, turning : array, shape (G, 2)
        Room for v and w [m/s], known at first touch.
    friction : array, shape (G, 2)
        Room for Q [N], known at first touch.
    moved : array, shape (G - 1, 2)
        Room for the way of the slip in each step [m].
    slid : array, shape (G,)
        Room for how far all of the contact slid in each step [m].
    """
    for step in range(len(time) - 1):
        length = time[step + 1] - time[step]
        pressed = impulse[step + 1] - impulse[step]
        mean = 0.5 * (force[step] + force[step + 1])
        # half a step, such that a friction of a constant part of the normal force has exactly that
        # part of its impulse
        rubs = 0.5 * length
        if mean > 0.0:
            rubs = 0.5 * (pressed / mean)
        most = 0.5 * sphere.turn * sphere.rolling_coefficient * pressed
        slows = rubs / sphere.mass
        turns = rubs * sphere.turn
        pulled_x = 0.5 * length * sphere.gravity[0]
        pulled_y = 0.5 * length * sphere.gravity[1]
        # half a kick with the friction at the start of the step, the drift, and half a kick with
        # that at its end
        velocity_x = velocity[step, 0] + pulled_x - slows * friction[step, 0]
        velocity_y = velocity[step, 1] + pulled_y - slows * friction[step, 1]
        turning_x, turning_y, unused = slowed(
            turning[step, 0] - turns * friction[step, 0],
            turning[step, 1] - turns * friction[step, 1],
            most,
        )
        moved[step, 0] = length * (velocity_x + turning_x)
        moved[step, 1] = length * (velocity_y + turning_y)
        history = history_after(history, force[step + 1], moved[step, 0], moved[step, 1])
        friction[step + 1, 0] = history.force[0]
        friction[step + 1, 1] = history.force[1]
        slid[step + 1] = history.slid
        velocity[step + 1, 0] = velocity_x + pulled_x - slows * history.force[0]
        velocity[step + 1, 1] = velocity_y + pulled_y - slows * history.force[1]
        turning_x, turning_y, _ = slowed(
            turning_x - turns * history.force[0],
            turning_y - turns * history.force[1],
            most + unused,
        )
        turning[step + 1, 0] = turning_x
        turning[step + 1, 1] = turning_y


@compiled
def history_at_touch(
    rubbing: Rubbing, coefficients: Vector, coefficient: float, rim: float
) -> TangentialHistory:
    """Return the history of a contact before first touch.

    `coefficient`: of friction. `rim`: radius of about the largest contact that will come [m], for
    which the springs of a row are close enough to each other.
    """
    springs = SPRINGS if rubbing.at_rim else 0
    return TangentialHistory(
        rubbing.at_rim,
        rubbing.growing,
        rubbing.shrinking,
        coefficients[HERTZ],
        coefficients[RADIUS],
        coefficients[SPRING],
        coefficient,
        coefficients[KAPPA],
        rubbing.sliding_energy,
        rim / SPRINGS,
        0.0,
        np.zeros((2, springs)),
        np.zeros(2),
        0.0,
    )


@compiled
def rim_of(coefficients: Vector, force: Vector) -> float:
    """Return the radius of the largest contact under normal forces (G,) [m]."""
    largest = 0.0
    for point in range(len(force)):
        largest = max(largest, force[point])
    # Hertz: a^3 = 3 F R/(4 E*)
    return float(np.cbrt(0.75 * largest * coefficients[RADIUS] / coefficients[MODULUS]))


@compiled
def parts_of(sphere: RubbedSphere, coefficients: Vector, normal: NormalPath) -> int:
    """Return how many steps there are in each of the normal motion's."""
    time = normal.rows[TIME]
    longest = 0.0
    for point in range(1, len(time)):
        longest = max(longest, time[point] - time[point - 1])
    stiffness = coefficients[SPRING] * rim_of(coefficients, normal.rows[FORCE])
    turning = math.sqrt(stiffness / tangential_mass(sphere)) * longest
    return int(min(max(math.ceil(turning / _MOST_TURNING), _PARTS), _MOST_PARTS))


@compiled
def refined(normal: NormalPath, parts: int) -> Matrix:
    """Return times [s], normal forces [N] and their impulses so far [N s] (3, G), with `parts`
    steps for each of the motion's.
    """
    rows = normal.rows
    points = rows.shape[1]
    fine = np.empty((3, parts * (points - 1) + 1))
    time = rows[TIME, 0]
    force = max(rows[FORCE, 0], 0.0)
    pressed = rows[IMPULSE, 0]  # by the end of each step of the motion
    highest = pressed
    fine[0, 0] = time
    fine[1, 0] = force
    fine[2, 0] = pressed
    count = 1
    for point in range(1, points):
        before = point - 1
        pressed = max(pressed, rows[IMPULSE, point])
        times = Cubic(rows[TIME, before], rows[PACE, before], rows[TIME, point], rows[PACE, point])
        forces = Cubic(
            rows[FORCE, before],
            rows[FORCE_SLOPE, before],
            rows[FORCE, point],
            rows[FORCE_SLOPE, point],
        )
        impulses = Cubic(
            rows[IMPULSE, before],
            rows[PACE, before] * rows[FORCE, before],
            rows[IMPULSE, point],
            rows[PACE, point] * rows[FORCE, point],
        )
        for part in range(parts):
            time_before = time
            force_before = force
            share = (part + 1) / parts
            later = rows[TIME, point]
            force = rows[FORCE, point]
            impulse = rows[IMPULSE, point]
            if normal.steps[before] > 0.0:  # where two parts meet nothing lies between
                later, _ = cubic_at(times, share)
                force, _ = cubic_at(forces, share)
                impulse, _ = cubic_at(impulses, share)
            time = max(time, later)
            force = max(force, 0.0)
            highest = max(highest, impulse)
            if time > time_before or force != force_before:
                fine[0, count] = time
                fine[1, count] = force
                fine[2, count] = min(highest, pressed)
                count += 1
    return fine[:, :count].copy()


@compiled
def spins_about_normal(
    sphere: RubbedSphere,
    spin: float,
    time: Vector,
    force: Vector,
    friction: Matrix,
    slip: Matrix,
) -> Vector:
    """Return a spin about the normal [rad/s] (G,), which twisting slows.

    It does not act on the motion along the plate. `friction` [N], `slip` [m/s]: (G, 2).
    """
    spins = np.zeros(len(time))
    if spin == 0.0:
        return spins
    rubs = np.empty(len(time))
    speeds = np.empty(len(time))
    for point in range(len(time)):
        rubs[point] = math.hypot(friction[point, 0], friction[point, 1])
        speeds[point] = math.hypot(slip[point, 0], slip[point, 1])
    slow_spin(twisting_of(sphere), abs(spin), sphere.inertia, time, force, rubs, speeds, spins)
    if spin < 0.0:
        for point in range(len(time)):
            spins[point] = -spins[point]
    return spins


@compiled
def resisted_path(
    rubbing: Rubbing,
    coefficients: Vector,
    sphere: RubbedSphere,
    begun: SphereState,
    normal: NormalPath,
) -> ResistedPath:
    """Return the motion along the plate during a contact in which rolling is resisted.

    Parameters
    ----------
    rubbing : Rubbing
        The friction law.
    coefficients : array, shape (5,)
        Of it in this contact; see `friction_records`.
    sphere : RubbedSphere
        The sphere.
    begun : SphereState
        Its state at first touch.
    normal : NormalPath
        The normal motion.
    """
    fine = refined(normal, parts_of(sphere, coefficients, normal))
    time = fine[0]
    force = fine[1]
    number = len(time)
    velocity = np.empty((number, 2))
    turning = np.empty((number, 2))
    friction = np.zeros((number, 2))
    way = np.empty((number - 1, 2))
    slid = np.zeros(number)
    velocity[0, 0] = begun.velocity_x
    velocity[0, 1] = begun.velocity_y
    turning[0, 0], turning[0, 1] = turning_of(sphere, begun)
    gravity = np.empty(2)
    gravity[0] = sphere.gravity_x
    gravity[1] = sphere.gravity_y
    turn = sphere.radius * sphere.radius / sphere.inertia
    rolling = RollingSphere(sphere.mass, turn, sphere.rolling_coefficient, gravity)
    rim = rim_of(coefficients, force)
    history = history_at_touch(rubbing, coefficients, sphere.coefficient, rim)
    march_resisted(rolling, history, time, force, fine[2], velocity, turning, friction, way, slid)
    moved = np.zeros((number, 2))
    slip = np.empty((number, 2))
    for axis in range(2):
        for point in range(number):
            slip[point, axis] = velocity[point, axis] + turning[point, axis]
            if point > 0:
                mean = 0.5 * (time[point] - time[point - 1])
                mean *= velocity[point, axis] + velocity[point - 1, axis]
                moved[point, axis] = moved[point - 1, axis] + mean
    spin = spins_about_normal(sphere, begun.spin_z, time, force, friction, slip)
    microslip = lost_in_microslip(history, force, friction, way, slid)
    return ResistedPath(time, moved, velocity, turning, spin, friction, microslip)


@compiled
def resisted_end(sphere: RubbedSphere, begun: SphereState, path: ResistedPath) -> SphereState:
    """Return the state of a sphere at the end of such a contact."""
    last = len(path.time) - 1
    return SphereState(
        begun.x + path.moved[last, 0],
        begun.y + path.moved[last, 1],
        path.velocity[last, 0],
        path.velocity[last, 1],
        path.turning[last, 1] / sphere.radius,
        -path.turning[last, 0] / sphere.radius,
        path.spin[last],
    )
