"""A stretch of contact of bodies that vibrate, as it was solved on the nodes of Radau collocation: its motion, its force, what it takes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats, Rule
from vibroimpact.dynamics.local import LocalContact
from vibroimpact.dynamics.oscillators import State
from vibroimpact.dynamics.receptance import Spectrum, Surroundings, impedance_of, own_drive

_ROUNDING = 2e-14  # of the energy of the oscillators, which may be much more than that of a soft touch


@dataclass(frozen=True)
class VibratingStretch:
    """A solved stretch of one drop.

    `length`: how long it lasts [s]. `start`: the state then. `static`, `dissipative`: parts of the force at the nodes [N].
    `approach`, `rate`: of the surfaces [m], and what the dashpot of the law feels [m/s], at its start and at the nodes
    (N + 1,). `delta`: the law's own indentation there [m]. `solved`: whether Newton's method converged. `broken`: what is lost at
    its end, as a sticking contact breaks [J].
    """

    around: Surroundings
    local: LocalContact
    spectrum: Spectrum
    length: float
    start: State
    static: Floats
    dissipative: Floats
    approach: Floats
    rate: Floats
    delta: Floats
    solved: bool
    broken: float = 0.0

    @property
    def force(self) -> Floats:
        """The force at the nodes [N]."""
        return self.static + self.dissipative

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
    def accelerations(self) -> tuple[Floats, Floats]:
        """Accelerations of the oscillators (N, n), and rates of the massless elements (N, k), at the nodes."""
        of, at, sigma = self.around.oscillators, self.spectrum, self.length * self.spectrum.values
        force, static = ((at.inverse @ part)[:, None] for part in (self.force, self.static))
        drive = own_drive(of, at, self.length, self.start) - of.outer * force - (of.shape - of.outer) * static
        oscillators = at.vectors @ (drive / impedance_of(of, sigma))
        massless = -of.mobility * force - at.constant[:, None] * (of.rate * self.start.local)
        return np.asarray(oscillators.real), np.asarray((at.vectors @ (massless / (1.0 + of.rate * sigma[:, None]))).real)

    @cached_property
    def velocities(self) -> Floats:
        """Velocities of the oscillators at the nodes (N, n)."""
        return np.asarray(self.start.velocity + self.length * (self.rule.integral @ self.accelerations[0]))

    @property
    def closing(self) -> Floats:
        """Rate of the approach of the surfaces, the oscillators inside the contact included, at the start and the nodes (N + 1,)."""
        of = self.around.oscillators
        if not of.inside.any():
            return self.rate
        return self.rate + np.concatenate([self.start.velocity[None], self.velocities]) @ (of.shape - of.outer)

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (T,)."""
        start, h, across, gravity = self.start, self.length, np.asarray(time), self.around.gravity
        integral, (accelerations, massless) = h * self.rule.integral_to(self._x(time)), self.accelerations
        pull = -self.force / self.around.mass
        return State(
            start.approach + across * (start.speed + 0.5 * gravity * across) + integral @ (h * (self.rule.integral @ pull)),
            start.speed + gravity * across + integral @ pull,
            start.displacement + integral @ self.velocities,
            start.velocity + integral @ accelerations,
            start.local + integral @ massless,
        )

    @cached_property
    def end(self) -> State:
        """The state at the end."""
        start, h, last = self.start, self.length, self.rule.integral[-1]
        gained, (_, massless) = self.rule.integral @ self.force, self.accelerations
        gravity, mass = self.around.gravity, self.around.mass
        return State(
            start.approach + h * (start.speed + 0.5 * gravity * h) - h * h * (last @ gained) / mass,
            start.speed + gravity * h - h * gained[-1] / mass,
            start.displacement + h * (last @ self.velocities),
            self.velocities[-1],
            start.local + h * (last @ massless),
        )

    def law_force_at(self, x: Floats) -> Floats:
        """Return the force that the law gives [N] at x in [0, 1], before any clip."""
        weights = self.rule.weights(np.asarray(x, dtype=float)).T
        static, dissipative = self.local.own_forces(weights @ self.delta, weights @ self.rate)
        return np.asarray(static + dissipative)

    def force_at(self, x: Floats) -> Floats:
        """Return the contact force, clipped where the law may not pull [N], at x in [0, 1]."""
        force = self.law_force_at(x)
        return force if self.local.law.tension == "kept" else np.maximum(force, 0.0)

    def indentation_at(self, x: Floats) -> Floats:
        """Return the approach of the sphere's centre to the surface of the body below [m] at x in [0, 1]."""
        return np.asarray(self.rule.weights(np.asarray(x, dtype=float)).T @ self._indentations)

    @cached_property
    def _indentations(self) -> Floats:
        """The same at the start and at the nodes, (N + 1,)."""
        of, start, h, rule = self.around.oscillators, self.start, self.length, self.rule
        velocity = start.speed - h / self.around.mass * (rule.integral @ self.force) + self.velocities @ of.below
        gravity = 0.5 * self.around.gravity * (h * rule.time) ** 2
        begun = float(of.indentation(start))
        return np.append(begun, begun + h * (rule.integral @ velocity) + gravity)

    @cached_property
    def powers(self) -> Floats:
        """What is lost at the nodes [W], (N, n + 1): in each oscillator; last, in the law and the massless elements."""
        of = self.around.oscillators
        contact = self.dissipative * self.rate[1:] + (self.accelerations[1] ** 2 / of.mobility).sum(axis=1)
        return np.concatenate([of.damping * self.velocities**2, contact[:, None]], axis=1)

    @cached_property
    def lost(self) -> Floats:
        """What is lost over the stretch, with what is at its end [J], (n + 1,) as in `powers`."""
        lost = self.length * (self.rule.integral[-1] @ self.powers)
        lost[-1] += self.broken
        return np.asarray(lost)

    def lost_by(self, time: Floats) -> Floats:
        """Return what is lost since the start [J] at times since then [s], (T, n + 1) as in `powers`."""
        return np.asarray(self.length * self.rule.integrate(self._x(time), self.powers))

    def forget(self) -> None:
        """Let go of the motion of the oscillators at the nodes, which is found again when it is asked for."""
        for name in ("accelerations", "velocities", "powers", "_indentations"):
            self.__dict__.pop(name, None)

    def _x(self, time: Floats) -> Floats:
        return self.rule.unmap_time(np.asarray(time) / self.length)

    @property
    def roughness(self) -> float:
        """The last Legendre coefficients of the force, beside what matters: with the square of it the error at the end goes."""
        force = self.around.mass * np.abs(self.rate).max() / self.length
        return float(self.rule.tail(self.force[:, None], np.array([force]))[0])

    def resolved(self, tolerance: float, speed: float) -> bool:
        """Is it solved, and its error within a relative tolerance, for motions of about a speed [m/s]?

        Two measures that know nothing of each other: the roughness of the force, and the balance of energy.
        """
        if not (self.solved and self.roughness**2 <= 0.1 * tolerance):
            return False
        lost = float(self.lost.sum())
        begun, done = self.local.own_work(self.delta[[0, -1]])
        gain = mechanical_energy(self.around, self.end) + done - mechanical_energy(self.around, self.start) - begun
        rounding = _ROUNDING * float(sum(part.sum() for part in self.around.oscillators.energies(self.start)))
        return bool(abs(gain + lost) <= 0.03 * tolerance * self.around.mass * speed**2 + rounding)


def mechanical_energy(around: Surroundings, state: State) -> float:
    """Return kinetic, potential and strain energy [J] of a state, without what the contact law holds."""
    of = around.oscillators
    sphere = around.mass * (0.5 * state.speed**2 - around.gravity * state.approach)
    return float(sphere + sum(part.sum() for part in of.energies(state)) + of.local_energy(state))
