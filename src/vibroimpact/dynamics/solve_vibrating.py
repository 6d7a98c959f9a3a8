r"""Solve a stretch of contact at once on the nodes of Radau collocation, up to an event where one ends it.

The unknowns are the contact forces and the laws' own indentations at the nodes and, where an event ends the stretch, how long it
lasts. All else is linear in the forces (`receptance`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from vibroimpact.dynamics.collocation import Floats, Map
from vibroimpact.dynamics.contact_history import ContactHistory
from vibroimpact.dynamics.linear_system import State
from vibroimpact.dynamics.local import Linearised, LocalContact, linearised
from vibroimpact.dynamics.receptance import NODES, Receptance, Seen, spectrum
from vibroimpact.dynamics.vibrating_stretch import VibratingStretch

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


def solve_vibrating(
    seen: Seen,
    locals_: Sequence[LocalContact],
    time_map: Map,
    length: float,
    start: State,
    begun: Sequence[float],
    guess: tuple[Floats, Floats] | None = None,
    aim: Aim | None = None,
    trend: Floats | None = None,
) -> VibratingStretch:
    """Solve the motion through a stretch of contact by Newton's method.

    Parameters
    ----------
    seen : Seen
        The system, as the contacts that push see it.
    locals_ : sequence of LocalContact
        The law of each, and what is in series with it.
    time_map : {"touch", "inside", "release"}
        In which root of time the forces are smooth.
    length : float
        How long the stretch lasts [s]; with an aim, about how long.
    start : State
        Where it begins.
    begun : sequence of float
        The laws' own indentations there [m], nearly.
    guess : tuple of two arrays, shape (c, N), optional
        Those indentations [m] and the forces [N] at the nodes, nearly.
    aim : Aim, optional
        What ends the stretch; its length is found.
    trend : array, shape (c,), optional
        About how fast the forces change at the start [N/s], where there is no guess.
    """
    of, at = seen.system, spectrum(time_map, max(local.law.root for local in locals_))
    met, begun_rate = (part[seen.contacts] for part in (of.approach(start), of.outer_rates(start)))
    met = np.maximum(met, [local.release_level for local in locals_])
    own = np.array([local.near(*pair) for local, *pair in zip(locals_, begun, met.tolist(), strict=True)])
    here = Receptance(seen, at, length, start)
    delta, force = _first_guess(locals_, here, own, begun_rate, trend) if guess is None else guess
    static = np.zeros_like(force)
    scale = float((of.mass[seen.contacts] * (np.abs(here.rate).max(axis=1) / length + np.abs(seen.gravity))).max())
    solved, before = False, np.inf
    for _ in range(_SWEEPS):
        now = linearised(locals_, delta, here.rate - taken(here.rate_by, force))
        if not (now.slope > 0.0).all():  # what is taken out in series outweighs the law: there is no such contact
            break
        try:
            by_delta, by_force, by_length = _newton_step(now, here, delta, force, aim)
        except np.linalg.LinAlgError:
            break
        limit = _LONGER * length
        by_length = min(max(by_length, -limit), limit / (1.0 + _LONGER))
        static, delta, force, length = now.static - now.stiffness * by_delta, delta - by_delta, force - by_force, length - by_length
        if aim is not None:
            here = Receptance(seen, at, length, start)
        most = max(float(np.abs(by_force).max()), float(np.abs(now.stiffness * by_delta).max())) / (scale + float(np.abs(force).max()))
        size = max(most, abs(by_length) / length)
        # what the next step would be: of a method that converges quadratically, but for its derivatives
        following = size * max((size / before) ** 2, _INEXACT) if size < before else size
        solved = min(size, following) < _CONVERGED or (size < _STALLED and size > 0.3 * before)
        if solved or not np.isfinite(size):
            break
        before = size
    approach = here.approach - taken(here.by_force, force) - taken(here.by_static, static)
    rate = here.rate - taken(here.rate_by, force)
    if of.mobility.size:  # a dashpot takes up a jump of the force at once
        jumps = seen.with_local.any(axis=0)
        begun_rate = np.where(jumps, at.rule.interpolate(np.zeros(1), rate.T)[0], begun_rate)
    histories = (np.column_stack(pair) for pair in ((met, approach), (begun_rate, rate), (own, delta)))
    parts = zip(seen.contacts, locals_, static, force - static, *histories, strict=True)
    contacts = tuple(ContactHistory(number, local, at.rule, *rest) for number, local, *rest in parts)
    return VibratingStretch(seen, at, length, start, contacts, bool(solved))


def taken(matrix: Floats, force: Floats) -> Floats:
    """Return what forces at the nodes of contacts (c, N) do by a matrix (c N, c N), (c, N)."""
    return np.asarray((matrix @ force.ravel()).reshape(force.shape))


def _first_guess(
    locals_: Sequence[LocalContact], here: Receptance, begun: Floats, begun_rate: Floats, trend: Floats | None
) -> tuple[Floats, Floats]:
    """Return what the forces at the start, going on, make of indentations and forces at the nodes (c, N)."""
    parts = np.array([local.own_forces(delta, rate) for local, delta, rate in zip(locals_, begun, begun_rate, strict=True)])
    static, force = (np.repeat(part[:, None], NODES, axis=1) for part in (parts[:, 0], parts.sum(axis=1)))
    if trend is not None:
        later = trend[:, None] * (here.length * here.at.rule.time)
        static, force = static + later, force + later
    approach = here.approach - taken(here.by_force, force) - taken(here.by_static, static)
    delta = np.array([local.about(np.maximum(row, local.release_level)) for local, row in zip(locals_, approach, strict=True)])
    rates = here.rate - taken(here.rate_by, force)
    return delta, np.array([np.add(*local.own_forces(*pair)) for local, *pair in zip(locals_, delta, rates, strict=True)])


def _newton_step(now: Linearised, here: Receptance, delta: Floats, force: Floats, aim: Aim | None) -> tuple[Floats, Floats, float]:
    r"""Return by how much Newton's method takes back the indentations, the forces, and the length.

    The equations are, with the approach y that goes with an indentation, :math:`y(\delta) = y_0(h) - G(h) F - G_s(h) F_s(\delta)` and
    :math:`F = F_{law}(\delta, \dot y_0(h) - R(h) F)`. Their indentations are eliminated.
    """
    shape = force.shape
    missing = (now.approach - here.approach).ravel() + here.by_force @ force.ravel() + here.by_static @ now.static.ravel()
    excess = (force - (now.static + now.dissipative)).ravel()
    left = eliminated(now, here)
    sunk = left.inward @ missing
    right = excess + left.push * sunk
    if aim is None:
        by_force = np.linalg.solve(left.jacobian, right)
        return (sunk - left.taken @ by_force).reshape(shape), by_force.reshape(shape), 0.0
    approach, rate, closing = here.by_length(force, now.static)
    by_length = -(left.inward @ approach.ravel())
    row, slope, gone = _event_row(now, here, left, delta, force, aim, closing, by_length, sunk)
    whole = np.empty((len(right) + 1, len(right) + 1))  # the length as a part of itself
    whole[:-1, :-1] = left.jacobian
    whole[:-1, -1] = (left.push * by_length - (now.dissipative_by_rate * rate).ravel()) * here.length
    whole[-1, :-1], whole[-1, -1] = row, slope * here.length
    found = np.linalg.solve(whole, np.append(right, gone))
    by_force, shorter = found[:-1], float(found[-1] * here.length)
    return (sunk - left.taken @ by_force - by_length * shorter).reshape(shape), by_force.reshape(shape), shorter


class Eliminated(NamedTuple):
    """What the indentations leave behind when they are eliminated from the linearised equations of a stretch; M = c N.

    `inward`, `taken`: how the indentations answer to an approach that is missing [-], and by how much forces take them back [m/N]
    (M, M). `push`: derivative of the force by the indentation [N/m] (M,). `jacobian`: of the equations of the forces that are left [-]
    (M, M).
    """

    inward: Floats
    taken: Floats
    push: Floats
    jacobian: Floats


def eliminated(now: Linearised, here: Receptance) -> Eliminated:
    """Return the linearised equations of a stretch without their indentations."""
    inward = here.by_static * now.stiffness.ravel()
    inward.flat[:: len(inward) + 1] += now.slope.ravel()
    inward = np.linalg.inv(inward)
    reached, push = inward @ here.by_force, (now.stiffness + now.dissipative_by_delta).ravel()
    jacobian = now.dissipative_by_rate.reshape(-1, 1) * here.rate_by + push[:, None] * reached
    jacobian.flat[:: len(jacobian) + 1] += 1.0
    return Eliminated(inward, reached, push, jacobian)


def _event_row(
    now: Linearised,
    here: Receptance,
    left: Eliminated,
    delta: Floats,
    force: Floats,
    aim: Aim,
    closing_by_length: Floats,
    by_length: Floats,
    sunk: Floats,
) -> tuple[Floats, float, float]:
    """Return the row of an event in the Jacobian: by the forces, by the length; and what it leaves, in units of a force."""
    last = (aim.contact + 1) * NODES - 1  # the last node of the contact with the event
    if aim.name == "no push":
        row = np.zeros(force.size)
        row[last] = 1.0
        return row, 0.0, float(force.flat[last])
    if aim.name == "turn":
        inside = here.closing_by_static[last] * now.stiffness.ravel()
        still = here.closing.flat[last] - here.rate_by[last] @ force.ravel() - here.closing_by_static[last] @ now.static.ravel()
        row, slope = inside @ left.taken - here.rate_by[last], float(closing_by_length.flat[last] + inside @ by_length)
        unit = 1.0 / max(float(np.abs(here.rate_by[last]).max()), 1e-300)
        return unit * row, unit * slope, unit * float(still + inside @ sunk)
    unit = 1.0 / max(float(np.abs(left.taken[last]).max()), 1e-300)
    return -unit * left.taken[last], -unit * float(by_length[last]), unit * float(delta.flat[last] - aim.level - sunk[last])
