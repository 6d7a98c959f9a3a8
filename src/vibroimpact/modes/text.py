"""Console output on modes, and on elastic bodies before their modes are computed."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.arrays import Floats
from vibroimpact.bodies.elastic import ElasticBody
from vibroimpact.cases.case import Case
from vibroimpact.cases.elastic.bodies import elastic_bodies
from vibroimpact.cases.elastic.meshes import meshes_of
from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable, facts, numbers, with_gap
from vibroimpact.structures.recipe import model_key
from vibroimpact.structures.store import has_model
from vibroimpact.units.display import MISSING, column_texts, fixed

_ROWS = 20


def modes_summary(case: Case, modes: Mapping[str, BodyModes]) -> RenderableType:
    """Return the console report on the modes of a case: each body, its lowest modes, and the doubts."""
    parts: list[RenderableType] = [Text(case.name or "modes", style="bold")]
    for name, found in modes.items():
        properties = found.model.properties
        rows = [
            (
                name,
                f"{properties.mass:.6g} kg, {found.model.facts['elements']}, {found.model.facts['degrees of freedom']} degrees of freedom",
            ),
            ("held by", _supports_text(found.body)),
            ("rigid motions", str(len(found.model.rigid_coefficients))),
            ("damping", found.body.damping.description),
        ]
        if "left out of the file" in found.model.facts:
            rows.append(("left out of the file", found.model.facts["left out of the file"]))
        parts += [facts(rows), _mode_table(found), *(Text(f"Doubt: {doubt}.", style="yellow") for doubt in found.doubts), Text()]
    return Group(*parts[:-1])


def _mode_table(found: BodyModes) -> TerminalTable:
    """Return the table of the lowest modes, and of the highest one if some are omitted."""
    basis, number = found.basis, len(found.basis.frequencies)
    shown = list(range(min(_ROWS, number))) + ([number - 1] if number > _ROWS else [])
    effective = basis.participation[:, 2] ** 2
    columns = (
        TerminalColumn("mode", [str(mode + 1) for mode in shown]),
        numbers("frequency", "Hz", column_texts(basis.frequencies[shown], 6)),
        numbers("within", "%", _error_texts(found.model.frequency_errors[shown])),
        TerminalColumn("damping ratio", column_texts(basis.damping_ratios[shown], 4)),
        numbers("shape at contact", "1/sqrt kg", _fixed_texts(basis.contact[shown], float(np.abs(basis.contact).max()))),
        numbers("effective mass, vertical", "kg", _fixed_texts(effective[shown], found.model.properties.mass)),
    )
    return TerminalTable(with_gap(columns, _ROWS) if number > _ROWS else columns)


def _error_texts(errors: Floats) -> list[str]:
    """Return relative frequency errors in per cent, as text."""
    return [cell if cell != MISSING else "not known" for cell in column_texts(100.0 * errors, 2)]


def _fixed_texts(values: Floats, reference: float) -> list[str]:
    """Return numbers with four decimals, or 0 where they are rounding errors relative to a reference value."""
    return [fixed(float(value), 4) if abs(value) > 1e-6 * reference else "0" for value in values]


def elastic_rows(case: Case) -> list[tuple[str, str]]:
    """Return the facts on the elastic bodies of a case that `check` prints: mesh, modes, damping and supports.

    Raises
    ------
    InputError
        If a mesh can't be generated, or an object that must lie on it does not.
    """
    rows: list[tuple[str, str]] = []
    meshes = meshes_of(case)
    for name, body in elastic_bodies(case).items():
        mesh = meshes[name]
        elements = ", ".join(f"{len(block.connectivity)} {block.kind}" for block in mesh.blocks)
        reduction = body.recipe.reduction
        kept = f"{reduction.modes} modes" if reduction.modes else f"modes up to {reduction.max_frequency:g} Hz"
        stored = "computed already" if has_model(model_key(body.recipe)) else "not computed yet"
        rows += [
            (
                f"elastic {name}",
                f"{elements}, {len(mesh.nodes)} nodes, {mesh.dofs_per_node * len(mesh.nodes)} degrees of freedom before supports",
            ),
            ("  modes", f"{kept}, {reduction.method}{', with an attachment mode' if reduction.attachment else ''}; {stored}"),
            ("  damping", body.damping.description),
            ("  held by", _supports_text(body)),
        ]
    return rows


def _supports_text(body: ElasticBody) -> str:
    return "; ".join(support.description for support in body.recipe.supports) or "nothing: it is free"
