"""The motion along the plate and the spin of one drop, where the core does not follow it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import interpreted, law_addresses
from vibroimpact.contact.friction.law import ImpulsiveFriction
from vibroimpact.contact.friction.laws.coulomb import Coulomb
from vibroimpact.dynamics.core.sphere_contact import strike
from vibroimpact.dynamics.motion.along import State, energy_taken, spheres_of
from vibroimpact.dynamics.motion.columns import OBLIQUE_IMPACT_COLUMNS
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.law_coefficients import coefficients_of
from vibroimpact.dynamics.oblique.lying import lie
from vibroimpact.dynamics.statement.problem import Problem


class ObliqueMotion:
    """Place, velocity along the plate and spin of one drop.

    `state`: now. `lost`, `microslip`: energy that friction took so far, and the part of it that was
    lost while a part of the contact stuck [J].

    Parameters
    ----------
    problem : Problem
        Of one drop that moves along the plate.
    """

    def __init__(self, problem: Problem) -> None:
        oblique = problem.oblique
        assert oblique is not None
        self.sphere = spheres_of(problem)
        self.state = State(
            *(
                np.array(values, dtype=float)[:, None]
                for values in (oblique.position, oblique.velocity, oblique.spin)
            )
        )
        self.law = oblique.friction
        self.lost = 0.0
        self.microslip = 0.0
        self._start = self.state.position
        self._motion = problem.motion
        self._half = np.full((2, 1), np.inf)
        if oblique.size is not None:
            self._half = 0.5 * np.array(oblique.size, dtype=float)[:, None]

    def fly(self, flight: Flight, time: Floats) -> None:
        """Advance the drop through its flight up to a time [s] (1,)."""
        self.state = flight.carry(self.sphere, self.state, time)

    def lie(self, pressing: Floats, elapsed: Floats) -> Floats:
        """Let the drop lie on the plate for a time [s] (1,), at most until it leaves it.

        Return that time. `pressing`: gravity along the normal [m/s^2] (1,).
        """
        before = self.state
        half_x, half_y = self._half[:, 0].tolist()
        after, _, times = lie(
            self.sphere, before, self.law, pressing, elapsed[:, None], (half_x, half_y)
        )
        self.lost += float(energy_taken(self.sphere, before, after)[0])
        self.state = after
        return times[:, 0]

    def distance(self, flight: Flight, time: Floats) -> float:
        """Return how far the drop moves along the plate in its flight up to a time [m]."""
        with np.errstate(invalid="ignore"):
            moved = self._over_plate(flight, time) - self._over_plate(flight, flight.start)
        return float(np.nan_to_num(np.hypot(*moved))[0])

    def _over_plate(self, flight: Flight, time: Floats) -> Floats:
        """Return the place at a time of its flight [s], seen from the plate [m] (2, 1)."""
        return self._from_plate(flight.carry(self.sphere, self.state, time).position, time)

    def _from_plate(self, place: Floats, time: Floats) -> Floats:
        """Return a place at a time [s], seen from the plate, whose supports may move along it."""
        if self._motion is None:
            return place
        return place - np.outer(self._motion.direction[:2], self._motion.at(time)[0])

    def seen_from_plate(self, time: Floats) -> dict[str, float]:
        """Return the columns of the place now, at a time [s] (1,), seen from the plate."""
        x, y = self._from_plate(self.state.position, time)[:, 0].tolist()
        return {"place_on_plate_x_m": x, "place_on_plate_y_m": y}

    def place_on_plate(self, flight: Flight, time: Floats) -> tuple[float, float]:
        """Return the place at a time of its flight [s], or the nearest one on the plate [m]."""
        with np.errstate(invalid="ignore"):
            place = np.nan_to_num(self._over_plate(flight, time))
        x, y = np.clip(place, -self._half, self._half)[:, 0].tolist()
        return x, y

    def is_beside(self, flight: Flight, time: float) -> bool:
        """Whether the drop will be beside the plate at a time of its flight [s]."""
        if not np.isfinite(time):
            return False
        place = self._over_plate(flight, np.array([time]))
        return bool((np.abs(place) > self._half).any())

    def strike(
        self, time: Floats, impulse: Floats, separation: float
    ) -> tuple[dict[str, float], float]:
        """Let a normal impulse without duration act at a time [N s] (1,), [s] (1,).

        Return the columns of the impact, and the work of the plate [J]: that of friction on the
        sphere, as the plate moves along itself. `separation`: normal speed after it [m/s].
        """
        start = self.state
        surface = np.zeros((2, 1))
        if self._motion is not None:
            surface = np.outer(self._motion.direction[:2], self._motion.at(time)[1])
        before = replace(start, velocity=start.velocity - surface)  # seen from the plate
        law = self.law
        if law is None:
            law = Coulomb(coefficient=0.0)
        assert isinstance(law, ImpulsiveFriction)  # others follow a force
        rows = before.rows
        ends = np.empty_like(rows)
        # loading the compiler would take longer
        with interpreted(), coefficients_of(law, 1) as coefficients:
            addresses = law_addresses(type(law))
            strike(addresses, coefficients, self.sphere.rows(law), rows, impulse, ends)
        after = State.of_rows(ends)
        lost = energy_taken(self.sphere, before, after)
        after = replace(after, velocity=after.velocity + surface)
        columns = self.finish(after, float(lost[0]), 0.0, separation)
        return columns, float((lost - energy_taken(self.sphere, start, after))[0])

    def finish(
        self, after: State, lost: float, microslip: float, separation: float
    ) -> dict[str, float]:
        """Put the drop into its state after a contact, and return the columns of that.

        Parameters
        ----------
        after : State
            Its state then.
        lost, microslip : float
            Energy that friction took, and the part of it that was lost while a part of the contact
            stuck [J].
        separation : float
            Normal speed at release [m/s].
        """
        before = self.state
        self.state = after
        self.lost += lost
        self.microslip += microslip
        speed = float(np.hypot(*before.velocity)[0])
        onward = float(np.hypot(*after.velocity)[0])
        ratio = np.nan
        if speed > 0.0:
            onward = float((before.velocity * after.velocity).sum()) / speed
            ratio = onward / speed
        vectors = (before.position, before.velocity, after.velocity, before.spin, after.spin)
        values = [float(value) for vector in vectors for value in vector[:, 0]]
        angle = float(np.degrees(np.arctan2(onward, separation)))
        further = [ratio, angle, lost, microslip, lost - microslip]
        return dict(zip(OBLIQUE_IMPACT_COLUMNS, [*values, *further], strict=True))

    def energies(self) -> dict[str, float]:
        """Return the entries of the motion along the plate in the energy ledger [J].

        The potential energy is zero at the start.
        """
        kinetic, rotation = self.sphere.kinetic(self.state)
        fallen = (self.sphere.gravity * (self.state.position - self._start)).sum()
        return {
            "kinetic_J": float(kinetic[0]),
            "potential_J": -float(self.sphere.mass[0] * fallen),
            "rotation_J": float(rotation[0]),
            "friction_J": self.lost,
        }
