r"""How many modes a reduction keeps, before they are computed.

Below a frequency they follow from Weyl's law and its next term. With the wave number :math:`k_T` of
shear waves and :math:`s = c_T^2 / c_L^2`, a free ball of volume V and surface S has about

.. math::

    \frac{V k_T^3}{6 \pi^2} (2 + s^{3/2}) + \frac{S k_T^2}{16 \pi} \frac{3 - 3 s + 2 s^2}{1 - s} - 6

modes, without its rigid motions (M. Dupuis, R. Mazo and L. Onsager, J. Chem. Phys. 33:1452, 1960).
A plate of area A has those of its bending waves, of wave number k, and of its waves in the plane,
:math:`A (k^2 + k_T^2 + k_P^2) / 4 \pi`; its edges, of lengths :math:`l_i`, add :math:`k \sum c_i
l_i / 4 \pi` (E. Bogomolny and E. Hugues, Phys. Rev. E 57:5404, 1998), and waves across its
thickness the term of its volume. Of a thin plate the first part is :math:`\tfrac12 A f \sqrt{\rho h
/ D}`.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.materials import Material
from vibroimpact.structures.plate_waves import wave_numbers
from vibroimpact.structures.recipe import (
    PlateOfPlates,
    PlateOfSolids,
    Recipe,
    SphereOfSolids,
    is_thin,
)
from vibroimpact.structures.supports.edge import EDGES, Edge

_OF_ANY_SHAPE = 100
"""Number of modes below a frequency of a body with an imported mesh: a guess."""

OF_AN_EDGE = {"free": 1.713, "simply-supported": -1.0, "clamped": -1.763}
"""Coefficients of the edges; that of free ones for a Poisson's ratio of 0.3."""


def modes_expected(recipe: Recipe) -> float:
    """Return the number of modes of a recipe, estimated if it gives their highest frequency.

    Of plate elements that are thicker than half a wavelength it is an upper bound: they do not have
    all waves across the thickness.

    Examples
    --------
    >>> from vibroimpact.structures.recipe import Reduction
    >>> steel = 7850.0, 210e9, 0.3
    >>> round(
    ...     modes_expected(
    ...         Recipe(SphereOfSolids(0.025), *steel, reduction=Reduction(max_frequency=150e3))
    ...     )
    ... )
    98
    """
    max_frequency = recipe.reduction.max_frequency
    if max_frequency is None:
        return recipe.reduction.modes or 0
    omega = 2.0 * math.pi * max_frequency
    if isinstance(recipe.shape, SphereOfSolids):
        return _modes_of_sphere(recipe, recipe.shape.radius, omega)
    if isinstance(recipe.shape, (PlateOfPlates, PlateOfSolids)):
        return _modes_of_plate(recipe, recipe.shape.size, omega)
    return _OF_ANY_SHAPE


def _modes_of_sphere(recipe: Recipe, radius: float, omega: float) -> float:
    """Return the number of elastic modes of a free sphere below an angular frequency [rad/s]."""
    shear = _shear_wave_number(recipe, omega)
    speed_ratio = _squared_speed_ratio(recipe)
    modes_per_area = (
        shear**2
        * (3.0 - 3.0 * speed_ratio + 2.0 * speed_ratio**2)
        / (16.0 * math.pi * (1.0 - speed_ratio))
    )
    surface = 4.0 * math.pi * radius**2
    # the volume is the surface times a third of the radius
    return max(
        0.0, surface * (radius / 3.0 * modes_per_volume(recipe, omega) + modes_per_area) - 6.0
    )


def _modes_of_plate(recipe: Recipe, size: tuple[float, float, float], omega: float) -> float:
    """Return the number of modes of a plate below an angular frequency [rad/s]."""
    length, width, thickness = size
    ratio = recipe.poissons_ratio
    material = Material(recipe.density, recipe.youngs_modulus, ratio)
    bending = float(wave_numbers(np.array(omega), thickness, material, is_thin(recipe)))
    shear = _shear_wave_number(recipe, omega)
    conditions = {
        support.edge: support.condition for support in recipe.supports if isinstance(support, Edge)
    }
    of_edges = []
    for edge in EDGES:
        side = width if edge[0] == "x" else length
        of_edges.append(OF_AN_EDGE[conditions.get(edge, "free")] * side)
    edge_sum = sum(of_edges)
    area = length * width
    # Weyl's count of waves in the plane: area k^2/4 pi of bending, shear and longitudinal waves,
    # of which k_P^2 = (1 - nu)/2 k_T^2, and edges times k/4 pi of bending
    squares = bending**2 + shear**2 * (1.0 + 0.5 * (1.0 - ratio))
    waves = area * squares + edge_sum * bending
    return max(0.0, waves / (4.0 * math.pi) + area * thickness * modes_per_volume(recipe, omega))


def modes_per_volume(recipe: Recipe, omega: float) -> float:
    """Return Weyl's number of modes per volume below an angular frequency [1/m^3].

    It is proportional to the cube of the frequency.
    """
    speed_ratio = _squared_speed_ratio(recipe)
    shear = _shear_wave_number(recipe, omega)
    return shear**3 * (2.0 + speed_ratio * math.sqrt(speed_ratio)) / (6.0 * math.pi**2)


def _shear_wave_number(recipe: Recipe, omega: float) -> float:
    """Return the wave number k_T of shear waves [1/m]."""
    ratio = recipe.poissons_ratio
    return omega * math.sqrt(2.0 * (1.0 + ratio) * recipe.density / recipe.youngs_modulus)


def _squared_speed_ratio(recipe: Recipe) -> float:
    """Return s, the squared ratio of the speeds of shear and pressure waves [-]."""
    ratio = recipe.poissons_ratio
    return 0.5 * (1.0 - 2.0 * ratio) / (1.0 - ratio)
