"""What a run remembers of its contacts, to start the next from."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.dynamics.collocation import Map
from vibroimpact.dynamics.rigid.stretch import Aim, WarmStart


class WarmStarts:
    """The dimensionless solutions of a run's last stretches, one a kind and drop, to start the next from."""

    def __init__(self, size: int) -> None:
        self.size = size
        self.starts: dict[tuple[Map, Aim], WarmStart] = {}

    def knows(self, kind: tuple[Map, Aim], ids: Drops) -> Bools:
        """Return for which drops there is a solution of a kind."""
        return np.isfinite(self.starts[kind].unknowns[-1, ids]) if kind in self.starts else np.zeros(len(ids), dtype=bool)

    def forget(self, kind: tuple[Map, Aim], ids: Drops) -> None:
        """Forget solutions that turned out to be of another motion."""
        if kind in self.starts:
            self.starts[kind].unknowns[:, ids] = np.nan

    def keep(self, kind: tuple[Map, Aim], ids: Drops, unknowns: Floats, inverse: Floats | None) -> None:
        """Remember a solution."""
        if kind not in self.starts:
            self.starts[kind] = WarmStart(np.full((len(unknowns), self.size), np.nan))
        self.starts[kind].unknowns[:, ids], self.starts[kind].inverse = unknowns, inverse
