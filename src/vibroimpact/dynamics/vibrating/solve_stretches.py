"""Newton's method for stretches of contact on the nodes of Radau collocation, each up to an event where one ends it.

The unknowns are the contact forces and the indentations of the laws at the nodes and, where an event ends the stretch, its length. All
other quantities are linear in the forces (`receptance`). Stretches of several systems are solved together if they have as many modes and
contacts, the same time map, and laws and end conditions of the same kind.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, Self

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.dynamics.collocation import Map
from vibroimpact.dynamics.linear_equations import stacked_inverse, stacked_matvec, stacked_solve
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.local import Linearised, LocalContact, linearise_contacts, stack_contacts
from vibroimpact.dynamics.vibrating.receptance import (
    NODES_PER_STRETCH,
    ContactView,
    RadauEigenbasis,
    Receptance,
    StackedSystems,
    radau_eigenbasis,
)
from vibroimpact.dynamics.vibrating.rubbing import FrictionForces, RubbedStretch, Rubbing
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch, stretch_motions

_MOST_ITERATIONS = 25
_LENGTH_FACTOR = 3.0  # one iteration lengthens by no more than this times the length, to four times it, or shortens to a quarter
_CONVERGED, _STALLED = 1e-13, 1e-11
_INEXACT = 1e-6  # of a Newton step: least size of the next one, as the derivatives are finite differences


@dataclass(frozen=True)
class EndCondition:
    """Condition at the end of a stretch whose length is unknown.

    "parted", where the surfaces separate, and "breakpoint": the law's indentation comes to a `level` [m]; "no push": zero force; "turn":
    zero rate of the approach. `contact`: index among the contacts that push.
    """

    name: Literal["parted", "no push", "breakpoint", "turn"]
    level: float = 0.0
    contact: int = 0


@dataclass(frozen=True)
class StretchProblem:
    """A stretch of contact to be solved.

    Parameters
    ----------
    view : ContactView
        The system, reduced to the contacts that push.
    contacts : sequence of LocalContact
        The law of each, and the compliance in series with it.
    time_map : {"touch", "inside", "release"}
        Time map in which the forces are smooth.
    length : float
        Length of the stretch [s]; with an end condition, its initial guess.
    start : State
        State at the start.
    begun : sequence of float
        Indentations of the laws at the start [m], approximately.
    trend : sequence of float
        Approximate rates of change of the forces at the start [N/s], used where there is no guess.
    guess : tuple of two arrays, shape (c, N), optional
        Initial guess of the indentations of the laws [m] and of the forces [N] at the nodes.
    end_condition : EndCondition, optional
        Condition at the end, from which the length is found.
    rubbing : Rubbing, optional
        Friction at the start, of a drop that has any.
    """

    view: ContactView
    contacts: Sequence[LocalContact]
    time_map: Map
    length: float
    start: State
    begun: Sequence[float]
    trend: Sequence[float] = ()
    guess: tuple[Floats, Floats] | None = None
    end_condition: EndCondition | None = None
    rubbing: Rubbing | None = None

    @property
    def kind(self) -> tuple[object, ...]:
        """Key that stretches must share to be solved together."""
        laws = tuple((type(local.law), bool(local.series)) for local in self.contacts)
        end_condition = (
            None
            if self.end_condition is None
            else "level"
            if self.end_condition.name in ("parted", "breakpoint")
            else self.end_condition.name
        )
        return self.view.modes.kind, self.time_map, end_condition, self.guess is None, laws, self.rubbing is None

    @property
    def size(self) -> int:
        """Number of coordinates of the system."""
        return self.view.system.number

    @classmethod
    def solve_group(cls, problems: Sequence[Self]) -> list[VibratingStretch]:
        """Return the solved stretches of problems of one kind."""
        return solve_stretches(problems)


def solve_stretches(problems: Sequence[StretchProblem]) -> list[VibratingStretch]:
    """Return the solved stretches of problems of one kind, by Newton's method."""
    first, number = problems[0], len(problems)
    basis = radau_eigenbasis(first.time_map, max(local.law.root for local in first.contacts))
    systems = StackedSystems([problem.view for problem in problems], [problem.start for problem in problems])
    stacked = [stack_contacts(of_one) for of_one in zip(*(problem.contacts for problem in problems), strict=True)]
    length, event = np.array([problem.length for problem in problems]), _end_conditions(problems)
    start_approach = np.maximum(systems.approach, [[local.release_level for local in problem.contacts] for problem in problems])
    begun = np.array([problem.begun for problem in problems])
    start_delta = np.array([local.refine_indentation(begun[:, place], start_approach[:, place]) for place, local in enumerate(stacked)]).T
    receptance = unrubbed = Receptance(systems, basis, length)
    friction = _friction(problems, basis)
    if friction is not None:
        friction.set_length(length)
        receptance = friction.moving(unrubbed)
    delta, force = _first_guess(problems, stacked, receptance, start_delta) if first.guess is None else _guesses(problems)
    # a scale of the forces, for motions that change their rate within the stretch
    largest = np.abs(receptance.rate).reshape(number, -1, NODES_PER_STRETCH).max(axis=2) / length[:, None]
    scale = (np.array([problem.view.mass for problem in problems]) * (largest + np.abs(systems.gravity))).max(axis=1)
    static, size = np.zeros_like(force), np.full(number, np.inf)
    solved, iterating = np.zeros(number, dtype=bool), np.ones(number, dtype=bool)
    for _ in range(_MOST_ITERATIONS):
        law = linearise_contacts(stacked, delta, receptance.rate - stacked_matvec(receptance.rate_by_force, force))
        # a negative compliance in series that exceeds that of the law makes the problem ill-posed: stop
        iterating = iterating & (law.slope.min(axis=1) > 0.0)
        if not iterating.any():
            break
        delta_step, force_step, length_step = _newton_step(law, receptance, delta, force, event)
        by_static = law.stiffness * delta_step
        previous = static, delta, force
        static, delta, force = law.static - by_static, delta - delta_step, force - force_step
        if not iterating.all():  # keep the iterates of those that have stopped
            pairs = zip((static, delta, force), previous, strict=True)
            static, delta, force = (np.where(iterating[:, None], *pair) for pair in pairs)
        step_size = np.maximum(np.abs(force_step), np.abs(by_static)).max(axis=1) / (scale + np.abs(force).max(axis=1))
        if event is not None:
            length_step = np.where(
                iterating, np.clip(length_step, -_LENGTH_FACTOR * length, _LENGTH_FACTOR / (1.0 + _LENGTH_FACTOR) * length), 0.0
            )
            length = length - length_step
            receptance = unrubbed = Receptance(systems, basis, length)
            step_size = np.maximum(step_size, np.abs(length_step) / length)
        if friction is not None:
            if event is not None:
                friction.set_length(length)
            step_size = np.maximum(step_size, friction.follow(force, iterating) / (scale + np.abs(force).max(axis=1)))
            receptance = friction.moving(unrubbed)
        last_size, size = size, step_size
        # predicted size of the next step: quadratic convergence, limited by the finite-difference derivatives
        next_size = size * np.minimum(np.maximum((size / last_size) ** 2, _INEXACT), 1.0)
        done = (next_size < _CONVERGED) | ((size < _STALLED) & (size > 0.3 * last_size))
        solved |= iterating & done
        iterating &= ~done & np.isfinite(size)
        if not iterating.any():
            break
    return _stretches(problems, stacked, receptance, length, (start_approach, start_delta), (static, delta, force), solved, friction)


