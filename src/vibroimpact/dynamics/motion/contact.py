"""The contact of one drop as it was solved, in parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw


class PartOfContact(Protocol):
    """A part of a contact: of rigid bodies as the core followed it, or of bodies that vibrate."""

    @property
    def duration(self) -> Floats:
        """Return the duration [s] (1,)."""


@dataclass(frozen=True)
class Piece:
    """A part of a contact; `start`: since first touch [s]. `law`: with its memory in this part."""

    start: float
    motion: PartOfContact
    law: CompliantLaw


@dataclass(frozen=True)
class Contact:
    """One contact, from first touch to release; `law`: with its memory at the end."""

    pieces: Sequence[Piece]
    law: CompliantLaw
