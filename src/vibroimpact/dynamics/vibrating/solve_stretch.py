r"""Solve stretches of contact on the nodes of Radau collocation, each up to an event where one ends it.

The unknowns are the contact forces and the laws' own indentations at the nodes and, where an event ends the stretch, how long it
lasts. All else is linear in the forces (`receptance`). Stretches of several systems are solved together where these have the same modes,
the same contacts push, and the same law acts there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, Self

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.dynamics.collocation import Map
from vibroimpact.dynamics.linear_equations import inverses, solutions, times
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.local import Linearised, LocalContact, linearised, stacked
from vibroimpact.dynamics.vibrating.receptance import NODES, Receptance, Seen, Together, spectrum
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch, motions_of

_SWEEPS = 25
_LONGER = 3.0  # times: by no more does a sweep change the length that is sought
_CONVERGED, _STALLED = 1e-13, 1e-11
_INEXACT = 1e-6  # of a step of Newton's method: what the next one is at least, as derivatives are differences


@dataclass(frozen=True)
class Aim:
    """What ends a stretch: surfaces part, a law pushes no more, its indentation comes to a `level` [m], or an approach turns.

    `contact`: of which of those that push.
    """

    name: Literal["parted", "no push", "breakpoint", "turn"]
    level: float = 0.0
    contact: int = 0


@dataclass(frozen=True)
class StretchProblem:
    """A stretch of contact to be solved.

    Parameters
    ----------
    seen : Seen
        The system, as the contacts that push see it.
    locals : sequence of LocalContact
        The law of each, and what is in series with it.
    time_map : {"touch", "inside", "release"}
        In which root of time the forces are smooth.
    length : float
        How long the stretch lasts [s]; with an aim, about how long.
    start : State
        Where it begins.
    begun : sequence of float
        The laws' own indentations there [m], nearly.
    trend : sequence of float
        About how fast the forces change at the start [N/s], where there is no guess.
    guess : tuple of two arrays, shape (c, N), optional
        Those indentations [m] and the forces [N] at the nodes, nearly.
    aim : Aim, optional
        What ends the stretch; its length is found.
    """

    seen: Seen
    locals: Sequence[LocalContact]
    time_map: Map
    length: float
    start: State
    begun: Sequence[float]
    trend: Sequence[float] = ()
    guess: tuple[Floats, Floats] | None = None
    aim: Aim | None = None

    @property
    def kind(self) -> tuple[object, ...]:
        """What has to be the same for stretches that are solved together."""
        laws = tuple((type(local.law), bool(local.series)) for local in self.locals)
        aim = None if self.aim is None else "level" if self.aim.name in ("parted", "breakpoint") else self.aim.name
        return self.seen.of.kind, self.time_map, aim, self.guess is None, laws

    @property
    def size(self) -> int:
        """How many coordinates the system has."""
        return self.seen.system.number

    @classmethod
    def solved(cls, problems: Sequence[Self]) -> list[VibratingStretch]:
        """Return the motion through stretches of one kind."""
        return solve_stretches(problems)


def solve_stretches(problems: Sequence[StretchProblem]) -> list[VibratingStretch]:
    """Return the motion through stretches of contact of one kind, by Newton's method."""
    first, number = problems[0], len(problems)
    at = spectrum(first.time_map, max(local.law.root for local in first.locals))
    systems = Together([problem.seen for problem in problems], [problem.start for problem in problems])
    locals_ = [stacked(of_one) for of_one in zip(*(problem.locals for problem in problems), strict=True)]
    length, event = np.array([problem.length for problem in problems]), _event_of(problems)
    met = np.maximum(systems.approach, [[local.release_level for local in problem.locals] for problem in problems])
    begun = np.array([problem.begun for problem in problems])
    own = np.array([local.near(begun[:, place], met[:, place]) for place, local in enumerate(locals_)]).T
    here = Receptance(systems, at, length)
    delta, force = _first_guess(problems, locals_, here, own) if first.guess is None else _guesses(problems)
    largest = np.abs(here.rate).reshape(number, -1, NODES).max(axis=2) / length[:, None]
    scale = (np.array([problem.seen.mass for problem in problems]) * (largest + np.abs(systems.gravity))).max(axis=1)
    static, size = np.zeros_like(force), np.full(number, np.inf)
    solved, going = np.zeros(number, dtype=bool), np.ones(number, dtype=bool)
    for _ in range(_SWEEPS):
        now = linearised(locals_, delta, here.rate - times(here.rate_by, force))
        going = going & (now.slope.min(axis=1) > 0.0)  # else what is taken out in series outweighs the law: there is no such contact
        if not going.any():
            break
        by_delta, by_force, by_length = _newton_step(now, here, delta, force, event)
        by_static = now.stiffness * by_delta
        before_it = static, delta, force
        static, delta, force = now.static - by_static, delta - by_delta, force - by_force
        if not going.all():  # some are where they have come to
            pairs = zip((static, delta, force), before_it, strict=True)
            static, delta, force = (np.where(going[:, None], *pair) for pair in pairs)
        most = np.maximum(np.abs(by_force), np.abs(by_static)).max(axis=1) / (scale + np.abs(force).max(axis=1))
        if event is not None:
            by_length = np.where(going, np.clip(by_length, -_LONGER * length, _LONGER / (1.0 + _LONGER) * length), 0.0)
            length = length - by_length
            here, most = Receptance(systems, at, length), np.maximum(most, np.abs(by_length) / length)
        before, size = size, most
        # what the next step would be: of a method that converges quadratically, but for its derivatives
        following = size * np.minimum(np.maximum((size / before) ** 2, _INEXACT), 1.0)
        done = (following < _CONVERGED) | ((size < _STALLED) & (size > 0.3 * before))
        solved |= going & done
        going &= ~done & np.isfinite(size)
        if not going.any():
            break
    return _stretches(problems, locals_, here, length, (met, own), (static, delta, force), solved)