def _friction(problems: Sequence[StretchProblem], basis: RadauEigenbasis) -> FrictionForces | None:
    """Return the friction forces of stretches; None if there is no friction."""
    rubbings = [problem.rubbing for problem in problems if problem.rubbing is not None]
    if not rubbings:
        return None
    return FrictionForces([problem.view for problem in problems], [problem.start for problem in problems], rubbings, basis)


def _stretches(
    problems: Sequence[StretchProblem],
    stacked: Sequence[LocalContact],
    receptance: Receptance,
    length: Floats,
    begun: tuple[Floats, Floats],
    found: tuple[Floats, Floats, Floats],
    solved: Bools,
    friction: FrictionForces | None,
) -> list[VibratingStretch]:
    """Return the solved stretches from their indentations and forces at the nodes.

    Parameters
    ----------
    problems : sequence of StretchProblem
        The problems.
    stacked : sequence of LocalContact
        The contacts of all of them, as `stack_contacts` gives them.
    receptance : Receptance
        Motion of their surfaces.
    length : array, shape (B,)
        Their lengths [s].
    begun : tuple of two arrays, shape (B, c)
        Approaches of the surfaces and indentations of the laws at the start [m].
    found : tuple of three arrays, shape (B, M)
        Static forces [N], indentations of the laws [m] and forces [N] at the nodes.
    solved : array of bool, shape (B,)
        Whether Newton's method converged.
    friction : FrictionForces or None
        Friction at the nodes, where there is any.
    """
    systems, basis, (start_approach, start_delta), (static, delta, force) = receptance.systems, receptance.basis, begun, found
    approach, rate = (
        receptance.approach - stacked_matvec(receptance.approach_by_force, force),
        receptance.rate - stacked_matvec(receptance.rate_by_force, force),
    )
    if receptance.approach_by_static is not None:
        approach -= stacked_matvec(receptance.approach_by_static, static)
    begun_rate, shape = systems.begun_rate, (*start_approach.shape, NODES_PER_STRETCH)
    if systems.massless:  # the rate of a massless element jumps with the force
        at_start = (rate.reshape(shape) @ basis.rule.weights_at_start)[..., 0]
        begun_rate = np.where(systems.local_incidence.any(axis=2), at_start, begun_rate)
    static, force = static.reshape(shape), force.reshape(shape)
    approaches, rates, indentations = (
        np.concatenate([begin[:, :, None], rest.reshape(shape)], axis=2)
        for begin, rest in ((start_approach, approach), (begun_rate, rate), (start_delta, delta))
    )
    dissipative, lengths = force - static, length.tolist()
    works = np.array([np.subtract(*local.work_at_indentation(indentations[:, place, [-1, 0]].T)) for place, local in enumerate(stacked)]).T
    dissipated = (dissipative * rates[:, :, 1:]) @ basis.rule.integral[-1] * length[:, None]
    needed = np.array([problem.view.mass for problem in problems]) * np.abs(rates).max(axis=2) / length[:, None]
    roughness = basis.rule.tail_of_each(force, needed).max(axis=1).tolist()
    rubbed: Sequence[RubbedStretch | None] = [None] * len(problems) if friction is None else friction.stretches(force[:, 0])
    modes = receptance.admittance, receptance.responses
    if friction is None:
        motions = stretch_motions(systems, basis, length, modes, force, static)
    else:
        both = [np.concatenate(parts, axis=1) for parts in ((force, friction.force), (static, np.zeros_like(friction.force)))]
        motions = stretch_motions(friction.systems, basis, length, modes, *both)
    stretches = []
    for number, problem in enumerate(problems):
        contacts = tuple(
            ContactHistory(
                problem.view.contacts[place],
                local,
                basis.rule,
                static[number, place],
                dissipative[number, place],
                approaches[number, place],
                rates[number, place],
                indentations[number, place],
                work=float(works[number, place]),
                dissipated=float(dissipated[number, place]),
            )
            for place, local in enumerate(problem.contacts)
        )
        stretch = VibratingStretch(
            problem.view, basis, lengths[number], problem.start, contacts, bool(solved[number]), roughness[number], rubbed[number]
        )
        stretch.__dict__["motion"] = motions[number]
        stretches.append(stretch)
    return stretches


