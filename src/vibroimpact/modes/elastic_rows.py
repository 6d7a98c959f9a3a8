"""Facts on elastic bodies before their modes are computed."""

from __future__ import annotations

from vibroimpact.cases.case import Case
from vibroimpact.cases.elastic.chosen_modes import chosen_for
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.modes.document import mesh_facts
from vibroimpact.modes.tables import supports_text


def elastic_rows(case: Case) -> list[tuple[str, str]]:
    """Return the facts on the elastic bodies of a case that `check` prints: mesh, modes, damping
    and supports.

    Raises
    ------
    InputError
        If a mesh can't be generated, or an object that must lie on it does not.
    """
    rows: list[tuple[str, str]] = []
    meshes = mesh_facts(case)
    for name, body in elastic_bodies(case).items():
        mesh = meshes[name]
        reduction = body.recipe.reduction
        if reduction.modes:
            kept = f"{reduction.modes} modes"
        else:
            kept = f"modes up to {reduction.max_frequency:g} Hz"
        kept += chosen_for(case, name)
        method: str = reduction.method
        if reduction.attachment:
            method += ", with an attachment mode"
        stored = "not computed yet"
        if mesh["modes_computed"]:
            stored = "computed already"
        rows += [
            (
                f"elastic {name}",
                f"{mesh['elements']}, {mesh['nodes']} nodes, {mesh['degrees_of_freedom']} "
                "degrees of freedom before supports",
            ),
            ("  modes", f"{kept}, {method}; {stored}"),
            ("  damping", body.damping.description),
            ("  held by", supports_text(body)),
        ]
        if mesh["materials"]:
            rows.append(("  materials", mesh["materials"]))
        rows += [("  of the file", remark) for remark in mesh["remarks"]]
    return rows
