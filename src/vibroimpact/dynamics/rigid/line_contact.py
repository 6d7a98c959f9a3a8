"""Contacts of rigid bodies, solved by the core one drop after the other, and their motion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import interpreted, law_addresses, law_coefficients
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.core import line_records as records
from vibroimpact.dynamics.core.events import ENDS, TENSIONS
from vibroimpact.dynamics.core.law import law_at_touch
from vibroimpact.dynamics.core.line import CAPTURED, FAILED, follow_line
from vibroimpact.dynamics.core.line_step import BY_ROOT, FREE
from vibroimpact.dynamics.core.lines import follow_lines, read_line, time_line
from vibroimpact.dynamics.core.normal_records import NormalGrid
from vibroimpact.dynamics.core.phase_contact import collocate_contact
from vibroimpact.dynamics.core.phase_records import ROWS, PhaseRules
from vibroimpact.dynamics.core.records import Law
from vibroimpact.dynamics.motion.contact import Contact, Piece
from vibroimpact.dynamics.motion.impact_conditions import ImpactConditions
from vibroimpact.dynamics.motion.law_coefficients import coefficients_of
from vibroimpact.dynamics.rigid.phase_rules import normal_grid, phase_rules

_MOST_STEPS = 1_000_000  # the stiffest sensible contacts need thousands
FEW = 5
"""Number of contacts: fewer take less time in plain Python than numba takes to load."""

_ROOM = 200  # steps of a contact, at first
_PARTS = 4  # of a step in a history
_TIGHTEST = 1e-11  # a smaller tolerance is too close to rounding for collocation
# at a larger one, which costs hardly less, the largest force would be less exact than it is taken
# to be
_LOOSEST = 1e-9
_NO_COMPLIANCE = np.zeros(7)
_OF_STEP = 0.01  # of the tolerance: error of a step, of which a contact has some dozens
_LEAST_ERROR = 1e-14
_ON_CORNER = 1e-9  # of the duration

NO_CONTACTS = records.ContactManner(
    manner=records.LineManner(2, 0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0),
    rules=PhaseRules(
        tolerance=0.0,
        roughness=0.0,
        roughness_inside=0.0,
        sharper=0.0,
        root=2,
        counts=np.zeros(0, dtype=np.int64),
        vectors=np.zeros((0, 0, 0)),
        matrices=np.zeros((0, 0, 0)),
        onward=np.zeros((0, 0, 0)),
    ),
    grid=NormalGrid(
        steps=0,
        derivatives=np.zeros((0, 0, 0)),
        values=np.zeros((0, 0, 0)),
        integrals=np.zeros((0, 0, 0)),
        own=np.zeros((0, 0, 0)),
        room=np.zeros((0, 0)),
        motion=np.zeros((0, 0)),
        parameter=np.zeros(0),
        points=np.zeros(1, dtype=np.int64),
    ),
    collocates=False,
    addresses=np.zeros(4, dtype=np.int64),
)
"""What takes the place of the contacts of a law without a force."""


def touches_of(conditions: ImpactConditions) -> Floats:
    """Return the bodies of B impacts as they touch (5, B), as `follow_lines` takes them."""
    return np.array(
        [
            conditions.mass,
            conditions.gravity,
            conditions.approach_speed,
            conditions.depth,
            conditions.speed_scale,
        ]
    )


def contact_manner(
    law: CompliantLaw, tolerance: float, friction_steps: int = 0
) -> records.ContactManner:
    """Return how contacts under a law are solved.

    `friction_steps`: of the normal motion in each segment of a contact, if it drives friction.
    """
    return records.ContactManner(
        manner=_common_manner(law, tolerance),
        rules=gauss_rules(law, tolerance),
        grid=normal_grid(friction_steps),
        collocates=collocates(law, tolerance),
        addresses=law_addresses(type(law)),
    )


def contact_of(
    conditions: ImpactConditions, tolerance: float, deepest: float, times: tuple[float, float]
) -> Contact:
    """Return the contact of one drop that the core has solved.

    Parameters
    ----------
    conditions : ImpactConditions
        The impact.
    tolerance : float
        Relative error allowed.
    deepest : float
        Largest indentation [m].
    times : tuple of two floats
        Durations of the contact and of its compression [s].
    """
    duration, compressed = times
    law = conditions.law
    law_after = law.after_compression(np.array([deepest]))
    compression = LineMotion(conditions, tolerance, "compression", np.array([compressed]))
    pieces = [Piece(0.0, compression, law)]
    if duration > compressed:
        left = np.array([duration - compressed])
        restitution = LineMotion(conditions, tolerance, "restitution", left)
        pieces.append(Piece(compressed, restitution, law_after))
    return Contact(pieces, law_after)


def release_rates(conditions: ImpactConditions, tolerance: float) -> Floats:
    """Return the indentation rates of B drops at the end of their contacts [m/s].

    They are zero where drops are captured, NaN where that failed. A few are collocated in plain
    Python.

    Parameters
    ----------
    conditions : ImpactConditions
        The impact.
    tolerance : float
        Relative error allowed.
    """
    size = len(conditions.mass)
    rates = np.full(size, np.nan)
    if size < FEW and collocates(conditions.law, tolerance):
        with interpreted():
            rates = np.array(
                [
                    _collocated_rate(conditions.pick(np.array([drop])), tolerance)
                    for drop in range(size)
                ]
            )
    missing = np.flatnonzero(np.isnan(rates))
    if missing.size:
        rates[missing] = _followed_rates(conditions.pick(missing), tolerance)
    return rates


def _collocated_rate(conditions: ImpactConditions, tolerance: float) -> float:
    """Return the indentation rate of one drop at the end of its contact [m/s].

    It is NaN if the contact cannot be collocated.
    """
    rules = gauss_rules(conditions.law, tolerance)
    law = _law_at_touch(conditions.law.take(0), conditions)
    room = np.zeros((ROWS, rules.vectors.shape[2]))
    solved, contact = collocate_contact(
        law, _manner(conditions, 0, tolerance), rules, normal_grid(0), room
    )
    return float(contact.end.rate) if solved else np.nan


def _followed_rates(conditions: ImpactConditions, tolerance: float) -> Floats:
    """Return what `release_rates` does, of contacts that the core follows."""
    size = len(conditions.mass)
    contacts = records.LineContacts(np.zeros(size, dtype=np.int64), np.zeros((10, size)))
    with coefficients_of(conditions.law, size) as coefficients:
        manner = contact_manner(conditions.law, tolerance)
        follow_lines(manner, coefficients, touches_of(conditions), contacts)
    rates = np.where(contacts.outcomes == FAILED, np.nan, contacts.ends[2])
    return np.where(contacts.outcomes == CAPTURED, 0.0, rates)


def law_and_bodies(
    held: CompliantLaw, conditions: ImpactConditions, tolerance: float
) -> tuple[Law, records.LineManner]:
    """Return the contact law and the bodies of one drop as the core takes them.

    `held`: the law of the drop, which is kept as long as they are used.
    """
    return _law_at_touch(held, conditions), _manner(conditions, 0, tolerance)


def _law_at_touch(law: CompliantLaw, conditions: ImpactConditions) -> Law:
    """Return the law of one drop as the core takes it."""
    return law_at_touch(
        law_addresses(type(law)),
        law_coefficients(law),
        _NO_COMPLIANCE,
        float(conditions.approach_speed[0]),
    )


def collocates(law: CompliantLaw, tolerance: float) -> bool:
    """Whether collocation is tried for contacts under a law."""
    return tolerance >= _TIGHTEST and law.contact_end != "pull-off"


def gauss_rules(law: CompliantLaw, tolerance: float) -> PhaseRules:
    """Return the Gauss rules of the collocation."""
    return phase_rules(law.root, min(max(tolerance, _TIGHTEST), _LOOSEST))


@dataclass(frozen=True)
class LineMotion:
    """The motion of one contact in compression or restitution.

    It is computed again where it is read.

    Parameters
    ----------
    conditions : ImpactConditions
        The impact, with the law as it is at touch.
    tolerance : float
        Relative error allowed.
    phase : {"compression", "restitution"}
        Which part of the contact this is.
    duration : array, shape (1,)
        Of this part [s].
    """

    conditions: ImpactConditions
    tolerance: float
    phase: Literal["compression", "restitution"]
    duration: Floats

    @cached_property
    def recorded(self) -> RecordedContact:
        """The contact with its steps."""
        return RecordedContact.of(self.conditions, self.tolerance)

    @property
    def begins_at(self) -> float:
        """Return the indentation at its start [m]."""
        if self.phase == "compression":
            return self.recorded.law.touch
        return self.recorded.contact.deepest

    @property
    def begins(self) -> float:
        """Time since touch at which it begins [s]."""
        if self.phase == "compression":
            return 0.0
        return self.recorded.contact.time_of_deepest

    def grid(self) -> Floats:
        """Return times since the start at which the motion is well resolved [s].

        That of the largest force is one of them.
        """
        times = self.recorded.times(self.phase == "restitution") - self.begins
        if self.phase == "compression":
            times = np.unique(np.append(times, self.recorded.contact.time_of_peak_force))
        return np.append(times[times < self.duration[0]], self.duration[0])

    def at(self, time: Floats) -> tuple[Floats, Floats, Floats]:
        """Return indentation [m], its rate [m/s] and the energy dissipated [J].

        They are those at times since the start [s].
        """
        delta, rate, lost = self.recorded.motion(self.begins + np.append(time, 0.0))
        return delta[:-1], rate[:-1], lost[:-1] - lost[-1]


@dataclass(frozen=True)
class RecordedContact:
    """The contact of one drop with its steps.

    Parameters
    ----------
    law, manner : Law, LineManner
        As the core takes them.
    steps : LineSteps
        Its steps.
    contact : LineContact
        How it ended.
    held : CompliantLaw
        The law, which compiled code may call.
    """

    law: Law
    manner: records.LineManner
    steps: records.LineSteps
    contact: records.LineContact
    held: CompliantLaw

    @classmethod
    def of(cls, conditions: ImpactConditions, tolerance: float) -> RecordedContact:
        """Follow the contact of one drop again, and record its steps."""
        held = conditions.law.take(0)
        law, manner = law_and_bodies(held, conditions, tolerance)
        room = _ROOM
        while True:
            steps = records.LineSteps(
                variable=np.zeros(room, dtype=np.int64),
                after=np.zeros(room, dtype=bool),
                begun=np.zeros((room, 4)),
                length=np.zeros(room),
                written=np.zeros(1, dtype=np.int64),
            )
            contact = follow_line(law, manner, steps)
            room = int(steps.written[0])
            if room <= len(steps.length):
                recorded_steps = records.LineSteps(
                    variable=steps.variable[:room].copy(),
                    after=steps.after[:room].copy(),
                    begun=steps.begun[:room].copy(),
                    length=steps.length[:room].copy(),
                    written=steps.written,
                )
                return cls(law, manner, recorded_steps, contact, held)

    def motion(self, times: Floats) -> Floats:
        """Return indentation [m], its rate [m/s] and energy dissipated [J] (3, T).

        They are those at times since touch [s].
        """
        # the core reads times in order
        order = np.argsort(times, kind="stable")
        ordered = np.empty((3, len(times)))
        read_line(
            self.law,
            self.manner,
            self.contact.deepest,
            self.steps,
            np.ascontiguousarray(times[order]),
            ordered,
        )
        motion = np.empty_like(ordered)
        motion[:, order] = ordered
        return motion

    def times(self, after: bool) -> Floats:
        """Return the times at which the contact is well resolved [s].

        They are those before, or after, its deepest point.
        """
        times = np.empty((len(self.steps.length), _PARTS))
        time_line(self.law, self.manner, self.contact.deepest, self.steps, times)
        return np.asarray(times[self.steps.after == after].ravel())

    def corners(self) -> Floats:
        """Return the times between which the force is smooth, from touch to the end [s]."""
        starts = self.steps.begun[1:, 0]
        variable = self.steps.variable[:-1]
        next_variable = self.steps.variable[1:]
        end = self.contact.end.time
        # after steps in the root of the indentation, and where free motion begins or ends
        at_corner = (variable == BY_ROOT) | (variable == FREE) | (next_variable == FREE)
        times = np.unique(np.append(starts[at_corner], self.contact.time_of_deepest))
        inside = (times > _ON_CORNER * end) & (times < (1.0 - _ON_CORNER) * end)
        return np.concatenate([[0.0], times[inside], [end]])


def _common_manner(law: CompliantLaw, tolerance: float) -> records.LineManner:
    """Return what contacts under a law have in common, as the core takes it, without bodies."""
    return records.LineManner(
        root=law.root,
        tension=TENSIONS.index(law.tension),
        contact_end=ENDS.index(law.contact_end),
        mass=0.0,
        gravity=0.0,
        depth=0.0,
        speed_scale=0.0,
        tolerance=max(_OF_STEP * tolerance, _LEAST_ERROR),
        most_steps=_MOST_STEPS,
    )


def _manner(conditions: ImpactConditions, drop: int, tolerance: float) -> records.LineManner:
    """Return a drop of an impact as the core takes it."""
    return _common_manner(conditions.law, tolerance)._replace(
        mass=float(conditions.mass[drop]),
        gravity=float(conditions.gravity[drop]),
        depth=float(conditions.depth[drop]),
        speed_scale=float(conditions.speed_scale[drop]),
    )
