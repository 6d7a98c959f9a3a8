"""The modes of a case as data: the tables and the summary of their folder, and what
`modes --json` and `check --json` print.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.cases.case import Case
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.cases.elastic.meshes import meshes_of
from vibroimpact.cases.elastic.modes import BodyModes, Modes
from vibroimpact.results.peaks import known_errors
from vibroimpact.structures.finite_elements.stated_materials import contradictions
from vibroimpact.structures.recipe import model_key
from vibroimpact.structures.store import has_model

MODE_COLUMNS = (
    "body",
    "mode",
    "frequency_Hz",
    "damping_ratio",
    "frequency_error",
    "contact_shape_per_sqrt_kg",
    "effective_mass_x_kg",
    "effective_mass_y_kg",
    "effective_mass_z_kg",
)
POINT_COLUMNS = (
    "body",
    "point",
    "mode",
    "frequency_Hz",
    "shape_x_per_sqrt_kg",
    "shape_y_per_sqrt_kg",
    "shape_z_per_sqrt_kg",
)


def modes_document(modes: Modes, summary: Mapping[str, Any]) -> dict[str, Any]:
    """Return what `modes --json` prints: the summary of the folder, and for each body the
    rows of `modes.csv` and `points.csv`.
    """
    tables = {
        name: {"modes": mode_rows(name, body), "points": point_rows(name, body)}
        for name, body in modes.items()
    }
    return {
        **summary,
        "modes": {name: {**entry, **tables[name]} for name, entry in summary["modes"].items()},
    }


def summary_of_modes(modes: Modes) -> dict[str, Any]:
    """Return the content of `summary.json` in the folder of modes."""
    return {
        "name": modes.case.name,
        "version": __version__,
        "modes": {name: _body_summary(body) for name, body in modes.items()},
    }


def mesh_facts(case: Case) -> dict[str, dict[str, Any]]:
    """Return what is known of the mesh of each elastic body of a case before its modes are
    computed.

    Raises
    ------
    InputError
        If a mesh can't be generated, or an object that must lie on it does not.
    """
    meshes = meshes_of(case)
    return {
        name: {
            "elements": ", ".join(
                f"{len(block.connectivity)} {block.kind}" for block in meshes[name].blocks
            ),
            "nodes": len(meshes[name].nodes),
            "degrees_of_freedom": meshes[name].dofs_per_node * len(meshes[name].nodes),
            "modes_computed": has_model(model_key(body.recipe)),
            "materials": meshes[name].materials_text,
            "remarks": [
                *meshes[name].remarks,
                *contradictions(meshes[name].stated, getattr(case, name).material),
            ],
        }
        for name, body in elastic_bodies(case).items()
    }


def mode_rows(name: str, body: BodyModes) -> list[dict[str, Any]]:
    """Return the modes of a body as rows of `MODE_COLUMNS`."""
    basis = body.basis
    return [
        dict(
            zip(
                MODE_COLUMNS,
                (
                    name,
                    mode + 1,
                    float(basis.frequencies[mode]),
                    float(basis.damping_ratios[mode]),
                    float(body.model.frequency_errors[mode]),
                    float(basis.contact[mode]),
                    *(float(value) ** 2 for value in basis.participation[mode]),
                ),
                strict=True,
            )
        )
        for mode in range(len(basis.frequencies))
    ]


def point_rows(name: str, body: BodyModes) -> list[dict[str, Any]]:
    """Return the shapes of a body at the watched points as rows of `POINT_COLUMNS`."""
    return [
        dict(
            zip(
                POINT_COLUMNS,
                (name, point, mode + 1, float(body.basis.frequencies[mode]), *map(float, shape)),
                strict=True,
            )
        )
        for point in body.body.watched
        for mode, shape in enumerate(body.basis.points[point])
    ]


def _body_summary(body: BodyModes) -> dict[str, Any]:
    properties = body.model.properties
    return {
        "frequencies_Hz": body.model.frequencies.tolist(),
        "frequency_errors": known_errors(body.model.frequency_errors, len(body.model.frequencies)),
        "mass_kg": properties.mass,
        "centre_of_mass_m": properties.centre.tolist(),
        "inertia_kg_m2": properties.inertia.tolist(),
        "rigid_motions": len(body.model.rigid_coefficients),
        "damping": body.body.damping.description,
        "supports": [support.description for support in body.body.recipe.supports],
        "mesh": dict(body.model.facts),
        "doubts": list(body.doubts),
    }
