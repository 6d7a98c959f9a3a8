r"""Air drag, which the computation of a fall neglects."""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.conditions import Conditions
from vibroimpact.cases.limit import Limit, percent_less
from vibroimpact.dynamics.air import AIR_DENSITY, AIR_VISCOSITY
from vibroimpact.dynamics.core.fall import drag_coefficient

_ROUNDS = 2  # fixed-point iterations of speed and drag coefficient; each reduces the error of the speed by a factor of 20


def drag_loss(radius: Array, density: Array, fall: Array, gravity: Array) -> Array:
    r"""Return the relative loss of speed by air drag of a sphere that falls from rest.

    With a constant drag coefficient the speed after a fall of height H is
    :math:`\sqrt{1 - e^{-2 k H}}\,\sqrt{g/k}`, with :math:`k = \tfrac12 \rho_a C_d \pi R^2 / m`. As the drag grows with the square of
    the speed, and so with the height fallen, the coefficient is evaluated after two thirds of the fall.

    Parameters
    ----------
    radius, density : float or array
        Radius [m] and density [kg/m^3] of the sphere.
    fall : float or array
        Height fallen [m].
    gravity : float or array
        Acceleration of gravity [m/s^2].
    """
    speed = np.sqrt(2.0 * gravity * fall)
    part, exponent = 1.0, 0.0
    for _ in range(_ROUNDS):
        reynolds = AIR_DENSITY * math.sqrt(2.0 / 3.0) * speed * part * 2.0 * radius / AIR_VISCOSITY
        exponent = 0.75 * AIR_DENSITY / density * drag_coefficient(reynolds) * fall / radius
        part = np.sqrt(-np.expm1(-exponent) / exponent)
    return 1.0 - part


def _number(drops: Conditions) -> Array:
    height = drops.case["drop"].get("height")
    if height is None or drops.case["drop"].get("air") is not None or drops.case["contact"].get("liquid") is not None:
        return math.nan
    return drag_loss(drops.radius, drops.density, height - drops.radius, drops.case["drop"]["gravity"])


def _sentence(drop: Conditions, lost: float) -> str:
    fall = drop.case["drop"]["height"] - drop.radius
    speed = math.sqrt(2.0 * drop.case["drop"]["gravity"] * fall)
    return (
        f"in air the first touch would be {percent_less(lost).removeprefix('-')} slower than in the vacuum that this drop falls through, "
        f"and each rebound loses speed again; give drop.air = true, or drop.speed = {speed * (1.0 - lost):.4g} in "
        "place of the height to begin with that speed"
    )


LIMITS = (
    Limit(
        name="air_drag",
        title="air drag",
        meaning="part of the speed at first touch that the drag of air would take",
        threshold=0.01,
        number=_number,
        sentence=_sentence,
        shown=percent_less,
    ),
)
