"""The interface of contact solvers of rigid bodies, and the one that integrates in time."""

from __future__ import annotations

from typing import Protocol

from vibroimpact.arrays import Drops, Floats
from vibroimpact.dynamics.contact import Contact
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.rigid.contact_in_time import integrate_contact
from vibroimpact.dynamics.rigid.peak_force import force_peak
from vibroimpact.dynamics.rigid.starting_values import WarmStarts


class SolvesContact(Protocol):
    """A solver of one contact of some drops of a run."""

    def __call__(self, encounter: Encounter, drops: Drops) -> tuple[Contact, Floats, Floats]:
        """Return the contact, its largest force [N], and the time of that since first touch [s]; `drops` are indices in the run."""
        ...


def collocated(tolerance: float, size: int) -> SolvesContact:
    """Return the solver that integrates the contacts of a run of `size` drops in time, started from their earlier contacts."""
    starts = WarmStarts(size)

    def solve(encounter: Encounter, drops: Drops) -> tuple[Contact, Floats, Floats]:
        contact = integrate_contact(encounter, tolerance, starts, drops)
        return contact, *force_peak(contact, encounter)

    return solve
