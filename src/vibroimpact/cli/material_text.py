"""What `materials` prints: the table of all, and the sheet of one with its sources."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.materials import find_material, material_library
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable, facts, numbers


def material_library_table() -> RenderableType:
    """Return the table of shipped materials."""
    library = material_library()
    columns = (
        TerminalColumn("name", list(library), text=True),
        numbers("density", "kg/m3", [f"{one.density:g}" for one in library.values()]),
        numbers("Young's", "GPa", [f"{one.youngs_modulus / 1e9:g}" for one in library.values()]),
        numbers("Poisson's", "-", [f"{one.poissons_ratio:g}" for one in library.values()]),
        TerminalColumn("what", [one.description for one in library.values()], text=True),
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
    material, rows = find_material(name), []
    for key, unit in (
        ("density", "kg/m3"),
        ("youngs_modulus", "Pa"),
        ("poissons_ratio", ""),
        ("yield_strength", "Pa"),
        ("compressive_strength", "Pa"),
        ("tensile_strength", "Pa"),
        ("loss_factor", ""),
    ):
        value = getattr(material, key)
        if value is not None:
            rows.append(
                (key, f"{value:g}\u00a0{unit}".strip("\u00a0"), material.sources.get(key, ""))
            )
    note = [Text(material.note)] if material.note else []
    return Group(Text(f"{material.name}: {material.description}", style="bold"), facts(rows), *note)


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
