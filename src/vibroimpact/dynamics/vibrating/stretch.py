"""A solved stretch of contact: motion of the coordinates, contact forces, energy balance and error measures."""

from __future__ import annotations

import threading
import weakref
from collections import deque
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Complex, Floats
from vibroimpact.dynamics.collocation import Rule
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.receptance import ContactView, RadauEigenbasis, StackedSystems
from vibroimpact.dynamics.vibrating.rubbing import RubbedStretch, rubbed_view

_RIGID_ROUNDING = 2e-15  # relative rounding error of the kinetic energy of the rigid motions that move the contacts
_ROUNDING = 2e-14  # relative rounding error of the energy of the modes, which may far exceed that of a soft contact
_KEPT = 64
"""Number of stretches whose motion a thread keeps in memory, the last ones that were solved or read: those of a few impacts."""


class _Kept(threading.local):
    """The stretches whose motion a thread keeps, oldest first.

    They are those of a thread, so that runs beside each other, as for windows of the live page, take nothing from one another. They are
    not those of a run: responses that are held would then hold their motions, which is four times the memory.
    """

    def __init__(self) -> None:
        self.stretches: deque[weakref.ref[VibratingStretch]] = deque()


_kept = _Kept()


class StretchMotion(NamedTuple):
    """Motion of the coordinates through a stretch.

    At the nodes: `accelerations` and `velocities` of the coordinates (N, n), and rates of the massless elements, `massless` (N, k). `end`:
    the state at the end. `gain`: increase of the energy of coordinates and massless elements, without the contact laws, and `rounding`: its
    rounding error [J]. `lost`: energy lost by the damping of each coordinate, and last in the massless elements [J] (n + 1,); of a driven
    coordinate minus the work of its drive.
    """

    accelerations: Floats
    velocities: Floats
    massless: Floats
    end: State
    gain: float
    rounding: float
    lost: Floats