def _guesses(problems: Sequence[StretchProblem]) -> tuple[Floats, Floats]:
    """Return the given initial guesses of indentations and forces at the nodes (B, M)."""
    delta, force = (np.array(parts) for parts in zip(*(problem.guess for problem in problems if problem.guess), strict=True))
    return delta.reshape(len(problems), -1), force.reshape(len(problems), -1)


def _first_guess(
    problems: Sequence[StretchProblem], stacked: Sequence[LocalContact], receptance: Receptance, begun: Floats
) -> tuple[Floats, Floats]:
    """Return initial guesses of indentations and forces at the nodes (B, M), by extrapolating the forces at the start linearly."""
    rates, shape = receptance.systems.begun_rate, (*begun.shape, NODES_PER_STRETCH)
    parts = np.array([local.forces_at_indentation(begun[:, place], rates[:, place]) for place, local in enumerate(stacked)])
    trend = np.array([problem.trend for problem in problems])
    later = trend[:, :, None] * (receptance.length[:, None] * receptance.basis.rule.time)[:, None]
    static, force = (np.add(part.T[:, :, None], later).reshape(len(problems), -1) for part in (parts[:, 0], parts.sum(axis=1)))
    approach, rate = (
        receptance.approach - stacked_matvec(receptance.approach_by_force, force),
        (receptance.rate - stacked_matvec(receptance.rate_by_force, force)).reshape(shape),
    )
    if receptance.approach_by_static is not None:
        approach -= stacked_matvec(receptance.approach_by_static, static)
    delta = approach.reshape(shape)
    for number, problem in enumerate(problems):
        for place, local in enumerate(problem.contacts):
            delta[number, place] = local.approximate_indentation(np.maximum(delta[number, place], local.release_level))
    forces = [np.add(*local.forces_at_indentation(delta[:, place].T, rate[:, place].T)).T for place, local in enumerate(stacked)]
    return delta.reshape(len(problems), -1), np.concatenate(forces, axis=1)


