"""One impact as it came out: its pieces, how it ended, and what it took."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vibroimpact.contact.phase.collocation import Floats
from vibroimpact.contact.phase.glide import Glide
from vibroimpact.contact.phase.stretch import Stretch

Drops = NDArray[np.intp]

COMPRESSION, RESTITUTION, GLIDE, RELEASED, CAPTURED, FAILED = range(6)
"""Where a drop is in its contact; from RELEASED on it is over."""


@dataclass(frozen=True)
class Piece:
    """One piece of the history of some drops' contact: a solved stretch or a free glide."""

    drops: Drops
    start: Floats
    """Time since first touch at which it begins [s], (b,)."""
    motion: Stretch | Glide


@dataclass
class Contact:
    """One impact of B drops, first touch to release; arrays are (B,).

    `outcome` is RELEASED, CAPTURED (its energy no longer suffices to get out of the indentation) or FAILED.
    `final_delta`, `final_rate`: indentation [m] and its rate [m/s] at the end.
    """

    pieces: list[Piece]
    outcome: NDArray[np.int8]
    duration: Floats
    final_delta: Floats
    final_rate: Floats
    max_delta: Floats
    time_of_max_delta: Floats
    dissipated: Floats

    def of(self, index: int) -> Contact:
        """Return the contact of one drop."""
        pieces = []
        for piece in self.pieces:
            here = piece.drops == index
            if here.any():
                pieces.append(Piece(np.zeros(1, dtype=np.intp), piece.start[here], piece.motion.take(here)))
        floats = (self.duration, self.final_delta, self.final_rate, self.max_delta, self.time_of_max_delta, self.dissipated)
        return Contact(pieces, self.outcome[index : index + 1], *(array[index : index + 1] for array in floats))
