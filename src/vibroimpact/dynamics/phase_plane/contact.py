"""Contacts of rigid bodies in the phase plane, where both ends of each way are known and no event is sought.

The way in is solved up to the deepest point, then the way out with what the law remembers of that, each in segments between the levels
where the force is not smooth (`plane_rule`). Where a law may not pull and its force becomes zero on the way out, the contact ends or the
sphere glides until the law pushes again, and so out. What does not come out to the tolerance is integrated in time (`contact_phase`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Self

import numpy as np

from vibroimpact.arrays import Array, Bools, Drops, Floats, Indices
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.static import static_work
from vibroimpact.dynamics.contact import RELEASED, Contact, Piece
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.collocation import PlaneRule, plane_rule
from vibroimpact.dynamics.phase_plane.motion import PlaneMotion
from vibroimpact.dynamics.phase_plane.peak_force import plane_peak
from vibroimpact.dynamics.phase_plane.phase import Direction, PlaneWay, solve_way
from vibroimpact.dynamics.phase_plane.zero_force import end_of_push, pulls
from vibroimpact.dynamics.rigid.glide import Glide, glide_until_push
from vibroimpact.dynamics.rigid.solve_contact import SolvesContact, collocated

_TIGHTEST = 1e-11  # below it rounding leaves too little room
_LEAST_RESTITUTION = 0.1  # slower drops are left to what knows how to capture them
_SWEEPS = 10
_MARGIN = 5e-3  # of its depth: by less than that it is not known beforehand whether a drop will pass a breakpoint
_ABOUT = 10.0  # tolerances of its depth: by less than that it has not passed it
_MORE = 8  # nodes, for what does not come out with the usual number
_INSIDE = 300.0  # tolerances: the last terms of a way that ends between its ends, where its error goes with them and not with their square


def contact_solver(law: ContactLaw, tolerance: float, size: int, *, finer: float = 1.0) -> SolvesContact:
    """Return what solves the contacts of a run of `size` drops of rigid bodies under laws of that kind.

    The tolerance is one of what comes out of a contact. Histories are read within it, where the phase plane is not as exact: there it is
    to be `finer` times as tight.
    """
    in_time = collocated(tolerance, size)
    if tolerance < _TIGHTEST or not (isinstance(law, CompliantLaw) and law.contact_end != "pull-off"):
        return in_time
    tolerance = max(tolerance / finer, _TIGHTEST)
    number, useless = _nodes_for(law, tolerance), False
    starts = _Starts(size, number, tolerance)

    def solve(encounter: Encounter, drops: Drops) -> tuple[Contact, Floats, Floats]:
        nonlocal useless
        if useless:
            return in_time(encounter, drops)
        found = _Found.of_size(len(drops))
        with np.errstate(all="ignore"):  # what is not finite is found, and tried again
            _solve(encounter, found, np.arange(len(drops)), drops, starts, _MARGIN)
            again = np.flatnonzero(~found.good)
            if again.size:
                afresh = _Starts(len(again), number + _MORE, tolerance)
                _solve(encounter, found, again, np.arange(len(again)), afresh, -_MARGIN)
        left = np.flatnonzero(~found.good)
        if not left.size:
            return found.contact(encounter.law), found.force, found.when
        later, force, when = in_time(encounter.pick(left), drops[left])
        useless = left.size == size
        if useless:
            return later, force, when
        contact = found.contact(encounter.law)
        contact.put(left, later)
        found.force[left], found.when[left] = force, when
        return contact, found.force, found.when

    return solve


def _nodes_for(law: CompliantLaw, tolerance: float) -> int:
    """Return the number of nodes of a segment: 14 at a tolerance of 1e-8, for a law that is smooth in the square root.

    Eight more where a way may end between its ends, where it is not as exact.
    """
    return int(2 * np.ceil(-np.log10(tolerance) - 1e-9)) + 2 * law.root - (-2 if law.tension == "cut" else 6)


class _Starts:
    """The solutions of a run's last contacts, in units of their approach speeds and depths, to start the next from.

    `number`: of nodes in a segment; `tolerance`: to which they are solved.
    """

    def __init__(self, size: int, number: int, tolerance: float) -> None:
        self.number, self.tolerance = number, tolerance
        self.depth = np.full(size, np.nan)
        self.squares: dict[tuple[Direction, int], Floats] = {}

    def depths(self, ids: Drops, touch: Floats, free: Floats) -> Floats:
        """Return about how deep contacts get [m], that touch at an indentation and would get as deep without damping [m]."""
        part = self.depth[ids]
        return np.asarray(touch + np.where(np.isfinite(part), part, 1.0) * (free - touch))

    def start(self, kind: tuple[Direction, int], ids: Drops, square: Floats, undamped: Callable[[], Floats]) -> Floats:
        """Return squares to start from, those of an undamped motion where no contact is known."""
        if kind not in self.squares:
            return undamped()
        found = self.squares[kind][:, ids] * square
        unknown = np.isnan(found[0])
        if unknown.any():
            found[:, unknown] = undamped()[:, unknown]
        return found

    def keep(self, ids: Drops, good: Bools, way: PlaneWay, square: Floats) -> None:
        """Remember a way, of the drops for which it is good."""
        kind = way.direction, way.rule.segments
        if kind not in self.squares:
            self.squares[kind] = np.full((len(way.squares), len(self.depth)), np.nan)
        self.squares[kind][:, ids] = np.where(good, way.squares / square, np.nan)


@dataclass
class _Found:
    """What came of the contacts of B drops.

    `good`: those that were solved to the tolerance; the others are to be solved otherwise. `pieces`: which drops, since when, their
    motion, and whether it is after the deepest point. `force`, `when`: the largest [N], and its time since first touch [s]. Else as in
    `Contact`.
    """

    good: Bools
    max_delta: Floats
    time_of_max_delta: Floats
    duration: Floats
    final_delta: Floats
    final_rate: Floats
    dissipated: Floats
    plastic: Floats
    stored: Floats
    force: Floats
    when: Floats
    pieces: list[tuple[Drops, Floats, PlaneMotion | Glide, bool]] = field(default_factory=list)

    @classmethod
    def of_size(cls, size: int) -> Self:
        return cls(np.zeros(size, dtype=bool), *np.full((10, size), np.nan))

    def contact(self, law: CompliantLaw) -> Contact:
        """Return the contact, of the drops that are good."""
        after = law.after_compression(self.max_delta)
        return Contact(
            [Piece(drops, start, motion, after if outward else law) for drops, start, motion, outward in self.pieces],
            np.full(len(self.good), RELEASED, dtype=np.int8),
            self.duration,
            self.final_delta,
            self.final_rate,
            self.max_delta,
            self.time_of_max_delta,
            self.dissipated,
            self.plastic,
            self.stored,
            after,
        )


def _solve(encounter: Encounter, found: _Found, places: Drops, ids: Drops, starts: _Starts, margin: float) -> None:
    """Solve the contacts at some places of B, those together that pass the same breakpoints.

    `ids`: their numbers among the starts. `margin`: of the depth they are thought to get, by which they are thought to pass a breakpoint.
    """
    here = encounter.take(places)
    touch = here.law.touch_level + np.zeros(len(places))
    depth = starts.depths(ids, touch, here.depth)
    passed = _passed(here.law, touch, depth, margin)
    first = int(passed[0])
    if (passed == first).all():  # as under a law without breakpoints
        _through(here, found, places, ids, starts, depth, first)
        return
    for which in np.unique(passed):
        some = np.flatnonzero(passed == which)
        _through(here.take(some), found, places[some], ids[some], starts, depth[some], int(which))


def _passed(law: CompliantLaw, low: Floats, high: Floats, margin: float) -> Indices:
    """Return which breakpoints lie between two indentations (B,), as the bits of a number; below the higher by a part of the depth."""
    found = np.zeros(len(low), dtype=np.intp)
    if law.breakpoints:
        high = high - margin * (high - low)
    for bit, level in enumerate(law.breakpoints):
        found += ((level > low) & (level < high)).astype(np.intp) << bit
    return found


def _levels(law: CompliantLaw, passed: int, high: Floats, low: Floats) -> Floats:
    """Return the levels between which the force is smooth, from the deepest [m], (S + 1, B)."""
    between = [level + np.zeros(len(low)) for bit, level in enumerate(law.breakpoints) if passed >> bit & 1]
    return np.array([high, *reversed(between), low])


def _levels_out(encounter: Encounter, high: Floats, tolerance: float) -> tuple[Bools, Floats]:
    """Return the levels of a way out from an indentation [m], and which drops pass the breakpoints that these hold, as most do."""
    passed = _passed(encounter.law, encounter.floor, high, _ABOUT * tolerance)
    usual = int(np.bincount(passed).argmax())
    return passed == usual, _levels(encounter.law, usual, high, encounter.floor)


def _through(encounter: Encounter, found: _Found, places: Drops, ids: Drops, starts: _Starts, depth: Floats, which: int) -> None:
    """Solve both ways of contacts that get about as deep as told [m] and pass the same breakpoints."""
    law, square, number, tolerance = encounter.law, encounter.approach_speed**2, starts.number, starts.tolerance
    touch = law.touch_level + np.zeros(len(places))
    levels = _levels(law, which, depth, touch)
    rule = plane_rule(number, law.root, len(levels) - 1)
    start = starts.start(("in", rule.segments), ids, square, lambda: _undamped(encounter, rule, levels, square))
    coming = solve_way(encounter, rule, "in", levels, start, tolerance, _SWEEPS)
    depth = coming.levels[0]
    good = coming.solved & (_passed(law, touch, depth, _ABOUT * tolerance) == which)
    force, when = plane_peak(encounter, coming)
    good &= np.isfinite(force) & np.isfinite(when)

    back = encounter.under(law.after_compression(depth))
    alike, returning = _levels_out(back, depth, tolerance)
    good &= alike
    rule_back = plane_rule(number, law.root, len(returning) - 1)
    start = starts.start(("out", rule_back.segments), ids, square, lambda: _undamped(back, rule_back, returning))
    leaving = solve_way(back, rule_back, "out", returning, start, tolerance, _SWEEPS)
    good &= leaving.solved & (leaving.ends[-1] > _LEAST_RESTITUTION**2 * square)
    starts.keep(ids, good, coming, square)
    starts.keep(ids, good, leaving, square)
    starts.depth[ids] = np.where(good, (depth - touch) / (encounter.depth - touch), np.nan)

    left = _Exit(leaving, back.floor)
    if law.tension == "cut":
        left.cut_short(back, tolerance)
    good &= left.good
    time_in = coming.duration
    values = {
        "good": good,
        "max_delta": depth,
        "time_of_max_delta": time_in,
        "duration": time_in + left.time,
        "final_delta": left.delta,
        "final_rate": left.rate,
        "dissipated": coming.dissipated + left.lost,
        "plastic": law.plastic_work(depth),
        "stored": back.law.elastic_energy(left.delta),
        "force": force,
        "when": when,
    }
    for name, value in values.items():
        getattr(found, name)[places] = value
    everyone, parts = np.arange(len(places)), [(drops, time_in[drops] + since, motion, True) for drops, since, motion in left.parts]
    for drops, since, motion, outward in [(everyone, 0.0 * time_in, PlaneMotion.of(coming, time_in), False), *parts]:
        if (kept := good[drops]).any():
            found.pieces.append((places[drops[kept]], since[kept], motion.take(kept), outward))


def _undamped(encounter: Encounter, rule: PlaneRule, levels: Floats, square: Floats | None = None, begun: Array = 0.0) -> Floats:
    """Return the u at the nodes of a way (S N, B) without damping, of a w at its shallow end, or as the static force gives it back."""
    law, weight, per_square = encounter.law, encounter.mass * encounter.gravity, rule.per_node**2

    def energy(delta: Floats) -> Floats:
        return np.asarray(static_work(law, delta) - weight * delta)

    high, low = energy(levels[0]), energy(levels[-1])
    whole = 2.0 / encounter.mass * (high - low) if square is None else square
    found = (begun + whole * (high - energy(rule.indentations(levels))) / (high - low)) * per_square
    return np.asarray(np.maximum(found, 1e-3 * np.abs(begun + whole)))


class _Exit:
    """How B drops leave after their deepest point.

    `good`: those that were solved to the tolerance. `time`: since then [s]. `delta`, `rate`: where they part [m], [m/s]. `lost` [J].
    `parts`: which drops, since when, and their motion.
    """

    def __init__(self, way: PlaneWay, floor: Floats) -> None:
        size = len(floor)
        self.way, self.good, self.time, self.delta = way, np.ones(size, dtype=bool), way.duration, floor.copy()
        self.rate, self.lost = -np.sqrt(way.ends[-1]), way.dissipated.copy()
        self.parts: list[tuple[Drops, Floats, PlaneMotion | Glide]] = [(np.arange(size), np.zeros(size), PlaneMotion.of(way, self.time))]

    def cut_short(self, encounter: Encounter, tolerance: float) -> None:
        """End the push of a law that may not pull where its force becomes zero, and with it the contact, or let drops glide."""
        law, way = encounter.law, self.way
        pulling, unseen = pulls(way)
        self.good &= ~unseen
        ends = np.asarray(pulling.any(axis=0))
        if law.contact_end == "zero-force":
            self.good &= ends  # or it is too small to be seen
        some = np.flatnonzero(ends & way.solved)
        if not some.size:
            return
        self.good[some] &= way.tail[some] <= _INSIDE * tolerance
        segment, y = end_of_push(encounter, way, pulling)
        delta, square = way.at(segment, y)
        self.delta, self.rate = np.where(ends, delta, self.delta), np.where(ends, -np.sqrt(square), self.rate)
        time, lost = way.grown(segment, y, way.pace, way.loss)
        self.time, self.lost = np.where(ends, time, self.time), np.where(ends, lost, self.lost)
        self.parts = [(np.arange(len(ends)), np.zeros(len(ends)), PlaneMotion.of(way, self.time.copy()))]
        if law.contact_end == "zero-force":
            return
        here = encounter.take(some)
        glide, pushes, stays = glide_until_push(here, self.delta[some], self.rate[some])
        self.parts.append((some, self.time[some], glide))
        self.good[some[stays]] = False
        self.time[some] += glide.duration
        held = here.law.elastic_energy(self.delta[some])
        self.delta[some], self.rate[some] = glide.end()
        self.lost[some] += held - here.law.elastic_energy(self.delta[some])
        if pushes.any():
            self.push_on(encounter, some[pushes], tolerance)

    def push_on(self, encounter: Encounter, drops: Drops, tolerance: float) -> None:
        """Take drops out whose law pushes again after they have glided."""
        here, begun, rule = encounter.take(drops), self.rate[drops] ** 2, self.way.rule
        alike, levels = _levels_out(here, self.delta[drops], tolerance)
        rule = plane_rule(rule.number, rule.root, len(levels) - 1, turns=False)
        way = solve_way(here, rule, "out", levels, _undamped(here, rule, levels, begun=begun), tolerance, _SWEEPS, begun)
        pulling, unseen = pulls(way)
        self.good[drops] &= way.solved & ~(pulling.any(axis=0) | unseen) & alike
        self.parts.append((drops, self.time[drops], PlaneMotion.of(way, way.duration)))
        self.time[drops] += way.duration
        self.delta[drops], self.rate[drops] = here.floor, -np.sqrt(way.ends[-1])
        self.lost[drops] += way.dissipated
