"""A sphere that has come to rest on what vibrates: both go on as one, about their equilibrium under its weight."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.dynamics.vibrating.riding import Riding, coupled_oscillators


@dataclass(frozen=True, eq=False)
class Lying:
    """The small oscillations of a sphere and what carries it, from where it was laid down on.

    `riding`: their equilibrium and modes. `start`: the state then. `left`: what they hold above their equilibrium then [J].
    `written_off`: what laying it down took [J].
    """

    riding: Riding
    start: State
    left: float
    written_off: float

    @cached_property
    def _coupled(self) -> tuple[Oscillators, Floats]:
        return coupled_oscillators(self.riding)

    @property
    def coupled(self) -> Oscillators:
        """Sphere and modes as oscillators that go on apart from each other."""
        return self._coupled[0]

    @cached_property
    def begun(self) -> Floats:
        """Displacements and velocities of these at the start, (2, n)."""
        return np.stack([self.riding.modes[1].T @ part for part in self.riding.deviation(self.start)])

    def together(self, time: Floats) -> Floats:
        """Return displacements and velocities of these at times since the sphere was laid down [s], (2, ..., n)."""
        later = self.coupled.transition(time)
        return np.asarray(later[:, 0] * self.begun[0] + later[:, 1] * self.begun[1])

    def state(self, time: Floats) -> State:
        """Return the state at times since the sphere was laid down [s] (...)."""
        riding, at = self.riding, self.riding.equilibrium
        place, speed = self.together(time) @ riding.modes[1].T
        force = riding.weight + riding.stiffness * (place @ riding.pull)
        return State(at.displacement + place, speed, -force[..., None] * riding.system.local_compliance)

    def force(self, time: Floats) -> Floats:
        """Return the force of the contact [N] at times since then [s]: what the motion of the sphere takes."""
        (place, speed), of = self.together(time), self.coupled
        pull = of.damping * speed + of.angular_frequency**2 * place
        return np.asarray(self.riding.weight + np.sqrt(self.riding.system.mass[0]) * (pull @ self.riding.modes[1][0]))

    def stored(self, time: Floats) -> Floats:
        """Return what the contact holds [J] at times since then [s], without the massless elements."""
        riding = self.riding
        excess = riding.stiffness * (self.together(time)[0] @ (riding.modes[1].T @ riding.pull))
        deeper = excess / riding.contact[0]
        return np.asarray(riding.stored + (riding.weight + 0.5 * excess) * deeper)

    def lost_by(self, time: Floats) -> Floats:
        """Return what is lost since then [J] at times (T,), (T, n + 1): in each coordinate; last, in the contact."""
        stiffness = self.coupled.angular_frequency**2

        def energies(moved: Floats) -> Floats:
            return np.asarray(0.5 * (moved[1] ** 2 + stiffness * moved[0] ** 2))

        return np.asarray((energies(self.begun) - energies(self.together(time))) @ self._coupled[1])


def lay_down(riding: Riding, state: State, stored: float) -> Lying:
    """Take a sphere that is at rest from the contact as it is to small oscillations.

    Where the force hardly varies, it goes on as it moves, on a linear spring: it is put where that holds what the contact and the massless
    elements do. Else it is laid into its static indentation where the surface is now, and moves with it as after a perfectly plastic
    impact. Neither makes energy: that indentation is the one of the least energy, and the impulse that makes both move together
    is the one that loses the most.

    Parameters
    ----------
    riding : Riding
        The equilibrium.
    state : State
        Where everything is.
    stored : float
        What the contact holds [J].
    """
    of, pull, at = riding.system, riding.pull, riding.equilibrium
    (place, speed), held = riding.deviation(state), riding.excess(state, stored)
    never = (1.0 - riding.share) * stored
    alone = of.rigid / of.of_rigid[0].sum()  # what moves the sphere alone
    if riding.linear and riding.stays(state):
        on_spring = held - 0.5 * float((speed**2 + (of.angular_frequency * place) ** 2).sum())
        deeper = np.copysign(np.sqrt(2.0 * max(on_spring, 0.0) / riding.stiffness), place @ pull)
        return Lying(riding, replace(state, displacement=state.displacement + alone * (deeper - place @ pull)), held, never)
    speed -= pull * (speed @ pull) / (pull @ pull)
    start = State(state.displacement - alone * (place @ pull), speed, at.local)
    left = riding.excess(start, riding.stored / riding.share)
    return Lying(riding, start, left, never + held - left)
