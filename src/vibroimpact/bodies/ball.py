"""Balls: their volume, mean density, and moment of inertia."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array

SOLID = 0.4
"""Moment of inertia of a homogeneous ball over mass and square of the radius [-]."""

HOLLOW = 2.0 / 3.0
"""Moment of inertia of a thin spherical shell over mass and square of the radius [-].

No ball has more.
"""

INERTIA_RATIOS = {"solid": SOLID, "hollow": HOLLOW}
"""Moments of inertia that have a name, over mass and square of the radius [-]."""


def ball_volume(radius: Array) -> Array:
    """Return the volume of a ball of a radius [m] [m^3].

    Examples
    --------
    >>> round(ball_volume(0.02) / 1e-6, 2)
    33.51
    """
    return 4.0 / 3.0 * np.pi * radius**3


def mean_density(mass: Array, radius: Array) -> Array:
    """Return the mass of a ball [kg] over its volume [kg/m^3], from its radius [m].

    If it is solid, that is the density of its material.

    Examples
    --------
    >>> round(float(mean_density(2.7e-3, 0.02)), 2)  # a table tennis ball
    80.57
    """
    return mass / ball_volume(np.asarray(radius))
