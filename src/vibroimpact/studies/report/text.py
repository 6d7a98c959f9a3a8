"""Terminal summary of a completed study: number of drops, main results, and the key with
the largest effect on each.
"""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.report.terminal_report import warning_lines
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.studies.percentiles import PERCENTILES
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.labels import drops_text, percent, with_unit
from vibroimpact.studies.report.outputs import study_outputs
from vibroimpact.studies.report.restitution import restitution_sentence, summarize_restitution
from vibroimpact.studies.report.sensitivity_table import (
    RANKS,
    SOBOL,
    Sensitivity,
    sensitivity_of,
    strongest,
)
from vibroimpact.studies.report.tables import (
    COUNTED_FROM,
    counts_sentence,
    doubt_sentences,
    reasons,
)
from vibroimpact.studies.study import Study
from vibroimpact.units.display import digits

_RESULTS, _REASONS = 5, 3
_TOLD = (5, 50, 95)  # percentiles shown
_NARROW = 70  # width of a terminal below which sensitivities are not shown


def study_summary(study: Study, width: int) -> RenderableType:
    """Return the summary for a terminal of a width; it fits on a screen."""
    there = [one for one in study_outputs(study, most=_RESULTS + 3) if one.spread.drops]
    outputs = ([one for one in there if one.spread.varies] or there)[:_RESULTS]
    found = sensitivity_of(study, outputs)
    told = found if width >= _NARROW else None
    columns = [
        TerminalColumn(
            "result", [with_unit(one.title, one.scale.unit) for one in outputs], text=True
        )
    ]
    for part in _TOLD:
        cells = [
            digits(one.spread.percentiles[PERCENTILES.index(part)] / one.scale.size)
            for one in outputs
        ]
        columns.append(TerminalColumn(f"{part}\u00a0%", cells))
    if told is not None:
        named = told.way == RANKS and any(not axis.numeric for axis in study_axes(study))
        heading = "most sensitive, of numeric keys, to" if named else "most sensitive to"
        columns.append(
            TerminalColumn(heading, [_strongest(told, one.name) for one in outputs], text=True)
        )
    why = [
        Text(f" {drops_text(number)}{', such as' if number > 1 else ''}: {words}", style="yellow")
        for number, words in reasons(study)[:_REASONS]
    ]
    restitution, doubts = restitution_sentence(summarize_restitution(study)), doubt_sentences(study)
    return Group(
        Text(study.name, style="bold"),
        Text(counts_sentence(study)),
        *why,
        *([TerminalTable(columns)] if outputs else []),
        *([Text(restitution)] if restitution else []),
        *warning_lines(doubts),
        *([Text(COUNTED_FROM, style="dim")] if doubts else []),
    )


def _strongest(found: Sensitivity, output: str) -> str:
    """Return the key with the largest effect on a result, with its magnitude; "" if
    undetermined.
    """
    key = strongest(found, output)
    if key is None:
        return ""
    place = found.keys.index(key)
    if found.way == RANKS:
        return (
            f"{key} (rank correlation "
            f"{digits(float(found.rows[output]['rank_correlation'][place]), 2)})"
        )
    return (
        f"{key} ({'index' if found.way == SOBOL else 'range'} "
        f"{percent(float(found.strength[output][place]))})"
    )
