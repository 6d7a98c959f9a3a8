"""Friction of a rigid sphere on a surface that moves: stated for the core, and read back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.dynamics.core import surface_friction_records as records
from vibroimpact.dynamics.core.surface_friction_motions import slowing
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere
from vibroimpact.dynamics.core.tangential_history import TangentialHistory
from vibroimpact.dynamics.motion.along import Sphere, State
from vibroimpact.dynamics.motion.collocation import Rule
from vibroimpact.dynamics.oblique.tangential_history import tangential_history
from vibroimpact.dynamics.statement.tolerance import DEFAULT_TOLERANCE

_LONGEST_STRETCH = 0.03  # of the duration of a contact, at the default tolerance
_ORDER = 4  # of the error in the length of stretches, about


def surface_friction_at_touch(
    law: CompliantFriction, largest_force: float, sphere: Sphere, state: State, directions: int
) -> SlidingSphere:
    """Return the friction of one drop at first touch.

    Parameters
    ----------
    law : CompliantFriction
        Of one drop.
    largest_force : float
        About the largest normal force that will come [N].
    sphere, state : Sphere, State
        The sphere, and its motion along the plate.
    directions : int
        Of friction: 2, or 5 where moments act.
    """
    about_x, about_y, about_z = state.spin[:, 0]
    return _no_surface_friction()._replace(
        directions=directions,
        rolling_coefficient=float(law.rolling_coefficient),
        mass=float(sphere.tangential_mass[0]),
        radius=float(sphere.radius[0]),
        inertia=float(sphere.inertia[0]),
        pull=sphere.gravity[:, 0].copy(),
        velocity=sphere.slip(state)[:, 0].copy(),
        spin=np.array([-about_y, about_x, about_z]),
        history=tangential_history(law, largest_force),
    )


def _no_surface_friction() -> SlidingSphere:
    """Return the friction of a contact that has none."""
    unused = TangentialHistory(
        False, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, np.zeros((2, 0)), np.zeros(2), 0.0
    )
    return SlidingSphere(
        directions=0,
        rolling_coefficient=0.0,
        mass=1.0,
        radius=1.0,
        inertia=1.0,
        pull=np.zeros(2),
        velocity=np.zeros(2),
        displacement=np.zeros(2),
        spin=np.zeros(3),
        force=np.zeros(2),
        turned=np.zeros(3),
        turned_way=np.zeros(2),
        normal=0.0,
        work=0.0,
        microslip=0.0,
        history=unused,
    )


NO_FRICTION = _no_surface_friction()
"""Friction of a contact that has none."""


def longest_with_friction(tolerance: float) -> float:
    """Return the largest length of a stretch with friction over the duration of a contact [-].

    The surfaces begin and cease to slip within stretches, which the balance of energy does not
    show. At the default tolerance the velocities along the plate after an impact are then known to
    1e-4 of those before.
    """
    ratio: float = (tolerance / DEFAULT_TOLERANCE) ** (1.0 / _ORDER)
    return _LONGEST_STRETCH * ratio


@dataclass(frozen=True)
class SlidingState:
    """Friction of one drop and motion of its contact point at an end of a stretch.

    The contact point is that of the sphere; the fields are as in `SlidingSphere`.
    """

    velocity: Floats
    displacement: Floats
    force: Floats
    turned: Floats
    turned_way: Floats
    work: float
    microslip: float

    @classmethod
    def of(cls, numbers: Floats) -> SlidingState:
        """Return the state of which the core has written the numbers (13,)."""
        return cls(
            velocity=numbers[records.VELOCITY_X : records.VELOCITY_Y + 1],
            displacement=numbers[records.DISPLACEMENT_X : records.DISPLACEMENT_Y + 1],
            force=numbers[records.FORCE_X : records.FORCE_Y + 1],
            turned=numbers[records.TURNED_X : records.TURNED_Z + 1],
            turned_way=numbers[records.TURNED_WAY_X : records.TURNED_WAY_Y + 1],
            work=float(numbers[records.WORK]),
            microslip=float(numbers[records.MICROSLIP]),
        )


@dataclass(frozen=True)
class SlidingStretch:
    """Friction through a stretch of contact of a length [s].

    `sphere`: what stays the same through the contact. `start`, `end`: at the ends. `force`: of
    friction, against the slip [N], and `slip`: velocity of the contact point of the sphere past the
    surface [m/s], at the nodes (2, N); where moments act also these [N m], and the spin past the
    surface [rad/s] (5, N).
    """

    rule: Rule
    length: float
    sphere: SlidingSphere
    start: SlidingState
    end: SlidingState
    force: Floats
    slip: Floats

    def at(self, time: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return the motion of the contact point, friction and energy taken, at times [s] (T,).

        Velocity and displacement are (2, T), friction is (2 or 5, T), and energy (T,).
        """
        rule = self.rule
        x = rule.unmap_time(time / self.length)
        to_time = self.length * rule.integral_to(x)

        # gravity in closed form, friction by the rule: u'' = g - Q/m_t
        pull = self.sphere.pull[:, None]
        start_velocity = self.start.velocity[:, None]
        start_displacement = self.start.displacement[:, None]
        deceleration = slowing(self.sphere, np.ascontiguousarray(self.force)).T
        velocity_lost = self.length * (rule.integral @ deceleration)
        velocity = start_velocity + pull * time - (to_time @ deceleration).T
        free = start_displacement + (start_velocity + 0.5 * pull * time) * time
        displacement = free - (to_time @ velocity_lost).T

        # the moments at the start are about those at the first node
        force_at_start = np.append(self.start.force, self.force[2:, 0])
        forces = np.concatenate([force_at_start[:, None], self.force], axis=1)
        force = forces @ rule.weights(x)
        power = (self.force * self.slip).sum(axis=0)
        work = self.start.work + to_time @ power
        return velocity, displacement, force, work

    def turned(self, time: Floats) -> tuple[Floats, Floats]:
        """Return the change of spin and of displacement by moments at times since the start [s].

        The spin [rad/s] is (3, T), and the displacement [m] (2, T), at times (T,).
        """
        rule = self.rule
        start = self.start
        radius = self.sphere.radius
        spin = start.turned[:, None] + 0.0 * time
        displacement = start.turned_way[:, None] + radius * start.turned[:2, None] * time
        if len(self.force) == 2:  # no moments act
            return spin, displacement
        to_time = self.length * rule.integral_to(rule.unmap_time(time / self.length))
        angular_deceleration = (self.force[2:] / self.sphere.inertia).T
        spin_lost = self.length * (rule.integral @ angular_deceleration[:, :2])
        return (
            spin - (to_time @ angular_deceleration).T,
            displacement - radius * (to_time @ spin_lost).T,
        )
