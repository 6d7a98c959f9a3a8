"""What measured restitutions tell: the rows of their table, and fits over the speed."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.calibration.bounces.charts import restitution_chart
from vibroimpact.calibration.bounces.report import answer_of_fits, fits_document, law_sentences
from vibroimpact.calibration.restitutions.restitutions import Restitutions
from vibroimpact.charts.made import made_charts
from vibroimpact.contact.speed_function import toml_of
from vibroimpact.report.report import Column, Note, Paragraph, Report, Section, Table
from vibroimpact.results.csv_files import write_rows
from vibroimpact.units.display import MISSING, column_texts


def report_of(restitutions: Restitutions) -> Report:
    """Return the report of measured restitutions."""
    fits = [Paragraph(sentence) for sentence in law_sentences(restitutions)]
    if restitutions.function is not None:
        fits.append(Paragraph(case_sentence(restitutions)))
    rows = Section(
        "impacts",
        "Row by row",
        (restitution_table(restitutions), Note(noise_sentence(restitutions))),
    )
    return Report(
        title=f"Restitutions of {Path(restitutions.source).name}",
        answer=status_sentence(restitutions),
        quantities=list(answer_of_fits(restitutions)),
        sections=(Section("fits", "Fits over the approach speed", fits), rows),
        charts=made_charts({"restitution": partial(restitution_chart, restitutions)}),
        warnings=restitutions.doubts,
        files={"restitutions.csv": partial(_write_restitutions, restitutions)},
        summary=_summary(restitutions),
        provenance=restitutions.source,
    )


def restitution_table(restitutions: Restitutions) -> Table:
    """Return the table of the restitutions with their intervals."""
    decimals = max(0, -round(math.log10(restitutions.rounding))) + 1
    intervals = []
    for low, high in restitutions.intervals:
        interval = MISSING
        if math.isfinite(low):
            interval = f"{low:.{decimals}f} to {high:.{decimals}f}"
        intervals.append(interval)
    rows = [str(row + 1) for row in range(len(restitutions.count))]
    return Table(
        (
            Column("Row", rows, is_text=True),
            Column("Approach speed", column_texts(restitutions.approach_speed, 4), "m/s"),
            Column("Restitution", column_texts(restitutions.restitution, 4)),
            Column(f"Interval, {100.0 * restitutions.confidence:g} %", intervals),
            Column("Impacts", [f"{number:.0f}" for number in restitutions.count]),
        )
    )


def status_sentence(restitutions: Restitutions) -> str:
    """Return how many restitutions there are."""
    impact_count = int(restitutions.count.sum())
    row_count = len(restitutions.count)
    ending = "s" if row_count > 1 else ""
    means = ""
    if impact_count != row_count:
        means = f", means of {impact_count} impacts"
    return f"{row_count} restitution{ending} over the approach speed{means}."


def noise_sentence(restitutions: Restitutions) -> str:
    """Return from where the intervals are."""
    many = len(restitutions.count) > 1
    deviations_known = not math.isnan(restitutions.deviation[0])
    sources = []
    if deviations_known and many:
        sources.append("the standard deviations of the table and the scatter beyond them")
    elif deviations_known:
        sources.append("the standard deviation of the table")
    elif many:
        sources.append("the scatter about each fit")
    if restitutions.by_speeds:
        what = f"{restitutions.rounding:g} m/s to which the separation speeds"
    else:
        what = f"{restitutions.rounding:g} to which the values"
    sources.append(f"the step of {what} are rounded")
    means = ""
    if not (restitutions.count == 1.0).all():
        means = " A scatter is that of single impacts."
    exact = "approach speeds" if restitutions.by_speeds else "speeds"
    return (
        f"The intervals of the fits follow from {', and from '.join(sources)}; {exact} "
        f"are taken as exact.{means}"
    )


def case_sentence(restitutions: Restitutions) -> str:
    """Return the linear fit as a case takes it."""
    assert restitutions.function is not None
    return f'In a case: law = "newton", restitution = {toml_of(restitutions.function)}'


def restitution_rows(restitutions: Restitutions) -> list[dict[str, Any]]:
    """Return the restitutions, one mapping each; None where there is no value."""
    columns = {
        "approach_speed_m_s": restitutions.approach_speed,
        "restitution": restitutions.restitution,
        "restitution_standard_deviation": restitutions.deviation,
        "restitution_low": restitutions.intervals[:, 0],
        "restitution_high": restitutions.intervals[:, 1],
        **{f"{law.name}": law(restitutions.approach_speed) for law in restitutions.laws},
    }
    return [
        {
            "count": int(number),
            **{name: _finite(values[row]) for name, values in columns.items()},
        }
        for row, number in enumerate(restitutions.count)
    ]


def _write_restitutions(restitutions: Restitutions, path: Path) -> None:
    """Write the restitutions as a table."""
    rows = restitution_rows(restitutions)
    write_rows(rows, path)


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _summary(restitutions: Restitutions) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    by_speed = None
    if restitutions.function is not None:
        by_speed = restitutions.function.table()
    return {
        "name": Path(restitutions.source).name,
        "version": __version__,
        "restitutions": {
            "file": restitutions.source,
            "confidence": restitutions.confidence,
            "rounding": restitutions.rounding,
            "rows": restitution_rows(restitutions),
            "fits": fits_document(restitutions.laws, restitutions.confidence),
            "by_speed": by_speed,
            "doubts": list(restitutions.doubts),
        },
    }
