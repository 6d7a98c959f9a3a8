"""Motion after a sphere has come to rest on bodies that vibrate: small oscillations of
all about their equilibrium under its weight.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.contact_equilibrium import (
    ContactEquilibrium,
    coupled_oscillators,
)
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.oscillators import Oscillators


@dataclass(frozen=True)
class FreeOscillations:
    """A motion about an equilibrium as that of independent oscillators in free motion.

    `start`: their displacements q and velocities q' at its start, (2, n). `shapes`: the coordinates
    of the system are displaced from the equilibrium by the sums of a q + b q', with a and b as (2,
    coordinates, n).
    """

    oscillators: Oscillators
    start: Floats
    shapes: Floats


@dataclass(frozen=True, eq=False)
class RestMotion:
    """Small oscillations of a sphere and the bodies that carry it, from the instant of rest on.

    `equilibrium`: their equilibrium and modes. `start`: state at that instant. `excess`: energy
    above the equilibrium then [J]. `written_off`: energy that the transition to rest took [J].
    """

    equilibrium: ContactEquilibrium
    start: State
    excess: float
    written_off: float

    @cached_property
    def _coupled(self) -> tuple[Oscillators, Floats]:
        """Coupled modes, and the distribution of their losses."""
        return coupled_oscillators(self.equilibrium)

    @property
    def coupled(self) -> Oscillators:
        """Coupled modes of sphere and bodies as independent oscillators."""
        return self._coupled[0]

    @cached_property
    def start_coupled(self) -> Floats:
        """Displacements and velocities of the coupled modes at the start, (2, n)."""
        return np.stack(
            [self.equilibrium.modes[1].T @ part for part in self.equilibrium.deviation(self.start)]
        )

    @property
    def oscillations(self) -> FreeOscillations:
        """The motion as that of independent oscillators."""
        shapes = self.equilibrium.modes[1]
        return FreeOscillations(
            self.coupled, self.start_coupled, np.stack([shapes, np.zeros_like(shapes)])
        )

    def coupled_state(self, time: Floats) -> Floats:
        """Return displacements and velocities of the coupled modes at times since the
        start [s], (2, ..., n).
        """
        later = self.coupled.transition(time)
        return np.asarray(later[:, 0] * self.start_coupled[0] + later[:, 1] * self.start_coupled[1])

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        equilibrium, at = self.equilibrium, self.equilibrium.state
        place, speed = self.coupled_state(time) @ equilibrium.modes[1].T
        force = equilibrium.weight + equilibrium.stiffness * (place @ equilibrium.shape)
        return State(
            at.displacement + place, speed, -force[..., None] * equilibrium.system.local_compliance
        )

    def force(self, time: Floats) -> Floats:
        """Return the contact force [N] at times since the start [s], from the
        acceleration of the sphere.
        """
        (place, speed), coupled = self.coupled_state(time), self.coupled
        restoring = coupled.damping * speed + coupled.angular_frequency**2 * place
        return np.asarray(
            self.equilibrium.weight
            + np.sqrt(self.equilibrium.system.mass[0]) * (restoring @ self.equilibrium.modes[1][0])
        )

    def stored(self, time: Floats) -> Floats:
        """Return the energy stored by the contact [J] at times since the start [s],
        without the massless elements.
        """
        equilibrium = self.equilibrium
        excess = equilibrium.stiffness * (
            self.coupled_state(time)[0] @ (equilibrium.modes[1].T @ equilibrium.shape)
        )
        deeper = excess / equilibrium.contact[0]
        return np.asarray(equilibrium.stored + (equilibrium.weight + 0.5 * excess) * deeper)

    def lost_by(self, time: Floats) -> Floats:
        """Return the energy lost since the start [J] at times (T,), (T, n + 1): in each
        coordinate, and last in the contact.
        """
        stiffness = self.coupled.angular_frequency**2

        def energies(moved: Floats) -> Floats:
            return np.asarray(0.5 * (moved[1] ** 2 + stiffness * moved[0] ** 2))

        return np.asarray(
            (energies(self.start_coupled) - energies(self.coupled_state(time))) @ self._coupled[1]
        )


def bring_to_rest(equilibrium: ContactEquilibrium, state: State, stored: float) -> RestMotion:
    """Return the small oscillations that replace the contact of a sphere at rest.

    If the bound of the force excludes separation, the motion goes on with a linear spring: the
    sphere is placed where that spring stores the energy of the contact and the massless elements.
    Otherwise the sphere is placed into its static indentation at the current position of the
    surface, and moves together with it as after a perfectly plastic impact. Neither adds energy:
    that indentation is the one of least energy, and the impulse after which both move together
    loses the most.

    Parameters
    ----------
    equilibrium : ContactEquilibrium
        The equilibrium.
    state : State
        Current state.
    stored : float
        Energy stored by the contact [J].
    """
    system, shape, at = equilibrium.system, equilibrium.shape, equilibrium.state
    (place, speed), held = equilibrium.deviation(state), equilibrium.excess(state, stored)
    never = (1.0 - equilibrium.share) * stored
    # displacement of the sphere alone, per unit approach
    alone = system.rigid / system.rigid_shape[0].sum()
    if equilibrium.linear and equilibrium.cannot_separate(state):
        on_spring = held - 0.5 * float((speed**2 + (system.angular_frequency * place) ** 2).sum())
        deeper = np.copysign(
            np.sqrt(2.0 * max(on_spring, 0.0) / equilibrium.stiffness), place @ shape
        )
        return RestMotion(
            equilibrium,
            replace(state, displacement=state.displacement + alone * (deeper - place @ shape)),
            held,
            never,
        )
    speed -= shape * (speed @ shape) / (shape @ shape)
    start = State(state.displacement - alone * (place @ shape), speed, at.local)
    excess = equilibrium.excess(start, equilibrium.stored / equilibrium.share)
    return RestMotion(equilibrium, start, excess, never + held - excess)
