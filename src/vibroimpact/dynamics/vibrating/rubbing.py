r"""Friction at the contact of a rigid sphere with a surface that moves, through stretches of contact.

The contact point of the sphere moves along the surface as a particle of its effective mass :math:`m_t`, 2/7 of that of a solid sphere, the
surface by the modes of the body below, which friction bends and turns. With the displacements u of the first and w of the second,

.. math:: m_t \ddot u = m_t g_t - Q,\qquad w = \sum_i \psi_i q_i,\qquad \ddot q_i + \ldots = -\chi_i F + \psi_i Q

and Q follows from F and the history of u - w by the friction law. At the nodes of a stretch all displacements are linear in F and Q. Q is
found by iteration beside Newton's method for F: it follows from displacements before it, so that each iteration adds an order in time.

Where rolling is resisted or the sphere spins about the normal, the moments M act as well, against the part of its spin that rolls and that
about the normal, both relative to the rigid rotation of the plate, which they turn. With the moment of inertia I of the sphere

.. math:: I \dot\omega = -R Q - M,\qquad m_t \ddot u = m_t g_t - Q - \frac{m_t R}{I} M

for the spins about -y, x (and z, on which Q has no moment). Moments that would turn a spin back within a stretch are as large as brings it
to its end.
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
from vibroimpact.dynamics.oblique.state import Sphere
from vibroimpact.dynamics.oblique.state import State as Along
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

    `law`: of one drop. `largest_force`: about [N]. `mass`: effective mass of the motion of the contact point [kg]. `radius` [m] and
    `inertia` [kg m^2] of the sphere. `pull`: acceleration of gravity along x and y [m/s^2]. `velocity` [m/s] and `displacement` since first
    touch [m] of the contact point; `spin` of the sphere about -y, x and z [rad/s] (3,). `force` of friction on it, against these, and
    `normal` force [N]. `history`: of the contact. Since first touch: `work`, energy that friction took, with what the contact stores
    tangentially [J]; `microslip`, the part of it that was not lost while all of the contact slid [J]; what the moments made of the spin,
    `turned` [rad/s] (3,), and of the displacement, `turned_way` [m]. Other arrays are (2,).
    """

    law: CompliantFriction
    largest_force: float
    mass: float
    radius: float
    inertia: float
    pull: Floats
    velocity: Floats
    displacement: Floats
    spin: Floats
    force: Floats
    history: TangentialHistory
    turned: Floats
    turned_way: Floats
    normal: float = 0.0
    work: float = 0.0
    microslip: float = 0.0

    def flown(self, length: float) -> Rubbing:
        """Return the same after a time without contact force [s]."""
        moved = self.displacement + (self.velocity + 0.5 * self.pull * length) * length
        fresh = self.law.history(self.largest_force)
        way = self.turned_way + self.radius * self.turned[:2] * length
        velocity = self.velocity + self.pull * length
        return replace(self, velocity=velocity, displacement=moved, force=np.zeros(2), normal=0.0, history=fresh, turned_way=way)


def rubbing_at_touch(law: CompliantFriction, largest_force: float, sphere: Sphere, before: Along) -> Rubbing:
    """Return the friction of one drop at first touch, from its sphere and state then."""
    none, (about_x, about_y, about_z) = np.zeros(2), before.spin[:, 0]
    mass, radius, inertia = (float(part[0]) for part in (sphere.tangential_mass, sphere.radius, sphere.inertia))
    spin, slip, pull = np.array([-about_y, about_x, about_z]), sphere.slip(before)[:, 0], sphere.gravity[:, 0]
    history = law.history(largest_force)
    return Rubbing(law, largest_force, mass, radius, inertia, pull, slip, none, spin, none, history, np.zeros(3), none)


