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

from dataclasses import dataclass, replace
from functools import cache
from typing import Literal, NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.dynamics.collocation import Map, Rule
from vibroimpact.dynamics.core.receptance import surface_motion
from vibroimpact.dynamics.core.records import Motion
from vibroimpact.dynamics.core.tangential_history import TangentialHistory, follow_history
from vibroimpact.dynamics.oblique.microslip import lost_in_microslip
from vibroimpact.dynamics.oblique.state import Sphere
from vibroimpact.dynamics.oblique.state import State as Along
from vibroimpact.dynamics.oblique.tangential_history import tangential_history
from vibroimpact.dynamics.vibrating.contact_view import ContactView, contact_view
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.radau_eigenbasis import NODES_PER_STRETCH, RadauEigenbasis, radau_eigenbasis

_STEPS = 4  # of the history from each node to the next
_LONGEST = 0.03  # of the duration of a contact, at the default tolerance
_DEFAULT_TOLERANCE = 1e-9
_ORDER = 4  # of the error in the length of stretches, about


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
        fresh = tangential_history(self.law, self.largest_force)
        way = self.turned_way + self.radius * self.turned[:2] * length
        velocity = self.velocity + self.pull * length
        return replace(self, velocity=velocity, displacement=moved, force=np.zeros(2), normal=0.0, history=fresh, turned_way=way)


def rubbing_at_touch(law: CompliantFriction, largest_force: float, sphere: Sphere, before: Along) -> Rubbing:
    """Return the friction of one drop at first touch, from its sphere and state then."""
    none, (about_x, about_y, about_z) = np.zeros(2), before.spin[:, 0]
    mass, radius, inertia = (float(part[0]) for part in (sphere.tangential_mass, sphere.radius, sphere.inertia))
    spin, slip, pull = np.array([-about_y, about_x, about_z]), sphere.slip(before)[:, 0], sphere.gravity[:, 0]
    history = tangential_history(law, largest_force)
    return Rubbing(law, largest_force, mass, radius, inertia, pull, slip, none, spin, none, history, np.zeros(3), none)


class Way(NamedTuple):
    """What happened on the way through a stretch, as `lost_in_microslip` takes it.

    normal, friction: forces [N] (T,), (T, 2). moved: displacements between them [m] (T - 1, 2). slid: how far all of the contact slid on
    the way to each [m] (T,).
    """

    normal: Floats
    friction: Floats
    moved: Floats
    slid: Floats


def longest_with_friction(tolerance: float) -> float:
    """Return the length of a stretch with friction at most, over the duration of a contact.

    The surfaces begin and cease to slip within stretches, which the balance of energy does not show. At the default tolerance the
    velocities along the plate after an impact are then known to 1e-4 of those before.
    """
    looser: float = (tolerance / _DEFAULT_TOLERANCE) ** (1.0 / _ORDER)
    return _LONGEST * looser


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


