"""How drops that came to rest do so."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.lying import Lying


@dataclass(frozen=True)
class Rest:
    """How the drops that came to rest do so; arrays are (B,), NaN for the others.

    `speed`: below which a sphere that leaves is at rest [m/s]. `time`: when the bounces that were not
    followed any more would have ended [s]. `sag`: static indentation [m]. `stored`: energy in it [J].
    `written_off`: energy that the sphere still had [J]. Where a body vibrates, `left`: what the sphere and what it lies on still
    hold above their equilibrium then [J], and `lying`: how they move on.
    """

    speed: Floats
    time: Floats
    sag: Floats
    stored: Floats
    written_off: Floats
    left: Floats
    lying: tuple[Lying | None, ...]
