"""The history of one drop of rigid bodies as a sequence of segments in order of time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import cast, overload

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.motion.bounce import Bounce
from vibroimpact.dynamics.motion.ride import RideSegment
from vibroimpact.dynamics.rigid.segments import (
    ContactSegment,
    FlightSegment,
    MotionInContact,
    RestSegment,
    Segment,
)


@dataclass(frozen=True, eq=False)
class Timeline(Sequence[Segment]):
    """Segments made lazily from the bounces of a run.

    Those of a hundred thousand impacts would take 1 GB.

    Parameters
    ----------
    bounces : sequence of Bounce
        The flights and contacts of one drop.
    rest : RestSegment, RideSegment or None
        What comes after them, if the drop comes to rest.
    starts : array, shape (segments,)
        When each segment begins [s].
    spent : array, shape (segments, 3)
        Energy lost before each in damping, in plastic deformation, and to the drive of the plate
        [J].
    """

    bounces: Sequence[Bounce]
    rest: RestSegment | RideSegment | None
    starts: Floats
    spent: Floats
    _firsts: Indices
    _recent: dict[int, list[Segment]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.starts)

    def bounce_of(self, number: int) -> int:
        """Return the number of the bounce to which a segment belongs.

        What comes after the bounces belongs to the last one.
        """
        after = int(np.searchsorted(self._firsts, number, side="right"))
        return min(after, len(self.bounces)) - 1

    @overload
    def __getitem__(self, index: int) -> Segment: ...

    @overload
    def __getitem__(self, index: slice) -> list[Segment]: ...

    def __getitem__(self, index: int | slice) -> Segment | list[Segment]:
        if isinstance(index, slice):
            return [self[number] for number in range(*index.indices(len(self)))]
        number = range(len(self))[index]
        bounce = self.bounce_of(number)
        if self.rest is not None and number == len(self) - 1:
            return self.rest
        if bounce not in self._recent:  # segments are mostly read in order
            self._recent.clear()
            self._recent[bounce] = segments_of(self.bounces[bounce])
        return self._recent[bounce][number - int(self._firsts[bounce])]


def timeline_of(
    bounces: Sequence[Bounce], rest: RestSegment | RideSegment | None, lost: Floats
) -> Timeline:
    """Return the history of one drop.

    Parameters
    ----------
    bounces : sequence of Bounce
        Its flights and contacts.
    rest : RestSegment, RideSegment or None
        What comes after them, if it comes to rest.
    lost : array, shape (impacts, 3)
        Energy that each impact takes in damping, in plastic deformation, and minus the work of the
        drive of the plate [J].
    """
    lost_before = np.concatenate([np.zeros((1, 3)), np.cumsum(lost, axis=0)])
    starts: list[float] = []
    spent: list[Floats] = []
    firsts: list[int] = []  # number of the first segment of each bounce
    for number, bounce in enumerate(bounces):
        firsts.append(len(starts))
        so_far = lost_before[number]
        segments = segments_of(bounce)
        for segment in segments:
            if isinstance(segment, RideSegment):
                so_far = lost_before[number + 1]
            starts.append(segment.start)
            spent.append(so_far)
            if isinstance(segment, ContactSegment) and segment is not segments[-1]:
                *_, dissipated, plastic = segment.at(segment.duration)
                so_far = so_far + np.array([float(dissipated[0]), float(plastic[0]), 0.0])
    if rest is not None:
        firsts.append(len(starts))
        starts.append(rest.start)
        spent.append(lost_before[-1])
    return Timeline(bounces, rest, np.array(starts), np.array(spent), np.array(firsts))


def segments_of(bounce: Bounce) -> list[Segment]:
    """Return the segments of a bounce of one drop."""
    touch = float(bounce.flight_end[0])
    segments: list[Segment] = [FlightSegment(float(bounce.flight.start[0]), touch, bounce.flight)]
    if bounce.ride is not None:
        launch = float(bounce.ride.end[0])
        if touch < launch < np.inf:
            segments.append(RideSegment(touch, launch, bounce.ride, launch))
    if bounce.contact is None:
        return segments
    for piece in bounce.contact.pieces:
        start = touch + piece.start
        end = start + float(piece.motion.duration[0])
        motion = cast(MotionInContact, piece.motion)
        segments.append(ContactSegment(start, end, motion, motion.conditions.under(piece.law)))
    return segments


def end_of(bounce: Bounce) -> float:
    """Return the end time of a bounce of one drop [s]."""
    return segments_of(bounce)[-1].end
