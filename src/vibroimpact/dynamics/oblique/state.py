"""The motion of spheres along the plate and their spin: the state, and its change in
flights and contacts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats


@dataclass(frozen=True)
class Sliding:
    """Motion of the contact points of B contacts along one direction, at G points of time; arrays
    are (G, B).

    `time`: since first touch [s]. `slip`: velocity of the contact point [m/s]. `displacement`:
    since first touch [m]. `force`: of friction, against the direction [N]. `microslip`: energy lost
    while a part of the contact sticks [J] (B,).
    """

    time: Floats
    slip: Floats
    displacement: Floats
    force: Floats
    microslip: Floats


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

    def changed(self, change: State, part: Floats | float = 1.0) -> State:
        """Return the state with a part of a change."""
        return State(
            *(
                getattr(self, name) + part * getattr(change, name)
                for name in ("position", "velocity", "spin")
            )
        )


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

    def pushed(self, state: State, impulse: Floats, twist: Floats | float = 0.0) -> State:
        """Return the state after an impulse at the contact point along the plate [N s] (2, B).

        `twist`: change of the spin about the normal [rad/s].
        """
        turn = self.radius / self.inertia
        spin = state.spin + np.stack(
            [turn * impulse[1], -turn * impulse[0], twist + 0.0 * impulse[0]]
        )
        return State(state.position, state.velocity + impulse / self.mass, spin)

    def turned(self, state: State, change: Floats, twist: Floats | float = 0.0) -> State:
        """Return the state after changes of the part of the spin in the slip [m/s] (2, B)
        and of the spin about the normal [rad/s].
        """
        spin = state.spin + np.stack(
            [change[1] / self.radius, -change[0] / self.radius, twist + 0.0 * change[0]]
        )
        return State(state.position, state.velocity, spin)


def energy_taken(sphere: Sphere, before: State, after: State) -> Floats:
    """Return the energy that friction takes between two states [J]."""
    work = sphere.mass * (sphere.gravity * (after.position - before.position)).sum(axis=0)
    return np.asarray(sum(sphere.kinetic(before)) + work - sum(sphere.kinetic(after)))


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
    (velocity, displacement), (spin, way), slip, mass = (
        moved,
        turned,
        sphere.slip(before),
        sphere.tangential_mass,
    )
    change = sphere.radius * spin[:2]
    impulse = mass * (velocity - slip - sphere.gravity * time - change)
    shift = mass * (displacement - (slip + 0.5 * sphere.gravity * time) * time - way)
    pushed = sphere.turned(sphere.pushed(sphere.fly(before, time), impulse), change, spin[2])
    return State(pushed.position + shift / sphere.mass, pushed.velocity, pushed.spin)


@dataclass(frozen=True)
class ObliqueContact:
    """The motion along the plate during contacts of B drops.

    `before`: state at first touch. `direction`: of the slip at first touch (2, B). `sliding`: along
    it. `twist`: changes of the spin about the normal by the end [rad/s] (B,). `change`: of velocity
    and spin by the end, by friction across the direction and by rolling resistance, if they act.
    """

    sphere: Sphere
    before: State
    direction: Floats
    sliding: Sliding
    twist: Floats
    change: State | None = None

    def of(self, drop: int) -> ObliqueContact:
        """Return the motion of one drop."""
        here, sliding = np.array([drop]), self.sliding
        alone = Sliding(*(values[..., here] for values in vars(sliding).values()))
        return ObliqueContact(
            self.sphere.take(here),
            self.before.take(here),
            self.direction[:, here],
            alone,
            self.twist[here],
            None if self.change is None else self.change.take(here),
        )

    def changed(self, change: State | None) -> ObliqueContact:
        """Return the motion with a further change by the end, if there is one."""
        if change is None:
            return self
        return replace(self, change=change if self.change is None else self.change.changed(change))

    def after(
        self, time: Floats, slip: Floats, displacement: Floats, part: Floats | float = 1.0
    ) -> State:
        """Return the state at a time since first touch, from slip and displacement along
        the direction; `part`: of the moments, so far.
        """
        sphere, before = self.sphere, self.before
        slip_before = (sphere.slip(before) * self.direction).sum(axis=0)
        pull = (sphere.gravity * self.direction).sum(axis=0)
        impulse = sphere.tangential_mass * (slip - slip_before - pull * time) * self.direction
        moved = (
            sphere.tangential_mass
            * (displacement - slip_before * time - 0.5 * pull * time**2)
            * self.direction
        )
        pushed = sphere.pushed(sphere.fly(before, time), impulse, self.twist * part)
        found = State(pushed.position + moved / sphere.mass, pushed.velocity, pushed.spin)
        if self.change is None:
            return found
        # evenly in time
        on_the_way = State(
            0.5 * time * self.change.velocity, self.change.velocity, self.change.spin
        )
        return found.changed(on_the_way, part)

    @property
    def duration(self) -> Floats:
        """Durations of the contacts [s]."""
        return np.asarray(self.sliding.time[-1])

    @property
    def end(self) -> State:
        """The state at the end of the contact."""
        return self.after(
            self.sliding.time[-1], self.sliding.slip[-1], self.sliding.displacement[-1]
        )

    def at(self, time: Floats) -> tuple[State, Floats, Floats]:
        """Return states of one drop, friction on it [N] (2, T) and energy taken [J] (T,),
        at times since first touch [s].
        """
        # a drop along the normal does not load it
        from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

        sliding = self.sliding
        times = sliding.time[:, 0]
        kept = np.append(True, np.diff(times) > 0.0)
        times, slip, displacement, force = (
            values[kept]
            for values in (
                times,
                sliding.slip[:, 0],
                sliding.displacement[:, 0],
                sliding.force[:, 0],
            )
        )
        path = CubicHermiteSpline(times, displacement, slip)
        now = np.minimum(time, times[-1])
        state = self.after(now, path(now, 1), path(now), now / times[-1])
        return (
            state,
            -self.direction * PchipInterpolator(times, force)(now),
            energy_taken(self.sphere, self.before, state),
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

    def of(self, drop: int) -> ImpulseAlong:
        """Return the contact of one drop."""
        here = np.array([drop])
        return ImpulseAlong(self.after.take(here), self.lost[here])

    def at(self, time: Floats) -> tuple[State, Floats, Floats]:
        """Return the state of one drop after the impulse, no friction (2, T), and the
        energy taken [J] (T,), for times from then on.
        """
        same = np.zeros(len(time), dtype=np.intp)
        return self.after.take(same), np.zeros((2, len(time))), self.lost[same]


class ContactAlong(Protocol):
    """The motion along the plate during contacts of some drops."""

    @property
    def duration(self) -> Floats:
        """Durations of the contacts [s]."""

    def of(self, drop: int) -> ContactAlong:
        """Return the motion of one drop."""

    def at(self, time: Floats) -> tuple[State, Floats, Floats]:
        """Return states of one drop, friction on it [N] (2, T) and energy taken [J] (T,),
        at times since first touch [s].
        """


ObliqueContacts = tuple[tuple[Drops, ContactAlong], ...]
"""The motion along the plate during contacts of groups of drops, with their places among
all drops of the contact.
"""
