"""Materials as a mesh file states them, and what of them contradicts the material of a body."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from vibroimpact.arrays import Integers
from vibroimpact.materials import Material

# relative: larger differences from the material of the case are stated
_SAME_DENSITY, _SAME_MODULUS = 0.05, 0.1


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
    """Materials that a mesh file states, and the number of each element's material; -1
    for an element without one.
    """

    materials: tuple[StatedMaterial, ...]
    of_elements: Integers


def contradictions(stated: StatedMaterials | None, material: Material) -> Iterator[str]:
    """Yield what a mesh file states of its only material, in SI, and the material of the body
    contradicts; nothing if it states several.

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
    said = stated.materials[0]
    if said.other:
        words = "its elements are computed with the isotropic material of the case"
        yield f"the material of the mesh file, {said.name}, is {said.other}; {words}"
        return
    off = {
        "density": (said.density / material.density - 1.0, _SAME_DENSITY, said.density, "kg/m3"),
        "Young's modulus": (
            said.youngs_modulus / material.youngs_modulus - 1.0,
            _SAME_MODULUS,
            said.youngs_modulus,
            "Pa",
        ),
    }
    differing = [
        f"a {what} of {value:.4g} {unit}"
        for what, (part, same, value, unit) in off.items()
        if abs(part) > same
    ]
    if differing:
        yield (
            f"the mesh file gives its material {said.name} {' and '.join(differing)}, and "
            "its elements are computed with the material of "
            f"the case, of {material.density:.4g} kg/m3 and {material.youngs_modulus:.4g} "
            "Pa; give the material that the body is made of"
        )
