"""How a run asks for a contact: what takes drops through one, and finds the peak of its force."""

from __future__ import annotations

from typing import Protocol

from vibroimpact.arrays import Drops, Floats
from vibroimpact.dynamics.contact import Contact
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.rigid.contact_in_time import contact_phase
from vibroimpact.dynamics.rigid.peak_force import force_peak
from vibroimpact.dynamics.rigid.warm_starts import WarmStarts


class SolvesContact(Protocol):
    """Takes the drops of a run through one contact."""

    def __call__(self, encounter: Encounter, drops: Drops) -> tuple[Contact, Floats, Floats]:
        """Return the contact, the largest force [N], and when it is reached since first touch [s]; `drops` are those of the run."""
        ...


def collocated(tolerance: float, size: int) -> SolvesContact:
    """Return what solves the contacts of a run of `size` drops in time, with all of their history."""
    starts = WarmStarts(size)

    def solve(encounter: Encounter, drops: Drops) -> tuple[Contact, Floats, Floats]:
        contact = contact_phase(encounter, tolerance, starts, drops)
        return contact, *force_peak(contact, encounter)

    return solve
