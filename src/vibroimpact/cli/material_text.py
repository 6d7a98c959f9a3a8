"""What `materials` prints: the table of all, and the sheet of one with its sources."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.materials import find_material, material_library
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable, facts, numbers

_UNITS = {
    "density": "kg/m3",
    "youngs_modulus": "Pa",
    "poissons_ratio": "",
    "yield_strength": "Pa",
    "compressive_strength": "Pa",
    "tensile_strength": "Pa",
    "hardness": "Pa",
    "loss_factor": "",
}


def material_library_table() -> RenderableType:
    """Return the table of shipped materials."""
    library = material_library()
    materials = library.values()
    densities = [f"{material.density:g}" for material in materials]
    moduli = [f"{material.youngs_modulus / 1e9:g}" for material in materials]
    poissons_ratios = [f"{material.poissons_ratio:g}" for material in materials]
    columns = (
        TerminalColumn("name", list(library), text=True),
        numbers("density", "kg/m3", densities),
        numbers("Young's", "GPa", moduli),
        numbers("Poisson's", "-", poissons_ratios),
        TerminalColumn("what", [material.description for material in materials], text=True),
    )
    notes = (
        'Also "rigid" for a plate. "vibroimpact materials NAME" gives the source of each '
        "number. Rock and coal vary widely."
    )
    return Group(TerminalTable(columns), Text(), Text(notes))


def material_sheet(name: str) -> RenderableType:
    """Return one material with the source of each number.

    Raises
    ------
    InputError
        If the material is unknown.
    """
    material = find_material(name)
    rows = []
    for key, unit in _UNITS.items():
        value = getattr(material, key)
        if value is not None:
            quantity = f"{value:g}\u00a0{unit}".strip("\u00a0")
            rows.append((key, quantity, material.sources.get(key, "")))
    title = Text(f"{material.name}: {material.description}", style="bold")
    if not material.note:
        return Group(title, facts(rows))
    return Group(title, facts(rows), Text(material.note))


def materials_document() -> dict[str, Any]:
    """Return the shipped materials by name."""
    return {"materials": {name: material_document(name) for name in material_library()}}


def material_document(name: str) -> dict[str, Any]:
    """Return one material with the keys of a case file, in SI, and the source of each number.

    Raises
    ------
    InputError
        If the material is unknown.
    """
    return asdict(find_material(name))
