"""Materials of the solid elements of a Nastran file.

They are those of MAT cards, and the properties that refer to them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from vibroimpact.meshes.nastran_cards import Card, nastran_real
from vibroimpact.meshes.parsed_mesh import FLUID
from vibroimpact.meshes.selection import Selection
from vibroimpact.meshes.text_files import TextLine, parse_integer
from vibroimpact.structures.finite_elements.stated_materials import StatedMaterial

_OTHERS = {
    "MAT9": "anisotropic",
    "MAT11": "orthotropic",
    "MATHP": "hyperelastic",
    "MATHE": "hyperelastic",
    "MAT10": FLUID,
}
_FLUID_FUNCTIONS = ("PFLUID", "FFLUID")
_COMPOSITES = ("PCOMPS", "PCOMPLS")

# what a number that can't be read should be, for messages
_MATERIAL = "the number of a material"
_PROPERTY = "the number of a property"


class NastranMaterials:
    """Collected MAT, PSOLID, PLSOLID, PCOMPS and PARAM WTMASS cards."""

    def __init__(self) -> None:
        self._isotropic: dict[int, StatedMaterial] = {}
        self._others: dict[int, StatedMaterial] = {}
        self._properties: dict[int, tuple[int | None, str]] = {}
        self._mass_per_weight = 1.0

    def take(self, card: Card) -> bool:
        """Read a card if it is one of these; return whether it was.

        Raises
        ------
        InputError
            If a number of it can't be read.
        """
        line = card.line
        fields = [*card.fields, *8 * [""]]
        if card.name == "MAT1":
            number = parse_integer(fields[0], line, _MATERIAL)
            self._isotropic[number] = _isotropic(f"MID{number}", fields, line)
        elif card.name in _OTHERS:
            number = parse_integer(fields[0], line, _MATERIAL)
            self._others[number] = StatedMaterial(f"MID{number}", other=_OTHERS[card.name])
        elif card.name in ("PSOLID", "PLSOLID"):
            material = None
            if fields[1]:
                material = parse_integer(fields[1], line, _MATERIAL)
            is_fluid = fields[6].upper() in _FLUID_FUNCTIONS
            fluid = FLUID if is_fluid else ""
            number = parse_integer(fields[0], line, _PROPERTY)
            self._properties[number] = (material, fluid)
        elif card.name in _COMPOSITES:
            number = parse_integer(fields[0], line, _PROPERTY)
            self._properties[number] = (None, "a layered composite")
        elif card.name == "PARAM" and fields[0].upper() == "WTMASS":
            self._mass_per_weight = nastran_real(fields[1], line, "the value of WTMASS", blank=1.0)
        else:
            return False
        return True

    def sections(
        self, element_sets: Mapping[str, Selection]
    ) -> list[tuple[Selection, StatedMaterial]]:
        """Return the elements of each property, which are the sets `PIDn`, with its material."""
        materials = dict(self._others)
        for number, material in self._isotropic.items():
            # PARAM,WTMASS multiplies every density, as of files that state weights
            materials[number] = replace(material, density=material.density * self._mass_per_weight)
        sections = []
        for number, (material_number, other) in self._properties.items():
            elements = element_sets.get(f"PID{number}")
            if elements is None:
                continue
            if material_number is None or other:
                material = StatedMaterial(f"PID{number}", other=other)
            else:
                unknown = StatedMaterial(f"MID{material_number}")
                material = materials.setdefault(material_number, unknown)
            sections.append((elements, material))
        return sections


def _isotropic(name: str, fields: list[str], line: TextLine) -> StatedMaterial:
    """Return the material of a MAT1 card.

    Of the two moduli and Poisson's ratio one follows from the others.
    """
    modulus, shear, ratio = (
        nastran_real(field, line, "an elastic constant", blank=math.nan) for field in fields[1:4]
    )
    density = nastran_real(fields[4], line, "a density", blank=math.nan)
    # E = 2 (1 + nu) G
    if math.isnan(ratio) and shear:
        ratio = 0.5 * modulus / shear - 1.0
    if math.isnan(modulus):
        modulus = 2.0 * (1.0 + ratio) * shear
    # zero is a number that is not given
    return StatedMaterial(name, density or math.nan, modulus or math.nan, ratio)
