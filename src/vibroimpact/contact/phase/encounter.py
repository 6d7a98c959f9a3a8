"""The facts of one impact: what the contact of each drop knows of its bodies."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.phase.collocation import Floats
from vibroimpact.contact.static import free_depth


@dataclass(frozen=True)
class Encounter:
    """The facts of one impact of B drops: the law, the mass it moves, gravity, the approach speed.

    `depth`: the indentation that it would reach if its damping took nothing [m]. `floor`: the least there is
    in this contact [m], where the surfaces part.
    """

    law: CompliantLaw
    mass: Floats
    gravity: Floats
    approach_speed: Floats
    depth: Floats
    floor: Floats

    def take(self, drops: NDArray[np.intp]) -> Encounter:
        """Return the encounter of some of the drops."""
        if len(drops) == len(self.mass):
            return self
        arrays = (self.mass, self.gravity, self.approach_speed, self.depth, self.floor)
        return Encounter(self.law.take(drops), *(array[drops] for array in arrays))

    def under(self, law: CompliantLaw) -> Encounter:
        """Return the encounter with another law, or the same with other memories."""
        return self if law is self.law else replace(self, law=law, floor=law.release_level + np.zeros(len(self.mass)))

    @property
    def speed_scale(self) -> Floats:
        """The speed of the motion in contact [m/s]: that of the approach, or what gravity adds to a soft touch."""
        return np.asarray(np.sqrt(self.approach_speed**2 + self.gravity * (self.depth - self.law.touch_level)))

    def acceleration(self, delta: Floats, velocity: Floats) -> Floats:
        """Return the rate of the indentation rate [m/s^2], without any clip of the force."""
        static, dissipative = self.law.forces(delta, velocity, self.approach_speed)
        return np.asarray(self.gravity - (static + dissipative) / self.mass)


def encounter_of(law: CompliantLaw, mass: Floats, gravity: Floats, approach_speed: Floats) -> Encounter:
    """Return the encounter of B drops, with its depth from the energy that is put in."""
    depth = free_depth(law, 0.5 * mass * approach_speed**2, mass * gravity)
    return Encounter(law, mass, gravity, approach_speed, depth, law.release_level + np.zeros(len(mass)))
