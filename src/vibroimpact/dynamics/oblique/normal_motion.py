"""The normal motion of contacts on a grid, which drives their friction: time and force as functions
of a parameter.

The parameter rises nearly evenly through each part of a contact, slowly at its ends, so that the
depth of the contact grows with its square. It counts the steps of the grid. The core writes it as
it collocates contacts; those that it follows step by step are read here.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Drops, Floats
from vibroimpact.dynamics.contact import NormalRecords
from vibroimpact.dynamics.core import normal_records as records
from vibroimpact.dynamics.impact_conditions import ImpactConditions

if TYPE_CHECKING:
    from vibroimpact.dynamics.rigid.line_contact import RecordedContact

_TOLERANCE = 1e-10  # of contacts that are followed
_ASIDE = 1e-6  # of a part: step of finite differences
_NONE, _STEEP = 1e-6, 1e-2
"""Parts of the largest force: one that is zero, and a slope that is not."""


@dataclass(frozen=True)
class NormalMotion:
    """The normal motion of B contacts at G points of a parameter.

    `steps`: of the parameter (G - 1,), 1; a step of zero joins two parts, between which the others
    may jump. `rows`: time, pace, its slope, force, its slope and impulse (B, 6, G), which the
    properties give (G, B).
    """

    steps: Floats
    rows: Floats

    @property
    def time(self) -> Floats:
        """Time since first touch [s]."""
        return self._row(records.TIME)

    @property
    def pace(self) -> Floats:
        """Derivative of the time by the parameter [s]."""
        return self._row(records.PACE)

    @property
    def force(self) -> Floats:
        """Contact force, >= 0 [N]."""
        return self._row(records.FORCE)

    @property
    def force_slope(self) -> Floats:
        """Its derivative by the parameter [N]."""
        return self._row(records.FORCE_SLOPE)

    @property
    def impulse(self) -> Floats:
        """Impulse of the force so far [N s]."""
        return self._row(records.IMPULSE)

    def _row(self, number: int) -> Floats:
        return self.rows[:, number].T

    def take(self, drops: Drops) -> NormalMotion:
        """Return the normal motion of some of the contacts."""
        return NormalMotion(self.steps, self.rows[drops])

    @property
    def pressed(self) -> Floats:
        """Impulse of the force so far [N s] (G, B), of which a force that pulls, as some
        laws have at the end, gives nothing back.
        """
        return np.asarray(np.maximum.accumulate(self.impulse, axis=0))


def normal_motions(
    normals: NormalRecords, conditions: ImpactConditions
) -> list[tuple[Drops, NormalMotion]]:
    """Return the normal motion of contacts in groups that consist of the same parts, with
    the places of their drops.
    """
    motions: list[tuple[Drops, NormalMotion]] = []
    for shape in np.unique(normals.shapes).tolist():
        places = np.flatnonzero(normals.shapes == shape)
        if shape == 0:
            motions.extend(
                (np.array([place]), _followed(conditions.pick(np.array([place])), normals.steps))
                for place in places.tolist()
            )
            continue
        steps = _steps_of(_parts_of(shape, normals.steps))
        motions.append((places, NormalMotion(steps, _rows_of(normals, places, len(steps) + 1))))
    return motions


def _parts_of(shape: int, steps: int) -> list[int]:
    """Return the numbers of steps of the parts of a motion, from the number that tells them."""
    parts: list[int] = []
    while shape:
        shape, digit = divmod(shape, records.SHAPES)
        parts.insert(0, records.MORE_STEPS * steps if digit == records.STEEP else steps)
    return parts


def _steps_of(parts: Sequence[int]) -> Floats:
    """Return the steps of the parameter (G - 1,) through parts with these numbers of
    steps, with a step of zero between them.
    """
    return np.concatenate([one for steps in parts for one in ([0.0], np.ones(steps))][1:])


def _rows_of(normals: NormalRecords, places: Drops, points: int) -> Floats:
    """Return the rows of some contacts (b, 6, G), whose motions have this many points."""
    size = records.MOTION_ROWS * points
    begins = normals.begins[places]
    if begins[-1] - begins[0] == size * (len(places) - 1):  # without others between them
        rows = normals.motions[begins[0] : begins[-1] + size]
    else:
        rows = normals.motions[begins[:, None] + np.arange(size)]
    return np.asarray(rows.reshape(len(places), records.MOTION_ROWS, points))


def _joined(parts: list[Floats]) -> NormalMotion:
    """Return the motion of one contact through parts (6, G) one after the other, with a
    step of zero between them.
    """
    for before, part in itertools.pairwise(parts):
        for row in (records.TIME, records.IMPULSE):
            part[row] += before[row, -1]
    return NormalMotion(
        _steps_of([part.shape[1] - 1 for part in parts]), np.concatenate(parts, axis=1)[None]
    )


def _followed(conditions: ImpactConditions, steps: int) -> NormalMotion:
    """Return the normal motion of one drop as the core follows it, in parts between which
    the force is not smooth.
    """
    # a drop of impulses does not load the compiler
    from vibroimpact.dynamics.rigid.line_contact import RecordedContact

    recorded = RecordedContact.of(conditions, _TOLERANCE)
    leaving = conditions.under(
        conditions.law.after_compression(np.array([recorded.contact.deepest]))
    )
    parts = []
    for begin, end in itertools.pairwise(recorded.corners().tolist()):
        here = conditions if end <= recorded.contact.time_of_deepest else leaving
        part = _of_part(recorded, here, begin, end - begin, steps)
        if _is_steep_at_end(part):
            part = _of_part(recorded, here, begin, end - begin, records.MORE_STEPS * steps)
        parts.append(part)
    return _joined(parts)


def _of_part(
    recorded: RecordedContact, conditions: ImpactConditions, begin: float, length: float, steps: int
) -> Floats:
    """Return the rows of the normal motion in a part of a contact that the core followed (6, G);
    the time is a cosine of the parameter.

    `begin`, `length`: of the part, since touch [s].
    """
    angle = np.linspace(0.0, np.pi, steps + 1)
    half, step = 0.5 * length, angle[1]
    time, pace, bend = (
        half * (1.0 - np.cos(angle)),
        step * half * np.sin(angle),
        step**2 * half * np.cos(angle),
    )
    delta, rate, _ = recorded.motion(begin + time)
    law, speed = conditions.law, conditions.approach_speed
    force = np.add(*law.forces(delta, rate, speed))
    aside = _ASIDE * length
    changes = aside * rate, aside * (conditions.gravity - force / conditions.mass)
    later, earlier = (
        np.add(
            *law.forces(
                np.maximum(delta + sign * changes[0], conditions.floor),
                rate + sign * changes[1],
                speed,
            )
        )
        for sign in (1.0, -1.0)
    )
    slope = (later - earlier) / (2.0 * aside) * pace
    if law.tension == "cut":
        slope, force = np.where(force > 0.0, slope, 0.0), np.maximum(force, 0.0)
    # what stops the bodies is the force
    impulse = conditions.mass * (conditions.gravity * time - (rate - rate[0]))
    return np.array([time, pace, bend, np.maximum(force, 0.0), slope, impulse])


def _is_steep_at_end(part: Floats) -> bool:
    """Does the force pull at an end of a part, or begin or end there with a slope? The
    radius of the contact has an infinite one then.
    """
    steps = part.shape[1] - 1
    force, slope, most = (
        part[records.FORCE, [0, -1]],
        part[records.FORCE_SLOPE, [0, -1]] * steps,
        part[records.FORCE].max(),
    )
    return bool(((force <= _NONE * most) & (np.abs(slope) > _STEEP * most)).any())
