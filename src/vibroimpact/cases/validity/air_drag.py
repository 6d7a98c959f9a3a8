r"""Air drag, which the computation of a fall neglects."""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit, of_slower_impact, percent_less
from vibroimpact.dynamics.core.fall import drag_coefficient
from vibroimpact.dynamics.fluids.air import AIR_DENSITY, AIR_VISCOSITY, check_thin
from vibroimpact.errors import InputError

# fixed-point iterations of speed and drag coefficient; each reduces the error of the speed by a
# factor of 20
_ROUNDS = 2


def drag_loss(
    radius: Array, density: Array, fall: Array, gravity: Array, longer: Array = 1.0
) -> Array:
    r"""Return the relative loss of speed by air drag of a sphere that falls from rest.

    With a constant drag coefficient the speed after a fall of height H is
    :math:`\sqrt{1 - e^{-2 k H}}\,\sqrt{g/k}`, with :math:`k = \tfrac12 \rho_a C_d \pi R^2 / m`. As
    the drag grows with the square of the speed, and so with the height fallen, the coefficient is
    evaluated after two thirds of the fall.

    Parameters
    ----------
    radius, density : float or array
        Radius [m] and density [kg/m^3] of the sphere.
    fall : float or array
        Height fallen [m].
    gravity : float or array
        Acceleration of gravity [m/s^2].
    longer : float or array, default 1
        What drag takes on the way of the sphere over what it takes in the fall from rest.
    """
    speed_in_vacuum = np.sqrt(2.0 * gravity * fall)
    ratio = 1.0  # of the speed in air to that in a vacuum
    for _ in range(_ROUNDS):
        reynolds = (
            AIR_DENSITY
            * math.sqrt(2.0 / 3.0)
            * speed_in_vacuum
            * ratio
            * 2.0
            * radius
            / AIR_VISCOSITY
        )
        exponent = (
            0.75 * AIR_DENSITY / density * drag_coefficient(reynolds) * longer * fall / radius
        )
        ratio = np.sqrt(-np.expm1(-exponent) / exponent)
    return 1.0 - ratio


def _number(drops: Conditions) -> Array:
    drop = drops.case["drop"]
    height = drop.get("height")
    if height is None:
        return math.nan
    if drop.get("air") is not None or drops.case["contact"].get("liquid") is not None:
        return math.nan
    gravity = drop["gravity"]
    slope = np.cos(drops.case["plate"].get("inclination") or 0.0)
    velocity = drop.get("velocity")
    if velocity is None:  # straight down
        return drag_loss(drops.radius, drops.density, (height - drops.radius) / slope, gravity)
    # along the normal: the top of a flight that is thrown up, or from which it would have the speed
    # that it is thrown down with, is higher; on the way from there drag takes energy with the
    # square of its length, up once more in the first case, and none in the second
    higher = 0.5 * velocity[2] ** 2 / (gravity * slope)
    fall = height - drops.radius + higher
    longer = 1.0 + np.sign(velocity[2]) * (higher / fall) ** 2
    return drag_loss(drops.radius, drops.density, fall, gravity * slope, longer)


def _sentence(drop: Conditions, loss: float) -> str:
    plate = drop.case["plate"]
    flight = drop.case["drop"]
    velocity = flight.get("velocity")
    is_inclined = plate.get("inclination") is not None
    if velocity is None:
        about = ""
    elif is_inclined or any(velocity[:2]):
        about = "at least "
    else:
        about = "about "
    remedy = f"give {_air_for(drop)}"
    if velocity is None and not is_inclined and plate.get("motion") is None:
        fall = flight["height"] - drop.radius
        speed = math.sqrt(2.0 * flight["gravity"] * fall) * (1.0 - loss)
        remedy += f", or drop.speed = {speed:.4g} in place of the height to begin with that speed"
    return (
        f"in air the first touch would be {about}{percent_less(loss).removeprefix('-')} "
        "slower than in the vacuum that this drop falls "
        f"through, and each rebound loses speed again; {remedy}"
    )


def _air_for(drop: Conditions) -> str:
    """Return the key that makes a sphere fall through air.

    Of a very light one air takes more than drag.
    """
    try:
        check_thin(AIR_DENSITY, drop.density)
    except InputError:
        return (
            f"contact.liquid = {{ density = {AIR_DENSITY:g}, viscosity = {AIR_VISCOSITY:g} }} "
            "with a law that takes a restitution"
        )
    return "drop.air = true"


LIMITS = (
    Limit(
        name="air_drag",
        title="air drag",
        meaning="part of the speed at first touch that the drag of air would take",
        threshold=0.01,
        number=_number,
        sentence=_sentence,
        effects=lambda _, loss: of_slower_impact(loss),
        shown=percent_less,
    ),
)
