"""The motion of spheres along the plate and their spin: the state, and its change in
flights and contacts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.dynamics.core.sphere_records import RubbedSphere
from vibroimpact.dynamics.statement.problem import Problem


@dataclass(frozen=True)
class State:
    """Places of the centres [m] (2, B), their velocities along the plate [m/s] (2, B),
    and angular velocities [rad/s] (3, B).
    """

    position: Floats
    velocity: Floats
    spin: Floats

    def take(self, drops: Drops | Bools) -> State:
        """Return the state of some drops."""
        return State(self.position[:, drops], self.velocity[:, drops], self.spin[:, drops])

    @property
    def rows(self) -> Floats:
        """The states as the core has them, one a row (B, 7)."""
        return np.concatenate([self.position, self.velocity, self.spin]).T.copy()

    @classmethod
    def of_rows(cls, rows: Floats) -> State:
        """Return the states that the core has in rows (B, 7)."""
        columns = rows.T
        return cls(columns[:2], columns[2:4], columns[4:])


@dataclass(frozen=True)
class Sphere:
    """Masses [kg], radii [m] and moments of inertia [kg m^2] of B spheres, and
    accelerations of gravity along the plate [m/s^2] (2, B).
    """

    mass: Floats
    radius: Floats
    inertia: Floats
    gravity: Floats

    def take(self, drops: Drops) -> Sphere:
        """Return some of the spheres."""
        return Sphere(
            self.mass[drops], self.radius[drops], self.inertia[drops], self.gravity[:, drops]
        )

    def rows(self, law: FrictionLaw | None) -> Floats:
        """Return the spheres and the law of their friction as the core has them, one a row (B, 8).

        `law`: of one drop, or of all of them.
        """
        rows = np.zeros((len(self.mass), len(RubbedSphere._fields)))
        numbers = [self.mass, self.radius, self.inertia, *self.gravity]
        if law is not None:
            of_one_newton = law.contact_radius(np.ones(len(self.mass)))
            numbers += [law.coefficient, law.rolling_coefficient, of_one_newton]
        for column, values in enumerate(numbers):
            rows[:, column] = values
        return rows

    @property
    def tangential_mass(self) -> Floats:
        """Effective mass of the motion of the contact point [kg]: 2/7 of that of a solid sphere."""
        return np.asarray(1.0 / (1.0 / self.mass + self.radius**2 / self.inertia))

    def turning(self, state: State) -> Floats:
        """Return the part of the spin in the velocity of the contact point along the
        plate [m/s] (2, B).
        """
        return np.asarray(self.radius * np.stack([-state.spin[1], state.spin[0]]))

    def slip(self, state: State) -> Floats:
        """Return the velocity of the contact point along the plate [m/s] (2, B)."""
        return np.asarray(state.velocity + self.turning(state))

    def kinetic(self, state: State) -> tuple[Floats, Floats]:
        """Return the kinetic energies of the motion along the plate and of the rotation [J]."""
        return 0.5 * self.mass * (state.velocity**2).sum(axis=0), 0.5 * self.inertia * (
            state.spin**2
        ).sum(axis=0)

    def fly(self, state: State, elapsed: Floats) -> State:
        """Return the state after a time without contact [s]."""
        moved = state.position + (state.velocity + 0.5 * self.gravity * elapsed) * elapsed
        return State(moved, state.velocity + self.gravity * elapsed, state.spin)


def energy_taken(sphere: Sphere, before: State, after: State) -> Floats:
    """Return the energy that friction takes between two states [J]."""
    work = sphere.mass * (sphere.gravity * (after.position - before.position)).sum(axis=0)
    return np.asarray(sum(sphere.kinetic(before)) + work - sum(sphere.kinetic(after)))


def friction_parts(lost: Floats, microslip: Floats) -> dict[str, Floats]:
    """Return the two parts of the energy that friction took [J]; see `FRICTION_PARTS`.

    `lost`: of both. `microslip`: while a part of the contact stuck.
    """
    return {"microslip_J": microslip, "gross_slip_J": lost - microslip}


def state_after(
    sphere: Sphere,
    before: State,
    time: Floats,
    moved: tuple[Floats, Floats],
    turned: tuple[Floats, Floats],
) -> State:
    """Return the states a time after first touch [s], from the motion of the contact points of the
    spheres.

    Parameters
    ----------
    sphere : Sphere
        The spheres.
    before : State
        Their states at first touch.
    time : array, shape (B,)
        Times since then [s].
    moved : tuple of two arrays, shape (2, B)
        Velocities of the contact points [m/s], and their displacements since then [m].
    turned : tuple of two arrays, shapes (3, B) and (2, B)
        What moments made of the spins about -y, x and z [rad/s], and of the displacements [m].
    """
    velocity, displacement = moved
    spin, way = turned
    slip = sphere.slip(before)
    change = sphere.radius * spin[:2]
    pull = sphere.gravity
    mass = sphere.tangential_mass
    impulse = mass * (velocity - slip - pull * time - change)
    shift = mass * (displacement - (slip + 0.5 * pull * time) * time - way)
    free = sphere.fly(before, time)
    turn = sphere.radius / sphere.inertia
    spins = [
        turn * impulse[1] + change[1] / sphere.radius,
        -turn * impulse[0] - change[0] / sphere.radius,
        spin[2],
    ]
    return State(
        free.position + shift / sphere.mass,
        free.velocity + impulse / sphere.mass,
        free.spin + np.stack(spins),
    )


@dataclass(frozen=True)
class ImpulseAlong:
    """Contacts of B drops that have no duration: their states `after`, and the energy
    that friction took [J], `lost` (B,).
    """

    after: State
    lost: Floats

    @property
    def duration(self) -> Floats:
        """Durations of the contacts [s]: none."""
        return np.zeros_like(self.lost)

    def at(self, time: Floats) -> tuple[State, Floats, Floats]:
        """Return the state of one drop after the impulse, no friction (2, T), and the
        energy taken [J] (T,), for times from then on.
        """
        same = np.zeros(len(time), dtype=np.intp)
        return self.after.take(same), np.zeros((2, len(time))), self.lost[same]


class ContactAlong(Protocol):
    """The motion along the plate during a contact of one drop."""

    @property
    def duration(self) -> Floats:
        """Duration of the contact [s] (1,)."""

    def at(self, time: Floats) -> tuple[State, Floats, Floats]:
        """Return states of one drop, friction on it [N] (2, T) and energy taken [J] (T,),
        at times since first touch [s].
        """


def spheres_of(problem: Problem) -> Sphere:
    """Return the spheres of a problem whose drops move along the plate."""
    oblique = problem.oblique
    assert oblique is not None
    ones = np.ones(problem.shape or 1)
    gravity = oblique.with_weight(problem.net_weight).gravity
    return Sphere(
        problem.sphere.mass * ones,
        problem.sphere.contact_offset * ones,
        problem.sphere_inertia * ones,
        np.array([value * ones for value in gravity]),
    )
