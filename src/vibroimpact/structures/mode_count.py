r"""How many modes a reduction keeps, told before they are computed: below a frequency by Weyl's law
and its next term.

With the wave number :math:`k_T` of shear waves and :math:`s = c_T^2 / c_L^2`, a free ball of volume
V and surface S has about

.. math::

    \frac{V k_T^3}{6 \pi^2} (2 + s^{3/2}) + \frac{S k_T^2}{16 \pi} \frac{3 - 3 s + 2 s^2}{1 - s} - 6

modes, without its rigid motions (M. Dupuis, R. Mazo and L. Onsager, J. Chem. Phys. 33:1452, 1960).
A plate of area A has those of its
bending waves, of wave number k, and of its waves in the plane, :math:`A (k^2 + k_T^2 + k_P^2) / 4
\pi`; its edges, of lengths
:math:`l_i`, add :math:`k \sum c_i l_i / 4 \pi` (E. Bogomolny and E. Hugues, Phys. Rev. E 57:5404,
1998), and waves across its thickness
the term of its volume. Of a thin plate the first part is :math:`\tfrac12 A f \sqrt{\rho h / D}`.
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
    if recipe.reduction.max_frequency is None:
        return recipe.reduction.modes or 0
    omega, ratio, shape = (
        2.0 * math.pi * recipe.reduction.max_frequency,
        recipe.poissons_ratio,
        recipe.shape,
    )
    shear = omega * math.sqrt(2.0 * (1.0 + ratio) * recipe.density / recipe.youngs_modulus)
    slowness = 0.5 * (1.0 - 2.0 * ratio) / (1.0 - ratio)
    of_volume = shear**3 * (2.0 + slowness * math.sqrt(slowness)) / (6.0 * math.pi**2)
    if isinstance(shape, SphereOfSolids):
        of_surface = (
            shear**2
            * (3.0 - 3.0 * slowness + 2.0 * slowness**2)
            / (16.0 * math.pi * (1.0 - slowness))
        )
        return max(
            0.0,
            4.0 * math.pi * shape.radius**2 * (shape.radius / 3.0 * of_volume + of_surface) - 6.0,
        )
    if isinstance(shape, (PlateOfPlates, PlateOfSolids)):
        length, width, thickness = shape.size
        material = Material(recipe.density, recipe.youngs_modulus, ratio)
        bending = float(wave_numbers(np.array(omega), thickness, material, is_thin(recipe)))
        held = {
            support.edge: support.condition
            for support in recipe.supports
            if isinstance(support, Edge)
        }
        edges = sum(
            OF_AN_EDGE[held.get(edge, "free")] * (width if edge[0] == "x" else length)
            for edge in EDGES
        )
        area = length * width
        waves = area * (bending**2 + shear**2 * (1.0 + 0.5 * (1.0 - ratio))) + edges * bending
        return max(0.0, waves / (4.0 * math.pi) + area * thickness * of_volume)
    return _OF_ANY_SHAPE
