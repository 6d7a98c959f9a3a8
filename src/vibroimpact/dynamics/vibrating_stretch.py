"""A stretch of contact as it was solved on the nodes of Radau collocation: its motion, its forces, what it takes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats, Rule
from vibroimpact.dynamics.contact_history import ContactHistory
from vibroimpact.dynamics.linear_system import LinearSystem, State
from vibroimpact.dynamics.receptance import Seen, Spectrum, impedance_of, own_drive

_RIGID_ROUNDING = 2e-15  # of the kinetic energy of the bodies that touch, which may move fast together
_ROUNDING = 2e-14  # of the energy of the modes, which may be much more than that of a soft touch


@dataclass(frozen=True)
class VibratingStretch:
    """A solved stretch of one system.

    `seen`: the system, as the contacts that push see it. `length`: how long it lasts [s]. `start`: the state then. `contacts`: what
    those that push do. `solved`: whether Newton's method converged.
    """

    seen: Seen
    spectrum: Spectrum
    length: float
    start: State
    contacts: tuple[ContactHistory, ...]
    solved: bool

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
    def accelerations(self) -> tuple[Floats, Floats]:
        """Accelerations of the coordinates (N, n), and rates of the massless elements (N, k), at the nodes."""
        seen, at, sigma = self.seen, self.spectrum, self.length * self.spectrum.values
        of, force, static = seen.system, self.force.T, np.stack([contact.static for contact in self.contacts]).T
        found = of.load - force @ seen.whole_outer  # of rigid motions
        pushed = at.inverse @ force
        if len(seen.outer):
            drive = own_drive(seen, at, self.length, self.start) - pushed @ seen.outer.T - (at.inverse @ static) @ seen.inner.T
            found[:, seen.modes] = (at.vectors @ (drive / impedance_of(seen, sigma))).real
        if not seen.local:
            return found, np.zeros((len(sigma), 0))
        massless = -pushed @ seen.local_mobility.T - at.constant[:, None] * (of.rate * self.start.local)
        return found, np.asarray((at.vectors @ (massless / (1.0 + of.rate * sigma[:, None]))).real)

    @cached_property
    def velocities(self) -> Floats:
        """Velocities of the coordinates at the nodes (N, n)."""
        return np.asarray(self.start.velocity + self.length * (self.rule.integral @ self.accelerations[0]))

    def closing(self, contact: int = 0) -> Floats:
        """Return the rate of the approach of the surfaces, coordinates inside the contact included, at the start and the nodes (N + 1,)."""
        rate, inner = self.contacts[contact].rate, self.seen.whole_inner[contact]
        if not inner.any():
            return rate
        return np.asarray(rate + np.concatenate([self.start.velocity[None], self.velocities]) @ inner)

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (T,)."""
        start, h, across, load = self.start, self.length, np.asarray(time)[:, None], self.system.load
        integral, (accelerations, massless) = h * self.rule.integral_to(self._x(time)), self.accelerations
        driven = accelerations - load  # whose share is in closed form
        return State(
            start.displacement + across * (start.velocity + 0.5 * across * load) + integral @ (h * (self.rule.integral @ driven)),
            start.velocity + across * load + integral @ driven,
            start.local + integral @ massless,
        )

    @cached_property
    def end(self) -> State:
        """The state at the end."""
        start, h, last = self.start, self.length, self.rule.integral[-1]
        return State(
            start.displacement + h * (last @ self.velocities), self.velocities[-1], start.local + h * (last @ self.accelerations[1])
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
        in_laws = sum(contact.dissipative * contact.rate[1:] for contact in self.contacts)
        lost = in_laws + (self.accelerations[1] ** 2 / of.mobility).sum(axis=1)
        return np.concatenate([of.damping * self.velocities**2, lost[:, None]], axis=1)

    @cached_property
    def lost(self) -> Floats:
        """What is lost over the stretch, with what is at its end [J], (n + 1,) as in `powers`."""
        lost = self.length * (self.rule.integral[-1] @ self.powers)
        lost[-1] += sum(contact.broken for contact in self.contacts)
        return np.asarray(lost)

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
        """Let go of the motion of the coordinates at the nodes, which is found again when it is asked for."""
        for name in ("accelerations", "velocities", "powers", "force"):
            self.__dict__.pop(name, None)

    def _x(self, time: Floats) -> Floats:
        return self.rule.unmap_time(np.asarray(time) / self.length)

    @property
    def roughness(self) -> float:
        """The last Legendre coefficients of the forces, beside what matters: with the square of it the error at the end goes."""
        rates = np.array([np.abs(contact.rate).max() for contact in self.contacts])
        return float(self.rule.tail(self.force.T, self.system.mass[self.seen.contacts] * rates / self.length).max())

    def resolved(self, tolerance: float, energy: float) -> bool:
        """Is it solved, and its error within a relative tolerance, for motions of about an energy [J]?

        Two measures that know nothing of each other: the roughness of the forces, and the balance of energy.
        """
        if not (self.solved and self.roughness**2 <= 0.1 * tolerance):
            return False
        of, start, end = self.system, self.start, self.end
        # by differences, so that what goes on beside the contacts, however fast, does not count
        gain = 0.5 * (end.velocity - start.velocity) @ (end.velocity + start.velocity) - (end.displacement - start.displacement) @ of.load
        strains = of.angular_frequency**2 * (end.displacement - start.displacement)
        gain += 0.5 * strains @ (end.displacement + start.displacement) + of.local_energy(end) - of.local_energy(start)
        gain += sum(contact.work for contact in self.contacts)
        of_all = np.add(*of.energies(start))
        rounding = _ROUNDING * float(of_all[of.vibrating].sum()) + _RIGID_ROUNDING * float(of_all[self.seen.rigid].sum())
        return bool(abs(gain + self.lost.sum()) <= 0.06 * tolerance * energy + rounding)
