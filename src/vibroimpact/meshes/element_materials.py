"""Materials of the elements of a mesh file.

They are those that the file states, in SI, or others in place of them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Integers
from vibroimpact.errors import InputError, did_you_mean, listed
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.stated_materials import StatedMaterial, StatedMaterials

REMEDY = (
    'give mesh.materials = { name = "steel", ... }, with the names of materials or element sets '
    "of the file"
)

_NAMES = {
    "density": "density",
    "youngs_modulus": "Young's modulus",
    "poissons_ratio": "Poisson's ratio",
}
"""The numbers of a material, by key."""

# of solids [kg/m^3]: less than a factor of 1000, so that systems of units differ
_LEAST_DENSITY = 25.0
_LARGEST_DENSITY = 24_999.0
# from soft rubber to diamond [Pa]
_LEAST_MODULUS = 1e4
_LARGEST_MODULUS = 1.3e12


class _Units(NamedTuple):
    """Consistent units: their names, and density and modulus of one in SI."""

    names: str
    density: float
    modulus: float


_SI = _Units("kg, m, s", 1.0, 1.0)
_SYSTEMS: Mapping[float, Sequence[_Units]] = {
    1.0: (_SI,),
    1e-3: (
        _Units("t, mm, s", 1e12, 1e6),
        _Units("kg, mm, ms", 1e9, 1e9),
        _Units("g, mm, ms", 1e6, 1e6),
        _SI,
    ),
    1e-2: (_Units("g, cm, s", 1e3, 0.1), _SI),
    0.0254: (_Units("lbf s^2/in, in, s", 10_686_895.0, 6_894.757), _SI),
    0.3048: (_Units("slug, ft, s", 515.3788, 47.88026), _SI),
}
"""Systems of units in which decks are written, by the unit of their coordinates [m]."""


def with_element_materials(
    mesh: Mesh, unit: float, named: Mapping[str, Material] | None = None
) -> Mesh:
    """Return a mesh with the materials of its elements, if there are several.

    Parameters
    ----------
    mesh : Mesh
        A mesh as read from a file, with what the file states of materials.
    unit : float
        Unit of the coordinates of the file [m]. Density and modulus are in the consistent units, of
        those that are usual with it, in which they are those of solids.
    named : mapping of str to Material, optional
        Materials in place of those of the file, by the name of a material or an element set of the
        file.

    Returns
    -------
    Mesh
        With `materials` if the file states several, or some are named. A file that states one
        material for all its elements leaves the elements to the material of the body; `stated` is
        in SI, if its units are known.

    Raises
    ------
    InputError
        If a name is unknown, names contradict one another or leave out a material of the file, or
        the file states several materials of which one has no number that is needed, is not
        isotropic, or is in unknown units.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> stated = (
    ...     StatedMaterial("MID1", 7.85e-9, 2.1e5, 0.3),
    ...     StatedMaterial("MID2", 1.1e-9, 10.0, 0.45),
    ... )
    >>> mesh = replace(
    ...     box_mesh((2.0, 1.0, 1.0), (2, 1, 1)), stated=StatedMaterials(stated, np.array([0, 1]))
    ... )
    >>> [
    ...     (round(one.density, 6), round(one.youngs_modulus))
    ...     for one in with_element_materials(mesh, 1e-3).materials
    ... ]
    [(7850.0, 210000000000), (1100.0, 10000000)]
    """
    stated = mesh.stated
    if named:
        return _with_named(mesh, named)
    if stated is None:
        return mesh
    if len({_properties(material) for material in stated.materials}) == 1:
        return _with_one(mesh, stated, unit)
    return _with_several(mesh, stated, unit)


def _properties(material: StatedMaterial) -> tuple[str, ...]:
    """Return what a stated material is, without its name.

    It is text, in which NaN is equal to itself.
    """
    return (
        repr(material.density),
        repr(material.youngs_modulus),
        repr(material.poissons_ratio),
        material.other,
    )


def _with_one(mesh: Mesh, stated: StatedMaterials, unit: float) -> Mesh:
    """Return a mesh whose file states one material, in SI.

    It has a remark if the units of the material are not known.
    """
    material = stated.materials[0]
    candidates = [_in_si(material, units) for units in _fitting([material], unit)]
    # without all numbers its units may not be known, but nothing depends on them
    is_incomplete = material.other or math.isnan(material.density + material.youngs_modulus)
    if is_incomplete and len(candidates) != 1:
        candidates = [replace(material, density=math.nan, youngs_modulus=math.nan)]
    if len(candidates) == 1:
        return replace(
            mesh, stated=StatedMaterials((candidates[0],), np.zeros_like(stated.of_elements))
        )
    remark = (
        f"the density of {material.density:.4g} and the modulus of "
        f"{material.youngs_modulus:.4g} of the material {material.name} of the mesh file are "
        f"those of no solid in the units that go with coordinates in {_unit_name(unit)}, "
        "and are not compared with those of the case; "
        "if the coordinates are in another unit, give mesh.unit"
    )
    return replace(mesh, stated=None, remarks=(*mesh.remarks, remark))


def _with_several(mesh: Mesh, stated: StatedMaterials, unit: float) -> Mesh:
    """Return a mesh with the several materials that its file states.

    Raises
    ------
    InputError
        If one can't be used.
    """
    count = len(stated.materials)
    for material in stated.materials:
        fault = _fault(material)
        if fault:
            raise InputError(
                f"the file gives its elements {count} materials, of which {material.name} "
                f"{fault}; {REMEDY}",
                "materials",
            )
    without = int((stated.of_elements < 0).sum())
    if without:
        raise InputError(
            f"the file gives {without} of its elements no material, and the others {count} "
            f"materials; {REMEDY}",
            "materials",
        )
    systems = _fitting(stated.materials, unit)
    if len(systems) != 1:
        densest = max(stated.materials, key=lambda material: material.density)
        raise InputError(
            f"the file gives its elements {count} materials in units that are not known: "
            f"{densest.name} has the density {densest.density:.4g} and "
            f"the modulus {densest.youngs_modulus:.4g}, with coordinates in "
            f"{_unit_name(unit)}. If these are in another unit, give mesh.unit; or {REMEDY}",
            "materials",
        )
    in_si = [_in_si(material, systems[0]) for material in stated.materials]
    return replace(
        mesh,
        materials=tuple(map(_material, in_si)),
        element_materials=stated.of_elements,
        stated=replace(stated, materials=tuple(in_si)),
    )


def _fault(material: StatedMaterial) -> str:
    """Return why the elements can't have a stated material; "" if they can."""
    if material.other:
        return f"is {material.other}"
    missing = [name for key, name in _NAMES.items() if math.isnan(getattr(material, key))]
    return f"has no {listed(missing)}" if missing else ""