class Friction:
    """Friction forces at the nodes of a stretch of one drop, and the motion that they cause.

    `force` (2, N), along x and y [N]; where moments act it has three further rows of these [N m] (5, N).
    """

    def __init__(self, view: ContactView, start: State, rubbing: Rubbing, basis: RadauEigenbasis) -> None:
        self.rubbing = rubbing
        self.basis = basis
        self.surfaces = rubbed_view(view).surfaces
        self.start = rubbed_view(view).start(start)
        self.turn = rubbing.radius / rubbing.inertia
        self.force = np.zeros((len(self.start.approach) - 1, NODES_PER_STRETCH))
        self.force[:2] = rubbing.force[:, None]
        self.history = rubbing.history
        self.normal = 0.0
        self.way = Way(np.zeros(1), np.zeros((1, 2)), np.zeros((0, 2)), np.zeros(1))

    def set_length(self, length: float) -> None:
        """Set the length of the stretch [s]."""
        self.length = length
        self.motion = surface_motion(self.basis.basis, self.surfaces, self.start, length)

    def moving(self, motion: Motion) -> Motion:
        """Return the motion of the surfaces at the contact with what friction moves them."""
        flat = self.force.ravel()
        rows, columns = slice(0, NODES_PER_STRETCH), slice(NODES_PER_STRETCH, None)
        closer = self.motion.approach_by_force[rows, columns] @ flat
        faster = self.motion.rate_by_force[rows, columns] @ flat
        return motion._replace(approach=motion.approach - closer, rate=motion.rate - faster, closing=motion.closing - faster)

    def follow(self, normal: Floats) -> float:
        """Find the friction under normal forces at the nodes [N] (N,) from the last iterate; return by how much it changed [N]."""
        start, before = self.rubbing, self.force
        of_force, of_moved = _between((self.basis.rule.time_map, self.basis.rule.root))
        steps = np.diff(self._displacements(normal) @ of_moved, axis=1, prepend=0.0)
        pressed = normal @ of_force
        self.force = before.copy()
        frictions = np.empty((len(pressed) + 1, 2))
        slid = np.empty(len(pressed) + 1)
        frictions[0] = start.force
        slid[0] = start.history.slid
        self.history = follow_history(start.history, pressed, np.ascontiguousarray(steps.T), frictions[1:], slid[1:])
        self.force[:2] = frictions[_STEPS::_STEPS].T
        self.way = Way(np.append(start.normal, pressed), frictions, steps.T, slid)
        self.normal = float(pressed[-1])
        if len(self.force) > 2:
            self.force[2:] = self._moments(normal)
        return float(np.abs(self.force - before).max())

    def _displacements(self, normal: Floats) -> Floats:
        """Return the displacements of the surfaces past each other since the start [m] (2, N)."""
        rule, start = self.basis.rule, self.rubbing
        time = self.length * rule.time
        alone = (start.velocity[:, None] + 0.5 * start.pull[:, None] * time) * time
        alone -= self.length**2 * (self._slowed @ rule.integral_twice.T)
        moved = self._surfaces(normal, self.force, "approach") - self.start.approach[1:, None]
        return np.asarray(alone + moved[:2])

    @property
    def _slowed(self) -> Floats:
        """By how much friction slows the contact point [m/s^2] (2, N)."""
        return slowing(self.force, self.rubbing.mass, self.turn)

    def _surfaces(self, normal: Floats, force: Floats, what: Literal["approach", "rate"]) -> Floats:
        """Return what the surface below adds to displacement ("approach") or slip ("rate") at the nodes, under friction forces."""
        every = np.concatenate([normal, force.ravel()])
        free, by_force = getattr(self.motion, what), getattr(self.motion, f"{what}_by_force")
        return np.asarray((free - by_force @ every).reshape(-1, NODES_PER_STRETCH)[1:])

    def _moments(self, normal: Floats) -> Floats:
        """Return the moments at the nodes [N m] (3, N): they act along the spins as these are without them, and end with these."""
        law, load = self.rubbing.law, np.maximum(normal, 0.0)
        force = self.force.copy()
        slips = self._velocities() + self._surfaces(normal, self.force, "rate")[:2]
        force[2:] = 0.0
        free = self._spins(force) + self._surfaces(normal, force, "rate")[2:]
        size = np.sqrt(_together(free**2))
        along = np.divide(free, size, out=np.zeros_like(free), where=size > 0.0)
        force[2:4] = law.rolling_coefficient * self.rubbing.radius * load
        rubbed, slip = np.hypot(*force[:2]), np.hypot(*slips)
        force[4] = law.twisting_moment(load) * law.twisting_part(load, rubbed, slip, size[2])
        force[2:] *= along
        full = self._spins(force) + self._surfaces(normal, force, "rate")[2:]
        left, slower = (_together(change * along)[:, -1:] for change in (free, free - full))
        return np.asarray(force[2:] * np.clip(np.divide(left, slower, out=np.ones_like(left), where=slower > left), 0.0, 1.0))

    def _velocities(self) -> Floats:
        """Return the velocities of the contact point of the sphere at the nodes [m/s] (2, N)."""
        rule, start = self.basis.rule, self.rubbing
        free = start.velocity[:, None] + start.pull[:, None] * (self.length * rule.time)
        return np.asarray(free - self.length * (self._slowed @ rule.integral.T))

    def _spins(self, force: Floats) -> Floats:
        """Return the spins of the sphere at the nodes [rad/s] (3, N), under friction forces and moments."""
        return np.asarray(self.rubbing.spin[:, None] - self.length * (self._slowed_spins(force) @ self.basis.rule.integral.T))

    def _slowed_spins(self, force: Floats) -> Floats:
        """Return by how much friction forces and moments slow the spins [rad/s^2] (3, N)."""
        slowed = force[2:] / self.rubbing.inertia
        slowed[:2] += self.turn * force[:2]
        return np.asarray(slowed)

    def _spin_imbalance(self, spins: Floats) -> float:
        """Return the error of the balance of energy of the spins, from these at the nodes (3, N) [J]."""
        slowed, integral = self._slowed_spins(self.force), self.length * self.basis.rule.integral[-1]
        change = -slowed @ integral
        gain = (change * (self.rubbing.spin + 0.5 * change)).sum()
        return float(self.rubbing.inertia * (gain + ((slowed * spins) @ integral).sum()))

    def stretch(self, normal: Floats) -> RubbedStretch:
        """Return the friction through the stretch, under the normal forces at the nodes [N] (N,)."""
        rule, length, slowed, start, force = self.basis.rule, self.length, self._slowed, self.rubbing, self.force
        weights = length * rule.integral[-1]
        velocity, below = self._velocities(), self._surfaces(normal, force, "rate")
        own = np.append(velocity, self._spins(force), axis=0) if len(force) > 2 else velocity
        slip = own + below
        of_spins = self._spin_imbalance(own[2:]) if len(own) > 2 else 0.0
        time = length * rule.time[-1]
        moved = (start.velocity + 0.5 * start.pull * time) * time - length**2 * (slowed @ rule.integral_twice[-1])
        taken, given = (float((force * rate).sum(axis=0) @ weights) for rate in (slip, -below))
        end = replace(
            start,
            velocity=velocity[:, -1],
            displacement=start.displacement + moved,
            force=force[:2, -1],
            normal=self.normal,
            history=self.history,
            work=start.work + taken,
            microslip=start.microslip + lost_in_microslip(start.law, *self.way),
        )
        gain = 0.5 * (end.velocity - start.velocity) @ (end.velocity + start.velocity) - start.pull @ moved
        lost = float((start.mass * slowed * velocity).sum(axis=0) @ weights)
        imbalance = abs(float(start.mass * gain) + lost) + abs(of_spins)
        stretch = RubbedStretch(rule, length, start, end, force, slip, given, imbalance)
        if len(force) > 2:
            turned, way = (part[:, 0] for part in stretch.turned(np.array([length])))
            stretch = replace(stretch, end=replace(end, spin=own[2:, -1], turned=turned, turned_way=way))
        return stretch


def _together(values: Floats) -> Floats:
    """Return the sums of the parts of both rolling directions, in the place of each, and the part about the normal (3, N)."""
    return np.stack([values[0] + values[1], values[0] + values[1], values[2]])


@cache
def _between(kind: tuple[Map, int]) -> tuple[Floats, Floats]:
    """Return the weights of nodal values (N, M) at points between the nodes, `_STEPS` from each to the next.

    First those of forces, then those of displacements, which are zero at the start.
    """
    rule = radau_eigenbasis(*kind).rule
    ends = np.concatenate([[0.0], rule.nodes])
    x = (ends[:-1, None] + np.diff(ends)[:, None] * np.arange(1, _STEPS + 1) / _STEPS).ravel()
    return rule.interpolate(x, np.eye(NODES_PER_STRETCH)).T, rule.weights(x)[1:]
