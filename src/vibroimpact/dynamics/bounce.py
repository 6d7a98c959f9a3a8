"""A bounce of a run: a flight and the contact that follows it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.contact import Contact
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.impact_conditions import ImpactConditions
from vibroimpact.dynamics.oblique.state import ObliqueContacts, Sphere, State
from vibroimpact.dynamics.shaken.ride import Ride

if TYPE_CHECKING:  # a drop of rigid bodies does not load what vibrates
    from vibroimpact.dynamics.vibrating.linear_system import FreeMotion


@dataclass(frozen=True)
class Bounce:
    """A flight of some drops and the contact that follows it; arrays have one entry for each of
    `drops` (b,).

    `flight_end`: end of the flight [s]. `contact` and `conditions` belong to `contact_drops`; they
    are None for a flight that ends the run and for an instantaneous law.
    """

    drops: Indices
    flight: Flight
    flight_end: Floats
    contact_drops: Indices
    contact: Contact | None = None
    conditions: ImpactConditions | None = None
    motions: tuple[FreeMotion, ...] = ()
    """Free motions of the bodies of each drop in flight, where a body vibrates."""
    oblique: tuple[Sphere, State] | None = None
    """The spheres, and their motion along the plate at the start of the flight, where
    they have any.
    """
    oblique_contacts: ObliqueContacts = ()
    ride: Ride | None = None
    """Rides of `contact_drops` on a shaken plate after an impact of a law without a force."""

    def of(self, drop: int) -> Bounce | None:
        """Return the bounce of one drop, or None if the drop is not in it."""
        here = np.flatnonzero(self.drops == drop)
        if not here.size:
            return None
        one, alone = np.zeros(1, dtype=np.intp), self.flight.take(here)
        contact_here = np.flatnonzero(self.contact_drops == drop)
        motions = self.motions[int(here[0]) : int(here[0]) + 1]
        oblique = (
            None
            if self.oblique is None
            else (self.oblique[0].take(here), self.oblique[1].take(here))
        )
        along = tuple(
            (one, part.of(place))
            for places, part in self.oblique_contacts
            for place in np.flatnonzero(np.isin(places, contact_here)).tolist()
        )
        if self.contact is None or self.conditions is None or not contact_here.size:
            ride = (
                self.ride.of(int(contact_here[0]))
                if self.ride is not None and contact_here.size
                else None
            )
            here_alone = one, alone, self.flight_end[here], one[: contact_here.size]
            return Bounce(
                *here_alone, motions=motions, oblique=oblique, oblique_contacts=along, ride=ride
            )
        contact, conditions = (
            self.contact.of(int(contact_here[0])),
            self.conditions.take(contact_here),
        )
        return Bounce(
            one, alone, self.flight_end[here], one, contact, conditions, motions, oblique, along
        )