class _EndConditions(NamedTuple):
    """End conditions of stretches: their name, levels of indentation [m] (B,), and the last node of the contact of each (B,)."""

    name: str
    levels: Floats
    last: Indices


def _end_conditions(problems: Sequence[StretchProblem]) -> _EndConditions | None:
    """Return the end conditions of stretches, or None if their lengths are given."""
    conditions = [problem.end_condition for problem in problems if problem.end_condition is not None]
    if not conditions:
        return None
    return _EndConditions(
        conditions[0].name,
        np.array([end_condition.level for end_condition in conditions]),
        np.array([(end_condition.contact + 1) * NODES_PER_STRETCH - 1 for end_condition in conditions]),
    )


def _newton_step(
    law: Linearised, receptance: Receptance, delta: Floats, force: Floats, event: _EndConditions | None
) -> tuple[Floats, Floats, Floats]:
    r"""Return the Newton steps of the indentations, the forces (B, M) and the lengths (B,), to be subtracted.

    With the approach y that belongs to an indentation, the equations are :math:`y(\delta) = y_0(h) - G(h) F - G_s(h) F_s(\delta)` and
    :math:`F = F_{law}(\delta, \dot y_0(h) - R(h) F)`. The indentations are eliminated from the linearised equations.
    """
    reduced = eliminate_indentations(law, receptance)
    residual = law.approach - receptance.approach + stacked_matvec(receptance.approach_by_force, force)
    if receptance.approach_by_static is not None:
        residual = residual + stacked_matvec(receptance.approach_by_static, law.static)
    free_delta = reduced.indentations(residual)
    right = force - (law.static + law.dissipative) + reduced.force_by_delta * free_delta
    if event is None:
        force_step = stacked_solve(reduced.jacobian, right)
        return free_delta - stacked_matvec(reduced.by_force, force_step), force_step, np.zeros(len(force))
    approach, rate, closing = receptance.by_length(force, law.static)
    length_step = -reduced.indentations(approach)
    row, slope, event_residual = _event_row(law, receptance, reduced, (delta, force), event, closing, length_step, free_delta)
    number, size = force.shape
    matrix = np.empty((number, size + 1, size + 1))  # the last unknown is the relative change of the length
    matrix[:, :-1, :-1] = reduced.jacobian
    matrix[:, :-1, -1] = (reduced.force_by_delta * length_step - law.dissipative_by_rate * rate) * receptance.length[:, None]
    matrix[:, -1, :-1], matrix[:, -1, -1] = row, slope * receptance.length
    found = stacked_solve(matrix, np.concatenate([right, event_residual[:, None]], axis=1))
    force_step, length_change = found[:, :-1], found[:, -1] * receptance.length
    return free_delta - stacked_matvec(reduced.by_force, force_step) - length_step * length_change[:, None], force_step, length_change


