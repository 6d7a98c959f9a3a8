"""What a ranking of contact laws tells: the fit of each to measured restitutions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Line, Mark, Points
from vibroimpact.charts.palette import series
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.law_comparison.ranking import FittedLaw, Ranking
from vibroimpact.report.report import Column, Explanation, Facts, Note, Report, Section, Table
from vibroimpact.results.csv_files import write_rows
from vibroimpact.units.display import MISSING

_DRAWN = 5
"""Laws of which the curve is drawn, those with the least residuals and different curves."""

_SAME = 1e-6
"""Difference of restitutions up to which two laws have the same curve."""

_POINTS = 61


def report_of(ranking: Ranking) -> Report:
    """Return the report of a ranking of contact laws.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory")
    >>> found = vi.laws.rank_laws(case, [1.0, 2.0, 4.0], [0.83, 0.8, 0.77], ["newton", "tsuji"])
    >>> report = report_of(found)
    >>> report.title, list(report.files)
    ('2 contact laws by measured restitutions', ['ranking.csv'])
    """
    number = len(ranking.laws)
    fit = Section(
        "fit",
        "Fit of each law",
        (
            ranking_table(ranking),
            Note(
                "One for all is the value of the loss parameter that fits all speeds best; at the "
                "slowest and at the fastest speed the values beside it would be needed. All are in "
                "ranking.csv."
            ),
            Explanation(
                "The residual is the root mean square of achieved less measured restitution, "
                "weighted by the number of impacts; the largest is that of a single row. Laws of "
                "which the restitution does not depend on the speed have the same residual, that "
                "of a constant. Bodies are rigid but for their contact, without gravity. A dash "
                "stands for a value that does not exist: no value of the parameter achieves that "
                "restitution, or the law has none."
            ),
        ),
    )
    sections = [fit]
    if ranking.left_out:
        left_out = Facts(list(ranking.left_out.items()))
        sections.append(Section("left-out", "Laws left out", (left_out,)))
    ending = "" if number == 1 else "s"
    summary = _summary(ranking)
    return Report(
        title=f"{number} contact law{ending} by measured restitutions",
        answer=answer(ranking),
        sections=sections,
        charts=made_charts({"restitution": partial(_chart, ranking)}),
        files={"ranking.csv": partial(_write, ranking)},
        summary=summary,
        provenance=ranking.source,
    )


def answer(ranking: Ranking) -> str:
    """Return which law fits best, with which value, and how the others compare."""
    best = ranking.laws[0]
    value = ""
    if best.parameter:
        value = f" with {best.parameter} = {_value(best.value, best.unit)}"
    phrase = (
        f"{best.name} fits the {len(ranking.speed)} restitutions best{value}: the residual is "
        f"{best.residual:.2g}"
    )
    others = [law for law in ranking.laws[1:] if not _same_curve(law, best)]
    if others:
        phrase += f", in place of {others[0].residual:.2g} with {others[0].name}"
    return f"{phrase}."


def ranking_table(ranking: Ranking) -> Table:
    """Return the table of the laws, the best first."""
    slowest = int(np.argmin(ranking.speed))
    fastest = int(np.argmax(ranking.speed))
    laws = ranking.laws
    return Table(
        (
            Column("Law", [law.name for law in laws], is_text=True),
            Column("Residual", [f"{law.residual:.2g}" for law in laws]),
            Column("Largest", [f"{law.largest:.2g}" for law in laws]),
            Column("Parameter", [law.parameter or MISSING for law in laws], is_text=True),
            Column("One for all", [_number(law.value) for law in laws]),
            Column(
                f"At {ranking.speed[slowest]:.3g} m/s",
                [_number(law.own_values[slowest]) for law in laws],
            ),
            Column(
                f"At {ranking.speed[fastest]:.3g} m/s",
                [_number(law.own_values[fastest]) for law in laws],
            ),
            Column("Unit", [law.unit or MISSING for law in laws], is_text=True),
        )
    )


def _number(value: float) -> str:
    return f"{value:.4g}" if math.isfinite(value) else MISSING


def _value(value: float, unit: str) -> str:
    return f"{value:.4g} {unit}".rstrip()


def _same_curve(first: FittedLaw, second: FittedLaw) -> bool:
    return bool(np.max(np.abs(first.restitution - second.restitution)) < _SAME)


def _chart(ranking: Ranking) -> Chart:
    """Return the measured restitutions, and the curves of the best laws."""
    drawn: list[FittedLaw] = []
    for law in ranking.laws:
        if len(drawn) < _DRAWN and not any(_same_curve(law, other) for other in drawn):
            drawn.append(law)
    speeds = np.geomspace(ranking.speed.min(), ranking.speed.max(), _POINTS)
    marks: list[Mark] = [
        Line(
            speeds,
            np.asarray(achieved_restitution(ranking.functions[law.name], ranking.mass, speeds)),
            law.name,
            series(number),
        )
        for number, law in enumerate(drawn)
    ]
    marks.append(Points(ranking.speed, ranking.restitution, "measured"))
    panel = Panel(
        Axis("Approach speed", "m/s", log=True),
        Axis("Separation speed over approach speed"),
        tuple(marks),
    )
    caption = (
        "Lines: the laws that fit best, each with one value of its parameter; of laws with the "
        "same curve the first. Symbols: measured."
    )
    return Chart("restitution", "Restitution over the speed", ((panel,),), caption)


def ranking_rows(ranking: Ranking) -> list[dict[str, Any]]:
    """Return a row for each law and each measured restitution; None where there is no value."""
    return [
        {
            "law": law.name,
            "approach_speed_m_s": float(ranking.speed[row]),
            "count": int(ranking.count[row]),
            "restitution_measured": float(ranking.restitution[row]),
            "restitution_achieved": float(law.restitution[row]),
            "parameter": law.parameter or None,
            "unit": law.unit or None,
            "value_for_all": _finite(law.value),
            "value_for_this": _finite(law.own_values[row]),
        }
        for law in ranking.laws
        for row in range(len(ranking.speed))
    ]


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _write(ranking: Ranking, path: Path) -> None:
    """Write the fits as a table."""
    rows: Sequence[dict[str, Any]] = ranking_rows(ranking)
    write_rows(rows, path)


def _summary(ranking: Ranking) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    return {
        "name": ranking.name,
        "version": __version__,
        "ranking": {
            "source": ranking.source,
            "mass_kg": ranking.mass,
            "laws": [
                {
                    "law": law.name,
                    "parameter": law.parameter or None,
                    "unit": law.unit or None,
                    "value": _finite(law.value),
                    "residual": law.residual,
                    "largest": law.largest,
                    "own_values": [_finite(value) for value in law.own_values],
                }
                for law in ranking.laws
            ],
            "approach_speed_m_s": ranking.speed.tolist(),
            "restitution": ranking.restitution.tolist(),
            "left_out": ranking.left_out,
        },
    }
