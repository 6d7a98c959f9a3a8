"""The data of one impact: contact law, masses, gravity and approach speed of each drop."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.compiled import law_addresses
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.core.depths import write_undamped_depths
from vibroimpact.dynamics.motion.law_coefficients import coefficients_of


@dataclass(frozen=True)
class ImpactConditions:
    """Law, effective mass [kg], gravity [m/s^2] and approach speed [m/s] of one impact of B drops.

    `depth`: largest indentation without damping [m]. `speed_scale`: scale of the speed in contact
    [m/s]: the approach speed, or that due to gravity and adhesion in a soft touch. `floor`: the
    indentation at separation [m].
    """

    law: CompliantLaw
    mass: Floats
    gravity: Floats
    approach_speed: Floats
    depth: Floats
    speed_scale: Floats
    floor: Floats

    def pick(self, drops: Indices) -> ImpactConditions:
        """Return the conditions of some drops in any order."""
        arrays = (
            self.mass,
            self.gravity,
            self.approach_speed,
            self.depth,
            self.speed_scale,
            self.floor,
        )
        return ImpactConditions(self.law.take(drops), *(array[drops] for array in arrays))

    def under(self, law: CompliantLaw) -> ImpactConditions:
        """Return the conditions with another law, or with the same law and another memory."""
        if law is self.law:
            return self
        return replace(self, law=law, floor=law.release_level + np.zeros(len(self.mass)))


def impact_conditions_of(
    law: CompliantLaw, mass: Floats, gravity: Floats, approach_speed: Floats
) -> ImpactConditions:
    """Return the conditions of B drops, with the undamped depth from the balance of energy."""
    weight = mass * gravity
    depth = undamped_depths(law, 0.5 * mass * approach_speed**2, weight)
    squared = approach_speed**2 + gravity * (depth - law.touch_level)
    if law.contact_end == "pull-off":
        # negative: the energy of adhesion
        squared = squared - 2.0 * law.elastic_energy(static_indentation(law, weight)) / mass
    return ImpactConditions(
        law,
        mass,
        gravity,
        approach_speed,
        depth,
        np.sqrt(squared),
        law.release_level + np.zeros(len(mass)),
    )


def undamped_depths(law: CompliantLaw, energy: Floats, weight: Floats) -> Floats:
    """Return the largest indentations of B impacts without damping [m], to a relative 1e-3.

    Each is as it is without the others.

    Parameters
    ----------
    law : CompliantLaw
        The law.
    energy : array, shape (B,)
        Kinetic energies at touch [J], > 0.
    weight : array, shape (B,)
        Constant forces in the direction of the indentation [N], whose work adds to the energy.
    """
    size = len(energy)
    depths = np.empty(size)
    with coefficients_of(law, size) as coefficients:
        write_undamped_depths(
            law_addresses(type(law)),
            coefficients,
            law.touch_level + np.zeros(size),
            energy,
            weight,
            depths,
        )
    return depths
