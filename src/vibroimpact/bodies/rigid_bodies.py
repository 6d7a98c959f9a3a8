"""Rigid bodies: a ball, solid or not, and a fixed plate."""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.bodies.ball import HOLLOW, INERTIA_RATIOS, ball_volume
from vibroimpact.bodies.body import Body
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.quoting import quoted

# relative: by so much a moment of inertia may be rounded up beyond that of a thin shell
_ROUNDING = 1e-3


def rigid_sphere(
    radius: Array,
    material: Material,
    *,
    mass: Array | None = None,
    inertia: Array | str | None = None,
) -> Body:
    r"""Return a rigid sphere, which is compliant at its contact alone.

    It is a solid ball, unless its mass or its moment of inertia are given.

    Parameters
    ----------
    radius : float or array
        Radius [m], > 0.
    material : Material
        Its density gives the mass :math:`\tfrac43 \pi R^3 \rho`, unless that is given.
    mass : float or array, optional
        Mass [kg], > 0, of a ball that is hollow, filled, or of several materials.
    inertia : float, array or str, optional
        Moment of inertia about an axis through the centre [kg m^2], > 0 and at most :math:`\tfrac23
        m R^2`; or "solid", :math:`\tfrac25 m R^2`, or "hollow", :math:`\tfrac23 m R^2` of a thin
        shell. By default that of the `inertia_ratio` of an `Oblique`, which is that of a solid
        ball.

    Raises
    ------
    InputError
        If a value is impossible.

    Examples
    --------
    >>> from vibroimpact.materials import find_material
    >>> round(rigid_sphere(0.025, find_material("rock-paper")).mass, 11)
    0.09032078879
    >>> ball = rigid_sphere(
    ...     0.02, Material(1400.0, 2.5e9, 0.35), mass=2.7e-3, inertia="hollow"
    ... )  # a table tennis ball
    >>> ball.mass, round(ball.inertia / 1e-7, 3)
    (0.0027, 7.2)
    """
    if not isinstance(material, Material):
        raise InputError(
            f"material must be a Material, as vi.find_material(...) gives it, not {material!r}"
        )
    radius = _as_array(radius)
    if mass is None:
        mass = ball_volume(radius) * material.density
    mass = _as_array(mass)
    if inertia is not None:
        inertia = _inertia(inertia, mass, radius)
    return Body(mass=mass, contact_offset=radius, inertia=inertia)


def _as_array(value: Any) -> Any:
    """Return a list or tuple of numbers as an array, and anything else as it is."""
    if isinstance(value, (list, tuple)):
        return np.asarray(value, dtype=float)
    return value


def _inertia(inertia: Array | str, mass: Array, radius: Array) -> Array:
    """Return the moment of inertia of a ball [kg m^2] from its value or its name.

    Raises
    ------
    InputError
        If there is no such name, or no ball of this mass and radius has so large a moment of
        inertia.
    """
    unit = mass * (radius * radius)
    if isinstance(inertia, str):
        if inertia not in INERTIA_RATIOS:
            raise InputError(
                f"{quoted(inertia)} is not allowed; inertia must be a number in kg m^2, "
                '"solid" or "hollow"',
                "inertia",
            )
        return INERTIA_RATIOS[inertia] * unit
    moments = _as_array(inertia)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = np.asarray(moments) / unit
    largest = np.max(np.where(np.isfinite(ratios) & (unit > 0.0), ratios, 0.0))
    if largest > HOLLOW * (1.0 + _ROUNDING):
        raise InputError(
            f"it is {largest:.4g} times the mass and the squared radius, and no sphere has "
            "more than the 2/3 of a thin shell: give at most "
            f'{float(np.min(HOLLOW * unit)):.4g} kg m^2, or "hollow"',
            "inertia",
        )
    return moments


def rigid_plate(thickness: Array = 0.0) -> Body:
    """Return a rigid plate that is fixed.

    Parameters
    ----------
    thickness : float or array, default 0
        Thickness [m]; the contact lies half of it above the centre.

    Examples
    --------
    >>> rigid_plate(0.008).mass
    inf
    """
    return Body(mass=np.inf, contact_offset=0.5 * thickness)
