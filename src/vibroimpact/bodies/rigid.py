"""Rigid bodies: a solid sphere, and a fixed plate."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.bodies.body import Body
from vibroimpact.errors import InputError
from vibroimpact.materials import Material


def rigid_sphere(radius: Array, material: Material) -> Body:
    r"""Return a solid sphere whose only compliance is that of its contact.

    Parameters
    ----------
    radius : float or array
        Radius [m], > 0.
    material : Material
        Its density gives the mass :math:`\tfrac43 \pi R^3 \rho`.

    Examples
    --------
    >>> from vibroimpact.materials import find_material
    >>> round(rigid_sphere(0.025, find_material("rock-paper")).mass, 11)
    0.09032078879
    """
    if not isinstance(material, Material):
        raise InputError(f"material must be a Material, as vi.find_material(...) gives it, not {material!r}")
    if isinstance(radius, (list, tuple)):
        radius = np.asarray(radius, dtype=float)
    return Body(mass=4.0 / 3.0 * np.pi * radius**3 * material.density, contact_offset=radius)


def rigid_plate(thickness: Array = 0.0) -> Body:
    """Return a fixed plate that does not deform.

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
