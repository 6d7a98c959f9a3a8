"""The motion along the plate during visits of spheres to plates that deform."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Drops, Floats
from vibroimpact.dynamics.contact import Contact
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.oblique.state import ObliqueContacts, Sphere, State, state_after
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.surface_friction import SlidingStretch


@dataclass(frozen=True)
class SlidingContact:
    """The motion along the plate during the visit of one drop; see `ObliqueContact`.

    `sphere`, `before`: the sphere, and its state at first touch. `duration`: of the visit [s] (1,).
    `parts`: starts of its stretches under friction since first touch [s], and these.
    """

    sphere: Sphere
    before: State
    duration: Floats
    parts: Sequence[tuple[float, SlidingStretch]]

    def of(self, drop: int) -> SlidingContact:
        """Return itself: it belongs to one drop."""
        return self

    def at(self, time: Floats) -> tuple[State, Floats, Floats]:
        """Return states, friction forces on the sphere [N] (2, T) and energy taken [J]
        (T,) at times since first touch [s] (T,).
        """
        sphere, before, now = self.sphere, self.before, np.minimum(time, self.duration)
        slip = sphere.slip(before)
        velocity, displacement = (
            slip + sphere.gravity * now,
            (slip + 0.5 * sphere.gravity * now) * now,
        )
        force, taken = np.zeros((2, len(now))), np.zeros(len(now))
        turned, turned_way = np.zeros((3, len(now))), np.zeros((2, len(now)))
        # what follows a stretch flies on from its end until the next one
        for start, stretch in self.parts:
            within, later = (
                (now >= start) & (now <= start + stretch.length),
                now > start + stretch.length,
            )
            if within.any():
                velocity[:, within], displacement[:, within], forces, taken[within] = stretch.at(
                    now[within] - start
                )
                force[:, within] = forces[:2]
                turned[:, within], turned_way[:, within] = stretch.turned(now[within] - start)
            if later.any():
                end, rest = stretch.end, now[later] - start - stretch.length
                pull = stretch.sphere.pull[:, None]
                velocity[:, later] = end.velocity[:, None] + pull * rest
                displacement[:, later] = (
                    end.displacement[:, None] + (end.velocity[:, None] + 0.5 * pull * rest) * rest
                )
                force[:, later], taken[later], turned[:, later] = 0.0, end.work, end.turned[:, None]
                turned_way[:, later] = (
                    end.turned_way[:, None] + stretch.sphere.radius * end.turned[:2, None] * rest
                )
        return (
            state_after(sphere, before, now, (velocity, displacement), (turned, turned_way)),
            -force,
            taken,
        )

    @property
    def end(self) -> tuple[State, Floats, Floats]:
        """The state at the end of the visit, the energy that friction took in it, and the
        part of that in microslip [J] (1,).
        """
        state, _, taken = self.at(self.duration)
        return state, taken, np.array([self.parts[-1][1].end.microslip if self.parts else 0.0])


def sliding_contacts(
    oblique: ObliqueMotion, drops: Drops, contact: Contact, row: dict[str, Floats]
) -> ObliqueContacts:
    """Advance drops through their visits along the plate, write their columns, and return
    the motion in them.
    """
    parts: list[list[tuple[float, SlidingStretch]]] = [[] for _ in drops]
    for piece in contact.pieces:
        if isinstance(piece.motion, VibratingStretch) and piece.motion.sliding is not None:
            parts[int(piece.drops[0])].append((float(piece.start[0]), piece.motion.sliding))
    found = []
    for place, stretches in enumerate(parts):
        here, one = np.array([place]), drops[place : place + 1]
        sphere, before = oblique.now(one)
        along = SlidingContact(sphere, before, contact.duration[here], stretches)
        oblique.finish(one, *along.end, row)
        found.append((here, along))
    return tuple(found)
