r"""Friction at the contact of a rigid sphere with a surface that moves, through stretches of contact.

The contact point of the sphere moves along the surface as a particle of its effective mass :math:`m_t`, 2/7 of that of a solid sphere, the
surface by the modes of the body below, which friction bends and turns. With the displacements u of the first and w of the second,

.. math:: m_t \ddot u = m_t g_t - Q,\qquad w = \sum_i \psi_i q_i,\qquad \ddot q_i + \ldots = -\chi_i F + \psi_i Q

and Q follows from F and the history of u - w by the friction law. At the nodes of a stretch all displacements are linear in F and Q. Q is
found by iteration beside Newton's method for F: it follows from displacements before it, so that each iteration adds an order in time.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.contact.friction.law import CompliantFriction, TangentialHistory
from vibroimpact.dynamics.collocation import Map, Rule
from vibroimpact.dynamics.linear_equations import stacked_matvec
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.receptance import (
    NODES_PER_STRETCH,
    ContactView,
    RadauEigenbasis,
    Receptance,
    StackedSystems,
    contact_view,
    radau_eigenbasis,
)

_STEPS = 4  # of the history from each node to the next


@dataclass(frozen=True)
class Rubbing:
    """Friction of one drop, and the motion of the contact point of its sphere, at an instant.

    `law`: of one drop. `largest_force`: about [N]. `mass`: effective mass of the motion of the contact point [kg]. `pull`: acceleration of
    gravity along x and y [m/s^2]. `velocity` [m/s] and `displacement` since first touch [m] of the contact point; `force` of friction on
    it, against these, and `normal` force [N]. `history`: of the contact. Since first touch: `work`, energy that friction took, with what
    the contact stores tangentially [J]; `microslip`, the part of it that was not lost while all of the contact slid [J]; and `twisting`,
    impulse of the moment of full twisting [N m s]. Arrays are (2,).
    """

    law: CompliantFriction
    largest_force: float
    mass: float
    pull: Floats
    velocity: Floats
    displacement: Floats
    force: Floats
    history: TangentialHistory
    normal: float = 0.0
    work: float = 0.0
    microslip: float = 0.0
    twisting: float = 0.0

    def flown(self, length: float) -> Rubbing:
        """Return the same after a time without contact force [s]."""
        moved = self.displacement + (self.velocity + 0.5 * self.pull * length) * length
        fresh = self.law.history(self.largest_force)
        return replace(self, velocity=self.velocity + self.pull * length, displacement=moved, force=np.zeros(2), normal=0.0, history=fresh)


def rubbing_at_touch(law: CompliantFriction, largest_force: float, mass: float, pull: Floats, velocity: Floats) -> Rubbing:
    """Return the friction of one drop at first touch, with a velocity of the contact point of its sphere [m/s] (2,)."""
    return Rubbing(law, largest_force, mass, pull, velocity, np.zeros(2), np.zeros(2), law.history(largest_force))


@dataclass(frozen=True)
class RubbedStretch:
    """Friction through a stretch of contact of a length [s].

    `start`, `end`: at its ends. `force`: of friction, against the slip [N], and `slip`: velocity of the contact point of the sphere past
    the surface [m/s], at the nodes (2, N). `surface_work`: work of friction on the body below [J]. `imbalance`: error of the balance of
    energy of the contact point [J].
    """

    rule: Rule
    length: float
    start: Rubbing
    end: Rubbing
    force: Floats
    slip: Floats
    surface_work: float
    imbalance: float

    def at(self, time: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return velocity and displacement of the contact point, friction (2, T) and energy taken (T,), at times since the start [s]."""
        rule, start, length = self.rule, self.start, self.length
        x = rule.unmap_time(time / length)
        integral, across, pull = length * rule.integral_to(x), time, start.pull[:, None]
        slowed = self.force.T / start.mass
        velocity = start.velocity[:, None] + pull * across - (integral @ slowed).T
        free = start.displacement[:, None] + (start.velocity[:, None] + 0.5 * pull * across) * across
        displacement = free - (integral @ (length * (rule.integral @ slowed))).T
        weights = rule.weights(x)
        force = np.concatenate([start.force[:, None], self.force], axis=1) @ weights
        return velocity, displacement, force, start.work + integral @ (self.force * self.slip).sum(axis=0)