@dataclass(frozen=True)
class VibratingStretch:
    """A solved stretch of one system.

    `view`: the system reduced to the contacts that push. `length` [s]. `start`: state at the start. `contacts`: histories of the contacts
    that push. `solved`: whether Newton's method converged. `roughness`: the last Legendre coefficients of the forces, relative to their
    scale; the error at the end is of the order of its square. `rubbed`: friction, of a drop that has any.
    """

    view: ContactView
    basis: RadauEigenbasis
    length: float
    start: State
    contacts: tuple[ContactHistory, ...]
    solved: bool
    roughness: float
    rubbed: RubbedStretch | None = None

    @property
    def system(self) -> LinearSystem:
        """The linear system."""
        return self.view.system

    @property
    def duration(self) -> Floats:
        """Its length [s], as an array of one."""
        return np.array([self.length])

    def take(self, drops: Bools) -> VibratingStretch:
        """Return itself: it belongs to one drop."""
        return self

    @property
    def rule(self) -> Rule:
        """Nodes and time map."""
        return self.basis.rule

    @cached_property
    def force(self) -> Floats:
        """Contact forces at the nodes [N] (c, N)."""
        return np.stack([contact.force for contact in self.contacts])

    @cached_property
    def motion(self) -> StretchMotion:
        """Motion of the coordinates; recomputed from the forces if it is no longer kept."""
        self.keep()
        view, force, static = self.view, self.force[None], np.array([[contact.static for contact in self.contacts]])
        if self.rubbed is not None:
            view, force = rubbed_view(view), np.concatenate([force, self.rubbed.force[None]], axis=1)
            static = np.concatenate([static, np.zeros_like(self.rubbed.force[None])], axis=1)
        systems, length = StackedSystems([view], [self.start]), np.array([self.length])
        admittance = 1.0 / systems.impedance(length[:, None] * self.basis.values)
        responses = systems.drive(self.basis, length) * admittance
        return stretch_motions(systems, self.basis, length, (admittance, responses), force, static)[0]

    @property
    def accelerations(self) -> Floats:
        """Accelerations of the coordinates at the nodes (N, n)."""
        return self.motion.accelerations

    @property
    def velocities(self) -> Floats:
        """Velocities of the coordinates at the nodes (N, n)."""
        return self.motion.velocities

    @cached_property
    def end(self) -> State:
        """State at the end."""
        return self.motion.end

    def closing_rates(self, contact: int = 0) -> Floats:
        """Return the rate of the approach at a contact, with coordinates inside the contact [m/s], at the start and the nodes (N + 1,)."""
        rate, inner = self.contacts[contact].rate, self.system.inner_shape[self.view.contacts[contact]]
        if not self.view.modes.inside:
            return rate
        return np.asarray(rate + np.concatenate([self.start.velocity[None], self.velocities]) @ inner)

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (T,)."""
        start, h, across, load = self.start, self.length, np.asarray(time)[:, None], self.system.load
        integral = h * self.rule.integral_to(self._x(time))
        driven = self.accelerations - load  # gravity is integrated in closed form
        return State(
            start.displacement + across * (start.velocity + 0.5 * across * load) + integral @ (h * (self.rule.integral @ driven)),
            start.velocity + across * load + integral @ driven,
            start.local + integral @ self.motion.massless,
        )

    def indentations(self, contact: int = 0) -> Floats:
        """Return the approach of the centre above to the surface below at a contact [m], at the start and the nodes (N + 1,)."""
        number = self.contacts[contact].number
        shape = self.system.indentation_shape[number]
        begun = float(self.system.offset[number] + self.start.displacement @ shape)
        return np.append(begun, begun + self.length * (self.rule.integral @ (self.velocities @ shape)))

    @cached_property
    def powers(self) -> Floats:
        """Power lost at the nodes [W], (N, n + 1): in each coordinate, and last in the laws and the massless elements."""
        system = self.system
        in_laws = sum(contact.power for contact in self.contacts)
        lost = in_laws + (self.motion.massless**2 / system.mobility).sum(axis=1)
        by_coordinate = system.damping * self.velocities**2
        if system.driven:
            shapes = system.shape[self.view.contacts, -system.driven :]
            pushed = self.force.T @ shapes
            if self.rubbed is not None and system.along is not None:
                pushed -= self.rubbed.force.T @ system.along[:, -system.driven :]
            by_coordinate[:, -system.driven :] = -pushed * self.velocities[:, -system.driven :]
        return np.concatenate([by_coordinate, lost[:, None]], axis=1)

    @cached_property
    def lost(self) -> Floats:
        """Energy lost over the stretch, with losses at its end [J], (n + 1,) as in `powers`."""
        lost = self.motion.lost.copy()
        lost[-1] += sum(contact.dissipated + contact.separation_loss for contact in self.contacts)
        return lost

    def lost_by(self, time: Floats) -> Floats:
        """Return the energy lost since the start [J] at times since then [s], (T, n + 1) as in `powers`."""
        return np.asarray(self.length * self.rule.integrate(self._x(time), self.powers))

    @property
    def trend(self) -> Floats:
        """Rates of change of the forces at the end [N/s] (c,); zero after a "release", where they are not smooth in time."""
        if self.rule.time_map == "release":
            return np.zeros(len(self.contacts))
        return np.asarray(self.force @ self.rule.end_slope / self.length)

    def keep(self) -> None:
        """Keep the motion at the nodes in memory until others of this thread take its place; the state and the losses at the end stay."""
        kept = _kept.stretches
        kept.append(weakref.ref(self))
        while len(kept) > _KEPT:
            oldest = kept.popleft()()
            if oldest is not None:
                _ = oldest.end, oldest.lost
                for name in ("motion", "powers", "force"):
                    oldest.__dict__.pop(name, None)

    def _x(self, time: Floats) -> Floats:
        """Return x at times since the start [s]."""
        return self.rule.unmap_time(np.asarray(time) / self.length)

    def resolved(self, tolerance: float, energy: float) -> bool:
        """Whether the stretch is solved with an error within a relative tolerance, for motions of about an energy [J].

        Two independent error measures: the roughness of the forces, and the balance of energy.
        """
        if not (self.solved and self.roughness**2 <= 0.1 * tolerance):
            return False
        if self.rubbed is not None and abs(self.rubbed.imbalance) > 0.06 * tolerance * energy:
            return False
        gain = self.motion.gain + sum(contact.work for contact in self.contacts)
        gain -= 0.0 if self.rubbed is None else self.rubbed.surface_work
        return bool(abs(gain + self.lost.sum()) <= 0.06 * tolerance * energy + self.motion.rounding)


def stretch_motions(
    systems: StackedSystems, basis: RadauEigenbasis, length: Floats, modes: tuple[Complex, Complex], force: Floats, static: Floats
) -> list[StretchMotion]:
    """Return the motion of the coordinates of B systems through stretches.

    Parameters
    ----------
    systems : StackedSystems
        The systems.
    basis : RadauEigenbasis
        Eigenbasis of the collocation rule.
    length : array, shape (B,)
        Lengths of the stretches [s].
    modes : tuple of two arrays, shape (B, m, H)
        Admittances of the modes, and their accelerations without contact forces.
    force, static : array, shape (B, c, N)
        Contact forces at the nodes, and their static parts [N].
    """
    rule, (admittance, responses), start, across = basis.rule, modes, systems.start, length[:, None]
    pushed = basis.to_eigenvectors(force)  # (B, c, H)
    parts = [pushed, basis.to_eigenvectors(static)] if systems.inside else [pushed]
    driven = sum(_modal_forces(systems.shapes[:, number], part) for number, part in enumerate(parts))
    accelerations = np.empty((*start.displacement.shape, len(rule.nodes)))
    accelerations[:, systems.mode_slice] = basis.to_nodes(responses - driven * admittance)
    load = np.array([view.system.load for view in systems.views])
    rigid = np.array([view.rigid_shapes for view in systems.views])
    accelerations[:, systems.rigid_slice] = load[:, systems.rigid_slice, None] - rigid.swapaxes(1, 2) @ force
    velocities = accelerations @ rule.integral.T
    velocities *= across[:, :, None]
    velocities += start.velocity[:, :, None]
    displacement = start.displacement + velocities @ rule.integral[-1] * across
    local, massless = start.local, np.zeros((*start.local.shape, len(rule.nodes)))
    if systems.massless:
        yielding = _modal_forces(systems.local_mobility, pushed) + (systems.rate * local)[:, :, None] * basis.constant
        massless = basis.to_nodes(-yielding / (1.0 + systems.rate[:, :, None] * (across * basis.values)[:, None]))
        local = local + massless @ rule.integral[-1] * across
    end = State(displacement, velocities[:, :, -1].copy(), local)
    frequency, damping, springs, mobility = (
        np.array([getattr(view.system, name) for view in systems.views]) for name in ("angular_frequency", "damping", "rate", "mobility")
    )
    lost = np.empty((len(force), accelerations.shape[1] + 1))
    lost[:, :-1] = damping * (velocities**2 @ rule.integral[-1]) * across
    lost[:, -1] = (massless**2 @ rule.integral[-1] / mobility).sum(axis=1) * length
    # as differences of squares, so that motion that the contact does not change causes no rounding error
    gain = 0.5 * (end.velocity - start.velocity) * (end.velocity + start.velocity)
    gain += (end.displacement - start.displacement) * (0.5 * frequency**2 * (end.displacement + start.displacement) - load)
    begun = 0.5 * (start.velocity**2 + (frequency * start.displacement) ** 2)
    if count := systems.views[0].system.driven:  # the energy of a driven coordinate is not counted, but the work of its drive
        shapes = np.array([view.system.shape[view.contacts, -count:] for view in systems.views])
        power = (shapes.swapaxes(1, 2) @ force) * velocities[:, -count:]
        lost[:, -1 - count : -1] = -(power @ rule.integral[-1]) * across
        gain[:, -count:] = begun[:, -count:] = 0.0
    in_springs = 0.5 * (end.local - start.local) * (end.local + start.local) * springs / mobility
    grown = (gain.sum(axis=1) + in_springs.sum(axis=1)).tolist()
    active_rigid = np.array([view.active_rigid for view in systems.views])
    rounding = (begun * np.where(frequency > 0.0, _ROUNDING, _RIGID_ROUNDING * active_rigid)).sum(axis=1).tolist()
    return [
        StretchMotion(accelerations[one].T, velocities[one].T, massless[one].T, end.take(one), grown[one], rounding[one], lost[one])
        for one in range(len(force))
    ]


def _modal_forces(shapes: Floats, forces: Complex) -> Complex:
    """Return the forces on modes of shapes (B or 1, c, m) by contact forces (B, c, H): (B, m, H)."""
    return np.asarray((shapes.swapaxes(1, 2) @ forces.view(np.float64)).view(np.complex128))
