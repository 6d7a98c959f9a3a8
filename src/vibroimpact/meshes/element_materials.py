"""Materials of the elements of a mesh file: those that the file states, in SI, or others
in place of them.
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
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.stated_materials import StatedMaterial, StatedMaterials

REMEDY = (
    'give mesh.materials = { name = "steel", ... }, with the names of materials or element sets '
    "of the file"
)

_TERMS = {"youngs_modulus": "Young's modulus", "poissons_ratio": "Poisson's ratio"}
"""What the keys of a material are called in the field."""

# kg/m^3, of solids: less than a factor of 1000, so that systems of units differ
_DENSITIES = (25.0, 24_999.0)
_MODULI = (1e4, 1.3e12)  # Pa, from soft rubber to diamond


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
    >>> from vibroimpact.structures.lattice import box_mesh
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
    if len({_numbers(one) for one in stated.materials}) == 1:
        return _with_one(mesh, stated, unit)
    return _with_stated(mesh, stated, unit)


def _numbers(one: StatedMaterial) -> tuple[str, ...]:
    """Return what a stated material is, without its name; as text, in which NaN is equal
    to itself.
    """
    return repr(one.density), repr(one.youngs_modulus), repr(one.poissons_ratio), one.other


def _with_one(mesh: Mesh, stated: StatedMaterials, unit: float) -> Mesh:
    """Return a mesh whose file states one material, in SI; with a remark if its units are
    not known.
    """
    one = stated.materials[0]
    fitting = [_in_si(one, units) for units in _fitting([one], unit)]
    # its units are not known, but nothing depends on them
    if one.other or math.isnan(one.density + one.youngs_modulus):
        fitting = (
            fitting[:1]
            if len(fitting) == 1
            else [replace(one, density=math.nan, youngs_modulus=math.nan)]
        )
    if len(fitting) == 1:
        return replace(
            mesh, stated=StatedMaterials((fitting[0],), np.zeros_like(stated.of_elements))
        )
    remark = (
        f"the density of {one.density:.4g} and the modulus of {one.youngs_modulus:.4g} of "
        f"the material {one.name} of the mesh file are "
        f"those of no solid in the units that go with coordinates in {_unit_name(unit)}, "
        "and are not compared with those of the case; "
        "if the coordinates are in another unit, give mesh.unit"
    )
    return replace(mesh, stated=None, remarks=(*mesh.remarks, remark))


def _with_stated(mesh: Mesh, stated: StatedMaterials, unit: float) -> Mesh:
    """Return a mesh with the several materials that its file states.

    Raises
    ------
    InputError
        If one can't be used.
    """
    count = len(stated.materials)
    for one in stated.materials:
        missing = [
            what
            for what, value in (
                ("density", one.density),
                ("Young's modulus", one.youngs_modulus),
                ("Poisson's ratio", one.poissons_ratio),
            )
            if math.isnan(value)
        ]
        fault = f"is {one.other}" if one.other else f"has no {listed(missing)}" if missing else ""
        if fault:
            raise InputError(
                f"the file gives its elements {count} materials, of which {one.name} "
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
    fitting = _fitting(stated.materials, unit)
    if len(fitting) != 1:
        one = max(stated.materials, key=lambda other: other.density)
        raise InputError(
            f"the file gives its elements {count} materials in units that are not known: "
            f"{one.name} has the density {one.density:.4g} and "
            f"the modulus {one.youngs_modulus:.4g}, with coordinates in "
            f"{_unit_name(unit)}. If these are in another unit, give mesh.unit; or {REMEDY}",
            "materials",
        )
    in_si = [_in_si(one, fitting[0]) for one in stated.materials]
    return replace(
        mesh,
        materials=tuple(map(_material, in_si)),
        element_materials=stated.of_elements,
        stated=replace(stated, materials=tuple(in_si)),
    )


def _material(one: StatedMaterial) -> Material:
    try:
        return Material(one.density, one.youngs_modulus, one.poissons_ratio, name=one.name)
    except InputError as error:
        raise InputError(
            f"the material {one.name} of the file: {_TERMS.get(error.key, error.key)} "
            f"{error.message}; {REMEDY}",
            "materials",
        ) from None


def _fitting(materials: Sequence[StatedMaterial], unit: float) -> list[_Units]:
    """Return the usual systems of units in which all stated numbers are those of solids."""
    systems = next(
        (found for known, found in _SYSTEMS.items() if math.isclose(known, unit, rel_tol=1e-6)),
        (_SI,),
    )

    def fits(units: _Units) -> bool:
        pairs = [(units.density * one.density, _DENSITIES) for one in materials]
        pairs += [(units.modulus * one.youngs_modulus, _MODULI) for one in materials]
        return all(math.isnan(value) or low <= value <= high for value, (low, high) in pairs)

    return [units for units in systems if fits(units)]


def _in_si(one: StatedMaterial, units: _Units) -> StatedMaterial:
    return replace(
        one, density=units.density * one.density, youngs_modulus=units.modulus * one.youngs_modulus
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
    sets = (
        {
            one.name: np.flatnonzero(mesh.stated.of_elements == index)
            for index, one in enumerate(stated)
        }
        if mesh.stated
        else {}
    )
    sets = {**mesh.element_sets, **sets}
    numbers = np.full(mesh.number_of_elements, -1)
    for number, name in enumerate(named):
        members = _members(sets, name)
        taken = numbers[members]
        clash = taken[(taken >= 0) & (taken != number)]
        if len(clash):
            other = list(named)[int(clash[0])]
            shared = int((clash == clash[0]).sum())
            elements = (
                "an element, which can" if shared == 1 else f"{shared} elements, each of which can"
            )
            raise InputError(
                f'"{name}" and "{other}" share {elements} have one material only; name '
                "sets that share none",
                "materials",
            )
        numbers[members] = number
    if len({_numbers(one) for one in stated}) > 1:
        for one in stated:
            left = int((numbers[sets[one.name]] < 0).sum())
            if left:
                too = (
                    "it"
                    if left == len(sets[one.name])
                    else f"a set that contains {'it' if left == 1 else 'them'}"
                )
                elements = "an element" if left == 1 else f"{left} elements"
                words = (
                    f'the names leave out {elements} of the material "{one.name}" of the file; '
                    f"name {too} too"
                )
                raise InputError(words, "materials")
    return replace(mesh, materials=tuple(named.values()), element_materials=numbers, stated=None)


def _members(sets: Mapping[str, Integers], name: str) -> Integers:
    exact = (
        name
        if name in sets
        else next((other for other in sets if other.lower() == name.lower()), None)
    )
    if exact is None:
        have = f"it has {listed(sets)}" if sets else "it has neither"
        raise InputError(
            f'the file has no material or element set "{name}"; '
            f"{have}.{did_you_mean(name, list(sets))}",
            "materials",
        )
    return sets[exact]
