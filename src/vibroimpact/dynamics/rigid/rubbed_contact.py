"""The motion along the plate during contacts of rigid bodies with friction, which the core
follows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import law_addresses
from vibroimpact.contact.friction.law import CompliantFriction, FrictionLaw, ImpulsiveFriction
from vibroimpact.contact.pair import hertz_stiffness
from vibroimpact.dynamics.core import friction_records as records
from vibroimpact.dynamics.core.normal_records import TIME
from vibroimpact.dynamics.core.resisted_contact import ResistedPath, resisted_path
from vibroimpact.dynamics.core.rubbing import SlidPath, rub_pairs, slid_path, solved_path
from vibroimpact.dynamics.core.sphere_contact import write_states_along
from vibroimpact.dynamics.core.sphere_records import RubbedSphere, SphereState
from vibroimpact.dynamics.motion.along import Sphere, State, energy_taken
from vibroimpact.dynamics.motion.impact_conditions import ImpactConditions
from vibroimpact.dynamics.motion.law_coefficients import coefficients_of

# of each phase of a contact at the default tolerance: the slip velocity at its end is within 2e-4
# of that at first touch
_STEPS = 16
_DEFAULT_TOLERANCE = 1e-9
_ORDER = 4  # of the error, in the steps
_ROUNDING = 1e-9
_ROUNDING_AT_RELEASE = 1e-5
"""Error of the rate of the depth at release, as a part of the largest."""


def friction_steps(tolerance: float) -> int:
    """Return the number of steps of friction in each phase of a contact."""
    finer: float = (_DEFAULT_TOLERANCE / tolerance) ** (1.0 / _ORDER)
    return _STEPS * max(math.ceil(finer - _ROUNDING), 1)


def rubbing_of(law: FrictionLaw | None) -> records.Rubbing:
    """Return a friction law as the core takes it."""
    kind = records.NO_FRICTION
    addresses = np.zeros(2, dtype=np.int64)
    growing, shrinking, at_rim, sliding_energy = 0, 0, False, 0.0
    if isinstance(law, ImpulsiveFriction):
        kind = records.IMPULSIVE
        addresses = law_addresses(type(law))
    elif isinstance(law, CompliantFriction):
        kind = records.ELASTIC
        growing, shrinking = law.stretching
        at_rim, sliding_energy = law.slips_at_rim, law.sliding_energy
    return records.Rubbing(
        kind=kind,
        addresses=addresses,
        growing=float(growing),
        shrinking=float(shrinking),
        at_rim=at_rim,
        sliding_energy=sliding_energy,
        rounding=_ROUNDING_AT_RELEASE,
    )


@contextmanager
def friction_coefficients(law: FrictionLaw | None, size: int) -> Iterator[Floats]:
    """Give the coefficients of the friction law of each of B drops (B, K), as the core takes
    them.
    """
    if law is None:
        yield np.zeros((size, 0))
    elif isinstance(law, CompliantFriction):
        modulus = law.effective_modulus
        radius = law.effective_radius
        coefficients = np.zeros((size, records.ELASTIC_COEFFICIENTS))
        coefficients[:, records.HERTZ] = hertz_stiffness(modulus, radius)
        coefficients[:, records.SPRING] = 2.0 * law.effective_shear_modulus
        coefficients[:, records.RADIUS] = radius
        coefficients[:, records.MODULUS] = modulus
        coefficients[:, records.KAPPA] = law.kappa
        yield coefficients
    else:
        with coefficients_of(law, size) as coefficients:
            yield coefficients


@dataclass(frozen=True)
class RubbedContact:
    """The motion along the plate during contacts of B drops; see `ContactAlong`.

    It is computed again where it is read.

    Parameters
    ----------
    conditions : ImpactConditions
        The impacts, with the contact law as it is at touch.
    tolerance : float
        Relative error allowed.
    law : FrictionLaw or None
        The friction law.
    sphere : Sphere
        The spheres.
    before : State
        Their states at first touch.
    duration : array, shape (B,)
        Durations of the contacts [s].
    """

    conditions: ImpactConditions
    tolerance: float
    law: FrictionLaw | None
    sphere: Sphere
    before: State
    duration: Floats

    def ends(self) -> tuple[State, Floats]:
        """Return the states at the end, and the energies lost in microslip [J] (B,)."""
        # a drop that does not rub does not load it
        from vibroimpact.dynamics.rigid.line_contact import contact_manner, touches_of

        size = len(self.duration)
        if self.law is None:
            return self.sphere.fly(self.before, self.duration), np.zeros(size)
        law = self.conditions.law
        starts = self.before.rows
        ends = np.empty_like(starts)
        microslips = np.zeros(size)
        with (
            coefficients_of(law, size) as coefficients,
            friction_coefficients(self.law, size) as friction,
        ):
            rub_pairs(
                contact_manner(law, self.tolerance, friction_steps(self.tolerance)),
                coefficients,
                touches_of(self.conditions),
                rubbing_of(self.law),
                friction,
                self.sphere.rows(self.law),
                starts,
                ends,
                microslips,
            )
        return State.of_rows(ends), microslips

    def at(self, time: Floats) -> tuple[State, Floats, Floats]:
        """Return states of one drop, friction on it [N] (2, T) and energy taken [J] (T,), at
        times since first touch [s] (T,).
        """
        sphere = self.sphere
        before = self.before
        if self.law is None:
            state = sphere.fly(before, np.minimum(time, self.duration))
            no_friction = np.zeros((2, len(time)))
            return state, no_friction, np.zeros(len(time))
        times, path = self._path
        now = np.minimum(time, times[-1])
        if isinstance(path, ResistedPath):
            state, friction = _within_resisted(sphere, before, times, path, now)
        else:
            state, friction = _within_slid(sphere, before, times, path, now)
        return state, friction, energy_taken(sphere, before, state)

    @cached_property
    def _path(self) -> tuple[Floats, SlidPath | ResistedPath]:
        """The motion of one drop, and the times at which it is known [s] (G,)."""
        from vibroimpact.dynamics.rigid.line_contact import contact_manner, law_and_bodies

        assert self.law is not None
        manner = contact_manner(self.conditions.law, self.tolerance, friction_steps(self.tolerance))
        held = self.conditions.law.take(0)
        law, bodies = law_and_bodies(held, self.conditions, self.tolerance)
        normal = solved_path(law, bodies, manner)
        sphere = RubbedSphere(*self.sphere.rows(self.law)[0].tolist())
        begun = SphereState(*self.before.rows[0].tolist())
        with friction_coefficients(self.law, 1) as friction:
            drop = rubbing_of(self.law), friction[0], sphere, begun, normal
            if isinstance(self.law, CompliantFriction) and sphere.rolling_coefficient > 0.0:
                resisted = resisted_path(*drop)
                return resisted.time, resisted
            return normal.rows[TIME], slid_path(*drop)


def _within_slid(
    sphere: Sphere, before: State, times: Floats, path: SlidPath, now: Floats
) -> tuple[State, Floats]:
    """Return states, and friction on the sphere [N] (2, T), along its first slip.

    `times`: at which the path is known. `now`: asked for (T,), both since first touch [s].
    """
    # a drop along the normal does not load it
    from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

    kept = np.append(True, np.diff(times) > 0.0)
    times = times[kept]
    velocity, displacement, force = path.path[:, kept]
    smooth = CubicHermiteSpline(times, displacement, velocity)
    states = np.empty((len(now), len(SphereState._fields)))
    write_states_along(
        RubbedSphere(*sphere.rows(None)[0].tolist()),
        SphereState(*before.rows[0].tolist()),
        path.slip,
        path.change,
        now,
        smooth(now, 1),
        smooth(now),
        float(times[-1]),
        states,
    )
    direction = np.array([path.slip.direction_x, path.slip.direction_y])
    return State.of_rows(states), -np.outer(direction, PchipInterpolator(times, force)(now))


def _within_resisted(
    sphere: Sphere, before: State, times: Floats, path: ResistedPath, now: Floats
) -> tuple[State, Floats]:
    """Return the same where rolling is resisted."""
    from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

    # of a force that jumps what comes after it
    kept = np.append(np.diff(times) > 0.0, True)
    times = times[kept]
    position = before.position + path.moved[kept].T
    velocity = path.velocity[kept].T
    # w is the velocity that the spin gives the contact point: w_x = -R omega_y, w_y = R omega_x
    turning_x, turning_y = path.turning[kept].T
    spin_x = turning_y / sphere.radius
    spin_y = -turning_x / sphere.radius
    spins = np.stack([spin_x, spin_y, path.spin[kept]])
    friction = -path.friction[kept].T

    position_at = CubicHermiteSpline(times, position, velocity, axis=1)
    # without overshoot where friction or a spin has a kink
    others = np.concatenate([velocity, spins, friction])
    others_at = PchipInterpolator(times, others, axis=1)
    velocity_now, spins_now, friction_now = np.split(others_at(now), [2, 5])
    return State(position_at(now), velocity_now, spins_now), friction_now
