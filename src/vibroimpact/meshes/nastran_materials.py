"""Materials of the solid elements of a Nastran file: MAT cards, and the properties that
refer to them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from vibroimpact.meshes.nastran_cards import Card, nastran_real
from vibroimpact.meshes.parsed_mesh import FLUID
from vibroimpact.meshes.selection import Selection
from vibroimpact.meshes.text_files import TextLine, parse_integer
from vibroimpact.structures.stated_materials import StatedMaterial

_OTHERS = {
    "MAT9": "anisotropic",
    "MAT11": "orthotropic",
    "MATHP": "hyperelastic",
    "MATHE": "hyperelastic",
    "MAT10": FLUID,
}
_FLUID_FUNCTIONS = ("PFLUID", "FFLUID")
_COMPOSITES = ("PCOMPS", "PCOMPLS")


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
        line, name, fields = card.line, card.name, [*card.fields, *8 * [""]]
        if name == "MAT1":
            number = parse_integer(fields[0], line, "the number of a material")
            self._isotropic[number] = _isotropic(f"MID{number}", fields, line)
        elif name in _OTHERS:
            number = parse_integer(fields[0], line, "the number of a material")
            self._others[number] = StatedMaterial(f"MID{number}", other=_OTHERS[name])
        elif name in ("PSOLID", "PLSOLID"):
            material = (
                parse_integer(fields[1], line, "the number of a material") if fields[1] else None
            )
            fluid = FLUID if fields[6].upper() in _FLUID_FUNCTIONS else ""
            self._properties[parse_integer(fields[0], line, "the number of a property")] = (
                material,
                fluid,
            )
        elif name in _COMPOSITES:
            self._properties[parse_integer(fields[0], line, "the number of a property")] = (
                None,
                "a layered composite",
            )
        elif name == "PARAM" and fields[0].upper() == "WTMASS":
            self._mass_per_weight = nastran_real(fields[1], line, "the value of WTMASS", blank=1.0)
        else:
            return False
        return True

    def sections(
        self, element_sets: Mapping[str, Selection]
    ) -> list[tuple[Selection, StatedMaterial]]:
        """Return the elements of each property, which are the sets `PIDn`, with its material."""
        known = {
            number: replace(one, density=one.density * self._mass_per_weight)
            for number, one in self._isotropic.items()
        }
        known = {**self._others, **known}
        found = []
        for number, (material, other) in self._properties.items():
            chosen = element_sets.get(f"PID{number}")
            if chosen is None:
                continue
            if material is None or other:
                found.append((chosen, StatedMaterial(f"PID{number}", other=other)))
            else:
                found.append((chosen, known.setdefault(material, StatedMaterial(f"MID{material}"))))
        return found


def _isotropic(name: str, fields: list[str], line: TextLine) -> StatedMaterial:
    """Return the material of a MAT1 card; of the two moduli and Poisson's ratio one
    follows from the others.
    """
    modulus, shear, ratio = (
        nastran_real(field, line, "an elastic constant", blank=math.nan) for field in fields[1:4]
    )
    density = nastran_real(fields[4], line, "a density", blank=math.nan)
    if math.isnan(ratio) and shear:
        ratio = 0.5 * modulus / shear - 1.0
    if math.isnan(modulus):
        modulus = 2.0 * (1.0 + ratio) * shear
    return StatedMaterial(name, density or math.nan, modulus or math.nan, ratio)
