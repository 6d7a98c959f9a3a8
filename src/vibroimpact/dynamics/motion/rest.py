"""State of drops that have come to rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats


@dataclass(frozen=True)
class Rest:
    """State of the drops at rest; arrays are (B,), NaN for the others.

    `speed`: rest speed, below which a sphere that separates counts as at rest [m/s]. `time`: end of
    the remaining bounces, which are not simulated [s]. `sag`: static indentation [m]. `stored`:
    energy in it [J]. `written_off`: energy that the sphere still had [J]. Where a body vibrates,
    `left`: what the sphere and what it lies on still hold above their equilibrium then [J], and
    `lying`: how they move on, a `RestMotion`, or None.
    """

    speed: Floats
    time: Floats
    sag: Floats
    stored: Floats
    written_off: Floats
    left: Floats
    lying: tuple[Any, ...]

    def take(self, index: int) -> Rest:
        """Return the rest of one drop, as that of a batch of one."""
        return Rest(*(value[index : index + 1] for value in vars(self).values()))

    @staticmethod
    def joined(parts: Sequence[Rest]) -> Rest:
        """Return the rest of the drops of several batches, in order."""
        arrays: dict[str, Any] = {
            name: np.concatenate([getattr(part, name) for part in parts]) for name in _ARRAYS
        }
        return Rest(**arrays, lying=tuple(one for part in parts for one in part.lying))


_ARRAYS = tuple(item.name for item in fields(Rest) if item.name != "lying")
