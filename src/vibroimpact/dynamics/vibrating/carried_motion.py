"""Motion of a sphere that a shaken plate carries for good: with the plate, in its static
indentation.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.contact_equilibrium import ContactEquilibrium
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, State
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion


@dataclass(frozen=True, eq=False)
class CarriedMotion(RestMotion):
    """A sphere that moves with a rigid plate that is shaken; its own oscillation on the contact is
    written off.

    `work`: of the drive in the transition, in which the sphere takes on the velocity of the plate
    [J].
    """

    work: float

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        return _with_plate(
            self.equilibrium, FreeMotion(self.equilibrium.system, self.start).state(time)
        )

    def force(self, time: Floats) -> Floats:
        """Return the contact force [N] at times since the start [s]."""
        system = self.equilibrium.system
        return np.asarray(
            self.equilibrium.weight + system.mass[0] * system.driven_motion(self.state(time))[2]
        )

    def stored(self, time: Floats) -> Floats:
        """Return the energy stored by the contact [J] at times since the start [s]."""
        return np.full_like(time, self.equilibrium.stored)

    def lost_by(self, time: Floats) -> Floats:
        """Return minus the work of the drive since the start [J] at times (T,), as that
        of the last coordinate, (T, n + 1).
        """
        system, state = self.equilibrium.system, self.state(time)
        lost = np.zeros((*np.shape(time), system.number + 1))
        lost[..., -2] = (
            system.mechanical_energy(self.start) - system.mechanical_energy(state) - self.work
        )
        return lost


def carry(equilibrium: ContactEquilibrium, state: State, stored: float) -> CarriedMotion:
    """Return the motion of a sphere with the plate from a state on in which the contact
    stores some energy [J].
    """
    system = equilibrium.system
    start = _with_plate(equilibrium, state)
    # an impulse at the contact gives the sphere the velocity of the plate
    gained = float(system.mass[0]) ** 0.5 * float(state.velocity[0] - start.velocity[0])
    work = gained * float(system.driven_motion(state)[1])
    written_off = (
        float(system.mechanical_energy(state) - system.mechanical_energy(start))
        + stored
        - equilibrium.stored
        + work
    )
    return CarriedMotion(equilibrium, start, np.nan, written_off, work)


def _with_plate(equilibrium: ContactEquilibrium, state: State) -> State:
    """Return states with the sphere in its static indentation in the plate, at the
    velocity of the plate.
    """
    system = equilibrium.system
    place, speed, _ = system.driven_motion(state)
    displacement, velocity = state.displacement.copy(), state.velocity.copy()
    displacement[..., 0], velocity[..., 0] = (
        part * float(system.mass[0]) ** 0.5 for part in (equilibrium.approach - place, -speed)
    )
    return replace(state, displacement=displacement, velocity=velocity)
