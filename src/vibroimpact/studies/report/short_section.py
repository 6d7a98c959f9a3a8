"""What the terminal shows of a study below its answer: its drops, or the spread of results."""

from __future__ import annotations

from vibroimpact.report.report import Block, Column, Note, Section, Table
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.answer import FEW_DROPS
from vibroimpact.studies.report.labels import with_unit
from vibroimpact.studies.report.outputs import Output
from vibroimpact.studies.report.percentiles import PERCENTILES
from vibroimpact.studies.report.tables import main_results, points_table, reason_sentences
from vibroimpact.units.display import digits

_RESULTS = 5
_REASONS = 3
_PERCENTILES = (5, 50, 95)  # those shown


def short_section(study: Study, outputs: list[Output]) -> Section:
    """Return the drops, or of many the main results, after the reasons of drops that failed; they
    fit on a screen.

    Parameters
    ----------
    study : Study
        The study.
    outputs : list of Output
        All its results, the most important first.
    """
    blocks: list[Block] = [
        Note(reason, is_warning=True) for reason in reason_sentences(study)[:_REASONS]
    ]
    if study.size <= FEW_DROPS:
        table = points_table(study, outputs)
    else:
        table = _distribution_table(main_results(outputs, _RESULTS))
    if table is not None:
        blocks.append(table)
    return Section("results", "", blocks, medium="terminal")


def _distribution_table(outputs: list[Output]) -> Table | None:
    """Return the names of results, and their percentiles; None without any."""
    if not outputs:
        return None
    names = [with_unit(output.title, output.scale.unit) for output in outputs]
    columns = [Column("result", names, is_text=True)]
    for percentile in _PERCENTILES:
        number = PERCENTILES.index(percentile)
        cells = [
            digits(output.spread.percentiles[number] / output.scale.size) for output in outputs
        ]
        columns.append(Column(f"{percentile}\u00a0%", cells))
    return Table(columns)
