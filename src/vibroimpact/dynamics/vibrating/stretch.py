"""A stretch of contact as it was solved on the nodes of Radau collocation: its motion, its forces, what it takes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Complex, Floats
from vibroimpact.dynamics.collocation import Rule
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.receptance import ContactView, RadauEigenbasis, StackedSystems

_RIGID_ROUNDING = 2e-15  # of the kinetic energy of the bodies that touch, which may move fast together
_ROUNDING = 2e-14  # of the energy of the modes, which may be much more than that of a soft touch


class StretchMotion(NamedTuple):
    """How the coordinates move through a stretch.

    `accelerations` and `velocities` of the coordinates (N, n), and rates of the massless elements, `massless` (N, k), at the nodes;
    `end`: the state there. `gain`: what the coordinates and the massless elements have more at the end, without contact laws, and
    `rounding`: what that may be wrong by [J]. `lost`: what the damping of each takes, and last the massless elements [J] (n + 1,).
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

    `seen`: the system, as the contacts that push see it. `length`: how long it lasts [s]. `start`: the state then. `contacts`: what
    those that push do. `solved`: whether Newton's method converged. `roughness`: the last Legendre coefficients of the forces, relative to
    the size that matters; the error at the end goes with its square.
    """

    view: ContactView
    basis: RadauEigenbasis
    length: float
    start: State
    contacts: tuple[ContactHistory, ...]
    solved: bool
    roughness: float

    @property
    def system(self) -> LinearSystem:
        """What moves."""
        return self.view.system

    @property
    def duration(self) -> Floats:
        """How long it lasts [s], as an array of one."""
        return np.array([self.length])

    def take(self, drops: Bools) -> VibratingStretch:
        """Return itself: it is of one drop."""
        return self

    @property
    def rule(self) -> Rule:
        """Nodes and time map."""
        return self.basis.rule

    @cached_property
    def force(self) -> Floats:
        """The forces at the nodes [N] (c, N)."""
        return np.stack([contact.force for contact in self.contacts])

    @cached_property
    def motion(self) -> StretchMotion:
        """The motion of the coordinates."""
        systems, length = StackedSystems([self.view], [self.start]), np.array([self.length])
        admittance = 1.0 / systems.impedance(length[:, None] * self.basis.values)
        responses = systems.drive(self.basis, length) * admittance
        static = np.array([[contact.static for contact in self.contacts]])
        return stretch_motions(systems, self.basis, length, (admittance, responses), self.force[None], static)[0]

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
        """The state at the end."""
        return self.motion.end

    def closing_rates(self, contact: int = 0) -> Floats:
        """Return the rate of the approach of the surfaces, coordinates inside the contact included, at the start and the nodes (N + 1,)."""
        rate, inner = self.contacts[contact].rate, self.system.inner_shape[self.view.contacts[contact]]
        if not self.view.modes.inside:
            return rate
        return np.asarray(rate + np.concatenate([self.start.velocity[None], self.velocities]) @ inner)

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (T,)."""
        start, h, across, load = self.start, self.length, np.asarray(time)[:, None], self.system.load
        integral = h * self.rule.integral_to(self._x(time))
        driven = self.accelerations - load  # whose share is in closed form
        return State(
            start.displacement + across * (start.velocity + 0.5 * across * load) + integral @ (h * (self.rule.integral @ driven)),
            start.velocity + across * load + integral @ driven,
            start.local + integral @ self.motion.massless,
        )

    def indentations(self, contact: int = 0) -> Floats:
        """Return how far the centre above has come to the surface below at a contact [m], at the start and the nodes (N + 1,)."""
        number = self.contacts[contact].number
        shape = self.system.indentation_shape[number]
        begun = float(self.system.offset[number] + self.start.displacement @ shape)
        return np.append(begun, begun + self.length * (self.rule.integral @ (self.velocities @ shape)))

    @cached_property
    def powers(self) -> Floats:
        """What is lost at the nodes [W], (N, n + 1), for histories: in each coordinate; last, in the laws and the massless elements."""
        system = self.system
        in_laws = sum(contact.power for contact in self.contacts)
        lost = in_laws + (self.motion.massless**2 / system.mobility).sum(axis=1)
        return np.concatenate([system.damping * self.velocities**2, lost[:, None]], axis=1)

    @cached_property
    def lost(self) -> Floats:
        """What is lost over the stretch, with what is at its end [J], (n + 1,) as in `powers`."""
        lost = self.motion.lost.copy()
        lost[-1] += sum(contact.dissipated + contact.separation_loss for contact in self.contacts)
        return lost

    def lost_by(self, time: Floats) -> Floats:
        """Return what is lost since the start [J] at times since then [s], (T, n + 1) as in `powers`."""
        return np.asarray(self.length * self.rule.integrate(self._x(time), self.powers))

    @property
    def trend(self) -> Floats:
        """How fast the forces change at the end [N/s] (c,), where they are smooth in time there; else zero."""
        if self.rule.time_map == "release":
            return np.zeros(len(self.contacts))
        return np.asarray(self.force @ self.rule.end_slope / self.length)

    def clear_cache(self) -> None:
        """Let go of the motion of the coordinates at the nodes, which is found again when it is asked for; what is at the end is kept."""
        if "motion" in self.__dict__:
            _ = self.end, self.lost
        for name in ("motion", "powers", "force"):
            self.__dict__.pop(name, None)

    def _x(self, time: Floats) -> Floats:
        return self.rule.unmap_time(np.asarray(time) / self.length)

    def resolved(self, tolerance: float, energy: float) -> bool:
        """Is it solved, and its error within a relative tolerance, for motions of about an energy [J]?

        Two measures that know nothing of each other: the roughness of the forces, and the balance of energy.
        """
        if not (self.solved and self.roughness**2 <= 0.1 * tolerance):
            return False
        gain = self.motion.gain + sum(contact.work for contact in self.contacts)
        return bool(abs(gain + self.lost.sum()) <= 0.06 * tolerance * energy + self.motion.rounding)


