r"""The drag of air on a sphere."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array

AIR_DENSITY, AIR_VISCOSITY = 1.2, 1.81e-5
"""Density [kg/m^3] and viscosity [Pa s] of air at 20 C and sea level."""

_STILL = 1e-30  # m/s, for a speed of zero, at which Stokes' drag is none


def drag_coefficient(reynolds: Array) -> Array:
    r"""Return the drag coefficient of a smooth sphere at a Reynolds number.

    .. math:: C_d = \frac{24}{Re}\left(1 + 0.15\,Re^{0.687}\right) + \frac{0.42}{1 + 42500\,Re^{-1.16}}

    Within 6 % of measurements up to a Reynolds number of 3e5.

    References
    ----------
    Clift, R. and Gauvin, W. H. (1970). The motion of particles in turbulent gas streams. Proc. Chemeca '70, 1, 14-28.

    Examples
    --------
    >>> round(float(drag_coefficient(1e4)), 2)
    0.42
    """
    return 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687) + 0.42 / (1.0 + 42500.0 * reynolds**-1.16)


def drag(speed: Array, radius: Array, density: Array) -> Array:
    r"""Return by how much air slows a sphere down [m/s^2], :math:`\tfrac38 (\rho_a / \rho) C_d v^2 / R`.

    Parameters
    ----------
    speed : float or array
        Through air that is at rest [m/s], >= 0.
    radius, density : float or array
        Of the sphere [m], [kg/m^3].

    Examples
    --------
    >>> round(float(drag(8.8, 0.025, 1380.0)), 3)
    0.478
    """
    fast = np.maximum(speed, _STILL)
    reynolds = AIR_DENSITY * fast * 2.0 * radius / AIR_VISCOSITY
    return 0.375 * AIR_DENSITY / density * drag_coefficient(reynolds) * fast**2 / radius
