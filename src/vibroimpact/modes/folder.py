"""Write the modes of a case: tables, pictures, and the meshes for other programs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import tomli_w

from vibroimpact._version import __version__
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.meshes.write_abaqus import write_abaqus
from vibroimpact.meshes.write_nastran import write_nastran
from vibroimpact.meshes.write_vtu import write_vtu
from vibroimpact.modes.shapes import draw_modes
from vibroimpact.report.figure_files import save_figures
from vibroimpact.results.csv_files import write_csv
from vibroimpact.results.folder import SUMMARY, new_folder
from vibroimpact.results.peaks import known_errors

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
_POINT_COLUMNS = ("body", "point", "mode", "frequency_Hz", "shape_x_per_sqrt_kg", "shape_y_per_sqrt_kg", "shape_z_per_sqrt_kg")
_SHAPES_WRITTEN = 50  # limits the size of the file for ParaView


def save_modes(case: Case, modes: Mapping[str, BodyModes], directory: str | PathLike[str], *, force: bool = False) -> Path:
    """Write the modes of a case into a folder, atomically.

    Parameters
    ----------
    case : Case
        The case.
    modes : mapping of str to BodyModes
        Modes of its bodies, from `compute_modes`.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing result folder.

    Returns
    -------
    pathlib.Path
        The folder: `modes.csv`, `points.csv` if points are watched, `summary.json`, `case.toml`, `figures/`, and for each body its
        mesh as .bdf and .inp and its shapes as .vtu.

    Raises
    ------
    InputError
        If the folder exists and may not be replaced, or it can't be written to.
    """
    with new_folder(directory, force=force) as folder:
        (folder / "case.toml").write_text(tomli_w.dumps(resolved_case(case)), encoding="utf-8")
        write_csv([row for name, body in modes.items() for row in mode_rows(name, body)], list(MODE_COLUMNS), folder / "modes.csv")
        points = [row for name, body in modes.items() for row in _point_rows(name, body)]
        if points:
            write_csv(points, list(_POINT_COLUMNS), folder / "points.csv")
        summary = {"name": case.name, "version": __version__, "modes": {name: _body_summary(body) for name, body in modes.items()}}
        (folder / SUMMARY).write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n", encoding="utf-8")
        (folder / "figures").mkdir()
        save_figures({f"{name}_modes": draw_modes(body.model, name) for name, body in modes.items()}, folder / "figures")
        for name, body in modes.items():
            _write_meshes(folder, name, body, getattr(case, name).material)
    return Path(directory)


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


def _point_rows(name: str, body: BodyModes) -> list[dict[str, Any]]:
    return [
        dict(zip(_POINT_COLUMNS, (name, point, mode + 1, float(body.basis.frequencies[mode]), *map(float, shape)), strict=True))
        for point, shapes in body.basis.points.items()
        for mode, shape in enumerate(shapes)
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


def _write_meshes(folder: Path, name: str, body: BodyModes, material: Any) -> None:
    model = body.model
    thickness = model.thickness or None
    write_nastran(model.mesh, folder / f"{name}.bdf", material, f"vibroimpact: {name}", thickness)
    write_abaqus(model.mesh, folder / f"{name}.inp", material, thickness)
    shapes = {
        f"mode {mode + 1:03d}, {model.frequencies[mode]:.6g} Hz": model.displacements(mode)
        for mode in range(min(_SHAPES_WRITTEN, len(model.frequencies)))
    }
    write_vtu(model.mesh, folder / f"{name}.vtu", shapes)
