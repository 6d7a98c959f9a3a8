"""HTML page of the modes of a case: frequencies and damping, shapes, and a plate in motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import tomli_w

from vibroimpact._version import __version__
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.made import made_scene
from vibroimpact.modes.charts import MOST_SHAPES, is_plate
from vibroimpact.modes.measured_table import MeasuredTable
from vibroimpact.modes.scene import mode_scene
from vibroimpact.modes.tables import ROWS, body_facts, mode_table, rows_left_out
from vibroimpact.report.page import render_page


def modes_page(
    case: Case,
    modes: Mapping[str, BodyModes],
    charts: Sequence[Chart],
    measured: MeasuredTable | None = None,
) -> str:
    """Return the page of the modes of a case as one self-contained HTML file.

    Parameters
    ----------
    case : Case
        The case.
    modes : mapping of str to BodyModes
        Modes of its bodies.
    charts : sequence of Chart
        The charts of these, as `mode_charts` returns them.
    measured : MeasuredTable, optional
        Measured modes, beside those of the plate.
    """
    plate = next((body for body in modes.values() if is_plate(body.model)), None)
    scene: dict[str, Any] | None = None
    lost: list[Chart] = []
    if plate is not None:
        scene, lost = made_scene(
            lambda: mode_scene(plate, min(MOST_SHAPES, len(plate.model.frequencies)))
        )
    name = case.name or "a case"
    return render_page(
        __package__,
        [*charts, *lost],
        scene,
        name=f"Modes of {name}",
        bodies=[_told(body, found) for body, found in modes.items()],
        measured=measured,
        lost=lost,
        moving=[] if scene is None else [one["name"] for one in scene["modes"]],
        case=tomli_w.dumps(resolved_case(case)),
        version=__version__,
    )


def _told(name: str, found: BodyModes) -> dict[str, Any]:
    """Return what the page tells of a body: its facts and doubts, its table with a row of
    dots where modes are left out, and its chart.
    """
    headers, rows = mode_table(found)
    if rows_left_out(found):
        rows.insert(ROWS, ["\u2026", *[""] * (len(headers) - 1)])
    return {
        "name": name,
        "facts": body_facts("mesh", found),
        "doubts": found.doubts,
        "headers": headers,
        "rows": rows,
        "estimated": any(heading == "within" for heading, _ in headers),
        "watched": bool(found.body.watched),
        "chart": f"{name}_modes",
    }
