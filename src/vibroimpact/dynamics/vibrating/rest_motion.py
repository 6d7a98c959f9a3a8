"""Small oscillations of a sphere at rest and the bodies that carry it, about their equilibrium."""

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
        _, mode_shapes = self.equilibrium.modes
        displacement, velocity = self.equilibrium.deviation(self.start)
        return np.stack([mode_shapes.T @ displacement, mode_shapes.T @ velocity])

    @property
    def oscillations(self) -> FreeOscillations:
        """The motion as that of independent oscillators."""
        _, mode_shapes = self.equilibrium.modes
        return FreeOscillations(
            self.coupled, self.start_coupled, np.stack([mode_shapes, np.zeros_like(mode_shapes)])
        )

    def coupled_state(self, time: Floats) -> Floats:
        """Return displacements and velocities of the coupled modes at times [s], (2, ..., n).

        Times are since the start.
        """
        transition = self.coupled.transition(time)
        displacement, velocity = self.start_coupled
        return np.asarray(transition[:, 0] * displacement + transition[:, 1] * velocity)

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        equilibrium = self.equilibrium
        _, mode_shapes = equilibrium.modes
        deviation, velocity = self.coupled_state(time) @ mode_shapes.T
        force = equilibrium.weight + equilibrium.stiffness * (deviation @ equilibrium.shape)
        # the massless elements follow the force quasi-statically
        return State(
            equilibrium.state.displacement + deviation,
            velocity,
            -force[..., None] * equilibrium.system.local_compliance,
        )

    def force(self, time: Floats) -> Floats:
        """Return the contact force [N] at times since the start [s].

        It follows from the acceleration of the sphere.
        """
        coupled = self.coupled
        displacement, velocity = self.coupled_state(time)
        _, mode_shapes = self.equilibrium.modes
        # minus the accelerations of the coupled modes
        restoring = coupled.damping * velocity + coupled.angular_frequency**2 * displacement
        return np.asarray(
            self.equilibrium.weight
            + np.sqrt(self.equilibrium.system.mass[0]) * (restoring @ mode_shapes[0])
        )

    def stored(self, time: Floats) -> Floats:
        """Return the energy stored by the contact [J] at times since the start [s].

        It is that without the massless elements.
        """
        equilibrium = self.equilibrium
        _, mode_shapes = equilibrium.modes
        displacement, _ = self.coupled_state(time)
        force = equilibrium.stiffness * (displacement @ (mode_shapes.T @ equilibrium.shape))
        indentation = force / equilibrium.contact[0]  # both beyond those at equilibrium
        return np.asarray(equilibrium.stored + (equilibrium.weight + 0.5 * force) * indentation)

    def lost_by(self, time: Floats) -> Floats:
        """Return the energy lost since the start [J] at times (T,), (T, n + 1).

        It is given for each coordinate, and last for the contact.
        """
        stiffness = self.coupled.angular_frequency**2
        _, distribution = self._coupled

        def energies(coupled_state: Floats) -> Floats:
            displacement, velocity = coupled_state
            return np.asarray(0.5 * (velocity**2 + stiffness * displacement**2))

        lost_by_modes = energies(self.start_coupled) - energies(self.coupled_state(time))
        return np.asarray(lost_by_modes @ distribution)


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
    system = equilibrium.system
    shape = equilibrium.shape
    displacement, velocity = equilibrium.deviation(state)
    approach = displacement @ shape  # beyond that at equilibrium
    excess = equilibrium.excess(state, stored)
    never_given_back = (1.0 - equilibrium.share) * stored
    # displacement of the sphere alone, per unit approach
    sphere_alone = system.rigid / system.rigid_shape[0].sum()
    if equilibrium.linear and equilibrium.cannot_separate(state):
        in_coordinates = float((velocity**2 + (system.angular_frequency * displacement) ** 2).sum())
        in_spring = excess - 0.5 * in_coordinates
        spring_approach = np.copysign(
            np.sqrt(2.0 * max(in_spring, 0.0) / equilibrium.stiffness), approach
        )
        start = replace(
            state, displacement=state.displacement + sphere_alone * (spring_approach - approach)
        )
        return RestMotion(equilibrium, start, excess, never_given_back)
    # the impulse after which the rate of the approach is zero
    velocity -= shape * (velocity @ shape) / (shape @ shape)
    start = State(state.displacement - sphere_alone * approach, velocity, equilibrium.state.local)
    excess_at_start = equilibrium.excess(start, equilibrium.stored / equilibrium.share)
    return RestMotion(
        equilibrium, start, excess_at_start, never_given_back + excess - excess_at_start
    )
