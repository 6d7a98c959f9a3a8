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

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.records import Real, Vector
from vibroimpact.dynamics.core.tangential_history import TangentialHistory, history_after


class RollingSphere(NamedTuple):
    """A sphere whose rolling is resisted.

    mass [kg]. turn: radius squared over moment of inertia [1/kg]. rolling_coefficient. gravity
    (2,): along the plate [m/s^2].
    """

    mass: Real
    turn: Real
    rolling_coefficient: Real
    gravity: Vector


@compiled(lambda t: t.tuple(t.real, t.real, t.real)(t.real, t.real, t.real))
def slowed(turning_x: float, turning_y: float, most: float) -> tuple[float, float, float]:
    """Return what a moment leaves of w that can take `most` of it [m/s], and how much
    more it could have taken.
    """
    speed = math.hypot(turning_x, turning_y)
    if speed > most:
        kept = 1.0 - most / speed
        return turning_x * kept, turning_y * kept, 0.0
    return 0.0, 0.0, most - speed


@compiled(
    lambda t: t.void(
        t.of(RollingSphere),
        t.of(TangentialHistory),
        t.vector,
        t.vector,
        t.vector,
        t.matrix,
        t.matrix,
        t.matrix,
        t.matrix,
        t.vector,
    )
)
def march_resisted(
    sphere: RollingSphere,
    history: TangentialHistory,
    time: Floats,
    force: Floats,
    impulse: Floats,
    velocity: Floats,
    turning: Floats,
    friction: Floats,
    moved: Floats,
    slid: Floats,
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
        rubs = 0.5 * (pressed / mean if mean > 0.0 else length)
        most = 0.5 * sphere.turn * sphere.rolling_coefficient * pressed
        slows = rubs / sphere.mass
        turns = rubs * sphere.turn
        pulled_x = 0.5 * length * sphere.gravity[0]
        pulled_y = 0.5 * length * sphere.gravity[1]
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
