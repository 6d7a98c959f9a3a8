"""Facts on elastic bodies before their modes are computed."""

from __future__ import annotations

from vibroimpact.cases.case import Case
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
        stored = "computed already" if mesh["modes_computed"] else "not computed yet"
        rows += [
            (
                f"elastic {name}",
                f"{mesh['elements']}, {mesh['nodes']} nodes, {mesh['degrees_of_freedom']} "
                "degrees of freedom before supports",
            ),
            (
                "  modes",
                f"{kept}, "
                f"{reduction.method}{', with an attachment mode' if reduction.attachment else ''}; "
                f"{stored}",
            ),
            ("  damping", body.damping.description),
            ("  held by", supports_text(body)),
        ]
        rows += [("  materials", mesh["materials"])] if mesh["materials"] else []
        rows += [("  of the file", remark) for remark in mesh["remarks"]]
    return rows
