"""Contacts of rigid bodies solved in the phase plane, where no event has to be located in time.

The compression phase is solved up to the largest indentation, then the restitution phase with the law's memory of it, each in segments
between the indentations where the force is not smooth (`collocation`). Where the force of a law without tension becomes zero in
restitution, the contact ends, or the sphere moves freely within the indentation until the law pushes again. Contacts that are not solved
to the tolerance here, and all that are not oblique, are solved by the core (`rigid.line_contact`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from vibroimpact.arrays import Array, Bools, Drops, Floats, Indices
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.static import static_work
from vibroimpact.dynamics.contact import RELEASED, Contact, Piece
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.collocation import PlaneRule, plane_rule
from vibroimpact.dynamics.phase_plane.motion import PlaneMotion
from vibroimpact.dynamics.phase_plane.peak_force import peak_force
from vibroimpact.dynamics.phase_plane.phase import PhaseName, PlanePhase, solve_phase
from vibroimpact.dynamics.phase_plane.zero_force import tensile_points, zero_force_point
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.rigid.glide import Glide, glide_until_push
from vibroimpact.dynamics.rigid.solve_contact import SolvesContact, followed

_TIGHTEST = 1e-11  # a smaller tolerance is too close to rounding
_LEAST_RESTITUTION = 0.1  # below it a drop may be captured, which the core finds
_SWEEPS = 10
_MARGIN = 5e-3  # of the depth: the estimated depth is not certain to pass a breakpoint that is closer
_ABOUT = 10.0  # tolerances of the depth: a breakpoint passed by less counts as not passed
_MORE = 8  # nodes, in a second attempt
_INSIDE = 300.0  # tolerances: bound of the last coefficients of a phase that ends within a segment, where the error is of their order


def solver_for(problem: Problem, *, finer: float = 1.0) -> SolvesContact:
    """Return the solver of contacts of rigid bodies for the drops of a problem.

    The core solves them one after the other. The motion that drives the friction of oblique drops is solved together, on a grid that is the
    same for one drop as for many.

    Parameters
    ----------
    problem : Problem
        The drops.
    finer : float
        Factor by which the error is reduced where histories are read within the contacts.
    """
    one_by_one = followed(problem.tolerance)
    if problem.oblique is None:
        return one_by_one
    together = contact_solver(problem.laws[0], problem.tolerance, math.prod(problem.shape), finer=finer)

    def solve(encounter: Encounter, drops: Drops) -> tuple[Contact, Floats, Floats]:
        contact, force, when = one_by_one(encounter, drops)
        return replace(contact, pieces=together(encounter, drops)[0].pieces), force, when

    return solve


def contact_solver(law: ContactLaw, tolerance: float, size: int, *, finer: float = 1.0) -> SolvesContact:
    """Return the solver of contacts of rigid bodies for a run of `size` drops under laws of this type.

    `tolerance`: relative error of the state at the end of a contact. `finer`: the factor by which it is reduced where histories are read
    within the contacts, since collocation is less accurate between the ends of a segment than at them.
    """
    one_by_one = followed(tolerance)
    if tolerance < _TIGHTEST or not (isinstance(law, CompliantLaw) and law.contact_end != "pull-off"):
        return one_by_one
    tolerance = max(tolerance / finer, _TIGHTEST)
    number, always_one_by_one = _nodes_per_segment(law, tolerance), False
    starts = _StartingValues(size, number, tolerance)

    def solve(encounter: Encounter, drops: Drops) -> tuple[Contact, Floats, Floats]:
        nonlocal always_one_by_one
        if always_one_by_one:
            return one_by_one(encounter, drops)
        found = _Solutions.of_size(len(drops))
        with np.errstate(all="ignore"):  # values that are not finite fail the checks below
            _solve(encounter, found, np.arange(len(drops)), drops, starts, _MARGIN)
            again = np.flatnonzero(~found.good)
            if again.size:
                afresh = _StartingValues(len(again), number + _MORE, tolerance)
                _solve(encounter, found, again, np.arange(len(again)), afresh, -_MARGIN)
        left = np.flatnonzero(~found.good)
        if not left.size:
            return found.contact(encounter.law), found.force, found.when
        later, force, when = one_by_one(encounter.pick(left), drops[left])
        always_one_by_one = left.size == size
        if always_one_by_one:
            return later, force, when
        contact = found.contact(encounter.law)
        contact.put(left, later)
        found.force[left], found.when[left] = force, when
        return contact, found.force, found.when

    return solve


def _nodes_per_segment(law: CompliantLaw, tolerance: float) -> int:
    """Return the number of nodes of a segment: 14 at a tolerance of 1e-8, for a law that is smooth in the square root of the indentation.

    Eight more for a law whose tension is cut, since its restitution phase may end within a segment.
    """
    return int(2 * np.ceil(-np.log10(tolerance) - 1e-9)) + 2 * law.root - (-2 if law.tension == "cut" else 6)


class _StartingValues:
    """Starting values of Newton's method: the solutions of the last contacts of a run, scaled by their approach speeds and depths.

    `number`: of nodes in a segment; `tolerance`: of the solutions.
    """

    def __init__(self, size: int, number: int, tolerance: float) -> None:
        self.number, self.tolerance = number, tolerance
        self.depth = np.full(size, np.nan)
        self.squares: dict[tuple[PhaseName, int], Floats] = {}

    def depths(self, ids: Drops, touch: Floats, free: Floats) -> Floats:
        """Return estimates of the largest indentations [m], from those at touch and those without damping [m]."""
        part = self.depth[ids]
        return np.asarray(touch + np.where(np.isfinite(part), part, 1.0) * (free - touch))

    def start(self, kind: tuple[PhaseName, int], ids: Drops, square: Floats, undamped: Callable[[], Floats]) -> Floats:
        """Return starting values of u, from an undamped motion where there is no earlier contact."""
        if kind not in self.squares:
            return undamped()
        found = self.squares[kind][:, ids] * square
        unknown = np.isnan(found[0])
        if unknown.any():
            found[:, unknown] = undamped()[:, unknown]
        return found

    def keep(self, ids: Drops, good: Bools, phase: PlanePhase, square: Floats) -> None:
        """Keep the solution of a phase, of the drops that were solved."""
        kind = phase.name, phase.rule.segments
        if kind not in self.squares:
            self.squares[kind] = np.full((len(phase.squares), len(self.depth)), np.nan)
        self.squares[kind][:, ids] = np.where(good, phase.squares / square, np.nan)


@dataclass
class _Solutions:
    """Solutions of the contacts of B drops.

    `good`: whether the contact was solved to the tolerance. `pieces`: drops, start, motion, and whether it is in restitution. `force`,
    `when`: largest force [N], and its time since first touch [s]. The others are as in `Contact`.
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
        """Return the contacts, of which only those of drops that are good are valid."""
        after = law.after_compression(self.max_delta)
        return Contact(
            [Piece(drops, start, motion, after if unloading else law) for drops, start, motion, unloading in self.pieces],
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


def _solve(encounter: Encounter, found: _Solutions, places: Drops, ids: Drops, starts: _StartingValues, margin: float) -> None:
    """Solve the contacts of some drops, in groups that pass the same breakpoints, which is estimated from their depths.

    `places`: of the drops in the encounter. `ids`: their numbers in the run. `margin`: part of the estimated depth by which a breakpoint
    must be passed to be counted.
    """
    here = encounter.take(places)
    touch = here.law.touch_level + np.zeros(len(places))
    depth = starts.depths(ids, touch, here.depth)
    passed = _passed_breakpoints(here.law, touch, depth, margin)
    first = int(passed[0])
    if (passed == first).all():  # always so under a law without breakpoints
        _solve_both_phases(here, found, places, ids, starts, depth, first)
        return
    for which in np.unique(passed):
        some = np.flatnonzero(passed == which)
        _solve_both_phases(here.take(some), found, places[some], ids[some], starts, depth[some], int(which))


def _passed_breakpoints(law: CompliantLaw, low: Floats, high: Floats, margin: float) -> Indices:
    """Return the breakpoints between two indentations (B,) as bits of a number, the higher less `margin` times their distance."""
    found = np.zeros(len(low), dtype=np.intp)
    if law.breakpoints:
        high = high - margin * (high - low)
    for bit, level in enumerate(law.breakpoints):
        found += ((level > low) & (level < high)).astype(np.intp) << bit
    return found


def _segment_levels(law: CompliantLaw, passed: int, high: Floats, low: Floats) -> Floats:
    """Return the ends of the segments within which the force is smooth [m] (S + 1, B), from the deepest."""
    between = [level + np.zeros(len(low)) for bit, level in enumerate(law.breakpoints) if passed >> bit & 1]
    return np.array([high, *reversed(between), low])


def _unloading_levels(encounter: Encounter, high: Floats, tolerance: float) -> tuple[Bools, Floats]:
    """Return the ends of the segments of a restitution phase [m], and which drops pass the breakpoints among these.

    They are those of most drops; the others are solved otherwise.
    """
    passed = _passed_breakpoints(encounter.law, encounter.floor, high, _ABOUT * tolerance)
    usual = int(np.bincount(passed).argmax())
    return passed == usual, _segment_levels(encounter.law, usual, high, encounter.floor)


def _solve_both_phases(
    encounter: Encounter, found: _Solutions, places: Drops, ids: Drops, starts: _StartingValues, depth: Floats, which: int
) -> None:
    """Solve compression and restitution of contacts of about this depth [m] that pass the same breakpoints (`which`)."""
    law, square, number, tolerance = encounter.law, encounter.approach_speed**2, starts.number, starts.tolerance
    touch = law.touch_level + np.zeros(len(places))
    levels = _segment_levels(law, which, depth, touch)
    rule = plane_rule(number, law.root, len(levels) - 1)
    start = starts.start(("compression", rule.segments), ids, square, lambda: _undamped_squares(encounter, rule, levels, square))
    compression = solve_phase(encounter, rule, "compression", levels, start, tolerance, _SWEEPS)
    depth = compression.levels[0]
    good = compression.solved & (_passed_breakpoints(law, touch, depth, _ABOUT * tolerance) == which)
    force, when = peak_force(encounter, compression)
    good &= np.isfinite(force) & np.isfinite(when)

    back = encounter.under(law.after_compression(depth))
    alike, levels_back = _unloading_levels(back, depth, tolerance)
    good &= alike
    rule_back = plane_rule(number, law.root, len(levels_back) - 1)
    start = starts.start(("restitution", rule_back.segments), ids, square, lambda: _undamped_squares(back, rule_back, levels_back))
    restitution = solve_phase(back, rule_back, "restitution", levels_back, start, tolerance, _SWEEPS)
    good &= restitution.solved & (restitution.ends[-1] > _LEAST_RESTITUTION**2 * square)
    starts.keep(ids, good, compression, square)
    starts.keep(ids, good, restitution, square)
    starts.depth[ids] = np.where(good, (depth - touch) / (encounter.depth - touch), np.nan)

    release = _Release(restitution, back.floor)
    if law.tension == "cut":
        release.cut_tension(back, tolerance)
    good &= release.good
    time_in = compression.duration
    values = {
        "good": good,
        "max_delta": depth,
        "time_of_max_delta": time_in,
        "duration": time_in + release.time,
        "final_delta": release.delta,
        "final_rate": release.rate,
        "dissipated": compression.dissipated + release.lost,
        "plastic": law.plastic_work(depth),
        "stored": back.law.elastic_energy(release.delta),
        "force": force,
        "when": when,
    }
    for name, value in values.items():
        getattr(found, name)[places] = value
    everyone, parts = np.arange(len(places)), [(drops, time_in[drops] + since, motion, True) for drops, since, motion in release.parts]
    for drops, since, motion, unloading in [(everyone, 0.0 * time_in, PlaneMotion.of(compression, time_in), False), *parts]:
        if (kept := good[drops]).any():
            found.pieces.append((places[drops[kept]], since[kept], motion.take(kept), unloading))


def _undamped_squares(encounter: Encounter, rule: PlaneRule, levels: Floats, square: Floats | None = None, begun: Array = 0.0) -> Floats:
    """Return u at the nodes (S N, B) of an undamped phase.

    `square`: w at its shallow end; by default as the static work gives it. `begun`: w at its deep end.
    """
    law, weight, per_square = encounter.law, encounter.mass * encounter.gravity, rule.per_node**2

    def energy(delta: Floats) -> Floats:
        return np.asarray(static_work(law, delta) - weight * delta)

    high, low = energy(levels[0]), energy(levels[-1])
    whole = 2.0 / encounter.mass * (high - low) if square is None else square
    found = (begun + whole * (high - energy(rule.indentations(levels))) / (high - low)) * per_square
    return np.asarray(np.maximum(found, 1e-3 * np.abs(begun + whole)))


class _Release:
    """Restitution phases of B drops up to the separation of the surfaces.

    `good`: whether they were solved to the tolerance. `time`: duration since the largest indentation [s]. `delta`, `rate`: indentation and
    its rate at separation [m], [m/s]. `lost`: energy dissipated [J]. `parts`: drops, start, and motion of each part.
    """

    def __init__(self, phase: PlanePhase, floor: Floats) -> None:
        size = len(floor)
        self.phase, self.good, self.time, self.delta = phase, np.ones(size, dtype=bool), phase.duration, floor.copy()
        self.rate, self.lost = -np.sqrt(phase.ends[-1]), phase.dissipated.copy()
        self.parts: list[tuple[Drops, Floats, PlaneMotion | Glide]] = [(np.arange(size), np.zeros(size), PlaneMotion.of(phase, self.time))]

    def cut_tension(self, encounter: Encounter, tolerance: float) -> None:
        """End restitution where the force of a law without tension becomes zero; there the contact ends, or free motion begins."""
        law, phase = encounter.law, self.phase
        pulling, unseen = tensile_points(phase)
        self.good &= ~unseen
        ends = np.asarray(pulling.any(axis=0))
        if law.contact_end == "zero-force":
            self.good &= ends  # otherwise the tension is too small to be resolved
        some = np.flatnonzero(ends & phase.solved)
        if not some.size:
            return
        self.good[some] &= phase.tail[some] <= _INSIDE * tolerance
        segment, y = zero_force_point(encounter, phase, pulling)
        delta, square = phase.at(segment, y)
        self.delta, self.rate = np.where(ends, delta, self.delta), np.where(ends, -np.sqrt(square), self.rate)
        time, lost = phase.integrals(segment, y, phase.pace, phase.loss)
        self.time, self.lost = np.where(ends, time, self.time), np.where(ends, lost, self.lost)
        self.parts = [(np.arange(len(ends)), np.zeros(len(ends)), PlaneMotion.of(phase, self.time.copy()))]
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
            self.resume_contact(encounter, some[pushes], tolerance)

    def resume_contact(self, encounter: Encounter, drops: Drops, tolerance: float) -> None:
        """Continue restitution where the law pushes again after free motion within the indentation."""
        here, begun, rule = encounter.take(drops), self.rate[drops] ** 2, self.phase.rule
        alike, levels = _unloading_levels(here, self.delta[drops], tolerance)
        rule = plane_rule(rule.number, rule.root, len(levels) - 1, turns=False)
        phase = solve_phase(
            here, rule, "restitution", levels, _undamped_squares(here, rule, levels, begun=begun), tolerance, _SWEEPS, begun
        )
        pulling, unseen = tensile_points(phase)
        self.good[drops] &= phase.solved & ~(pulling.any(axis=0) | unseen) & alike
        self.parts.append((drops, self.time[drops], PlaneMotion.of(phase, phase.duration)))
        self.time[drops] += phase.duration
        self.delta[drops], self.rate[drops] = here.floor, -np.sqrt(phase.ends[-1])
        self.lost[drops] += phase.dissipated
