"""Motion of a sphere that a shaken rigid plate carries for good, in its static indentation."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.contact_equilibrium import ContactEquilibrium
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, State
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion


@dataclass(frozen=True, eq=False)
class CarriedMotion(RestMotion):
    """A sphere that moves with a shaken rigid plate; its oscillation on the contact is written off.

    `work`: of the drive in the transition, in which the sphere takes on the velocity of the plate
    [J].
    """

    work: float

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        motion = FreeMotion(self.equilibrium.system, self.start)
        return _with_plate(self.equilibrium, motion.state(time))

    def force(self, time: Floats) -> Floats:
        """Return the contact force [N] at times since the start [s]."""
        system = self.equilibrium.system
        _, _, acceleration = system.driven_motion(self.state(time))
        return np.asarray(self.equilibrium.weight + system.mass[0] * acceleration)

    def stored(self, time: Floats) -> Floats:
        """Return the energy stored by the contact [J] at times since the start [s]."""
        return np.full_like(time, self.equilibrium.stored)

    def lost_by(self, time: Floats) -> Floats:
        """Return the energy lost since the start [J] at times (T,), (T, n + 1).

        It is minus the work of the drive, in the last coordinate.
        """
        system = self.equilibrium.system
        initial_energy = system.mechanical_energy(self.start)
        energy = system.mechanical_energy(self.state(time))
        lost = np.zeros((*np.shape(time), system.number + 1))
        lost[..., -2] = initial_energy - energy - self.work
        return lost


def carry(equilibrium: ContactEquilibrium, state: State, stored: float) -> CarriedMotion:
    """Return the motion of a sphere with the plate, from a state on.

    In that state the contact stores `stored` [J].
    """
    system = equilibrium.system
    start = _with_plate(equilibrium, state)
    # an impulse at the contact gives the sphere the velocity of the plate
    impulse = float(system.mass[0]) ** 0.5 * float(state.velocity[0] - start.velocity[0])
    _, plate_rate, _ = system.driven_motion(state)
    work = impulse * float(plate_rate)
    released = float(system.mechanical_energy(state) - system.mechanical_energy(start))
    written_off = released + stored - equilibrium.stored + work
    return CarriedMotion(equilibrium, start, np.nan, written_off, work)


def _with_plate(equilibrium: ContactEquilibrium, state: State) -> State:
    """Return states with the sphere in its static indentation, at the velocity of the plate."""
    system = equilibrium.system
    root_mass = float(system.mass[0]) ** 0.5
    plate_approach, plate_rate, _ = system.driven_motion(state)
    displacement = state.displacement.copy()
    velocity = state.velocity.copy()
    displacement[..., 0] = (equilibrium.approach - plate_approach) * root_mass
    velocity[..., 0] = -plate_rate * root_mass
    return replace(state, displacement=displacement, velocity=velocity)
