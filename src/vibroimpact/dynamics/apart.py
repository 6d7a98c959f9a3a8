"""Free motion between two contacts of one visit, or inside an indentation once the law has stopped pushing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats
from vibroimpact.dynamics.linear_system import FreeMotion, State
from vibroimpact.dynamics.local import LocalContact


@dataclass(frozen=True)
class Apart:
    """Free motion between two contacts, or inside an indentation once the law has stopped pushing.

    `length` [s]. `local` holds in its indentation what is lost as it recovers; None once the surfaces have parted.
    """

    free: FreeMotion
    length: float
    local: LocalContact | None = None

    @property
    def duration(self) -> Floats:
        """How long it lasts [s], as an array of one."""
        return np.array([self.length])

    def take(self, drops: NDArray[np.bool_]) -> Apart:
        """Return itself: it is of one drop."""
        return self

    def lost_by(self, time: Floats) -> Floats:
        """Return what is lost since the start [J] at times since then [s], (T, n + 1): in each coordinate; last, in the contact."""
        return self.lost_at(self.free.state(time))

    def lost_at(self, state: State) -> Floats:
        """Return the same of states that the motion comes to."""
        lost = self.free.lost_at(state)
        if self.local is not None:
            of, floor = self.free.system, self.local.release_level
            before, now = (np.maximum(of.approach(place)[..., 0], floor) for place in (self.free.start, state))
            lost[..., -1] += self.local.elastic_energy(before) - self.local.elastic_energy(now)
        return lost