def rubbed_view(view: ContactView) -> ContactView:
    """Return the system of a drop reduced to its contact and to the two directions of friction at it."""
    return contact_view(view.system.rubbed, (0, 1, 2))


class FrictionForces:
    """Friction forces at the nodes of stretches of B drops, and the motion that they cause; arrays over both directions are (B, 2, N)."""

    def __init__(self, views: Sequence[ContactView], starts: Sequence[State], rubbings: Sequence[Rubbing], basis: RadauEigenbasis) -> None:
        self.rubbings, self.basis = rubbings, basis
        self.systems = StackedSystems([rubbed_view(view) for view in views], starts)
        self.mass, self.pull, self.velocity, force = (
            np.array([getattr(one, name) for one in rubbings]) for name in ("mass", "pull", "velocity", "force")
        )
        self.force = np.repeat(force[:, :, None], NODES_PER_STRETCH, axis=2)
        self.histories: list[TangentialHistory] = [one.history for one in rubbings]
        self.normal, self.microslip = np.zeros((2, len(rubbings)))

    def set_length(self, length: Floats) -> None:
        """Set the lengths of the stretches [s] (B,)."""
        self.length, self.receptance = length, Receptance(self.systems, self.basis, length)

    def moving(self, receptance: Receptance) -> Receptance:
        """Return the motion of the surfaces at the contacts with what friction moves them."""
        found, normal = copy.copy(receptance), slice(0, NODES_PER_STRETCH)
        rubbing, flat = slice(NODES_PER_STRETCH, None), self.force.reshape(len(self.force), -1)
        faster = stacked_matvec(self.receptance.rate_by_force[:, normal, rubbing], flat)
        found.approach = receptance.approach - stacked_matvec(self.receptance.approach_by_force[:, normal, rubbing], flat)
        found.rate, found.closing = receptance.rate - faster, receptance.closing - faster
        return found

    def follow(self, normal: Floats, iterating: Bools) -> Floats:
        """Find the friction under normal forces at the nodes [N] (B, N) from the last iterate; return how much it changed [N] (B,)."""
        before, (of_force, of_moved) = self.force, _between((self.basis.rule.time_map, self.basis.rule.root))
        steps = np.diff(self._displacements(normal) @ of_moved, axis=2, prepend=0.0)
        pressed = (normal[:, None] @ of_force)[:, 0]  # system by system, as all products
        self.force = before.copy()
        for number in np.flatnonzero(iterating).tolist():
            start = self.rubbings[number]
            history, frictions, slid = start.history, [start.force], [start.history.slid]
            for node, (force, moved) in enumerate(zip(pressed[number].tolist(), steps[number].T, strict=True), start=1):
                history, friction = history.after(force, moved)
                frictions.append(friction)
                slid.append(history.slid)
                if node % _STEPS == 0:
                    self.force[number, :, node // _STEPS - 1] = friction
            self.histories[number] = history
            normals = np.append(start.normal, pressed[number])
            self.microslip[number] = lost_in_microslip(start.law, normals, np.array(frictions), steps[number].T, np.array(slid))
            self.normal[number] = normals[-1]
        return np.asarray(np.abs(self.force - before).max(axis=(1, 2)))

    def _displacements(self, normal: Floats) -> Floats:
        """Return the displacements of the surfaces past each other since the start [m]."""
        rule, across = self.basis.rule, self.length[:, None, None]
        time = across * rule.time
        alone = (self.velocity[:, :, None] + 0.5 * self.pull[:, :, None] * time) * time
        alone -= across**2 * (self.force @ rule.integral_twice.T) / self.mass[:, None, None]
        return np.asarray(alone + self._surfaces(normal, "approach") - self.systems.approach[:, 1:, None])

    def _surfaces(self, normal: Floats, what: str) -> Floats:
        """Return what the surfaces below add to displacement ("approach") or slip ("rate") at the nodes."""
        every = np.concatenate([normal, self.force.reshape(len(normal), -1)], axis=1)
        found = getattr(self.receptance, what) - stacked_matvec(getattr(self.receptance, f"{what}_by_force"), every)
        return np.asarray(found.reshape(len(normal), 3, NODES_PER_STRETCH)[:, 1:])

    def stretches(self, normal: Floats) -> list[RubbedStretch]:
        """Return the friction through the stretches, under the normal forces at the nodes [N] (B, N)."""
        rule, across = self.basis.rule, self.length[:, None, None]
        slowed = self.force / self.mass[:, None, None]
        velocity = self.velocity[:, :, None] + self.pull[:, :, None] * (across * rule.time) - across * (slowed @ rule.integral.T)
        below = self._surfaces(normal, "rate")
        time = across[:, :, 0] * rule.time[-1]
        moved = (self.velocity + 0.5 * self.pull * time) * time - across[:, :, 0] ** 2 * (slowed @ rule.integral_twice[-1])
        found = []
        for number, start in enumerate(self.rubbings):
            length, force, slip = float(self.length[number]), self.force[number], velocity[number] + below[number]
            taken, given = (length * float(rule.integral[-1] @ (force * rate).sum(axis=0)) for rate in (slip, -below[number]))
            moment = start.law.twisting_moment(np.maximum(normal[number], 0.0))
            end = replace(
                start,
                velocity=velocity[number, :, -1],
                displacement=start.displacement + moved[number],
                force=force[:, -1],
                normal=float(self.normal[number]),
                history=self.histories[number],
                work=start.work + taken,
                microslip=start.microslip + float(self.microslip[number]),
                twisting=start.twisting + length * float(rule.integral[-1] @ moment),
            )
            gain = 0.5 * (end.velocity - start.velocity) @ (end.velocity + start.velocity) - start.pull @ moved[number]
            found.append(RubbedStretch(rule, length, start, end, force, slip, given, float(start.mass * gain) + taken + given))
        return found


def lost_in_microslip(law: CompliantFriction, normal: Floats, friction: Floats, moved: Floats, slid: Floats) -> float:
    """Return what friction took on a way [J], but while all of the contact slid; less its elastic energy, where it slides at the end.

    `normal`: forces [N] (T,). `friction`: forces [N] (T, 2). `moved`: displacements between them [m] (T - 1, 2). `slid`: on the way to
    each of them [m] (T,).
    """
    normal = np.maximum(normal, 0.0)
    mean, slides = 0.5 * (normal[1:] + normal[:-1]), (slid > 0.0) | (normal == 0.0)
    taken = 0.5 * ((friction[1:] + friction[:-1]) * moved).sum(axis=1) - law.coefficient * mean * slid[1:]
    return float(np.where(slides[1:] & slides[:-1], np.diff(law.energy_in_sliding(normal)), taken).sum())


@cache
def _between(kind: tuple[Map, int]) -> tuple[Floats, Floats]:
    """Return the weights of nodal values (N, M) at points between the nodes, `_STEPS` from each to the next.

    First those of forces, then those of displacements, which are zero at the start.
    """
    rule = radau_eigenbasis(*kind).rule
    ends = np.concatenate([[0.0], rule.nodes])
    x = (ends[:-1, None] + np.diff(ends)[:, None] * np.arange(1, _STEPS + 1) / _STEPS).ravel()
    return rule.interpolate(x, np.eye(NODES_PER_STRETCH)).T, rule.weights(x)[1:]