def stretch_motions(
    systems: StackedSystems, basis: RadauEigenbasis, length: Floats, modes: tuple[Complex, Complex], force: Floats, static: Floats
) -> list[StretchMotion]:
    """Return how the coordinates of B systems move through stretches.

    Parameters
    ----------
    systems : Together
        The systems.
    at : Spectrum
        The rule of the stretches.
    length : array, shape (B,)
        How long they last [s].
    modes : tuple of two arrays, shape (B, m, H)
        Admittances of the modes, and what becomes of their motion at the start without contact forces.
    force, static : array, shape (B, c, N)
        The contact forces at the nodes, and their static part [N].
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
    # by differences, so that what goes on beside the contacts, however fast, does not count
    gain = 0.5 * (end.velocity - start.velocity) * (end.velocity + start.velocity)
    gain += (end.displacement - start.displacement) * (0.5 * frequency**2 * (end.displacement + start.displacement) - load)
    in_springs = 0.5 * (end.local - start.local) * (end.local + start.local) * springs / mobility
    grown = (gain.sum(axis=1) + in_springs.sum(axis=1)).tolist()
    begun, active_rigid = (
        0.5 * (start.velocity**2 + (frequency * start.displacement) ** 2),
        np.array([view.active_rigid for view in systems.views]),
    )
    rounding = (begun * np.where(frequency > 0.0, _ROUNDING, _RIGID_ROUNDING * active_rigid)).sum(axis=1).tolist()
    return [
        StretchMotion(accelerations[one].T, velocities[one].T, massless[one].T, end.take(one), grown[one], rounding[one], lost[one])
        for one in range(len(force))
    ]


def _modal_forces(shapes: Floats, forces: Complex) -> Complex:
    """Return what forces at contacts (B, c, H) do to modes of shapes (B or 1, c, m), (B, m, H)."""
    return np.asarray((shapes.swapaxes(1, 2) @ forces.view(np.float64)).view(np.complex128))