def _material(stated: StatedMaterial) -> Material:
    """Return a material with the numbers of the file, in SI."""
    try:
        return Material(
            stated.density, stated.youngs_modulus, stated.poissons_ratio, name=stated.name
        )
    except InputError as error:
        raise InputError(
            f"the material {stated.name} of the file: {_NAMES.get(error.key, error.key)} "
            f"{error.message}; {REMEDY}",
            "materials",
        ) from None


def _fitting(materials: Sequence[StatedMaterial], unit: float) -> list[_Units]:
    """Return the usual systems of units in which all stated numbers are those of solids."""
    systems: Sequence[_Units] = (_SI,)
    for length, systems_of_length in _SYSTEMS.items():
        if math.isclose(length, unit, rel_tol=1e-6):
            systems = systems_of_length
    return [
        units
        for units in systems
        if all(_is_of_solid(_in_si(material, units)) for material in materials)
    ]


def _is_of_solid(material: StatedMaterial) -> bool:
    """Whether the numbers of a material in SI are those of a solid, as far as they are stated."""
    density = material.density
    modulus = material.youngs_modulus
    has_density = math.isnan(density) or _LEAST_DENSITY <= density <= _LARGEST_DENSITY
    has_modulus = math.isnan(modulus) or _LEAST_MODULUS <= modulus <= _LARGEST_MODULUS
    return has_density and has_modulus


def _in_si(material: StatedMaterial, units: _Units) -> StatedMaterial:
    """Return a material in SI, from other units."""
    return replace(
        material,
        density=units.density * material.density,
        youngs_modulus=units.modulus * material.youngs_modulus,
    )


def _unit_name(unit: float) -> str:
    return {1.0: "m", 1e-3: "mm", 1e-2: "cm", 0.0254: "in", 0.3048: "ft"}.get(unit, f"{unit:g} m")


def _with_named(mesh: Mesh, named: Mapping[str, Material]) -> Mesh:
    """Return a mesh with materials by the names of materials or element sets of the file.

    Raises
    ------
    InputError
        If a name is unknown, or names contradict one another or leave out a material of the file.
    """
    stated = mesh.stated.materials if mesh.stated else ()
    sets = dict(mesh.element_sets)
    if mesh.stated:
        for index, material in enumerate(stated):
            sets[material.name] = np.flatnonzero(mesh.stated.of_elements == index)
    numbers = np.full(mesh.number_of_elements, -1)
    names = list(named)
    for number, name in enumerate(names):
        members = _members(sets, name)
        earlier = numbers[members]
        clashes = earlier[(earlier >= 0) & (earlier != number)]
        if len(clashes):
            other = int(clashes[0])
            shared = int((clashes == other).sum())
            raise _clash(name, names[other], shared)
        numbers[members] = number
    # a single material of the file remains that of the elements that no name takes
    if len({_properties(material) for material in stated}) > 1:
        for material in stated:
            members = sets[material.name]
            unnamed = int((numbers[members] < 0).sum())
            _check_all_named(material, len(members), unnamed)
    return replace(mesh, materials=tuple(named.values()), element_materials=numbers, stated=None)


def _clash(name: str, other: str, shared: int) -> InputError:
    """Return an error that names two sets which share elements."""
    elements = "an element, which"
    if shared > 1:
        elements = f"{shared} elements, each of which"
    return InputError(
        f'"{name}" and "{other}" share {elements} can have one material only; name '
        "sets that share none",
        "materials",
    )


def _check_all_named(material: StatedMaterial, count: int, unnamed: int) -> None:
    """Raise InputError if the names leave out elements of a material of the file.

    Parameters
    ----------
    material : StatedMaterial
        The material.
    count, unnamed : int
        Number of its elements, and of those that the names leave out.
    """
    if not unnamed:
        return
    elements = f"{unnamed} elements"
    missing = "a set that contains them"
    if unnamed == 1:
        elements = "an element"
        missing = "a set that contains it"
    if unnamed == count:
        missing = "it"
    raise InputError(
        f'the names leave out {elements} of the material "{material.name}" of the file; '
        f"name {missing} too",
        "materials",
    )


def _members(sets: Mapping[str, Integers], name: str) -> Integers:
    """Return the elements of a material or set by its name, if need be ignoring case.

    Raises
    ------
    InputError
        If there is none.
    """
    if name in sets:
        return sets[name]
    for other, members in sets.items():
        if other.lower() == name.lower():
            return members
    names = "it has neither"
    if sets:
        names = f"it has {listed(sets)}"
    raise InputError(
        f'the file has no material or element set "{name}"; '
        f"{names}.{did_you_mean(name, list(sets))}",
        "materials",
    )
