"""What the command line prints of modes, and of elastic bodies before they are computed."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from rich.console import Group, RenderableType
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from vibroimpact.bodies.elastic import ElasticBody
from vibroimpact.cases.build_elastic import elastic_bodies
from vibroimpact.cases.modes import BodyModes
from vibroimpact.cases.schema import Case
from vibroimpact.structures.recipe import model_key
from vibroimpact.structures.store import has_model
from vibroimpact.structures.surface import place_of, surface_motion

_ROWS = 20


def modes_summary(case: Case, modes: Mapping[str, BodyModes]) -> RenderableType:
    """Return what is printed of the modes of a case: what each body is, its lowest modes, and what to doubt."""
    parts: list[RenderableType] = [Text(case.name or "modes", style="bold")]
    for name, found in modes.items():
        properties = found.model.properties
        facts = Table.grid(padding=(0, 2))
        rows = [
            (
                name,
                f"{properties.mass:.6g} kg, {found.model.facts['elements']}, {found.model.facts['degrees of freedom']} degrees of freedom",
            ),
            ("held by", _supports(found.body)),
            ("rigid motions", str(len(found.model.left))),
            ("damping", found.body.damping.words),
        ]
        if "left out of the file" in found.model.facts:
            rows.append(("left out of the file", found.model.facts["left out of the file"]))
        for row in rows:
            facts.add_row(*(escape(cell) for cell in row))
        parts += [facts, _table(found), *(Text(f"Doubt: {doubt}.", style="yellow") for doubt in found.doubts), Text()]
    return Group(*parts[:-1])


def _table(found: BodyModes) -> Table:
    table = Table(box=None, padding=(0, 1), header_style="bold")
    for heading in (
        "mode",
        "frequency\n[Hz]",
        "within\n[%]",
        "damping\nratio",
        "shape at contact\n[1/sqrt kg]",
        "effective mass, vertical\n[kg]",
    ):
        table.add_column(escape(heading), justify="right", no_wrap=True, vertical="bottom")
    basis = found.basis
    for mode in range(min(_ROWS, len(basis.frequencies))):
        table.add_row(
            str(mode + 1),
            f"{basis.frequencies[mode]:.6g}",
            _within(found.model.frequency_errors[mode]),
            f"{basis.damping_ratios[mode]:.4g}",
            _clean(basis.contact[mode], float(np.abs(basis.contact).max())),
            _clean(basis.participation[mode, 2] ** 2, found.model.properties.mass),
        )
    if len(basis.frequencies) > _ROWS:
        table.add_row("...", f"{basis.frequencies[-1]:.6g}", _within(found.model.frequency_errors[-1]), "", "", "")
    return table


def _within(error: float) -> str:
    """Return in per cent by how much a frequency may be off."""
    return f"{100.0 * error:.2g}" if np.isfinite(error) else "not known"


def _clean(value: float, whole: float) -> str:
    """Return a number, or 0 where it is rounding of the whole."""
    return f"{value:.4f}" if abs(value) > 1e-6 * whole else "0"


def elastic_rows(case: Case) -> list[tuple[str, str]]:
    """Return what `check` says of the elastic bodies of a case: their mesh, supports, modes and damping.

    Raises
    ------
    InputError
        If a mesh can't be made.
    """
    rows: list[tuple[str, str]] = []
    for name, body in elastic_bodies(case).items():
        mesh = body.recipe.shape.mesh(body.recipe.supports)
        points = {"the contact point": (body.contact, body.side), **{f'sensor "{key}"': place for key, place in body.watched.items()}}
        for what, (spot, side) in points.items():  # are they on the body?
            surface_motion(mesh, np.array([place_of(mesh, spot, side)]), side, what=f"{name}: {what}")
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
            ("  damping", body.damping.words),
            ("  held by", _supports(body)),
        ]
    return rows


def _supports(body: ElasticBody) -> str:
    return "; ".join(support.words for support in body.recipe.supports) or "nothing: it is free"
