"""The motion along the plate during contacts that the core follows along their first slip."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import law_addresses
from vibroimpact.contact.friction.law import CompliantFriction, FrictionLaw, ImpulsiveFriction
from vibroimpact.contact.pair import hertz_stiffness
from vibroimpact.dynamics.core import normal_records as records
from vibroimpact.dynamics.core.sphere_contact import (
    Change,
    FirstSlip,
    end_contacts,
    slide_freely,
    slide_impulsively,
    write_first_slips,
    write_states_along,
)
from vibroimpact.dynamics.core.sphere_records import RubbedSphere, SphereState
from vibroimpact.dynamics.law_coefficients import coefficients_of
from vibroimpact.dynamics.oblique.normal_motion import NormalMotion
from vibroimpact.dynamics.oblique.state import Sphere, State, energy_taken

_ROUNDING = 1e-5
"""Error of the rate of the depth at release, as a part of the largest."""


@dataclass(frozen=True)
class ObliqueContact:
    """The motion along the plate during contacts of B drops.

    `sphere`, `before`: the spheres, and their states at first touch. `slips`: of each the members
    of `FirstSlip` (B, 4). `time`: since first touch [s] (B, G). `paths`: velocities of the contact
    points [m/s], displacements [m] and friction against the slip [N] (B, 3, G). `changes`: of each
    the members of `Change` (B, 5). `microslip`: energy lost while a part of the contact sticks [J]
    (B,). `end`: the states at the end.
    """

    sphere: Sphere
    before: State
    slips: Floats
    time: Floats
    paths: Floats
    changes: Floats
    microslip: Floats
    end: State

    @property
    def duration(self) -> Floats:
        """Durations of the contacts [s]."""
        return self.time[:, -1]

    def of(self, drop: int) -> ObliqueContact:
        """Return the motion of one drop."""
        here = np.array([drop])
        return ObliqueContact(
            self.sphere.take(here),
            self.before.take(here),
            self.slips[here],
            self.time[here],
            self.paths[here],
            self.changes[here],
            self.microslip[here],
            self.end.take(here),
        )

    def at(self, time: Floats) -> tuple[State, Floats, Floats]:
        """Return states of one drop, friction on it [N] (2, T) and energy taken [J] (T,),
        at times since first touch [s].
        """
        # a drop along the normal does not load it
        from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

        kept = np.append(True, np.diff(self.time[0]) > 0.0)
        times = self.time[0, kept]
        velocity, displacement, force = self.paths[0][:, kept]
        path = CubicHermiteSpline(times, displacement, velocity)
        now = np.minimum(time, times[-1])
        slip = FirstSlip(*self.slips[0].tolist())
        states = np.empty((len(now), len(SphereState._fields)))
        write_states_along(
            RubbedSphere(*self.sphere.rows(None)[0].tolist()),
            SphereState(*self.before.rows[0].tolist()),
            slip,
            Change(*self.changes[0].tolist()),
            now,
            path(now, 1),
            path(now),
            float(times[-1]),
            states,
        )
        state = State.of_rows(states)
        friction = -np.outer(slip[:2], PchipInterpolator(times, force)(now))
        return state, friction, energy_taken(self.sphere, self.before, state)


def collide(
    law: FrictionLaw | None, normal: NormalMotion, sphere: Sphere, before: State
) -> ObliqueContact:
    """Return the motion along the plate during contacts.

    Parameters
    ----------
    law : FrictionLaw or None
        The friction law, of B contacts; None if there is no friction.
    normal : NormalMotion
        Their normal motion.
    sphere : Sphere
        The spheres.
    before : State
        Their states at first touch.
    """
    spheres = sphere.rows(law)
    starts = before.rows
    slips = np.empty((len(spheres), len(FirstSlip._fields)))
    write_first_slips(spheres, starts, slips)
    paths, microslip = slide(law, normal, slips, sphere.tangential_mass)
    changes = np.empty((len(spheres), len(Change._fields)))
    ends = np.empty_like(starts)
    end_contacts(spheres, starts, slips, normal.rows, normal.steps, paths, changes, ends)
    time = normal.rows[:, records.TIME]
    end = State.of_rows(ends)
    return ObliqueContact(sphere, before, slips, time, paths, changes, microslip, end)


def slide(
    law: FrictionLaw | None, normal: NormalMotion, slips: Floats, mass: Floats
) -> tuple[Floats, Floats]:
    """Return the sliding of contacts: velocities of the contact points [m/s], displacements [m] and
    friction against the slip [N] (B, 3, G), and the energy lost while a part of the contact sticks
    [J] (B,).

    Parameters
    ----------
    law : FrictionLaw or None
        The friction law; None if there is no friction.
    normal : NormalMotion
        Normal motion of the contacts.
    slips : array, shape (B, 4)
        Of each the members of `FirstSlip`.
    mass : array, shape (B,)
        Effective masses of the tangential motion [kg].
    """
    rows = normal.rows
    size, _, points = rows.shape
    paths = np.empty((size, 3, points))
    microslip = np.zeros(size)
    if isinstance(law, CompliantFriction):
        # a drop without such friction does not load it
        from vibroimpact.dynamics.core.sliding_paths import slide_contacts

        contacts = np.empty((size, 6))
        contacts[:, 0] = hertz_stiffness(law.effective_modulus, law.effective_radius)
        contacts[:, 1] = 2.0 * law.effective_shear_modulus * np.sqrt(law.effective_radius)
        contacts[:, 2] = law.kappa
        contacts[:, 3] = slips[:, 2]
        contacts[:, 4] = mass
        contacts[:, 5] = slips[:, 3]
        growing, shrinking = law.stretching
        of_law = (float(growing), float(shrinking), law.slips_at_rim, law.sliding_energy)
        slide_contacts(*of_law, _ROUNDING, contacts, rows, normal.steps, paths, microslip)
    elif isinstance(law, ImpulsiveFriction):
        with coefficients_of(law, size) as coefficients:
            slide_impulsively(
                law_addresses(type(law)), coefficients, slips, mass, rows, normal.steps, paths
            )
    else:
        slide_freely(slips, rows, paths)
    return paths, microslip
