"""Free flight, contact and rest of B drops whose bodies do not vibrate."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.bounce import Bounce
from vibroimpact.dynamics.columns import IMPACT_COLUMNS
from vibroimpact.dynamics.contact import FAILED, Contact
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.impact_conditions import ImpactConditions
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.oblique.state import ObliqueContacts
from vibroimpact.dynamics.run_bodies import Motions

if TYPE_CHECKING:  # a drop of rigid bodies does not load what vibrates
    from vibroimpact.dynamics.vibrating.rest_motion import RestMotion


class RigidBodies:
    """The bodies of B drops that do not vibrate: a sphere falls on a plate at rest.

    `Bodies` describes the methods.

    Parameters
    ----------
    size : int
        Number of drops.
    tolerance : float
        Relative error allowed in their contacts.
    """

    def __init__(self, size: int, tolerance: float) -> None:
        self.columns = tuple(IMPACT_COLUMNS)
        self.tolerance = tolerance
        self.remaining_energy = np.full(size, np.nan)
        self.lying: list[RestMotion | None] = [None] * size

    def next_touch(
        self, drops: Drops, flight: Flight, law: ContactLaw
    ) -> tuple[Floats, Floats, Motions]:
        """Return times of touch [s], approach speeds [m/s], and no motions of bodies.

        The times are those of the parabolas of the flights.
        """
        level = -law.touch_level if isinstance(law, CompliantLaw) else np.zeros(1)
        touch, speed = flight.touch(level)
        return touch, speed, ()

    def pass_flight(self, drops: Drops, motions: Motions, elapsed: Floats) -> None:
        """Do nothing: rigid bodies have no state but that of the flight."""

    def closing_speed(self, drops: Drops, speed: Floats, velocity: Floats) -> Floats:
        """Return the speed of the rigid bodies."""
        return speed

    def rigid_speed(self, drops: Drops, velocity: Floats) -> Floats:
        """Return the velocity of the spheres."""
        return velocity

    def collide(
        self,
        drops: Drops,
        conditions: ImpactConditions,
        at_touch: tuple[Floats, Floats],
        limits: tuple[Floats, Floats],
        row: dict[str, Floats],
    ) -> tuple[Contact, Floats, Floats]:
        """Return the contact of drops, which the core solves."""
        # a law without a force does not load it
        from vibroimpact.dynamics.rigid.line_contact import follow_contacts

        return follow_contacts(conditions, self.tolerance)

    def slide(
        self, oblique: ObliqueMotion, bounce: Bounce, row: dict[str, Floats]
    ) -> ObliqueContacts:
        """Advance drops along the plate, driven by the normal motion of their contacts.

        The normal motion does not feel friction.
        """
        assert bounce.contact is not None
        assert bounce.conditions is not None
        return oblique.collide(
            bounce.contact_drops, bounce.conditions, bounce.contact.duration, row
        )

    def falls_back(self, contact: Contact, law: CompliantLaw, gravity: Floats) -> Bools:
        """Return which drops fall back into the indentation.

        They do before they have risen to the touch level of the law.
        """
        overlap = np.maximum(contact.final_delta - law.touch_level, 0.0)
        falls = contact.final_rate**2 < 2.0 * gravity * overlap
        return np.asarray((contact.outcome != FAILED) & falls)

    def rests(self, drops: Drops, velocity: Floats, rest_speed: Floats) -> Bools:
        """Return which drops separate below the rest speed, or not at all."""
        return np.asarray((velocity < rest_speed) | (velocity == 0.0))

    def static_state(
        self, drops: Drops, law: ContactLaw, weight: Floats, energy: Floats
    ) -> dict[str, Floats]:
        """Return the static indentation, its energy, and the rest of the energy."""
        sag = np.zeros(len(drops))
        stored = np.zeros(len(drops))
        if isinstance(law, CompliantLaw):
            sag = static_indentation(law, weight)
            stored = law.elastic_energy(sag)
        return {"sag": sag, "stored": stored, "written_off": energy - (stored - weight * sag)}

    def follow(
        self, drops: Drops, elapsed: Floats, sag: Floats, stored: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return the gap of the static indentation, no velocity, and the stored energy."""
        return -sag, np.zeros(len(drops)), stored

    def energies(self) -> dict[str, Floats]:
        """Return no further entries."""
        return {}

    def growth(self, bounce: Bounce) -> Floats:
        """Return nothing: the growth is followed where bodies vibrate."""
        return np.zeros(0)
