"""The facts of one impact: what the contact of each drop knows of its bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.phase.collocation import Floats


@dataclass(frozen=True)
class Encounter:
    """The facts of one impact of B drops: the law, the mass it moves, gravity, the approach speed.

    `depth`: the indentation that it would reach if nothing were lost [m].
    """

    law: CompliantLaw
    mass: Floats
    gravity: Floats
    approach_speed: Floats
    depth: Floats

    def take(self, drops: NDArray[np.intp]) -> Encounter:
        """Return the encounter of some of the drops."""
        if len(drops) == len(self.mass):
            return self
        return Encounter(self.law.take(drops), self.mass[drops], self.gravity[drops], self.approach_speed[drops], self.depth[drops])

    @property
    def speed_scale(self) -> Floats:
        """The speed of the motion in contact [m/s]: that of the approach, or what gravity adds to a soft touch."""
        return np.sqrt(self.approach_speed**2 + self.gravity * self.depth)

    def acceleration(self, delta: Floats, velocity: Floats) -> Floats:
        """Return the rate of the indentation rate [m/s^2], without any clip of the force."""
        elastic, dissipative = self.law.forces(delta, velocity, self.approach_speed)
        return np.asarray(self.gravity - (elastic + dissipative) / self.mass)


def encounter_of(law: CompliantLaw, mass: Floats, gravity: Floats, approach_speed: Floats) -> Encounter:
    """Return the encounter of B drops, with its depth from the energy that is put in."""
    energy, weight = 0.5 * mass * approach_speed**2, mass * gravity
    depth = np.full(len(mass), 1e-6)
    with np.errstate(all="ignore"):
        for _ in range(40):  # for a power law exact in one step, but for gravity's part
            stored = law.elastic_energy(depth)
            elastic, _dissipative = law.forces(depth, np.zeros_like(depth), approach_speed)
            step = ((energy + weight * depth) / stored) ** (stored / (elastic * depth))
            depth = depth * step
            if np.all(np.abs(step - 1.0) < 1e-3):
                break
    return Encounter(law, mass, gravity, approach_speed, depth)