def _stretches(
    problems: Sequence[StretchProblem],
    locals_: Sequence[LocalContact],
    here: Receptance,
    length: Floats,
    begun: tuple[Floats, Floats],
    found: tuple[Floats, Floats, Floats],
    solved: Bools,
) -> list[VibratingStretch]:
    """Return stretches as they were solved.

    Parameters
    ----------
    problems : sequence of StretchProblem
        What was solved.
    locals_ : sequence of LocalContact
        The contacts of all of them, `stacked`.
    here : Receptance
        How their surfaces move.
    length : array, shape (B,)
        How long they last [s].
    begun : tuple of two arrays, shape (B, c)
        Approaches of the surfaces and the laws' own indentations at the start [m].
    found : tuple of three arrays, shape (B, M)
        Static forces [N], own indentations [m] and forces [N] at the nodes.
    solved : array of bool, shape (B,)
        Whether Newton's method converged.
    """
    systems, at, (met, own), (static, delta, force) = here.systems, here.at, begun, found
    approach, rate = here.approach - times(here.by_force, force), here.rate - times(here.rate_by, force)
    if here.by_static is not None:
        approach -= times(here.by_static, static)
    begun_rate, shape = systems.begun_rate, (*met.shape, NODES)
    if systems.massless:  # a dashpot takes up a jump of the force at once
        at_start = (rate.reshape(shape) @ at.rule.weights_at_start)[..., 0]
        begun_rate = np.where(systems.with_local.any(axis=2), at_start, begun_rate)
    static, force = static.reshape(shape), force.reshape(shape)
    approaches, rates, indentations = (
        np.concatenate([begin[:, :, None], rest.reshape(shape)], axis=2)
        for begin, rest in ((met, approach), (begun_rate, rate), (own, delta))
    )
    dissipative, lengths = force - static, length.tolist()
    works = np.array([np.subtract(*local.own_work(indentations[:, place, [-1, 0]].T)) for place, local in enumerate(locals_)]).T
    dissipated = (dissipative * rates[:, :, 1:]) @ at.rule.integral[-1] * length[:, None]
    needed = np.array([problem.seen.mass for problem in problems]) * np.abs(rates).max(axis=2) / length[:, None]
    roughness = at.rule.tail_of_each(force, needed).max(axis=1).tolist()
    motions = motions_of(systems, at, length, (here.admittance, here.responses), force, static)
    stretches = []
    for number, problem in enumerate(problems):
        contacts = tuple(
            ContactHistory(
                problem.seen.contacts[place],
                local,
                at.rule,
                static[number, place],
                dissipative[number, place],
                approaches[number, place],
                rates[number, place],
                indentations[number, place],
                work=float(works[number, place]),
                dissipated=float(dissipated[number, place]),
            )
            for place, local in enumerate(problem.locals)
        )
        stretch = VibratingStretch(problem.seen, at, lengths[number], problem.start, contacts, bool(solved[number]), roughness[number])
        stretch.__dict__["motion"] = motions[number]
        stretches.append(stretch)
    return stretches


