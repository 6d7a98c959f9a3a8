"""A stretch of contact as it was solved on the nodes of Radau collocation: its motion, its forces, what it takes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats, Rule
from vibroimpact.dynamics.contact_history import ContactHistory
from vibroimpact.dynamics.linear_system import LinearSystem, State
from vibroimpact.dynamics.receptance import Complex, Seen, Spectrum, Together

_RIGID_ROUNDING = 2e-15  # of the kinetic energy of the bodies that touch, which may move fast together
_ROUNDING = 2e-14  # of the energy of the modes, which may be much more than that of a soft touch


class Motion(NamedTuple):
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
    those that push do. `solved`: whether Newton's method converged. `roughness`: the last Legendre coefficients of the forces, beside what
    matters: with the square of it the error at the end goes.
    """

    seen: Seen
    spectrum: Spectrum
    length: float
    start: State
    contacts: tuple[ContactHistory, ...]
    solved: bool
    roughness: float

    @property
    def system(self) -> LinearSystem:
        """What moves."""
        return self.seen.system

    @property
    def duration(self) -> Floats:
        """How long it lasts [s], as an array of one."""
        return np.array([self.length])

    def take(self, drops: NDArray[np.bool_]) -> VibratingStretch:
        """Return itself: it is of one drop."""
        return self

    @property
    def rule(self) -> Rule:
        """Nodes and time map."""
        return self.spectrum.rule

    @cached_property
    def force(self) -> Floats:
        """The forces at the nodes [N] (c, N)."""
        return np.stack([contact.force for contact in self.contacts])

    @cached_property
    def motion(self) -> Motion:
        """The motion of the coordinates."""
        systems, length = Together([self.seen], [self.start]), np.array([self.length])
        admittance = 1.0 / systems.of.impedance(length[:, None] * self.spectrum.values)
        responses = systems.of.drive(self.spectrum, length, systems.displacement, systems.velocity) * admittance
        static = np.array([[contact.static for contact in self.contacts]])
        return motions_of(systems, self.spectrum, length, (admittance, responses), self.force[None], static)[0]

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

    def closing(self, contact: int = 0) -> Floats:
        """Return the rate of the approach of the surfaces, coordinates inside the contact included, at the start and the nodes (N + 1,)."""
        rate, inner = self.contacts[contact].rate, self.system.inner[self.seen.contacts[contact]]
        if not self.seen.of.inside:
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
        shape = self.system.of_bodies[number]
        begun = float(self.system.offset[number] + self.start.displacement @ shape)
        return np.append(begun, begun + self.length * (self.rule.integral @ (self.velocities @ shape)))

    @cached_property
    def powers(self) -> Floats:
        """What is lost at the nodes [W], (N, n + 1): in each coordinate; last, in the laws and the massless elements."""
        of = self.system
        in_laws = sum(contact.power for contact in self.contacts)
        lost = in_laws + (self.motion.massless**2 / of.mobility).sum(axis=1)
        return np.concatenate([of.damping * self.velocities**2, lost[:, None]], axis=1)

    @cached_property
    def lost(self) -> Floats:
        """What is lost over the stretch, with what is at its end [J], (n + 1,) as in `powers`."""
        lost = self.motion.lost.copy()
        lost[-1] += sum(contact.dissipated + contact.broken for contact in self.contacts)
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

    def forget(self) -> None:
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


def motions_of(
    systems: Together, at: Spectrum, length: Floats, modes: tuple[Complex, Complex], force: Floats, static: Floats
) -> list[Motion]:
    """Return how the coordinates of B systems move through stretches.

    Parameters
    ----------
    systems : Together
        The systems.
    at : Spectrum
        The rule of the stretches.
    length : array, shape (B,)
        How long they last [s].
    modes : tuple of two arrays, shape (m, B, H)
        Admittances of the modes, and what becomes of their motion at the start without contact forces.
    force, static : array, shape (B, c, N)
        The contact forces at the nodes, and their static part [N].
    """
    of, rule, (admittance, responses), start = systems.of, at.rule, modes, systems.start
    pushed = at.to_eigenvectors(force).swapaxes(0, 1).copy()  # (c, B, H)
    driven = of.summed(of.outer, pushed)
    if of.inside:
        driven += of.summed(of.inner, at.to_eigenvectors(static).swapaxes(0, 1).copy())
    driven *= admittance
    accelerations = np.empty((start.displacement.shape[1], *force.shape[::2]))
    accelerations[of.modes] = at.to_nodes(responses - driven)
    for number, seen in enumerate(systems.seen):
        accelerations[of.rigid, number] = seen.system.load[of.rigid, None] - seen.rigid.T @ force[number]
    across = length[:, None]
    in_rows = (-1, len(rule.nodes))  # one product of all is quicker
    velocities = (accelerations.reshape(in_rows) @ rule.integral.T).reshape(accelerations.shape)
    velocities *= across
    velocities += start.velocity.T[:, :, None]
    moved = (velocities.reshape(in_rows) @ rule.integral[-1]).reshape(velocities.shape[:2])
    displacement = start.displacement + moved.T * across
    local, massless = start.local, np.zeros((len(of.rate), *force.shape[::2]))
    if len(of.rate):
        yielding = of.summed(of.local_mobility, pushed) + (of.rate * local.T)[:, :, None] * at.constant
        massless = at.to_nodes(-yielding / (1.0 + of.rate[:, :, None] * (across * at.values)))
        local = local + (massless @ rule.integral[-1]).T * across
    velocity, system = velocities[:, :, -1].T.copy(), systems.seen[0].system
    gain, rounding = _balances(systems, State(displacement, velocity, local))
    lost = np.empty((len(force), len(accelerations) + 1))
    lost[:, :-1] = system.damping * (velocities.reshape(in_rows) ** 2 @ rule.integral[-1]).reshape(velocities.shape[:2]).T * across
    lost[:, -1] = (massless**2 @ rule.integral[-1]).T @ (1.0 / system.mobility) * length
    ends = zip(displacement, velocity, local, strict=True)
    return [
        Motion(
            accelerations[:, number].T,
            velocities[:, number].T,
            massless[:, number].T,
            State(*end),
            float(gain[number]),
            float(rounding[number]),
            lost[number],
        )
        for number, end in enumerate(ends)
    ]


def _balances(systems: Together, end: State) -> tuple[Floats, Floats]:
    """Return by how much energy grows from the start to an end, without that of contact laws, and what rounding may make of it [J] (B,)."""
    start, system = systems.start, systems.seen[0].system
    # by differences, so that what goes on beside the contacts, however fast, does not count
    gain = 0.5 * (end.velocity - start.velocity) * (end.velocity + start.velocity)
    strains = 0.5 * system.angular_frequency**2 * (end.displacement + start.displacement)
    gain += (end.displacement - start.displacement) * (strains - np.array([seen.system.load for seen in systems.seen]))
    springs = 0.5 * (end.local - start.local) * (end.local + start.local) @ (system.rate / system.mobility)
    begun, touched = np.add(*system.energies(start)), np.array([seen.touched for seen in systems.seen])
    rounding = _ROUNDING * begun @ system.vibrating + _RIGID_ROUNDING * (begun * touched).sum(axis=1)
    return gain.sum(axis=1) + springs, rounding
