"""The contact of drops as it was solved: its parts, its end, and the energy lost in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.law import CompliantLaw

RELEASED, CAPTURED, FAILED, SETTLED, RIDING = range(5)
"""Outcomes of a contact.

Only with bodies that vibrate: SETTLED, released below the rest speed and at rest; RIDING, still in
contact without being at rest.
"""


class PartOfContact(Protocol):
    """A part of a contact: of rigid bodies as the core followed it, or of bodies that vibrate."""

    @property
    def duration(self) -> Floats:
        """Return the duration [s] (b,)."""

    def take(self, drops: Bools) -> PartOfContact:
        """Return the part of the drops under a mask; of bodies that vibrate, itself."""


@dataclass(frozen=True)
class Piece:
    """A part of the contact of some drops."""

    drops: Drops
    start: Floats
    """Time since first touch at which it begins [s], (b,)."""
    motion: PartOfContact
    law: CompliantLaw
    """The law with its memory in this part, of all B drops of the contact."""


@dataclass
class Contact:
    """One contact of B drops, from first touch to release; arrays are (B,).

    `outcome`: RELEASED, CAPTURED (the energy does not suffice to leave the indentation), FAILED,
    SETTLED or RIDING. `final_delta`, `final_rate`: indentation [m] and its rate [m/s] at the end.
    `dissipated`, `plastic`: energy lost in damping and in plastic deformation [J]. `stored`: energy
    left in the contact [J]. `law`: the law with its memory of this contact.
    """

    pieces: Sequence[Piece]
    outcome: NDArray[np.int8]
    duration: Floats
    final_delta: Floats
    final_rate: Floats
    max_delta: Floats
    time_of_max_delta: Floats
    dissipated: Floats
    plastic: Floats
    stored: Floats
    law: CompliantLaw

    def of(self, index: int) -> Contact:
        """Return the contact of one drop."""
        pieces = []
        for piece in self.pieces:
            here = piece.drops == index
            if here.any():
                law = piece.law.take(np.array([index]))
                pieces.append(
                    Piece(
                        np.zeros(1, dtype=np.intp), piece.start[here], piece.motion.take(here), law
                    )
                )
        arrays = {
            name: value[index : index + 1]
            for name, value in vars(self).items()
            if isinstance(value, np.ndarray)
        }
        return replace(self, pieces=pieces, law=self.law.take(np.array([index])), **arrays)
