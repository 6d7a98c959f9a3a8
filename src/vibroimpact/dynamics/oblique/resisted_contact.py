"""Contacts of rigid bodies in which rolling is resisted while friction is elastic,
marched by the core.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.dynamics.core.cubics import values_in_parts
from vibroimpact.dynamics.core.resisted_contact import RollingSphere, march_resisted
from vibroimpact.dynamics.core.tangential_history import lost_in_microslip
from vibroimpact.dynamics.core.twisting import Twisting, slow_spin
from vibroimpact.dynamics.oblique.normal_motion import NormalMotion
from vibroimpact.dynamics.oblique.state import Sphere, State, energy_taken
from vibroimpact.dynamics.oblique.tangential_history import tangential_history

_PARTS = 16
"""Steps in each of the normal motion's: spins after the contact are then within 1e-3 of
the largest; where the slip turns it is 3e-4.
"""

_MOST_PARTS = 1024
_MOST_TURNING = 0.2
"""Angle by which the free oscillation of a contact that sticks turns in a step at most
[rad], until there are `_MOST_PARTS`.
"""


@dataclass(frozen=True)
class ResistedContact:
    """The motion along the plate during the contact of one drop; see `ContactAlong`.

    `sphere`, `before`: the sphere, and its state at first touch. `time`: since then [s] (G,).
    `states`: then. `friction`: force on the sphere [N] (2, G). `microslip`: energy lost while a
    part of the contact sticks [J] (1,).
    """

    sphere: Sphere
    before: State
    time: Floats
    states: State
    friction: Floats
    microslip: Floats

    @property
    def duration(self) -> Floats:
        """The duration of the contact [s] (1,)."""
        return self.time[-1:]

    @property
    def end(self) -> State:
        """The state at the end of the contact."""
        return self.states.take(np.array([-1]))

    def of(self, drop: int) -> ResistedContact:
        """Return itself: it belongs to one drop."""
        return self

    def at(self, time: Floats) -> tuple[State, Floats, Floats]:
        """Return states, friction on the sphere [N] (2, T) and energy taken [J] (T,), at
        times since first touch [s] (T,).
        """
        # a drop along the normal does not load it
        from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

        now = np.minimum(time, self.time[-1])
        # of a force that jumps what comes after it
        passed = np.flatnonzero(np.append(np.diff(self.time) > 0.0, True))
        times, states, friction = (
            self.time[passed],
            self.states.take(passed),
            self.friction[:, passed],
        )
        path = CubicHermiteSpline(times, states.position, states.velocity, axis=1)
        smooth = PchipInterpolator(
            times, np.concatenate([states.velocity, states.spin, friction]), axis=1
        )(now)
        state = State(path(now), smooth[:2], smooth[2:5])
        return state, smooth[5:], energy_taken(self.sphere, self.before, state)


def resisted_contact(
    law: CompliantFriction, normal: NormalMotion, sphere: Sphere, before: State
) -> ResistedContact:
    """Return the motion of one drop along the plate during a contact in which rolling is resisted.

    Parameters
    ----------
    law : CompliantFriction
        Of one drop.
    normal : NormalMotion
        The normal motion of its contact.
    sphere : Sphere
        The sphere.
    before : State
        Its state at first touch.
    """
    time, force, impulse = _refined(normal, _parts(law, normal, sphere))
    rolling = RollingSphere(
        mass=float(sphere.mass[0]),
        turn=float(sphere.radius[0] ** 2 / sphere.inertia[0]),
        rolling_coefficient=float(law.rolling_coefficient),
        gravity=sphere.gravity[:, 0].copy(),
    )
    velocities = np.empty((len(time), 2))
    turnings = np.empty((len(time), 2))
    frictions = np.zeros((len(time), 2))
    moved = np.empty((len(time) - 1, 2))
    slid = np.zeros(len(time))
    velocities[0] = before.velocity[:, 0]
    turnings[0] = sphere.turning(before)[:, 0]
    history = tangential_history(law, float(force.max()))
    march_resisted(
        rolling, history, time, force, impulse, velocities, turnings, frictions, moved, slid
    )
    elapsed = np.diff(time)
    position = np.zeros_like(velocities)
    np.cumsum(0.5 * elapsed[:, None] * (velocities[1:] + velocities[:-1]), axis=0, out=position[1:])
    slips = np.hypot(*(velocities + turnings).T)
    spins = _spins_about_normal(law, time, force, np.hypot(*frictions.T), slips, sphere, before)
    states = State(
        before.position + position.T,
        velocities.T,
        np.stack([turnings[:, 1] / sphere.radius, -turnings[:, 0] / sphere.radius, spins]),
    )
    microslip = lost_in_microslip(history, force, frictions, moved, slid)
    return ResistedContact(sphere, before, time, states, -frictions.T, np.array([microslip]))


def _parts(law: CompliantFriction, normal: NormalMotion, sphere: Sphere) -> int:
    """Return how many steps there are in each of the normal motion's."""
    stiffness = 2.0 * law.effective_shear_modulus * law.contact_radius(normal.force.max())
    longest = np.diff(normal.time[:, 0]).max()
    turning = float(np.sqrt(stiffness / sphere.tangential_mass[0]) * longest)
    return int(min(max(np.ceil(turning / _MOST_TURNING), _PARTS), _MOST_PARTS))


def _refined(normal: NormalMotion, parts: int) -> tuple[Floats, Floats, Floats]:
    """Return times [s], normal forces [N] and their impulses so far [N s] (G,) of one
    drop, with `parts` steps for each of the motion's.
    """
    inside = normal.steps[:, None] > 0.0  # where two parts meet nothing lies between

    def at(values: Floats, slopes: Floats) -> Floats:
        between = values_in_parts(
            np.ascontiguousarray(values[:, 0]), np.ascontiguousarray(slopes[:, 0]), parts
        )
        return np.append(values[0, 0], np.where(inside, between, values[1:]).ravel())

    time = np.maximum.accumulate(at(normal.time, normal.pace))
    force = np.maximum(at(normal.force, normal.force_slope), 0.0)
    # by the end of each step of the motion
    bound = np.append(normal.pressed[:1, 0], np.repeat(normal.pressed[1:, 0], parts))
    impulse = np.minimum(
        np.maximum.accumulate(at(normal.impulse, normal.pace * normal.force)), bound
    )
    kept = np.append(True, (np.diff(time) > 0.0) | (np.diff(force) != 0.0))
    return time[kept], force[kept], impulse[kept]


def _spins_about_normal(
    law: CompliantFriction,
    time: Floats,
    force: Floats,
    friction: Floats,
    slip: Floats,
    sphere: Sphere,
    before: State,
) -> Floats:
    """Return the spins about the normal of one drop [rad/s] (G,), which twisting slows;
    they do not act on the motion along the plate.
    """
    spin = float(before.spin[2, 0])
    if spin == 0.0:
        return np.zeros_like(time)
    twisting = Twisting(float(law.coefficient), float(law.contact_radius(np.ones(1))[0]))
    spins = np.empty_like(time)
    slow_spin(twisting, abs(spin), float(sphere.inertia[0]), time, force, friction, slip, spins)
    return np.asarray(np.sign(spin) * spins)
