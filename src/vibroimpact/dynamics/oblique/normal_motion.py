"""The normal motion of contacts on a grid, which drives their friction: time and force as functions of a parameter.

The parameter rises nearly evenly through each part of a contact, slowly at its ends, so that the depth of the contact grows with its
square. It counts the steps of the grid.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Drops, Floats
from vibroimpact.dynamics.contact import Contact, Piece
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.collocation import PlaneRule
from vibroimpact.dynamics.phase_plane.motion import PlaneMotion

if TYPE_CHECKING:
    from vibroimpact.dynamics.rigid.line_contact import RecordedContact

_ROUNDING = 1e-9
_HALVINGS = 30
_MORE = 3  # times as many steps where the force is steep
_TOLERANCE = 1e-10  # of contacts that are followed
_ASIDE = 1e-6  # of a part: step of finite differences
_NONE, _STEEP = 1e-6, 1e-2
"""Parts of the largest force: one that is zero, and a slope that is not."""


@dataclass(frozen=True)
class NormalMotion:
    """The normal motion of B contacts at G points of a parameter; arrays are (G, B).

    `steps`: of the parameter (G - 1,), 1; a step of zero joins two parts, between which the others may jump. `time`: since first touch [s].
    `pace`, `pace_slope`: derivatives of the time by the parameter [s]. `force`: >= 0 [N], `force_slope`: its derivative. `impulse`: of the
    force so far [N s].
    """

    steps: Floats
    time: Floats
    pace: Floats
    pace_slope: Floats
    force: Floats
    force_slope: Floats
    impulse: Floats

    def take(self, drops: Drops) -> NormalMotion:
        """Return the normal motion of some of the contacts."""
        return NormalMotion(self.steps, *(getattr(self, name)[:, drops] for name in _ARRAYS))

    @property
    def pressed(self) -> Floats:
        """Impulse of the force so far [N s] (G, B), of which a force that pulls, as some laws have at the end, gives nothing back."""
        return np.asarray(np.maximum.accumulate(self.impulse, axis=0))

    def integrals(self, values: Floats, slopes: Floats) -> Floats:
        """Return the integrals over time so far (G, B) of a quantity with these values, and slopes by the parameter."""
        rate, bend, step = self.pace * values, self.pace_slope * values + self.pace * slopes, self.steps[:, None]
        found = np.zeros_like(rate)
        np.cumsum(step * (0.5 * (rate[1:] + rate[:-1]) + (bend[:-1] - bend[1:]) / 12.0), axis=0, out=found[1:])
        return found


def normal_motions(contact: Contact, encounter: Encounter, steps: int) -> list[tuple[Drops, NormalMotion]]:
    """Return the normal motion of contacts in groups that consist of the same parts, with the places of their drops.

    `steps`: of each segment of a phase; three times as many where the force is steep.
    """
    pieces, size = contact.pieces, len(encounter.mass)
    member = np.zeros((len(pieces), size), dtype=bool)
    for number, piece in enumerate(pieces):
        member[number, piece.drops] = True
    kinds, kind_of = member[:, :1], np.zeros(size, dtype=np.intp)
    if not member.all():
        kinds, kind_of = np.unique(member, axis=1, return_inverse=True)
    found = []
    for kind in range(kinds.shape[1]):
        places, parts = np.flatnonzero(kind_of.ravel() == kind), [pieces[number] for number in np.flatnonzero(kinds[:, kind])]
        if all(isinstance(part.motion, PlaneMotion) for part in parts):
            found.append((places, _joined([one for part in parts for one in _of_phase(part, encounter, places, steps)])))
        else:
            found.extend((np.array([place]), _followed(encounter.pick(np.array([place])), steps)) for place in places.tolist())
    return found


_COARSER = 0.2
"""Part by which steps are longer than evenly where the contact is deepest, and shorter where it begins and ends."""

_ARRAYS = ("time", "pace", "pace_slope", "force", "force_slope", "impulse")


def _of_phase(piece: Piece, encounter: Encounter, places: Drops, steps: int) -> list[NormalMotion]:
    """Return the normal motion in the segments of a phase that was solved in the phase plane, in order of time.

    The parameter is y, which falls in compression.
    """
    here = np.isin(piece.drops, places)
    motion, encounter = piece.motion.take(here), encounter.under(piece.law).take(places)
    assert isinstance(motion, PlaneMotion)
    rule, compressing = motion.rule, motion.name == "compression"
    static, dissipative = motion.forces(encounter)
    forces = static + dissipative
    steps *= _MORE if _is_steep(rule, forces) else 1
    if encounter.law.tension == "cut":
        forces = np.maximum(forces, 0.0)
    (grid, rate, bend), left, found = _graded(steps), motion.duration, []
    for pace, force in zip(rule.split(motion.pace), rule.split(forces), strict=True):
        ends = _reach(rule, pace, left)
        if (ends == 1.0).all():
            values, sums = rule.weights_at(grid[:, 0]).T, rule.weights_to_end(grid[:, 0]).T @ rule.integral
            slopes = values @ rule.derivatives[0]
            speed, change = (rate * values) @ pace, (rate**2 * slopes + bend * values) @ pace
            strength, growth = values @ force, (rate * slopes) @ force
            time, impulse = sums @ pace, sums @ (force * pace)
        else:  # released within the segment, each drop at a place of its own
            at, first = grid * ends, rate * ends
            values, sums = (weights(at.ravel()).reshape(-1, *at.shape) for weights in (rule.weights_at, rule.weights_to_end))
            nodes = (pace, rule.derivatives[0] @ pace, force, rule.derivatives[0] @ force)
            speed, change, strength, growth = (np.einsum("ngb,nb->gb", values, one) for one in nodes)
            time, impulse = (np.einsum("ngb,nb->gb", sums, rule.integral @ one) for one in (pace, force * pace))
            speed, change, growth = speed * first, change * first**2 + speed * bend * ends, growth * first
        time[0] = impulse[0] = 0.0
        found.append(NormalMotion(np.ones(steps), time, speed, change, np.maximum(strength, 0.0), growth, impulse))
        left = left - time[-1]
    return [_reversed(one) for one in reversed(found)] if compressing else found


def _graded(steps: int) -> tuple[Floats, Floats, Floats]:
    """Return y at the points of a segment, from 0 to 1, and its derivatives by the number of the step (G, 1)."""
    share = np.linspace(0.0, 1.0, steps + 1)[:, None]
    rate = 1.0 + _COARSER * (1.0 - 2.0 * share)
    return share * (1.0 + _COARSER * (1.0 - share)), rate / steps, np.full_like(share, -2.0 * _COARSER / steps**2)


def _is_steep(rule: PlaneRule, forces: Floats) -> bool:
    """Return whether the force of some drop pulls at the end of a phase, or begins or ends there with a slope.

    Where it becomes zero with a slope, the radius of the contact has an infinite one.
    """
    at_end, slope = rule.end @ rule.split(forces)[-1], rule.end @ (rule.derivatives[0] @ rule.split(forces)[-1])
    most = forces.max(axis=0)
    return bool(((at_end < -_NONE * most) | (np.abs(at_end) <= _NONE * most) & (np.abs(slope) > _STEEP * most)).any())


def _reach(rule: PlaneRule, pace: Floats, left: Floats) -> Floats:
    """Return the y at which a time from the deep end of a segment has passed [s] (B,), at most 1; `pace`: dt/dy at the nodes (N, B)."""
    elapsed = rule.integral @ pace
    found = np.ones(pace.shape[-1])
    short = np.flatnonzero(left < elapsed[-1] * (1.0 - _ROUNDING))
    if short.size:
        low, high = np.zeros(len(short)), np.ones(len(short))
        for _ in range(_HALVINGS):  # by Newton's method within a bracket
            y = found[short]
            passed = (rule.weights_to_end(y) * elapsed[:, short]).sum(axis=0) - left[short]
            low, high = np.where(passed <= 0.0, y, low), np.where(passed > 0.0, y, high)
            step = y - passed / (rule.weights_at(y) * pace[:, short]).sum(axis=0)
            found[short] = np.where((step > low) & (step < high), step, 0.5 * (low + high))
    return found


def _reversed(motion: NormalMotion) -> NormalMotion:
    """Return a motion whose parameter counts from the other end."""
    time, pace, slope, force, force_slope, impulse = (getattr(motion, name)[::-1] for name in _ARRAYS)
    return NormalMotion(motion.steps[::-1], time[0] - time, pace, -slope, force, -force_slope, impulse[0] - impulse)


def _joined(parts: list[NormalMotion]) -> NormalMotion:
    """Return the motion through parts one after the other, with a step of zero between them."""
    arrays: dict[str, Floats] = {}
    for name in _ARRAYS:
        series = [getattr(part, name) for part in parts]
        if name in ("time", "impulse"):
            for number in range(1, len(series)):
                series[number] = series[number - 1][-1] + series[number]
        arrays[name] = np.concatenate(series)
    steps = np.concatenate([one for part in parts for one in ([0.0], part.steps)][1:])
    return NormalMotion(steps, **arrays)


def _followed(encounter: Encounter, steps: int) -> NormalMotion:
    """Return the normal motion of one drop as the core follows it, in parts between which the force is not smooth."""
    from vibroimpact.dynamics.rigid.line_contact import RecordedContact  # a drop of impulses does not load the compiler

    recorded = RecordedContact.of(encounter, _TOLERANCE)
    leaving = encounter.under(encounter.law.after_compression(np.array([recorded.contact.deepest])))
    parts = []
    for begin, end in itertools.pairwise(recorded.corners().tolist()):
        here = encounter if end <= recorded.contact.time_of_deepest else leaving
        part = _of_part(recorded, here, begin, end - begin, steps)
        if _is_steep_at_end(part):
            part = _of_part(recorded, here, begin, end - begin, _MORE * steps)
        parts.append(part)
    return _joined(parts)


def _of_part(recorded: RecordedContact, encounter: Encounter, begin: float, length: float, steps: int) -> NormalMotion:
    """Return the normal motion in a part of a contact that the core followed; the time is a cosine of the parameter.

    `begin`, `length`: of the part, since touch [s].
    """
    angle = np.linspace(0.0, np.pi, steps + 1)
    half, step = 0.5 * length, angle[1]
    time, pace, bend = half * (1.0 - np.cos(angle)), step * half * np.sin(angle), step**2 * half * np.cos(angle)
    delta, rate, _ = recorded.motion(begin + time)
    law, speed = encounter.law, encounter.approach_speed
    force = np.add(*law.forces(delta, rate, speed))
    aside = _ASIDE * length
    changes = aside * rate, aside * (encounter.gravity - force / encounter.mass)
    later, earlier = (
        np.add(*law.forces(np.maximum(delta + sign * changes[0], encounter.floor), rate + sign * changes[1], speed)) for sign in (1.0, -1.0)
    )
    slope = (later - earlier) / (2.0 * aside) * pace
    if law.tension == "cut":
        slope, force = np.where(force > 0.0, slope, 0.0), np.maximum(force, 0.0)
    impulse = encounter.mass * (encounter.gravity * time - (rate - rate[0]))  # what stops the bodies is the force
    arrays = (time, pace, bend, np.maximum(force, 0.0), slope, impulse)
    return NormalMotion(np.ones(steps), *(values[:, None] for values in arrays))


def _is_steep_at_end(part: NormalMotion) -> bool:
    """Does the force pull at an end of a part, or begin or end there with a slope? The radius of the contact has an infinite one then."""
    force, slope, most = part.force[[0, -1]], part.force_slope[[0, -1]] * len(part.steps), part.force.max()
    return bool(((force <= _NONE * most) & (np.abs(slope) > _STEEP * most)).any())
