"""Structural compliance of a plate at its contact point, from a static finite-element solution."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Bools, Floats
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.disc_quadrature import UNIFORM, pressure_rule
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.plate_element import shear_factor
from vibroimpact.structures.finite_elements.structure import Structure
from vibroimpact.structures.finite_elements.surface import Side, materials_around, surface_motion
from vibroimpact.structures.memory_cache import MemoryCache
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.plate_compliance import (
    Average,
    plate_theory_average,
    plate_theory_term,
    through_thickness_average,
    through_thickness_term,
)
from vibroimpact.structures.recipe import Recipe, SphereOfSolids, is_thin, plate_key
from vibroimpact.structures.store import COMPLIANCE, hold_entry, key_of, load_or_compute
from vibroimpact.structures.supports.constraints import HeldStructure
from vibroimpact.structures.supports.support import held_by

_FACES: tuple[Side, Side] = ("upper", "lower")
_RADIUS = 0.75  # of the disc, in thicknesses; elements of that size resolve it
_FACTORISED = MemoryCache[tuple[HeldStructure, ElasticSystem]](capacity=500e6)


def static_compliance(
    recipe: Recipe,
    place: tuple[float, float],
    side: Side = "upper",
    tell: Callable[[str], None] | None = None,
) -> float:
    """Return the structural compliance of a plate at a place [m/N], from the store or computed.

    It is the displacement of a point under a unit normal force, less that of the half space, which
    is part of the contact law.

    Parameters
    ----------
    recipe : Recipe
        The plate and its supports; the reduction has no effect.
    place : tuple of two floats
        x and y [m].
    side : str, default "upper"
        The loaded face: "upper" or "lower".
    tell : callable, optional
        Called with a message on a failure of the store.

    Raises
    ------
    InputError
        If the place is not on the body, the body is a sphere, or the mesh or a support is invalid.
    ComputationError
        If the stiffness is singular.

    Notes
    -----
    For a plate with free rigid motions the rigid displacement is excluded: inertia balances the
    force (inertia relief).

    By Kirchhoff's theory (`theory = "thin"`) the deflection under a point force is finite, and is
    returned: the thin theory has neither shear nor a half space.

    Otherwise the displacement under a point force is infinite, and finite elements do not resolve
    the field near it. The force is therefore distributed over a disc of 0.75 thicknesses, or the
    part of it on the body near an edge, and the response is averaged in the same way: that of plate
    elements, to which `plate_theory_term` is added, or that of the opposite face of solid elements,
    to which `through_thickness_term` is added. These terms are exact for a plate that extends a few
    thicknesses around the place.

    Examples
    --------
    >>> from vibroimpact.structures.supports.edge import EDGES, Edge
    >>> edges = tuple(Edge(edge, "simply-supported") for edge in EDGES)
    >>> from vibroimpact.structures.recipe import PlateOfPlates
    >>> recipe = Recipe(PlateOfPlates((0.5, 0.5, 0.01), 0.125), 7850.0, 210e9, 0.3, edges)
    >>> stiffness = 210e9 * 0.01**3 / (12 * 0.91)
    >>> round(static_compliance(recipe, (0.0, 0.0)) * stiffness / 0.5**2, 4)  # 0.0116 is Navier's
    0.0116
    """
    return stored_compliance(
        compliance_key(recipe, place, side), lambda: computed_compliance(recipe, place, side), tell
    )


def stored_compliance(
    key: str, compute: Callable[[], float], tell: Callable[[str], None] | None = None
) -> float:
    """Return a compliance by its key from the store, or computed and then stored [m/N].

    Parameters
    ----------
    key : str
        Its key in the store.
    compute : callable
        Computes it where the store does not have it.
    tell : callable, optional
        Called with a message on a failure of the store.

    Raises
    ------
    InputError, ComputationError
        As `compute` does.
    """
    return load_or_compute(
        key,
        COMPLIANCE,
        lambda arrays: float(arrays[COMPLIANCE].item()),
        compute,
        lambda compliance: {COMPLIANCE: np.array(compliance)},
        tell,
    )


def hold_compliances(
    recipe: Recipe, places: Sequence[tuple[float, float]], side: Side = "upper"
) -> None:
    """Compute the compliances of a plate at places together.

    Calls of `static_compliance` that follow in this process find them in memory.
    """
    compliances = computed_compliances(recipe, places, side)
    for place, compliance in zip(places, compliances, strict=True):
        key = compliance_key(recipe, place, side)
        hold_entry(key, COMPLIANCE, {COMPLIANCE: np.array(compliance)})


def compliance_key(recipe: Recipe, place: tuple[float, float], side: Side = "upper") -> str:
    """Return the key of the compliance of a plate at a place in the store."""
    return key_of(["structural compliance", plate_key(recipe), place, side])


def computed_compliance(recipe: Recipe, place: tuple[float, float], side: Side = "upper") -> float:
    """Return the structural compliance of a held plate, computed anew.

    Parameters and errors are those of `static_compliance`.
    """
    return float(computed_compliances(recipe, [place], side)[0])


def computed_compliances(
    recipe: Recipe, places: Sequence[tuple[float, float]], side: Side = "upper"
) -> Floats:
    """Return the structural compliances of a held plate at several places, (places,).

    The forces at all places are solved together.
    """
    if isinstance(recipe.shape, SphereOfSolids):
        raise InputError(
            "a structural compliance is that of a plate, which has two faces; a sphere has none"
        )
    held, elastic = _factorised(recipe)
    structure = held.structure
    averages = []
    terms = []  # what the averaged compliance lacks
    for thickness, place in zip(_thicknesses(structure, places), places, strict=True):
        material = _material_of_layer(structure.mesh, recipe, place, thickness)
        modulus = material.youngs_modulus
        ratio = material.poissons_ratio
        if not structure.mesh.is_flat:
            average = through_thickness_average(_RADIUS * thickness)
            term = through_thickness_term(thickness, modulus, ratio, average)
        elif is_thin(recipe):
            average = plate_element_average(thickness, ratio, thin=True)
            term = 0.0
        else:
            average = plate_element_average(thickness, ratio)
            term = plate_theory_term(thickness, modulus, ratio, shear_factor(ratio), average)
        averages.append(average)
        terms.append(term)
    return averaged_compliances(held, elastic, places, averages, side) + terms


def plate_element_average(thickness: float, poissons_ratio: float, thin: bool = False) -> Average:
    """Return the average of force and displacement around a place of plate elements.

    By Kirchhoff's theory, `thin`, it is that of a point.
    """
    if thin:
        return Average(0.0, 0.0)
    return plate_theory_average(
        _RADIUS * thickness, thickness, poissons_ratio, shear_factor(poissons_ratio)
    )


def averaged_compliances(
    held: HeldStructure,
    elastic: ElasticSystem,
    places: Sequence[tuple[float, float]],
    averages: Sequence[Average],
    side: Side = "upper",
) -> Floats:
    """Return the averaged displacements of the opposite face under unit forces, (places,) [m/N].

    The forces are averaged in the same way.

    Parameters
    ----------
    held, elastic : HeldStructure, ElasticSystem
        A held body, and its factorised system.
    places : sequence of two floats
        x and y [m].
    averages : sequence of Average
        One per place.
    side : str, default "upper"
        The loaded face: "upper" or "lower".

    Raises
    ------
    InputError
        If a place is not on the body.
    """
    upper, lower = _face_rows(held, places, averages)
    load = upper
    opposite = lower
    if side == "lower":
        load = lower
        opposite = upper
    displacements = elastic.static(load.toarray().T)
    return np.asarray(opposite.multiply(displacements.T).sum(axis=1))


def _material_of_layer(
    mesh: Mesh, recipe: Recipe, place: tuple[float, float], thickness: float
) -> Material:
    """Return the material of a body around a place.

    It is for the terms of a layer, which are exact for one of a single material.

    Raises
    ------
    InputError
        If the elements there are of several materials.
    """
    materials = materials_around(mesh, _material(recipe), place, _RADIUS * thickness)
    if len(materials) > 1:
        kinds = "; ".join(
            f"{material.density:.4g} kg/m3, {material.youngs_modulus:.3g} Pa"
            for material in materials[:3]
        )
        if len(materials) > 3:
            kinds += "; ..."
        raise InputError(
            f"around ({place[0]:g}, {place[1]:g}) m the body is of {len(materials)} materials "
            f"({kinds}), and its static compliance under a "
            "contact is known where it is of one; give contact.local_compliance = "
            '"superposed", which takes the modes as they are'
        )
    return materials[0]


def _thicknesses(structure: Structure, places: Sequence[tuple[float, float]]) -> list[float]:
    """Return the thickness [m] of a body at places.

    Raises
    ------
    InputError
        If a place is not on the body.
    """
    _, upper = surface_motion(structure.mesh, np.array(places))
    if structure.mesh.is_flat:
        return len(places) * [structure.thickness]
    _, lower = surface_motion(structure.mesh, np.array(places), "lower")
    thicknesses: list[float] = np.linalg.norm(upper - lower, axis=1).tolist()
    return thicknesses


def _material(recipe: Recipe) -> Material:
    """Return the material of a recipe."""
    return Material(recipe.density, recipe.youngs_modulus, recipe.poissons_ratio)


def _factorised(recipe: Recipe) -> tuple[HeldStructure, ElasticSystem]:
    """Return a held body and its factorised system.

    The last one is cached, for drops on other places of one plate.
    """
    key = plate_key(recipe)
    cached = _FACTORISED.get(key)
    if cached is not None:
        return cached
    _FACTORISED.clear()  # before the new factors need the memory
    structure = recipe.shape.structure(recipe.shape.mesh(recipe.supports), _material(recipe))
    held = held_by(structure, recipe.supports)
    elastic = ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)
    _FACTORISED.put(key, (held, elastic), elastic.size)
    return held, elastic


def _face_rows(
    held: HeldStructure, places: Sequence[tuple[float, float]], averages: Sequence[Average]
) -> list[csr_array]:
    """Return the averaged vertical displacements of the upper and lower face around places.

    They are rows of the free degrees of freedom, (places, free).
    """
    disc_points, disc_weights = pressure_rule(UNIFORM)
    points = []
    weights = []
    for place, average in zip(places, averages, strict=True):
        points.append(np.asarray(place) + average.radius * disc_points)
        weights.append(disc_weights * average.weights(disc_points))
    is_on_body, motions = _on_body(held.structure.mesh, np.concatenate(points))
    # the part of each disc that is on the body
    weights_on_body = np.where(is_on_body, np.concatenate(weights), 0.0)
    shares = weights_on_body.reshape(len(places), -1)
    for place, is_inside in zip(places, is_on_body.reshape(shares.shape), strict=True):
        if not is_inside.any():
            raise InputError(
                f"the body is too narrow at ({place[0]:g}, {place[1]:g}) m to be taken for a plate"
            )
    shares /= shares.sum(axis=1, keepdims=True)
    rows = np.repeat(np.arange(len(places)), len(disc_points))
    columns = np.arange(shares.size)
    averaging = csr_array((shares.ravel(), (rows, columns)), shape=(len(places), shares.size))
    averaging = averaging[:, is_on_body]
    return [csr_array(averaging @ motion @ held.expansion) for motion in motions]


def _on_body(mesh: Mesh, places: Floats) -> tuple[Bools, list[csr_array]]:
    """Return a mask of the places on the body, and their vertical displacements on either face.

    All places within the bounding box are tried together first, which is fast; one by one only if
    that fails.
    """
    low = mesh.nodes[:, :2].min(axis=0)
    high = mesh.nodes[:, :2].max(axis=0)
    is_in_box = ((places >= low) & (places <= high)).all(axis=1)
    if is_in_box.any():
        motions = _vertical_motions(mesh, places[is_in_box])
        if motions:
            return is_in_box, motions
    is_on_body = np.array([bool(_vertical_motions(mesh, place)) for place in places])
    if not is_on_body.any():
        return is_on_body, []
    return is_on_body, _vertical_motions(mesh, places[is_on_body])


def _vertical_motions(mesh: Mesh, places: Floats) -> list[csr_array]:
    """Return the vertical displacements of places on either face per degree of freedom.

    The list is empty if a place is not on the body.
    """
    try:
        if mesh.is_flat:  # both faces of a plate element have the same deflection
            return 2 * [surface_motion(mesh, places)[0][2::3]]
        return [surface_motion(mesh, places, face)[0][2::3] for face in _FACES]
    except InputError:
        return []


def responses_to_spread_forces(
    recipe: Recipe,
    places: Sequence[tuple[float, float]],
    side: Side,
    average: Callable[[tuple[float, float], float], Average],
) -> tuple[Structure, list[float], Floats]:
    """Return the response of a held plate to unit upward forces distributed around places.

    Parameters
    ----------
    recipe, side : as in `static_compliance`
        The plate, and its face.
    places : sequence of two floats
        The places of the forces, which are solved together.
    average : callable
        From a place and the thickness there [m] to the distribution of the force.

    Returns
    -------
    structure : Structure
        The finite elements.
    thicknesses : list of float
        Thickness at each place [m].
    displacements : array, shape (dofs, places)
        Displacements of all degrees of freedom of the mesh under each force [m/N].

    Raises
    ------
    InputError, ComputationError
        As in `static_compliance`.
    """
    held, elastic = _factorised(recipe)
    thicknesses = _thicknesses(held.structure, places)
    averages = [
        average(place, thickness) for place, thickness in zip(places, thicknesses, strict=True)
    ]
    loads = _face_rows(held, places, averages)[_FACES.index(side)]
    displacements = np.asarray(held.expansion @ elastic.static(loads.toarray().T))
    return held.structure, thicknesses, displacements
