"""A bounce of a run: a flight and the contact that follows it."""

from __future__ import annotations

from dataclasses import dataclass, replace
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
    """A flight of some drops and the contact that follows it.

    Arrays have one entry for each of `drops` (b,). `flight_end`: end of the flight [s]. `contact`
    and `conditions` belong to `contact_drops`; they are None for a flight that ends the run and for
    an instantaneous law.
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
    """The spheres, and any motion along the plate, at the start of the flight."""
    oblique_contacts: ObliqueContacts = ()
    ride: Ride | None = None
    """Rides of `contact_drops` on a shaken plate after an impact of a law without a force."""

    def of(self, drop: int) -> Bounce | None:
        """Return the bounce of one drop, or None if the drop is not in it."""
        index = np.flatnonzero(self.drops == drop)
        if not index.size:
            return None
        contact_index = np.flatnonzero(self.contact_drops == drop)
        first = np.zeros(1, dtype=np.intp)  # the drop alone is the first one
        oblique = None
        if self.oblique is not None:
            sphere, state = self.oblique
            oblique = sphere.take(index), state.take(index)
        oblique_contacts = []
        for positions, contact in self.oblique_contacts:
            for position in np.flatnonzero(np.isin(positions, contact_index)).tolist():
                oblique_contacts.append((first, contact.of(position)))
        alone = Bounce(
            drops=first,
            flight=self.flight.take(index),
            flight_end=self.flight_end[index],
            contact_drops=first[: contact_index.size],
            motions=self.motions[int(index[0]) : int(index[0]) + 1],
            oblique=oblique,
            oblique_contacts=tuple(oblique_contacts),
        )
        if not contact_index.size:
            return alone
        if self.contact is not None and self.conditions is not None:
            return replace(
                alone,
                contact=self.contact.of(int(contact_index[0])),
                conditions=self.conditions.take(contact_index),
            )
        ride = None if self.ride is None else self.ride.of(int(contact_index[0]))
        return replace(alone, ride=ride)