@dataclass(frozen=True)
class RubbedStretch:
    """Friction through a stretch of contact of a length [s].

    `start`, `end`: at its ends. `force`: of friction, against the slip [N], and `slip`: velocity of the contact point of the sphere past
    the surface [m/s], at the nodes (2, N); where moments act also these [N m], and the spin past the surface [rad/s] (5, N).
    `surface_work`: work of friction on the body below [J]. `imbalance`: error of the balances of energy of the contact point and of
    the spin [J].
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
        """Return velocity and displacement of the contact point (2, T), friction (2 or 5, T) and energy taken (T,), at times [s] (T,)."""
        rule, start, length = self.rule, self.start, self.length
        x = rule.unmap_time(time / length)
        integral, across, pull = length * rule.integral_to(x), time, start.pull[:, None]
        slowed = slowing(self.force, start.mass, start.radius / start.inertia).T
        velocity = start.velocity[:, None] + pull * across - (integral @ slowed).T
        free = start.displacement[:, None] + (start.velocity[:, None] + 0.5 * pull * across) * across
        displacement = free - (integral @ (length * (rule.integral @ slowed))).T
        begun = np.append(start.force, self.force[2:, 0])  # the moments begin about as at the first node
        force = np.concatenate([begun[:, None], self.force], axis=1) @ rule.weights(x)
        return velocity, displacement, force, start.work + integral @ (self.force * self.slip).sum(axis=0)

    def turned(self, time: Floats) -> tuple[Floats, Floats]:
        """Return what moments made of the spin [rad/s] (3, T), and of the displacement [m] (2, T), at times since the start [s] (T,)."""
        rule, start, length = self.rule, self.start, self.length
        turned, way = start.turned[:, None] + 0.0 * time, start.turned_way[:, None] + start.radius * start.turned[:2, None] * time
        if len(self.force) == 2:
            return turned, way
        integral, slowed = length * rule.integral_to(rule.unmap_time(time / length)), (self.force[2:] / start.inertia).T
        more = (integral @ (length * (rule.integral @ slowed[:, :2]))).T
        return turned - (integral @ slowed).T, way - start.radius * more


def slowing(force: Floats, mass: Floats | float, turn: Floats | float) -> Floats:
    """Return by how much friction (..., 2, N), or it and its moments (..., 5, N), slow the contact point [m/s^2] (..., 2, N).

    `mass`: effective [kg]. `turn`: radius over moment of inertia of the sphere [1/(kg m)].
    """
    slowed = force[..., :2, :] / mass
    return slowed if force.shape[-2] == 2 else slowed + turn * force[..., 2:4, :]


def rubbed_view(view: ContactView) -> ContactView:
    """Return the system of a drop reduced to its contact and to the directions of friction at it."""
    return contact_view(view.system.rubbed, tuple(range(len(view.system.rubbed.shape))))


class FrictionForces:
    """Friction forces at the nodes of stretches of B drops, and the motion that they cause; arrays over both directions are (B, 2, N).

    `force` has three further rows, (B, 5, N), where moments act.
    """

    def __init__(self, views: Sequence[ContactView], starts: Sequence[State], rubbings: Sequence[Rubbing], basis: RadauEigenbasis) -> None:
        self.rubbings, self.basis = rubbings, basis
        self.systems = StackedSystems([rubbed_view(view) for view in views], starts)
        self.mass, self.pull, self.velocity, force = (
            np.array([getattr(one, name) for one in rubbings]) for name in ("mass", "pull", "velocity", "force")
        )
        self.spin, self.inertia, radius = (np.array([getattr(one, name) for one in rubbings]) for name in ("spin", "inertia", "radius"))
        self.turn = radius / self.inertia
        self.force = np.zeros((len(views), self.systems.gravity.shape[1] - 1, NODES_PER_STRETCH))
        self.force[:, :2] = force[:, :, None]
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
                    self.force[number, :2, node // _STEPS - 1] = friction
            self.histories[number] = history
            normals = np.append(start.normal, pressed[number])
            self.microslip[number] = lost_in_microslip(start.law, normals, np.array(frictions), steps[number].T, np.array(slid))
            self.normal[number] = normals[-1]
        if self.force.shape[1] > 2:
            self.force[iterating, 2:] = self._moments(normal)[iterating]
        return np.asarray(np.abs(self.force - before).max(axis=(1, 2)))

    def _displacements(self, normal: Floats) -> Floats:
        """Return the displacements of the surfaces past each other since the start [m]."""
        rule, across = self.basis.rule, self.length[:, None, None]
        time = across * rule.time
        alone = (self.velocity[:, :, None] + 0.5 * self.pull[:, :, None] * time) * time
        alone -= across**2 * (self._slowed @ rule.integral_twice.T)
        return np.asarray(alone + (self._surfaces(normal, self.force, "approach") - self.systems.approach[:, 1:, None])[:, :2])

    @property
    def _slowed(self) -> Floats:
        """By how much friction slows the contact points [m/s^2]."""
        return slowing(self.force, self.mass[:, None, None], self.turn[:, None, None])

    def _surfaces(self, normal: Floats, force: Floats, what: str) -> Floats:
        """Return what the surfaces below add to displacement ("approach") or slip ("rate") at the nodes, under friction forces."""
        every = np.concatenate([normal, force.reshape(len(normal), -1)], axis=1)
        found = getattr(self.receptance, what) - stacked_matvec(getattr(self.receptance, f"{what}_by_force"), every)
        return np.asarray(found.reshape(len(normal), -1, NODES_PER_STRETCH)[:, 1:])

    def _moments(self, normal: Floats) -> Floats:
        """Return the moments at the nodes [N m] (B, 3, N): they act along the spins as these are without them, and end with these."""
        force, slips = self.force.copy(), self._velocities() + self._surfaces(normal, self.force, "rate")[:, :2]
        force[:, 2:] = 0.0
        free = self._spins(force) + self._surfaces(normal, force, "rate")[:, 2:]
        size = np.sqrt(_together(free**2))
        along = np.divide(free, size, out=np.zeros_like(free), where=size > 0.0)
        for number, (one, load) in enumerate(zip(self.rubbings, np.maximum(normal, 0.0), strict=True)):
            force[number, 2:4] = one.law.rolling_coefficient * one.radius * load
            rubbed, slip = np.hypot(*force[number, :2]), np.hypot(*slips[number])
            force[number, 4] = one.law.twisting_moment(load) * one.law.twisting_part(load, rubbed, slip, size[number, 2])
        force[:, 2:] *= along
        full = self._spins(force) + self._surfaces(normal, force, "rate")[:, 2:]
        left, slower = (_together(change * along)[:, :, -1:] for change in (free, free - full))
        return np.asarray(force[:, 2:] * np.clip(np.divide(left, slower, out=np.ones_like(left), where=slower > left), 0.0, 1.0))

    def _velocities(self) -> Floats:
        """Return the velocities of the contact points of the spheres at the nodes [m/s] (B, 2, N)."""
        rule, across = self.basis.rule, self.length[:, None, None]
        return np.asarray(
            self.velocity[:, :, None] + self.pull[:, :, None] * (across * rule.time) - across * (self._slowed @ rule.integral.T)
        )

    def _spins(self, force: Floats) -> Floats:
        """Return the spins of the spheres at the nodes [rad/s] (B, 3, N), under friction forces and moments."""
        return np.asarray(self.spin[:, :, None] - self.length[:, None, None] * (self._slowed_spins(force) @ self.basis.rule.integral.T))

    def _slowed_spins(self, force: Floats) -> Floats:
        """Return by how much friction forces and moments slow the spins [rad/s^2] (B, 3, N)."""
        slowed = force[:, 2:] / self.inertia[:, None, None]
        slowed[:, :2] += self.turn[:, None, None] * force[:, :2]
        return np.asarray(slowed)

    def _spin_imbalances(self, spins: Floats) -> Floats:
        """Return the error of the balance of energy of the spins, from these at the nodes (B, 3, N): [J] (B,)."""
        slowed, integral = self._slowed_spins(self.force), self.length[:, None] * self.basis.rule.integral[-1]
        change = -np.einsum("bkn,bn->bk", slowed, integral)
        gain = (change * (self.spin + 0.5 * change)).sum(axis=1)
        return np.asarray(self.inertia * (gain + np.einsum("bkn,bkn,bn->b", slowed, spins, integral)))

    def stretches(self, normal: Floats) -> list[RubbedStretch]:
        """Return the friction through the stretches, under the normal forces at the nodes [N] (B, N)."""
        rule, across, slowed = self.basis.rule, self.length[:, None, None], self._slowed
        velocity, below = self._velocities(), self._surfaces(normal, self.force, "rate")
        own = np.append(velocity, self._spins(self.force), axis=1) if len(self.force[0]) > 2 else velocity
        slips, of_spins = own + below, self._spin_imbalances(own[:, 2:]) if len(own[0]) > 2 else np.zeros(len(own))
        time = across[:, :, 0] * rule.time[-1]
        moved = (self.velocity + 0.5 * self.pull * time) * time - across[:, :, 0] ** 2 * (slowed @ rule.integral_twice[-1])
        found = []
        for number, start in enumerate(self.rubbings):
            length, force, slip = float(self.length[number]), self.force[number], slips[number]
            taken, given = (length * float(rule.integral[-1] @ (force * rate).sum(axis=0)) for rate in (slip, -below[number]))
            end = replace(
                start,
                velocity=velocity[number, :, -1],
                displacement=start.displacement + moved[number],
                force=force[:2, -1],
                normal=float(self.normal[number]),
                history=self.histories[number],
                work=start.work + taken,
                microslip=start.microslip + float(self.microslip[number]),
            )
            gain = 0.5 * (end.velocity - start.velocity) @ (end.velocity + start.velocity) - start.pull @ moved[number]
            lost = length * float(rule.integral[-1] @ (start.mass * slowed[number] * velocity[number]).sum(axis=0))
            imbalance = abs(float(start.mass * gain) + lost) + abs(float(of_spins[number]))
            stretch = RubbedStretch(rule, length, start, end, force, slip, given, imbalance)
            if len(force) > 2:
                turned, way = (part[:, 0] for part in stretch.turned(self.length[number : number + 1]))
                stretch = replace(stretch, end=replace(end, spin=own[number, 2:, -1], turned=turned, turned_way=way))
            found.append(stretch)
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


def _together(values: Floats) -> Floats:
    """Return the sums of the parts of both rolling directions, in the place of each, and the part about the normal (B, 3, N)."""
    return np.stack([values[:, 0] + values[:, 1], values[:, 0] + values[:, 1], values[:, 2]], axis=1)


@cache
def _between(kind: tuple[Map, int]) -> tuple[Floats, Floats]:
    """Return the weights of nodal values (N, M) at points between the nodes, `_STEPS` from each to the next.

    First those of forces, then those of displacements, which are zero at the start.
    """
    rule = radau_eigenbasis(*kind).rule
    ends = np.concatenate([[0.0], rule.nodes])
    x = (ends[:-1, None] + np.diff(ends)[:, None] * np.arange(1, _STEPS + 1) / _STEPS).ravel()
    return rule.interpolate(x, np.eye(NODES_PER_STRETCH)).T, rule.weights(x)[1:]