def _guesses(problems: Sequence[StretchProblem]) -> tuple[Floats, Floats]:
    """Return the guesses of indentations and forces at the nodes (B, M)."""
    delta, force = (np.array(parts) for parts in zip(*(problem.guess for problem in problems if problem.guess), strict=True))
    return delta.reshape(len(problems), -1), force.reshape(len(problems), -1)


def _first_guess(
    problems: Sequence[StretchProblem], locals_: Sequence[LocalContact], here: Receptance, begun: Floats
) -> tuple[Floats, Floats]:
    """Return what the forces at the start, going on, make of indentations and forces at the nodes (B, M)."""
    rates, shape = here.systems.begun_rate, (*begun.shape, NODES)
    parts = np.array([local.own_forces(begun[:, place], rates[:, place]) for place, local in enumerate(locals_)])
    trend = np.array([problem.trend for problem in problems])
    later = trend[:, :, None] * (here.length[:, None] * here.at.rule.time)[:, None]
    static, force = (np.add(part.T[:, :, None], later).reshape(len(problems), -1) for part in (parts[:, 0], parts.sum(axis=1)))
    approach, rate = here.approach - times(here.by_force, force), (here.rate - times(here.rate_by, force)).reshape(shape)
    if here.by_static is not None:
        approach -= times(here.by_static, static)
    delta = approach.reshape(shape)
    for number, problem in enumerate(problems):
        for place, local in enumerate(problem.locals):
            delta[number, place] = local.about(np.maximum(delta[number, place], local.release_level))
    forces = [np.add(*local.own_forces(delta[:, place].T, rate[:, place].T)).T for place, local in enumerate(locals_)]
    return delta.reshape(len(problems), -1), np.concatenate(forces, axis=1)


class _Events(NamedTuple):
    """What ends stretches: its name, the levels of indentations [m] (B,), and the last node of the contact in which it happens (B,)."""

    name: str
    levels: Floats
    last: Indices


def _event_of(problems: Sequence[StretchProblem]) -> _Events | None:
    """Return what ends stretches, or None if their lengths are given."""
    aims = [problem.aim for problem in problems if problem.aim is not None]
    if not aims:
        return None
    return _Events(aims[0].name, np.array([aim.level for aim in aims]), np.array([(aim.contact + 1) * NODES - 1 for aim in aims]))


