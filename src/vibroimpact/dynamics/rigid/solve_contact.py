"""The interface of contact solvers of rigid bodies, and the one that solves each drop on its own."""

from __future__ import annotations

from typing import Protocol

from vibroimpact.arrays import Drops, Floats
from vibroimpact.dynamics.contact import Contact
from vibroimpact.dynamics.encounter import Encounter


class SolvesContact(Protocol):
    """A solver of one contact of some drops of a run."""

    def __call__(self, encounter: Encounter, drops: Drops) -> tuple[Contact, Floats, Floats]:
        """Return the contact, its largest force [N], and the time of that since first touch [s]; `drops` are indices in the run."""
        ...


def followed(tolerance: float) -> SolvesContact:
    """Return the solver that solves each drop on its own, whatever its law."""

    def solve(encounter: Encounter, drops: Drops) -> tuple[Contact, Floats, Floats]:
        from vibroimpact.dynamics.rigid.line_contact import follow_contacts  # a law without a force does not load the compiler

        return follow_contacts(encounter, tolerance)

    return solve
