r"""Solve a stretch of contact of bodies that vibrate, at once on the nodes of Radau collocation, up to an event where one ends it.

The unknowns are the contact forces and the law's own indentations at the nodes and, where an event ends the stretch, how long it
lasts. All else is linear in the forces (`receptance`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from vibroimpact.dynamics.collocation import Floats, Map
from vibroimpact.dynamics.local import Linearised, LocalContact
from vibroimpact.dynamics.oscillators import State
from vibroimpact.dynamics.receptance import NODES, Receptance, Surroundings, spectrum
from vibroimpact.dynamics.vibrating_stretch import VibratingStretch

_SWEEPS = 25
_UNIT = np.eye(NODES)
_LONGER = 3.0  # times: by no more does a sweep change the length that is sought
_CONVERGED, _STALLED = 1e-13, 1e-11


@dataclass(frozen=True)
class Aim:
    """What ends a stretch: the surfaces part, the law pushes no more, its indentation comes to a `level` [m], or the approach turns."""

    name: Literal["parted", "no push", "breakpoint", "turn"]
    level: float = 0.0


def solve_vibrating(
    around: Surroundings,
    local: LocalContact,
    time_map: Map,
    length: float,
    start: State,
    begun: float,
    guess: tuple[Floats, Floats] | None = None,
    aim: Aim | None = None,
) -> VibratingStretch:
    """Solve the motion through a stretch of contact by Newton's method.

    Parameters
    ----------
    around : Surroundings
        Mass, gravity and what vibrates.
    local : LocalContact
        The law and what is in series with it.
    time_map : {"touch", "inside", "release"}
        In which root of time the force is smooth.
    length : float
        How long the stretch lasts [s]; with an aim, about how long.
    start : State
        Where it begins.
    begun : float
        The law's own indentation there [m], nearly.
    guess : tuple of two arrays, shape (N,), optional
        That indentation [m] and the force [N] at the nodes, nearly.
    aim : Aim, optional
        What ends the stretch; its length is found.
    """
    of, at = around.oscillators, spectrum(time_map, local.law.root)
    met, begun_rate = max(float(of.approach(start)), local.release_level), float(of.outer_rates(start))
    begun = local.near(begun, met)
    seen = Receptance(around, at, length, start)
    delta, force = _first_guess(local, seen, begun, begun_rate) if guess is None else guess
    static = np.zeros(NODES)
    scale = around.mass * (np.abs(seen.rate).max() / length + around.gravity)
    solved, before = False, np.inf
    for _ in range(_SWEEPS):
        now = local.linearised(delta, seen.rate - seen.rate_by @ force)
        if not (now.slope > 0.0).all():  # what is taken out in series outweighs the law: there is no such contact
            break
        try:
            by_delta, by_force, by_length = _newton_step(now, seen, delta, force, aim)
        except np.linalg.LinAlgError:
            break
        limit = _LONGER * length
        by_length = min(max(by_length, -limit), limit / (1.0 + _LONGER))
        static, delta, force, length = now.static - now.stiffness * by_delta, delta - by_delta, force - by_force, length - by_length
        if aim is not None:
            seen = Receptance(around, at, length, start)
        most = max(float(np.abs(by_force).max()), float(np.abs(now.stiffness * by_delta).max())) / (scale + float(np.abs(force).max()))
        size = max(most, abs(by_length) / length)
        solved = size < _CONVERGED or (size < _STALLED and size > 0.3 * before)
        if solved or not np.isfinite(size):
            break
        before = size
    approach, rate = seen.approach - seen.by_force @ force - seen.by_static @ static, seen.rate - seen.rate_by @ force
    if of.mobility.size:  # a dashpot takes up a jump of the force at once
        begun_rate = float(at.rule.interpolate(np.zeros(1), rate)[0])
    motion = np.append(met, approach), np.append(begun_rate, rate), np.append(begun, delta)
    return VibratingStretch(around, local, at, length, start, static, force - static, *motion, bool(solved))


def _first_guess(local: LocalContact, seen: Receptance, begun: float, begun_rate: float) -> tuple[Floats, Floats]:
    """Return what the force at the start, going on, makes of indentations and forces at the nodes."""
    static, dissipative = local.own_forces(np.array(begun), np.array(begun_rate))
    force, static = np.full(NODES, float(static + dissipative)), np.full(NODES, float(static))
    delta = local.about(np.maximum(seen.approach - seen.by_force @ force - seen.by_static @ static, local.release_level))
    return delta, np.add(*local.own_forces(delta, seen.rate - seen.rate_by @ force))


def _newton_step(now: Linearised, seen: Receptance, delta: Floats, force: Floats, aim: Aim | None) -> tuple[Floats, Floats, float]:
    r"""Return by how much Newton's method takes back the indentations, the forces, and the length.

    The equations are, with the approach y that goes with an indentation, :math:`y(\delta) = y_0(h) - G(h) F - G_s(h) F_s(\delta)` and
    :math:`F = F_{law}(\delta, \dot y_0(h) - R(h) F)`. Their indentations are eliminated.
    """
    missing = now.approach + seen.by_force @ force + seen.by_static @ now.static - seen.approach
    excess = force - (now.static + now.dissipative)
    inward, taken, push, jacobian = eliminated(now, seen)
    sunk = inward @ missing
    right = excess + push * sunk
    if aim is None:
        by_force = np.linalg.solve(jacobian, right)
        return sunk - taken @ by_force, by_force, 0.0
    approach, rate, closing = seen.by_length(force, now.static)
    by_length = -(inward @ approach)
    row, last, gone = _event_row(now, seen, delta, force, aim, sunk, taken, by_length, closing)
    whole = np.empty((NODES + 1, NODES + 1))  # the length as a part of itself
    whole[:-1, :-1], whole[:-1, -1] = jacobian, (push * by_length - now.dissipative_by_rate * rate) * seen.length
    whole[-1, :-1], whole[-1, -1] = row, last * seen.length
    found = np.linalg.solve(whole, np.append(right, gone))
    by_force, shorter = found[:-1], float(found[-1] * seen.length)
    return sunk - taken @ by_force - by_length * shorter, by_force, shorter


def eliminated(now: Linearised, seen: Receptance) -> tuple[Floats, Floats, Floats, Floats]:
    """Return what the indentations leave behind when they are eliminated from the linearised equations of a stretch.

    Returns
    -------
    inward, taken : array, shape (N, N)
        How the indentations answer to an approach that is missing [-], and by how much forces take them back [m/N].
    push : array, shape (N,)
        Derivative of the force by the indentation [N/m].
    jacobian : array, shape (N, N)
        Of the equations of the forces that are left [-].
    """
    inward = np.linalg.inv(np.diag(now.slope) + seen.by_static * now.stiffness)
    taken, push = inward @ seen.by_force, now.stiffness + now.dissipative_by_delta
    return inward, taken, push, _UNIT + now.dissipative_by_rate[:, None] * seen.rate_by + push[:, None] * taken


def _event_row(
    now: Linearised,
    seen: Receptance,
    delta: Floats,
    force: Floats,
    aim: Aim,
    sunk: Floats,
    taken: Floats,
    by_length: Floats,
    closing_by_length: Floats,
) -> tuple[Floats, float, float]:
    """Return the row of an event in the Jacobian: by the forces, by the length; and what it leaves, in units of a force."""
    if aim.name == "no push":
        return _UNIT[-1], 0.0, float(force[-1])
    if aim.name == "turn":
        inside = seen.closing_by_static[-1] * now.stiffness
        left = float(seen.closing[-1] - seen.rate_by[-1] @ force - seen.closing_by_static[-1] @ now.static)
        row, last = inside @ taken - seen.rate_by[-1], float(closing_by_length[-1] + inside @ by_length)
        unit = 1.0 / max(float(np.abs(seen.rate_by[-1]).max()), 1e-300)
        return unit * row, unit * last, unit * (left + float(inside @ sunk))
    left = float(delta[-1] - aim.level)
    unit = 1.0 / max(float(np.abs(taken[-1]).max()), 1e-300)
    return -unit * taken[-1], -unit * float(by_length[-1]), unit * (left - float(sunk[-1]))
