"""HTML report of a run: set-up, tables, charts, plate in motion, case and provenance on
one page.
"""

from __future__ import annotations

from pathlib import Path

import tomli_w

from vibroimpact.charts.made import made_charts, made_scene
from vibroimpact.dynamics.energy import CLOSURE_LIMIT
from vibroimpact.files.result_folder import REPORT
from vibroimpact.report.page import render_page
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.results.result import Result
from vibroimpact.runs.below import level_below
from vibroimpact.runs.captions import left_out, scene_caption, sensors_left_out
from vibroimpact.runs.charts import run_charts
from vibroimpact.runs.deformation import deformation_rows, treatment_sentence
from vibroimpact.runs.scene import scene_of
from vibroimpact.runs.setup import setup_chart, setup_rows
from vibroimpact.runs.tables import SUM, impact_table, ledger_table
from vibroimpact.units.display import digits


def write_report(result: Result, directory: Path) -> None:
    """Write `report.html` into an existing directory.

    Parameters
    ----------
    result : Result
        Result of one drop.
    directory : pathlib.Path
        Existing directory.
    """
    (directory / REPORT).write_text(run_page(result), encoding="utf-8")


def run_page(result: Result) -> str:
    """Return the report as one self-contained HTML page whose charts can be explored.

    Parameters
    ----------
    result : Result
        Result of one drop.
    """
    unit, ledger = ledger_table(result)
    # the plate in motion takes the place of the maps of its deflection
    charts = [chart for chart in run_charts(result) if chart.name != "deflection"]
    scene, lost = (
        made_scene(lambda: scene_of(result)) if result.deflection is not None else (None, [])
    )
    charts += lost
    return render_page(
        __package__,
        [*made_charts({"setup": lambda: setup_chart(result)}), *charts],
        scene,
        name=result.name[:1].upper() + result.name[1:],
        status=result.status,
        failed=result.status.startswith("Failed"),
        setup=setup_rows(result),
        impacts=impact_table(result),
        level=level_below(result),
        rubs="friction_J" in result.energy,
        ledger_unit=unit,
        ledger=[(row.title, row.energy, row.part) for row in ledger],
        sum=SUM,
        closure=f"{digits(result.energy['closure_J'], 2)} J",
        closure_relative=digits(result.energy["closure_relative"], 2),
        closure_limit=digits(CLOSURE_LIMIT, 1),
        shown=[chart.name for chart in charts],
        left_out=left_out(result),
        sentence=treatment_sentence(result),
        deformation=deformation_rows(result),
        sensors_left_out=sensors_left_out(result),
        scene_caption=scene_caption(result) if scene is not None else "",
        case=_case_text(result.case),
        doubts=result.doubts,
        provenance=result.provenance,
    )


def _case_text(case: ResolvedCase) -> str:
    return tomli_w.dumps(case) if case else ""
