"""Static strains of the faces of a plate under a force elsewhere, from one static solution."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.structures.finite_elements.plate_element import shear_factor
from vibroimpact.structures.finite_elements.structure import Structure
from vibroimpact.structures.finite_elements.surface import Side
from vibroimpact.structures.finite_elements.surface_strain import surface_strain
from vibroimpact.structures.plate_compliance import Average, mean_square
from vibroimpact.structures.recipe import PlateOfPlates, Recipe, is_thin, plate_key
from vibroimpact.structures.static_compliance import responses_to_spread_forces
from vibroimpact.structures.store import key_of, load_or_compute_array
from vibroimpact.structures.transfer_compliance import Point

_RADIUS = 0.75  # of the disc of the force, in thicknesses


def transfer_strains(
    recipe: Recipe,
    place: tuple[float, float],
    side: Side,
    points: Sequence[Point],
    tell: Callable[[str], None] | None = None,
) -> Floats:
    r"""Return the static strains at points of a held plate under a unit upward force [1/N].

    They are an array (points, 3). The force is spread over a disc whose effect away from it is that
    of a point force on the face of a layer, as in `transfer_compliance`; within some thicknesses of
    the force the strain of a layer differs.

    Parameters
    ----------
    recipe : Recipe
        The plate and its supports; the reduction has no effect.
    place : tuple of two floats
        x and y of the force [m].
    side : str
        Face of the force, "upper" or "lower".
    points : sequence of ((x, y), side)
        Where the strains are.
    tell : callable, optional
        Called with a message on a failure of the store.

    Raises
    ------
    InputError
        If a place is not on the body, the supports permit vertical rigid motion, or the mesh or a
        support is invalid.
    ComputationError
        If the stiffness is singular.
    """
    return load_or_compute_array(
        strain_key(recipe, place, side, points),
        lambda: computed_strains(recipe, place, side, points),
        tell,
    )


def strain_key(
    recipe: Recipe, place: tuple[float, float], side: Side, points: Sequence[Point]
) -> str:
    """Return the key of the strains under a force in the store."""
    return key_of(["transfer strain", plate_key(recipe), place, side, list(points)])


def computed_strains(
    recipe: Recipe, place: tuple[float, float], side: Side, points: Sequence[Point]
) -> Floats:
    """Return the strains under a force, computed anew.

    Parameters and errors are those of `transfer_strains`.
    """
    structure, displacements = response_at_face(recipe, place, side)
    strains = [
        surface_strain(structure.mesh, point, face, structure.thickness) @ displacements
        for point, face in points
    ]
    return np.array(strains)


def response_at_face(
    recipe: Recipe, place: tuple[float, float], side: Side
) -> tuple[Structure, Floats]:
    """Return the bare structure of a held plate, and its displacements under a unit upward force.

    Parameters and errors are those of `transfer_strains`.
    """

    def distribution(place: tuple[float, float], thickness: float) -> Average:
        return _spread_at_face(recipe, thickness)

    structure, _, displacements = responses_to_spread_forces(recipe, [place], side, distribution)
    return structure, displacements[:, 0]


def _spread_at_face(recipe: Recipe, thickness: float) -> Average:
    """Return the distribution of a force whose static response is that at the face of a plate.

    The response is that of the modes at the face, not of plate theory.
    """
    has_layer = isinstance(recipe.shape, PlateOfPlates) and not is_thin(recipe)
    square = 0.0  # mean of r^2 over the square of the thickness
    if has_layer:
        square = mean_square(1.0, recipe.poissons_ratio, shear_factor(recipe.poissons_ratio))
    return Average(_RADIUS * thickness, 3.0 - 6.0 * square / _RADIUS**2)
