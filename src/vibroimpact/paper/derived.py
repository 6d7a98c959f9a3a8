"""Quantities that follow from printed values alone: the damping function, the mass of the
meshed sphere and its fall after touch.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.paper.printed import printed
from vibroimpact.paper.runs import IMPACTS

POWERS = np.arange(3)
"""Exponents of the approach speed in the damping function, in the order of its coefficients."""


def printed_dampings() -> Floats:
    """Return the printed damping of each impact [N s/m]."""
    return np.array([printed(f"damping.{impact}").value for impact in IMPACTS])


def printed_function(speeds: Floats) -> Floats:
    """Return the printed damping function at approach speeds [m/s], in N s/m.

    Examples
    --------
    >>> printed_function(np.array([8.82666])).round(3).tolist()
    [179.781]
    """
    return function_at(
        speeds, np.array([printed(f"damping_function.{power + 1}").value for power in POWERS])
    )


def parabola(speeds: Floats) -> Floats:
    """Return the least-squares parabola through the printed dampings: its coefficients, lowest
    power first [SI].

    Parameters
    ----------
    speeds : array
        Approach speeds of the five impacts along the last axis [m/s].
    """
    return np.asarray(np.linalg.pinv(speeds[..., None] ** POWERS) @ printed_dampings())


def function_at(speeds: Floats, coefficients: Floats) -> Floats:
    """Return the polynomial with coefficients along the last axis [SI] at approach speeds
    along the last axis [m/s], in N s/m.
    """
    return np.asarray(speeds[..., None] ** POWERS @ coefficients[..., None])[..., 0]


def mesh_mass(kind: int, gravity: float) -> tuple[float, float]:
    """Return the range of the mass of the meshed sphere [kg], from the printed largest force and
    acceleration.

    Force and acceleration peak together, m = F/(a + g); the range covers the rounding of both.

    Parameters
    ----------
    kind : int
        2 or 3.
    gravity : float
        Acceleration of gravity [m/s^2].

    Examples
    --------
    >>> [round(mass, 6) for mass in mesh_mass(3, 9.8)]
    [0.090305, 0.090305]
    """
    force = printed(f"type{kind}.max_force")
    acceleration = printed(f"type{kind}.max_acceleration")
    least = (force.value - force.half) / (acceleration.value + acceleration.half + gravity)
    most = (force.value + force.half) / (acceleration.value - acceleration.half + gravity)
    return least, most


def fall_beyond_touch(kind: int, gravity: float) -> float:
    """Return the fall of the sphere's centre after first touch [m] that the printed
    energies of Type 2 or 3 imply.
    """
    released = printed(f"type{kind}.potential_energy")
    touch = printed(f"type{kind}.energy_at_touch")
    return (released.value - touch.value) / (mesh_mass(kind, gravity)[0] * gravity)
