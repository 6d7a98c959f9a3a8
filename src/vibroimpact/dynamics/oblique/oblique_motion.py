"""The motion along the plate and the spin of the drops of a run, through flights and contacts."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from typing import Any

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.compiled import interpreted, law_addresses
from vibroimpact.contact.friction.law import ImpulsiveFriction
from vibroimpact.contact.friction.laws.coulomb import Coulomb
from vibroimpact.dynamics.columns import OBLIQUE_IMPACT_COLUMNS
from vibroimpact.dynamics.core.sphere_contact import strike
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.impact_conditions import ImpactConditions
from vibroimpact.dynamics.law_coefficients import coefficients_of
from vibroimpact.dynamics.oblique.lying import lie
from vibroimpact.dynamics.oblique.rubbed_contact import RubbedContact
from vibroimpact.dynamics.oblique.state import (
    ImpulseAlong,
    ObliqueContacts,
    Sphere,
    State,
    energy_taken,
)
from vibroimpact.dynamics.oblique.statement import Oblique
from vibroimpact.dynamics.shaken.statement import PlateMotion

_FEW = 200
"""Fewer impulses than these do not load the compiler."""


class ObliqueMotion:
    """Places, velocities along the plate and spins of the B drops of a run.

    Parameters
    ----------
    oblique : Oblique
        What the drops have at the start.
    mass, radius, inertia : array, shape (B,)
        Of the spheres [kg], [m], [kg m^2].
    motion : PlateMotion or None
        Of the plate.
    tolerance : float
        Relative error allowed.
    """

    def __init__(
        self,
        oblique: Oblique,
        mass: Floats,
        radius: Floats,
        inertia: Floats,
        motion: PlateMotion | None,
        tolerance: float,
    ) -> None:
        def spread(values: Any) -> Floats:
            return np.array(
                [np.broadcast_to(np.asarray(value, dtype=float), mass.shape) for value in values]
            )

        self.sphere = Sphere(mass, radius, inertia, spread(oblique.gravity))
        self.state = State(spread(oblique.position), spread(oblique.velocity), spread(oblique.spin))
        self.start, self.half = (
            self.state.position,
            None if oblique.size is None else 0.5 * np.array(oblique.size)[:, None],
        )
        self.law, self.lost, self.microslip = (
            oblique.friction,
            np.zeros(len(mass)),
            np.zeros(len(mass)),
        )
        self.motion = motion
        self.tolerance = tolerance

    def fly(self, drops: Drops, flight: Flight, time: Floats) -> None:
        """Advance drops through their flights up to a time [s]."""
        self._put(drops, self._flown(drops, flight, time))

    def _flown(self, drops: Drops, flight: Flight, time: Floats) -> State:
        return flight.carry(self.sphere.take(drops), self.state.take(drops), time)

    def pulled(self, drops: Drops) -> tuple[Floats, Floats]:
        """Return the velocities of drops along the plate [m/s], and the accelerations of
        gravity along it [m/s^2], (2, B).
        """
        return self.state.velocity[:, drops], self.sphere.gravity[:, drops]

    def now(self, drops: Drops) -> tuple[Sphere, State]:
        """Return spheres and state of drops."""
        return self.sphere.take(drops), self.state.take(drops)

    def lie(self, drops: Drops, pressing: Floats, elapsed: Floats) -> Floats:
        """Let drops lie on the plate for a time [s], at most until they leave it, and return that
        time.

        `pressing`: gravity along the normal [m/s^2].
        """
        sphere, before = self.sphere.take(drops), self.state.take(drops)
        law = None if self.law is None else self.law.take(drops)
        half = (np.inf, np.inf) if self.half is None else tuple(self.half[:, 0].tolist())
        after, _, times = lie(sphere, before, law, pressing, elapsed[:, None], half)
        self.lost[drops] += energy_taken(sphere, before, after)
        self._put(drops, after)
        return times[:, 0]

    def distance(self, drops: Drops, flight: Flight, time: Floats) -> Floats:
        """Return how far drops move along the plate in their flights up to a time [m]."""
        with np.errstate(invalid="ignore"):
            moved = self._over_plate(drops, flight, time) - self._over_plate(
                drops, flight, flight.start
            )
        return np.asarray(np.nan_to_num(np.hypot(*moved)))

    def _over_plate(self, drops: Drops, flight: Flight, time: Floats) -> Floats:
        """Return the places of drops at times of their flights [s], seen from the plate
        [m] (2, b).
        """
        return self._from_plate(self._flown(drops, flight, time).position, time)

    def _from_plate(self, place: Floats, time: Floats) -> Floats:
        """Return places at some times [s], seen from the plate, whose supports may move
        along it [m] (2, b).
        """
        return (
            place
            if self.motion is None
            else place - np.outer(self.motion.direction[:2], self.motion.at(time)[0])
        )

    def seen_from_plate(self, drops: Drops, time: Floats) -> Floats:
        """Return the places of drops now, at some times [s], seen from the plate [m] (2, b)."""
        return self._from_plate(self.state.position[:, drops], time)

    def place_on_plate(self, drops: Drops, flight: Flight, time: Floats) -> Floats:
        """Return the places of drops at times of their flights [s], or the nearest ones
        on the plate [m] (2, b).
        """
        with np.errstate(invalid="ignore"):
            place = np.nan_to_num(self._over_plate(drops, flight, time))
        return place if self.half is None else np.clip(place, -self.half, self.half)

    def beside(self, drops: Drops, flight: Flight, time: Floats) -> Bools:
        """Return which drops will be beside the plate at a time of their flights [s]."""
        if self.half is None:
            return np.zeros(len(drops), dtype=bool)
        with np.errstate(invalid="ignore"):
            place = self._over_plate(drops, flight, time)
        return np.asarray(np.isfinite(time) & (np.abs(place) > self.half).any(axis=0))

    def collide(
        self,
        drops: Drops,
        conditions: ImpactConditions,
        duration: Floats,
        row: dict[str, Floats],
    ) -> ObliqueContacts:
        """Advance drops through contacts of rigid bodies, write their columns, and return the
        motion in them.

        `conditions`: the impacts of these drops. `duration`: of their contacts [s].
        """
        sphere, before = self.now(drops)
        law = self.law if self.law is None or len(drops) == len(self.lost) else self.law.take(drops)
        contact = RubbedContact(conditions, self.tolerance, law, sphere, before, duration)
        end, microslip = contact.ends()
        self.finish(drops, end, energy_taken(sphere, before, end), microslip, row)
        return ((np.arange(len(drops)), contact),)

    def collide_at_once(
        self, drops: Drops, time: Floats, impulse: Floats, row: dict[str, Floats]
    ) -> tuple[ObliqueContacts, Floats]:
        """Let a normal impulse without duration act on drops at some times [N s], [s], and write
        its columns.

        Return the contacts, and the plate's work [J]: that of friction on the spheres, as the plate
        moves along itself.
        """
        sphere, start = self.now(drops)
        surface = (
            0.0
            if self.motion is None
            else np.outer(self.motion.direction[:2], self.motion.at(time)[1])
        )
        before = replace(start, velocity=start.velocity - surface)  # seen from the plate
        law = Coulomb(coefficient=0.0) if self.law is None else self.law.take(drops)
        assert isinstance(law, ImpulsiveFriction)  # others follow a force
        rows = before.rows
        ends = np.empty_like(rows)
        with (
            interpreted() if len(drops) < _FEW else nullcontext(),
            coefficients_of(law, len(drops)) as coefficients,
        ):
            strike(law_addresses(type(law)), coefficients, sphere.rows(law), rows, impulse, ends)
        after = State.of_rows(ends)
        lost, after = (
            energy_taken(sphere, before, after),
            replace(after, velocity=after.velocity + surface),
        )
        self.finish(drops, after, lost, np.zeros(len(drops)), row)
        return ((np.arange(len(drops)), ImpulseAlong(after, lost)),), lost - energy_taken(
            sphere, start, after
        )

    def finish(
        self, drops: Drops, after: State, lost: Floats, microslip: Floats, row: dict[str, Floats]
    ) -> None:
        """Put drops into their states after a contact in which friction took an energy [J], and
        write its columns.

        `microslip`: the part of it that was lost while a part of the contact stuck [J].
        """
        before = self.state.take(drops)
        self.lost[drops] += lost
        self.microslip[drops] += microslip
        values = [*before.position, *before.velocity, *after.velocity, *before.spin, *after.spin]
        speed = np.hypot(*before.velocity)
        with np.errstate(divide="ignore", invalid="ignore"):
            onward = np.where(
                speed > 0.0,
                (before.velocity * after.velocity).sum(axis=0) / speed,
                np.hypot(*after.velocity),
            )
            ratio = np.where(speed > 0.0, onward / speed, np.nan)
        angle = np.degrees(np.arctan2(onward, row["separation_speed_m_s"][drops]))
        for name, value in zip(
            OBLIQUE_IMPACT_COLUMNS,
            [*values, ratio, angle, lost, microslip, lost - microslip],
            strict=True,
        ):
            row[name][drops] = value
        self._put(drops, after)

    def _put(self, drops: Drops, state: State) -> None:
        now = State(self.state.position.copy(), self.state.velocity.copy(), self.state.spin.copy())
        for name, values in vars(now).items():
            values[:, drops] = getattr(state, name)
        self.state = now

    def energies(self) -> tuple[Floats, Floats, Floats]:
        """Return the kinetic energies along the plate and of rotation, and the potential
        energy along the plate, zero at the start [J].
        """
        fallen = (self.sphere.gravity * (self.state.position - self.start)).sum(axis=0)
        return *self.sphere.kinetic(self.state), -self.sphere.mass * fallen