class ReducedEquations(NamedTuple):
    """Linearised equations of B stretches after elimination of the indentations; M = c N.

    `inverse`: derivative of the indentations by the residual of the approach [-] (B, M, M), or its diagonal (B, M). `by_force`: minus their
    derivative by the forces [m/N] (B, M, M). `force_by_delta`: derivative of the law's force by the indentation [N/m] (B, M). `jacobian`:
    of the remaining equations in the forces [-] (B, M, M).
    """

    inverse: Floats
    by_force: Floats
    force_by_delta: Floats
    jacobian: Floats

    def indentations(self, residual: Floats) -> Floats:
        """Return the change of the indentations for a residual of the approach [m] (B, M)."""
        return self.inverse * residual if self.inverse.ndim == 2 else stacked_matvec(self.inverse, residual)


def eliminate_indentations(law: Linearised, receptance: Receptance) -> ReducedEquations:
    """Return the linearised equations of stretches, reduced to the forces."""
    diagonal = np.arange(law.slope.shape[1])
    if receptance.approach_by_static is None:
        inverse = 1.0 / law.slope
        by_force = inverse[:, :, None] * receptance.approach_by_force
    else:
        matrix = receptance.approach_by_static * law.stiffness[:, None]
        matrix[:, diagonal, diagonal] += law.slope
        inverse = stacked_inverse(matrix)
        by_force = inverse @ receptance.approach_by_force
    force_by_delta = law.stiffness + law.dissipative_by_delta
    jacobian = law.dissipative_by_rate[:, :, None] * receptance.rate_by_force
    jacobian += force_by_delta[:, :, None] * by_force
    jacobian[:, diagonal, diagonal] += 1.0
    return ReducedEquations(inverse, by_force, force_by_delta, jacobian)


def _event_row(
    law: Linearised,
    receptance: Receptance,
    reduced: ReducedEquations,
    at_nodes: tuple[Floats, Floats],
    event: _EndConditions,
    closing_by_length: Floats,
    length_step: Floats,
    free_delta: Floats,
) -> tuple[Floats, Floats, Floats]:
    """Return the row of the end condition in each Jacobian (B, M), its last entry (B,) and its residual (B,), scaled to units of force."""
    (name, levels, last), (delta, force), rows = event, at_nodes, np.arange(len(free_delta))
    if name == "no push":
        row = np.zeros_like(force)
        row[rows, last] = 1.0
        return row, np.zeros(len(force)), force[rows, last]
    if name == "turn":
        rate_by = receptance.rate_by_force[rows, last]
        row, slope = -rate_by, closing_by_length[rows, last]
        still = receptance.closing[rows, last] - (rate_by * force).sum(axis=1)
        if receptance.closing_by_static is not None:
            by_static = receptance.closing_by_static[rows, last]
            inside = by_static * law.stiffness
            row, slope = row + stacked_matvec(reduced.by_force.swapaxes(1, 2), inside), slope + (inside * length_step).sum(axis=1)
            still = still - (by_static * law.static).sum(axis=1) + (inside * free_delta).sum(axis=1)
        unit = 1.0 / np.maximum(np.abs(rate_by).max(axis=1), 1e-300)
        return unit[:, None] * row, unit * slope, unit * still
    by_force = reduced.by_force[rows, last]
    unit = 1.0 / np.maximum(np.abs(by_force).max(axis=1), 1e-300)
    return -unit[:, None] * by_force, -unit * length_step[rows, last], unit * (delta[rows, last] - levels - free_delta[rows, last])
