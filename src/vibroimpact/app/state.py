"""What the live page shows of a case: computed, and as a document with arrays."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any, NamedTuple

import numpy as np
import tomli_w

from vibroimpact.app.draft import draft_of, drafted
from vibroimpact.app.messages import Detail
from vibroimpact.app.served_cases import check_bounds, check_table
from vibroimpact.cases.case import Case
from vibroimpact.cases.reader import case_of
from vibroimpact.charts.made import drawn, made_charts
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.report.report import Table
from vibroimpact.report.result_warning import size_of
from vibroimpact.results.result import Result, result_of
from vibroimpact.runs.answer import answer_of, answer_of_impacts
from vibroimpact.runs.charts import chart_makers
from vibroimpact.runs.scene import rigid_scene, scene_of
from vibroimpact.runs.tables import impact_table, ledger_table

Tell = Callable[[str, float], None]
"""Function that is told what is being computed, and the fraction done; it raises to give it up."""

MODES = "computing modes"
"""What is told while modes are computed, which may take long."""


class State(NamedTuple):
    """A case that was computed: its response and result, and the document that shows it."""

    case: Case
    response: Response
    result: Result
    document: dict[str, Any]


def state_of(
    table: dict[str, Any], detail: Detail, tell: Tell, looked_at: Collection[str] | None = None
) -> State:
    """Return a case, computed.

    Parameters
    ----------
    table : dict
        The case, with the structure of a TOML case file.
    detail : str
        "draft" while the case is being changed, or "full".
    tell : callable
        Told what is being computed and how far it is.
    looked_at : collection of str, optional
        Names of the charts that are made; by default all.

    Raises
    ------
    InputError
        If it is not a valid case, with the words of the command line, or too large for the live
        page.

    Examples
    --------
    >>> from vibroimpact.cases.reader import load_table
    >>> state = state_of(load_table("paper:type1-theory"), "full", lambda what, part: None)
    >>> state.document["status"]
    'Stopped after 5 impacts, at the top of the last rebound, at 5.11709 s.'
    """
    check_table(table)
    case = case_of(table)
    check_bounds(case)
    problem = case.to_problem(lambda fraction: tell(MODES, fraction), lambda note: None)
    is_draft = detail == "draft"
    response = simulate(
        drafted(problem) if is_draft else problem, lambda fraction: tell("simulating", fraction)
    )
    tell("reading histories", 1.0)
    result = draft_of(response) if is_draft else result_of(response)
    tell("drawing", 1.0)
    return State(case, response, result, _document(result, table, detail, looked_at))


def _warnings(result: Result) -> list[dict[str, str]]:
    """Return the warnings with the sizes of their effects."""
    return [{"text": str(warning), "size": size_of(warning)} for warning in result.doubts]


def _document(
    result: Result, table: dict[str, Any], detail: Detail, looked_at: Collection[str] | None
) -> dict[str, Any]:
    makers = chart_makers(result)
    # the plate in motion takes the place of its maps
    names = [name for name in makers if name != "deflection"]
    makers_looked_at = {
        name: makers[name] for name in names if looked_at is None or name in looked_at
    }
    is_full = detail == "full"
    return {
        "name": result.name,
        "status": result.status,
        "answer": [
            {
                "name": quantity.name,
                "text": quantity.text,
                "error": quantity.error_text,
                "note": quantity.note,
            }
            # the signals of a draft are computed where they are looked at
            for quantity in (answer_of(result) if is_full else answer_of_impacts(result))
        ],
        "warnings": _warnings(result) if is_full else [],
        "impacts": _impacts(result),
        "ledger": _ledger(result),
        "charts": [drawn(chart, plotly_chart) for chart in made_charts(makers_looked_at)],
        "names": names,
        "scene": rigid_scene(result) if result.deflection is None else scene_of(result),
        "case": result.case,
        "toml": tomli_w.dumps(table),
        "detail": detail,
        "signals": _signals(result) if is_full else [],
        "frequencies": {body: np.array(result.frequencies(body)) for body in ("sphere", "plate")},
    }


def _impacts(result: Result) -> dict[str, Any]:
    return table_document(impact_table(result))


def table_document(table: Table) -> dict[str, Any]:
    """Return a table as the page shows it."""
    return {
        "headers": table.headings,
        "rows": table.rows,
        "left_out": 0 if table.gap is None else table.gap.left_out,
    }


def _ledger(result: Result) -> dict[str, Any]:
    unit, rows = ledger_table(result)
    return {"unit": unit, "rows": [[row.title, row.energy, row.part] for row in rows]}


def _signals(result: Result) -> list[dict[str, Any]]:
    return [
        {
            "name": name,
            "rate": signal.sensor.rate,
            "unit": signal.sensor.unit,
            "value": signal.value,
        }
        for name, signal in result.signals.items()
    ]
