"""Materials as a mesh file states them, and what of them contradicts the material of a body."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from vibroimpact.arrays import Integers
from vibroimpact.materials import Material

# relative: larger differences from the material of the case are stated
_SAME_DENSITY = 0.05
_SAME_MODULUS = 0.1


@dataclass(frozen=True)
class StatedMaterial:
    """Material as a mesh file states it, in the units of the file.

    Parameters
    ----------
    name : str
        Its name.
    density, youngs_modulus, poissons_ratio : float
        NaN where the file does not state them.
    other : str, default ""
        What it is if not isotropic and linear-elastic, such as "orthotropic".
    """

    name: str
    density: float = math.nan
    youngs_modulus: float = math.nan
    poissons_ratio: float = math.nan
    other: str = ""


@dataclass(frozen=True)
class StatedMaterials:
    """Materials that a mesh file states, and the number of each element's material.

    The number is -1 for an element without one.
    """

    materials: tuple[StatedMaterial, ...]
    of_elements: Integers


def contradictions(stated: StatedMaterials | None, material: Material) -> Iterator[str]:
    """Yield what a mesh file states of its only material, and the body's material contradicts.

    The numbers of the file are taken as SI units. Nothing is yielded if it states several
    materials.

    Examples
    --------
    >>> import numpy as np
    >>> stated = StatedMaterials((StatedMaterial("MID1", 1100.0, 10e6, 0.45),), np.zeros(6))
    >>> [found] = contradictions(stated, Material(7850.0, 210e9, 0.3))
    >>> print(found[:83])
    the mesh file gives its material MID1 a density of 1100 kg/m3 and a Young's modulus
    """
    if stated is None or len(stated.materials) > 1:
        return
    in_file = stated.materials[0]
    if in_file.other:
        yield (
            f"the material of the mesh file, {in_file.name}, is {in_file.other}; its elements "
            "are computed with the isotropic material of the case"
        )
        return
    # comparisons with NaN, of what the file does not state, are False
    differing = []
    if abs(in_file.density / material.density - 1.0) > _SAME_DENSITY:
        differing.append(f"a density of {in_file.density:.4g} kg/m3")
    if abs(in_file.youngs_modulus / material.youngs_modulus - 1.0) > _SAME_MODULUS:
        differing.append(f"a Young's modulus of {in_file.youngs_modulus:.4g} Pa")
    if differing:
        yield (
            f"the mesh file gives its material {in_file.name} {' and '.join(differing)}, and "
            "its elements are computed with the material of "
            f"the case, of {material.density:.4g} kg/m3 and {material.youngs_modulus:.4g} "
            "Pa; give the material that the body is made of"
        )
