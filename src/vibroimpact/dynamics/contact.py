"""One impact as it came out: its pieces, how it ended, and what it took."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.phase_plane.motion import PlaneMotion
from vibroimpact.dynamics.rigid.glide import Glide
from vibroimpact.dynamics.rigid.stretch import Stretch

COMPRESSION, RESTITUTION, GLIDE, RELEASED, CAPTURED, FAILED, SETTLED, RIDING = range(8)
"""Where a drop is in its contact; from RELEASED on it is over.

Only on bodies that vibrate: SETTLED, released more slowly than the rest speed for good; RIDING, in contact still, and not to stay.
"""


class PartOfVisit(Protocol):
    """A part of the contact of bodies that vibrate, of one drop."""

    @property
    def duration(self) -> Floats:
        """How long it lasts [s], (1,)."""

    def take(self, drops: Bools) -> PartOfVisit:
        """Return itself."""


@dataclass(frozen=True)
class Piece:
    """One piece of the history of some drops' contact: a solved stretch or a free glide."""

    drops: Drops
    start: Floats
    """Time since first touch at which it begins [s], (b,)."""
    motion: Stretch | PlaneMotion | Glide | PartOfVisit
    law: CompliantLaw
    """The law with its memories then, of all B drops of the contact."""


@dataclass
class Contact:
    """One impact of B drops, first touch to release; arrays are (B,).

    `outcome` is RELEASED, CAPTURED (its energy no longer suffices to get out of the indentation) or FAILED, or what only
    bodies that vibrate have.
    `final_delta`, `final_rate`: indentation [m] and its rate [m/s] at the end. `dissipated`, `plastic`: work
    lost in damping and in plastic deformation [J]. `stored`: energy left in the contact [J]. `law`: the law with what
    it remembers of this contact.
    """

    pieces: list[Piece]
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

    def put(self, drops: Drops, other: Contact) -> None:
        """Take over the contacts of some drops."""
        for name, values in vars(other).items():
            if isinstance(values, np.ndarray):
                getattr(self, name)[drops] = values
        self.law = _remembering(self.law, drops, other.law)
        for piece in other.pieces:
            self.pieces.append(Piece(drops[piece.drops], piece.start, piece.motion, _remembering(self.law, drops, piece.law)))

    def of(self, index: int) -> Contact:
        """Return the contact of one drop."""
        pieces = []
        for piece in self.pieces:
            here = piece.drops == index
            if here.any():
                law = piece.law.take(np.array([index]))
                pieces.append(Piece(np.zeros(1, dtype=np.intp), piece.start[here], piece.motion.take(here), law))
        arrays = {name: value[index : index + 1] for name, value in vars(self).items() if isinstance(value, np.ndarray)}
        return replace(self, pieces=pieces, law=self.law.take(np.array([index])), **arrays)


def _remembering(law: CompliantLaw, drops: Drops, other: CompliantLaw) -> CompliantLaw:
    """Return a law of B drops, of which some remember what another law, of these alone, does."""
    memories = {name: values + np.zeros(len(drops)) for name, values in other.memories().items()}
    whole = {name: np.array(getattr(law, name)) for name in memories}
    for name, values in memories.items():
        whole[name][drops] = values
    return law.changed(whole)