def _newton_step(now: Linearised, here: Receptance, delta: Floats, force: Floats, event: _Events | None) -> tuple[Floats, Floats, Floats]:
    r"""Return by how much Newton's method takes back the indentations, the forces (B, M), and the lengths (B,).

    The equations are, with the approach y that goes with an indentation, :math:`y(\delta) = y_0(h) - G(h) F - G_s(h) F_s(\delta)` and
    :math:`F = F_{law}(\delta, \dot y_0(h) - R(h) F)`. Their indentations are eliminated.
    """
    left = eliminated(now, here)
    missing = now.approach - here.approach + times(here.by_force, force)
    if here.by_static is not None:
        missing = missing + times(here.by_static, now.static)
    sunk = left.answer(missing)
    right = force - (now.static + now.dissipative) + left.push * sunk
    if event is None:
        by_force = solutions(left.jacobian, right)
        return sunk - times(left.taken, by_force), by_force, np.zeros(len(force))
    approach, rate, closing = here.by_length(force, now.static)
    by_length = -left.answer(approach)
    row, slope, gone = _event_row(now, here, left, (delta, force), event, closing, by_length, sunk)
    number, size = force.shape
    whole = np.empty((number, size + 1, size + 1))  # the length as a part of itself
    whole[:, :-1, :-1] = left.jacobian
    whole[:, :-1, -1] = (left.push * by_length - now.dissipative_by_rate * rate) * here.length[:, None]
    whole[:, -1, :-1], whole[:, -1, -1] = row, slope * here.length
    found = solutions(whole, np.concatenate([right, gone[:, None]], axis=1))
    by_force, shorter = found[:, :-1], found[:, -1] * here.length
    return sunk - times(left.taken, by_force) - by_length * shorter[:, None], by_force, shorter


class Eliminated(NamedTuple):
    """What the indentations leave behind when they are eliminated from the linearised equations of B stretches; M = c N.

    `inward`: how the indentations answer to an approach that is missing [-] (B, M, M), or (B, M) where each answers to its own alone.
    `taken`: by how much forces take them back [m/N] (B, M, M). `push`: derivative of the force by the indentation [N/m] (B, M).
    `jacobian`: of the equations of the forces that are left [-] (B, M, M).
    """

    inward: Floats
    taken: Floats
    push: Floats
    jacobian: Floats

    def answer(self, missing: Floats) -> Floats:
        """Return the indentations for an approach that is missing [m] (B, M)."""
        return self.inward * missing if self.inward.ndim == 2 else times(self.inward, missing)


def eliminated(now: Linearised, here: Receptance) -> Eliminated:
    """Return the linearised equations of stretches without their indentations."""
    diagonal = np.arange(now.slope.shape[1])
    if here.by_static is None:
        inward = 1.0 / now.slope
        reached = inward[:, :, None] * here.by_force
    else:
        matrix = here.by_static * now.stiffness[:, None]
        matrix[:, diagonal, diagonal] += now.slope
        inward = inverses(matrix)
        reached = inward @ here.by_force
    push = now.stiffness + now.dissipative_by_delta
    jacobian = now.dissipative_by_rate[:, :, None] * here.rate_by
    jacobian += push[:, :, None] * reached
    jacobian[:, diagonal, diagonal] += 1.0
    return Eliminated(inward, reached, push, jacobian)


def _event_row(
    now: Linearised,
    here: Receptance,
    left: Eliminated,
    at: tuple[Floats, Floats],
    event: _Events,
    closing_by_length: Floats,
    by_length: Floats,
    sunk: Floats,
) -> tuple[Floats, Floats, Floats]:
    """Return the rows of events in the Jacobians (B, M): by the forces, by the length; and what they leave, in units of a force (B,)."""
    (name, levels, last), (delta, force), every = event, at, np.arange(len(sunk))
    if name == "no push":
        row = np.zeros_like(force)
        row[every, last] = 1.0
        return row, np.zeros(len(force)), force[every, last]
    if name == "turn":
        rate_by = here.rate_by[every, last]
        row, slope = -rate_by, closing_by_length[every, last]
        still = here.closing[every, last] - (rate_by * force).sum(axis=1)
        if here.closing_by_static is not None:
            by_static = here.closing_by_static[every, last]
            inside = by_static * now.stiffness
            row, slope = row + times(left.taken.swapaxes(1, 2), inside), slope + (inside * by_length).sum(axis=1)
            still = still - (by_static * now.static).sum(axis=1) + (inside * sunk).sum(axis=1)
        unit = 1.0 / np.maximum(np.abs(rate_by).max(axis=1), 1e-300)
        return unit[:, None] * row, unit * slope, unit * still
    reached = left.taken[every, last]
    unit = 1.0 / np.maximum(np.abs(reached).max(axis=1), 1e-300)
    return -unit[:, None] * reached, -unit * by_length[every, last], unit * (delta[every, last] - levels - sunk[every, last])
