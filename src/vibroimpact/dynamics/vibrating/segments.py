"""History of one drop whose bodies vibrate: segments that give the motion at any time in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.recorded_drop import VibratingBounce
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

_STRETCH_POINTS = 49
_GAP_POINTS = 25

# grid of a free motion: points in the first periods of the lowest mode, and in the remainder
_FIRST_PERIODS = 10.0
_POINTS_OF_FIRST_PERIODS = 2001
_POINTS_OF_REMAINDER = 1001


@dataclass(frozen=True)
class VibratingSegment:
    """A segment of the history of one drop.

    It is a flight, a stretch of contact, a gap between two contacts, or rest.

    `start`, `end` [s]. `lost_before_all`: returns the energy lost before each segment [J],
    (segments, n + 2): in each coordinate, in the contact, in plastic deformation; `number`: of this
    one.
    """

    start: float
    end: float
    motion: VibratingStretch | FreePhase | FreeMotion | RestMotion
    lost_before_all: Callable[[], Floats]
    number: int

    @property
    def trajectory(self) -> VibratingStretch | FreeMotion | RestMotion:
        """The motion that gives states at times since the start of the segment."""
        if isinstance(self.motion, FreePhase):
            return self.motion.free
        return self.motion

    @property
    def system(self) -> LinearSystem:
        """The linear system."""
        trajectory = self.trajectory
        if isinstance(trajectory, RestMotion):
            return trajectory.equilibrium.system
        return trajectory.system

    @property
    def in_contact(self) -> bool:
        """Whether the surfaces overlap."""
        if isinstance(self.motion, FreePhase):
            return self.motion.local is not None
        return isinstance(self.motion, (VibratingStretch, RestMotion))

    def grid(self) -> Floats:
        """Times since the start that resolve the segment in a graph [s]."""
        span = self.end - self.start
        if isinstance(self.motion, VibratingStretch):
            x = np.linspace(0.0, 1.0, _STRETCH_POINTS)
            return np.asarray(span * self.motion.rule.map_time(x))
        if isinstance(self.motion, FreePhase):
            return np.linspace(0.0, span, _GAP_POINTS)
        lowest = float(self.system.angular_frequency[self.system.vibrating].min(initial=np.inf))
        first = 0.0
        if np.isfinite(lowest):
            first = min(span, _FIRST_PERIODS * 2.0 * np.pi / lowest)
        return np.concatenate(
            [
                np.linspace(0.0, first, _POINTS_OF_FIRST_PERIODS)[:-1],
                np.linspace(first, span, _POINTS_OF_REMAINDER),
            ]
        )

    @property
    def lost_before(self) -> Floats:
        """Energy lost before it [J] (n + 2,)."""
        return np.asarray(self.lost_before_all()[self.number])

    @property
    def lost(self) -> Floats:
        """Energy lost in it [J], as in `lost_before`."""
        if isinstance(self.motion, VibratingStretch):
            return np.append(self.motion.lost, self._plastic_work(self.motion))
        duration = np.array([self.end - self.start])
        return np.append(self.motion.lost_by(duration)[0], 0.0)

    def _plastic_work(self, stretch: VibratingStretch) -> float:
        """Return the plastic work in a stretch of contact [J]."""
        (contact,) = stretch.contacts
        local = contact.local
        if not local.law.yields:
            return 0.0
        # nothing yields before the surfaces touch
        start, end = np.maximum(contact.approach[[0, -1]], local.release_level)
        return float(local.plastic_work(end) - local.plastic_work(start))

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (T,)."""
        return self.trajectory.state(time)


def vibrating_timeline(
    bounces: Sequence[VibratingBounce], lying: RestMotion | None, end: float
) -> list[VibratingSegment]:
    """Return the history of one drop as segments in order.

    Parameters
    ----------
    bounces : sequence of VibratingBounce
        Its flights and visits.
    lying : RestMotion or None
        Its motion at rest, if it comes to rest.
    end : float
        End of the run [s].
    """
    segments: list[VibratingSegment] = []

    @cache
    def lost_before_all() -> Floats:
        # that of a history of motion alone is not asked for, and takes as long as the rest
        lost = np.zeros((len(segments), bounces[0].motion.system.number + 2))
        for segment in segments[:-1]:
            lost[segment.number + 1] = lost[segment.number] + segment.lost
        return lost

    def append(
        begin: float, end: float, motion: VibratingStretch | FreePhase | FreeMotion | RestMotion
    ) -> None:
        segments.append(VibratingSegment(begin, end, motion, lost_before_all, len(segments)))

    for bounce in bounces:
        touch = float(bounce.flight_end[0])
        start = float(bounce.flight.start[0])
        append(start, touch, bounce.motion)
        if bounce.contact is None:  # the run has ended in this flight
            continue
        for piece in bounce.contact.pieces:
            begin = touch + piece.start
            assert isinstance(piece.motion, (VibratingStretch, FreePhase))
            append(begin, begin + piece.motion.length, piece.motion)
    if lying is not None:
        append(segments[-1].end, end, lying)
    return segments
