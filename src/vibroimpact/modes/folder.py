"""Write the modes of a case: tables, the report page, and the meshes for other programs;
figures where they are asked for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.meshes.write_abaqus import write_abaqus
from vibroimpact.meshes.write_nastran import write_nastran
from vibroimpact.meshes.write_vtu import write_vtu
from vibroimpact.modes.charts import mode_charts
from vibroimpact.modes.document import (
    MODE_COLUMNS,
    POINT_COLUMNS,
    mode_rows,
    point_rows,
    summary_of_modes,
)
from vibroimpact.modes.measured_table import MeasuredTable
from vibroimpact.modes.page import modes_page
from vibroimpact.results.csv_files import write_csv
from vibroimpact.results.folder import CASE, REPORT, new_folder, write_case, write_summary

_SHAPES_WRITTEN = 50  # limits the size of the file for ParaView


def save_modes(
    case: Case,
    modes: Mapping[str, BodyModes],
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
    measured: MeasuredTable | None = None,
) -> Path:
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
    figures : sequence of str
        Formats in which the charts are also written as files, into a folder `figures`: of "png",
        "svg" and "pdf".
    measured : MeasuredTable, optional
        Measured modes, for the report and `measured.csv`.

    Returns
    -------
    pathlib.Path
        The folder: `report.html`, `modes.csv`, `points.csv` if points are watched, `summary.json`,
        `case.toml`, and for each body its mesh as .bdf and .inp and its shapes as .vtu.

    Raises
    ------
    InputError
        If the folder exists and may not be replaced, or it can't be written to.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> case = vi.case_of(
    ...     {
    ...         "sphere": {
    ...             "radius": "25 mm",
    ...             "material": "rock-paper",
    ...             "model": "elastic",
    ...             "modes": 5,
    ...         },
    ...         "plate": {"material": "rigid"},
    ...         "drop": {"speed": 1.0},
    ...         "contact": {"law": "hertz"},
    ...     }
    ... )
    >>> with TemporaryDirectory() as folder:
    ...     place = vi.save_modes(case, vi.compute_modes(case), f"{folder}/modes")
    ...     sorted(file.name for file in place.iterdir())
    ['case.toml', 'modes.csv', 'report.html', 'sphere.bdf', 'sphere.inp', 'sphere.vtu',
    'summary.json']
    """
    with new_folder(directory, force=force) as folder:
        write_case(resolved_case(case), folder / CASE)
        write_csv(
            [row for name, body in modes.items() for row in mode_rows(name, body)],
            list(MODE_COLUMNS),
            folder / "modes.csv",
        )
        points = [row for name, body in modes.items() for row in point_rows(name, body)]
        if points:
            write_csv(points, list(POINT_COLUMNS), folder / "points.csv")
        if measured is not None:
            write_csv(
                [dict(row) for row in measured.rows],
                list(measured.columns),
                folder / "measured.csv",
            )
        summary = summary_of_modes(case, modes)
        write_summary(summary, folder)
        charts = mode_charts(modes)
        (folder / REPORT).write_text(modes_page(case, modes, charts, measured), encoding="utf-8")
        write_figures(charts, folder, figures)
        for name, body in modes.items():
            _write_meshes(folder, name, body, getattr(case, name).material)
    return Path(directory)


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
