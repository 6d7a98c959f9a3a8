"""Materials of the solid elements of an Abaqus file.

They are those of *MATERIAL with its options, and *SOLID SECTION.
"""

from __future__ import annotations

import math
from dataclasses import replace

from vibroimpact.meshes.abaqus_blocks import Block
from vibroimpact.meshes.nastran_cards import nastran_real
from vibroimpact.meshes.text_files import TextLine
from vibroimpact.structures.finite_elements.stated_materials import StatedMaterial

_OTHERS = {
    "HYPERELASTIC": "hyperelastic",
    "HYPERFOAM": "hyperelastic",
    "USER MATERIAL": "a user material",
    "DEFORMATION PLASTICITY": "of deformation plasticity",
}
_SOLID = "SOLID SECTION"
_KINDS = {
    "ANISO": "anisotropic",
    "ORTHO": "orthotropic",
    "ENGINEERING": "orthotropic",
    "LAMINA": "orthotropic",
}
"""What a material is by the beginning of the type of its elasticity, unless it is isotropic."""


class AbaqusMaterials:
    """Collected *MATERIAL, *DENSITY, *ELASTIC and *SOLID SECTION.

    Other keywords make a material another than isotropic.
    """

    def __init__(self) -> None:
        self._materials: dict[str, StatedMaterial] = {}
        self._open = ""
        self._sections: list[tuple[TextLine, str, str]] = []

    def take(self, block: Block) -> bool:
        """Read a block if it is one of these; return whether it was.

        Raises
        ------
        InputError
            If a number of it can't be read.
        """
        keyword = block.keyword
        parameters = block.parameters
        if keyword == "MATERIAL":
            name = parameters.get("NAME", "")
            self._open = name.upper()
            self._materials.setdefault(self._open, StatedMaterial(name))
        elif keyword == _SOLID and parameters.get("ELSET"):
            material = parameters.get("MATERIAL", "")
            if "COMPOSITE" in parameters:
                material = ""
            self._sections.append((block.line, parameters["ELSET"], material))
        elif self._open not in self._materials:
            return False
        elif keyword == "DENSITY":
            self._change(density=_numbers(block, 1, "a density")[0])
        elif keyword == "ELASTIC":
            self._elastic(block)
        elif keyword in _OTHERS:
            self._change(other=_OTHERS[keyword])
        else:
            return False
        return True

    def sections(self) -> list[tuple[TextLine, str, StatedMaterial]]:
        """Return the lines, element sets and materials of the sections."""
        # a material that the file does not define has no numbers
        materials = {
            name.upper(): StatedMaterial(name) for _, _, name in self._sections if name
        } | self._materials
        composite = StatedMaterial("*SOLID SECTION", other="a layered composite")
        sections = []
        for line, elements, name in self._sections:
            material = materials[name.upper()] if name else composite
            sections.append((line, elements, material))
        return sections

    def _elastic(self, block: Block) -> None:
        """Read the elastic constants of the open material."""
        kind = block.parameters.get("TYPE", "ISO").upper()
        if not kind.startswith("ISO"):
            unnamed = f"of the elasticity {kind}"
            names = (name for start, name in _KINDS.items() if kind.startswith(start))
            self._change(other=next(names, unnamed))
            return
        rows = [
            _numbers(replace(block, data=[line]), 2, "an elastic constant") for line in block.data
        ]
        if any(row != rows[0] for row in rows):
            self._change(other="of elastic constants that depend on the temperature or on a field")
        elif rows:
            self._change(youngs_modulus=rows[0][0], poissons_ratio=rows[0][1])

    def _change(self, **values: float | str) -> None:
        """Change fields of the open material."""
        self._materials[self._open] = replace(self._materials[self._open], **values)  # type: ignore[arg-type]


def _numbers(block: Block, count: int, what: str) -> list[float]:
    """Return the first numbers of the first data line of a block; NaN where there are none."""
    if not block.data:
        return [math.nan] * count
    line = block.data[0]
    texts = [*(text.strip() for text in line.text.split(",")), *count * [""]]
    return [nastran_real(text, line, what, blank=math.nan) for text in texts[:count]]
