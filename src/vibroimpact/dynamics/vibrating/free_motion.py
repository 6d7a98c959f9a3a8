"""Free phase of a march: between two contacts, or in recoil once a law has stopped pushing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact


@dataclass(frozen=True)
class FreePhase:
    """Free motion between two contacts, or inside an indentation once the law has stopped pushing.

    `length` [s]. `recoiling`: contacts, with their numbers, whose surfaces still overlap without a
    force; the energy stored in their indentation is lost as it recovers. Where it is empty, all
    surfaces are apart.
    """

    free: FreeMotion
    length: float
    recoiling: tuple[tuple[int, LocalContact], ...] = ()

    @property
    def local(self) -> LocalContact | None:
        """The first contact that recoils, or None."""
        return self.recoiling[0][1] if self.recoiling else None

    @property
    def duration(self) -> Floats:
        """Its length [s], as an array of one."""
        return np.array([self.length])

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        return self.free.state(time)

    def lost_by(self, time: Floats) -> Floats:
        """Return the energy lost since the start [J] at times since then [s], (..., n + 1).

        It is given for each coordinate, and last for the contacts.
        """
        return self.lost_at(self.free.state(time))

    def lost_at(self, state: State) -> Floats:
        """Return the energy lost since the start [J] as in `lost_by`, at states of this motion."""
        lost = self.free.lost_at(state)
        for number, local in self.recoiling:
            lost[..., -1] += coasting_loss(self.free.system, number, local, self.free.start, state)
        return lost


def coasting_loss(
    system: LinearSystem, number: int, local: LocalContact, start: State, states: State
) -> Floats:
    """Return the stored energy that a recoiling contact has lost from a state to later ones [J]."""

    def elastic_energy(state: State) -> Floats:
        approach = system.approach_at(state, number)
        return np.asarray(local.elastic_energy(np.maximum(approach, local.release_level)))

    return np.asarray(elastic_energy(start) - elastic_energy(states))
