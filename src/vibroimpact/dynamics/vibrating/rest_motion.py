"""A sphere that has come to rest on what vibrates: both go on as one, about their equilibrium under its weight."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.contact_equilibrium import ContactEquilibrium, coupled_oscillators
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.oscillators import Oscillators


@dataclass(frozen=True, eq=False)
class RestMotion:
    """The small oscillations of a sphere and what carries it, from where it was laid down on.

    `riding`: their equilibrium and modes. `start`: the state then. `left`: what they hold above their equilibrium then [J].
    `written_off`: what laying it down took [J].
    """

    equilibrium: ContactEquilibrium
    start: State
    excess: float
    written_off: float

    @cached_property
    def _coupled(self) -> tuple[Oscillators, Floats]:
        return coupled_oscillators(self.equilibrium)

    @property
    def coupled(self) -> Oscillators:
        """Sphere and modes as oscillators that go on apart from each other."""
        return self._coupled[0]

    @cached_property
    def start_coupled(self) -> Floats:
        """Displacements and velocities of these at the start, (2, n)."""
        return np.stack([self.equilibrium.modes[1].T @ part for part in self.equilibrium.deviation(self.start)])

    def coupled_state(self, time: Floats) -> Floats:
        """Return displacements and velocities of these at times since the sphere was laid down [s], (2, ..., n)."""
        later = self.coupled.transition(time)
        return np.asarray(later[:, 0] * self.start_coupled[0] + later[:, 1] * self.start_coupled[1])

    def state(self, time: Floats) -> State:
        """Return the state at times since the sphere was laid down [s] (...)."""
        equilibrium, at = self.equilibrium, self.equilibrium.state
        place, speed = self.coupled_state(time) @ equilibrium.modes[1].T
        force = equilibrium.weight + equilibrium.stiffness * (place @ equilibrium.shape)
        return State(at.displacement + place, speed, -force[..., None] * equilibrium.system.local_compliance)

    def force(self, time: Floats) -> Floats:
        """Return the force of the contact [N] at times since then [s]: what the motion of the sphere takes."""
        (place, speed), coupled = self.coupled_state(time), self.coupled
        restoring = coupled.damping * speed + coupled.angular_frequency**2 * place
        return np.asarray(self.equilibrium.weight + np.sqrt(self.equilibrium.system.mass[0]) * (restoring @ self.equilibrium.modes[1][0]))

    def stored(self, time: Floats) -> Floats:
        """Return what the contact holds [J] at times since then [s], without the massless elements."""
        equilibrium = self.equilibrium
        excess = equilibrium.stiffness * (self.coupled_state(time)[0] @ (equilibrium.modes[1].T @ equilibrium.shape))
        deeper = excess / equilibrium.contact[0]
        return np.asarray(equilibrium.stored + (equilibrium.weight + 0.5 * excess) * deeper)

    def lost_by(self, time: Floats) -> Floats:
        """Return what is lost since then [J] at times (T,), (T, n + 1): in each coordinate; last, in the contact."""
        stiffness = self.coupled.angular_frequency**2

        def energies(moved: Floats) -> Floats:
            return np.asarray(0.5 * (moved[1] ** 2 + stiffness * moved[0] ** 2))

        return np.asarray((energies(self.start_coupled) - energies(self.coupled_state(time))) @ self._coupled[1])


def bring_to_rest(equilibrium: ContactEquilibrium, state: State, stored: float) -> RestMotion:
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
    system, shape, at = equilibrium.system, equilibrium.shape, equilibrium.state
    (place, speed), held = equilibrium.deviation(state), equilibrium.excess(state, stored)
    never = (1.0 - equilibrium.share) * stored
    alone = system.rigid / system.rigid_shape[0].sum()  # what moves the sphere alone
    if equilibrium.linear and equilibrium.cannot_separate(state):
        on_spring = held - 0.5 * float((speed**2 + (system.angular_frequency * place) ** 2).sum())
        deeper = np.copysign(np.sqrt(2.0 * max(on_spring, 0.0) / equilibrium.stiffness), place @ shape)
        return RestMotion(equilibrium, replace(state, displacement=state.displacement + alone * (deeper - place @ shape)), held, never)
    speed -= shape * (speed @ shape) / (shape @ shape)
    start = State(state.displacement - alone * (place @ shape), speed, at.local)
    excess = equilibrium.excess(start, equilibrium.stored / equilibrium.share)
    return RestMotion(equilibrium, start, excess, never + held - excess)
