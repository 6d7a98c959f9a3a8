"""The motion along the plate in impacts of spheres on plates that deform."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.along import Sphere, State, state_after
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.vibrating.recorded_motion import RecordedMotion
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.surface_friction import SlidingStretch


@dataclass(frozen=True)
class SlidingContact:
    """The motion along the plate in the impact of one drop; see `ContactAlong`.

    `sphere`, `before`: the sphere, and its state at first touch. `duration`: of the impact [s]
    (1,). `stretches`: its stretches under friction, with their starts since first touch [s].
    """

    sphere: Sphere
    before: State
    duration: Floats
    stretches: Sequence[tuple[float, SlidingStretch]]

    def at(self, time: Floats) -> tuple[State, Floats, Floats]:
        """Return states, friction forces on the sphere [N] (2, T) and energy taken [J] (T,).

        Times [s] (T,) are since first touch.
        """
        time = np.minimum(time, self.duration)
        slip = self.sphere.slip(self.before)
        gravity = self.sphere.gravity
        # without friction, until the first stretch
        velocity = slip + gravity * time
        displacement = (slip + 0.5 * gravity * time) * time
        force = np.zeros((2, len(time)))
        work = np.zeros(len(time))
        turned = np.zeros((3, len(time)))
        turned_way = np.zeros((2, len(time)))
        begun = np.searchsorted(self._starts, time, side="right") - 1  # the last stretch begun
        for number in np.unique(begun[begun >= 0]).tolist():
            start, stretch = self.stretches[number]
            finish = start + stretch.length
            within = (begun == number) & (time <= finish)
            if within.any():
                elapsed = time[within] - start
                velocity[:, within], displacement[:, within], forces, work[within] = stretch.at(
                    elapsed
                )
                force[:, within] = forces[:2]
                turned[:, within], turned_way[:, within] = stretch.turned(elapsed)
            # the sphere flies on from the end of a stretch until the next one
            later = (begun == number) & (time > finish)
            if later.any():
                end = stretch.end
                elapsed = time[later] - start - stretch.length
                pull = stretch.sphere.pull[:, None]
                velocity[:, later] = end.velocity[:, None] + pull * elapsed
                displacement[:, later] = (
                    end.displacement[:, None]
                    + (end.velocity[:, None] + 0.5 * pull * elapsed) * elapsed
                )
                work[later] = end.work
                turned[:, later] = end.turned[:, None]
                turned_way[:, later] = (
                    end.turned_way[:, None] + stretch.sphere.radius * end.turned[:2, None] * elapsed
                )
        state = state_after(
            self.sphere, self.before, time, (velocity, displacement), (turned, turned_way)
        )
        return state, -force, work

    @cached_property
    def _starts(self) -> Floats:
        """Starts of the stretches, since first touch [s]."""
        return np.array([start for start, _ in self.stretches])

    @property
    def end(self) -> tuple[State, Floats, Floats]:
        """The state at the end, and the energies that friction and microslip took [J] (1,)."""
        state, _, work = self.at(self.duration)
        microslip = 0.0
        if self.stretches:
            _, last_stretch = self.stretches[-1]
            microslip = last_stretch.end.microslip
        return state, work, np.array([microslip])


def sliding_contact(
    oblique: ObliqueMotion, recorded: RecordedMotion, impact: int, duration: float
) -> SlidingContact:
    """Return the motion along the plate in an impact of one drop, from its state before it.

    Parameters
    ----------
    oblique : ObliqueMotion
        Of the drop, before the impact.
    recorded : RecordedMotion
        Its motion.
    impact : int
        Number of the impact, counted from 0.
    duration : float
        Of the impact [s].
    """
    stretches = []
    for part in recorded.parts_of(impact):
        motion = recorded.motion(part)
        if isinstance(motion, VibratingStretch) and motion.sliding is not None:
            stretches.append((float(recorded.parts.start[part]), motion.sliding))
    return SlidingContact(oblique.sphere, oblique.state, np.array([duration]), stretches)
