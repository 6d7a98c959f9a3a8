"""The facts of one impact: what the contact of each drop knows of its bodies."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.static import static_indentation, undamped_depth


@dataclass(frozen=True)
class Encounter:
    """The facts of one impact of B drops: the law, the mass it moves, gravity, the approach speed.

    `depth`: the indentation that it would reach if its damping took nothing [m]. `speed_scale`: the speed of
    the motion in contact [m/s]: that of the approach, or what gravity and adhesion add to a soft touch. `floor`: the
    least indentation there is in this contact [m], where the surfaces part.
    """

    law: CompliantLaw
    mass: Floats
    gravity: Floats
    approach_speed: Floats
    depth: Floats
    speed_scale: Floats
    floor: Floats

    def take(self, drops: Indices) -> Encounter:
        """Return the encounter of some of the drops, in rising order."""
        return self if len(drops) == len(self.mass) else self.pick(drops)

    def pick(self, drops: Indices) -> Encounter:
        """Return the encounter of some drops in any order."""
        arrays = (self.mass, self.gravity, self.approach_speed, self.depth, self.speed_scale, self.floor)
        return Encounter(self.law.take(drops), *(array[drops] for array in arrays))

    def under(self, law: CompliantLaw) -> Encounter:
        """Return the encounter with another law, or the same with other memories."""
        return self if law is self.law else replace(self, law=law, floor=law.release_level + np.zeros(len(self.mass)))

    def acceleration(self, delta: Floats, velocity: Floats) -> Floats:
        """Return the rate of the indentation rate [m/s^2], without any clip of the force."""
        static, dissipative = self.law.forces(delta, velocity, self.approach_speed)
        return np.asarray(self.gravity - (static + dissipative) / self.mass)


def encounter_of(law: CompliantLaw, mass: Floats, gravity: Floats, approach_speed: Floats) -> Encounter:
    """Return the encounter of B drops, with its depth from the energy that is put in."""
    weight = mass * gravity
    depth = undamped_depth(law, 0.5 * mass * approach_speed**2, weight)
    squared = approach_speed**2 + gravity * (depth - law.touch_level)
    if law.contact_end == "pull-off":
        squared = squared - 2.0 * law.elastic_energy(static_indentation(law, weight)) / mass  # which is negative
    return Encounter(law, mass, gravity, approach_speed, depth, np.sqrt(squared), law.release_level + np.zeros(len(mass)))
