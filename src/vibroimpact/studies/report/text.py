"""What a sweep prints at its end: how many drops, the results that matter, and the key that moves them most."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.report.terminal_table import Column, TerminalTable
from vibroimpact.runs.terminal import doubt_lines
from vibroimpact.studies.percentiles import PERCENTILES
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.doubts import COUNTED_FROM, doubt_sentences
from vibroimpact.studies.report.labels import percent, with_unit
from vibroimpact.studies.report.outputs import study_outputs
from vibroimpact.studies.report.restitution import restitution_of, restitution_sentence
from vibroimpact.studies.report.sensitivity import RANKS, SOBOL, Sensitivity, sensitivity_of, strongest
from vibroimpact.studies.report.tables import counts_sentence, reasons
from vibroimpact.studies.study import Study
from vibroimpact.units.display import digits

_RESULTS, _REASONS = 5, 3
_TOLD = (5, 50, 95)  # percentiles
_NARROW = 70  # columns of a terminal


def study_summary(study: Study, width: int) -> RenderableType:
    """Return what a sweep prints in a terminal of a width: no more than a screen."""
    there = [one for one in study_outputs(study, most=_RESULTS + 3) if one.spread.drops]
    outputs = ([one for one in there if one.spread.varies] or there)[:_RESULTS]
    found = sensitivity_of(study, outputs)
    told = found if width >= _NARROW else None
    columns = [Column("result", [with_unit(one.title, one.scale.unit) for one in outputs], words=True)]
    for part in _TOLD:
        cells = [digits(one.spread.percentiles[PERCENTILES.index(part)] / one.scale.size) for one in outputs]
        columns.append(Column(f"{part}\u00a0%", cells))
    if told is not None:
        named = told.way == RANKS and any(not axis.numeric for axis in study_axes(study))
        heading = "moved most, of keys that are numbers, by" if named else "moved most by"
        columns.append(Column(heading, [_strongest(told, one.name) for one in outputs], words=True))
    why = [Text(f" {number}: {words}", style="yellow") for number, words in reasons(study)[:_REASONS]]
    restitution, doubts = restitution_sentence(restitution_of(study)), doubt_sentences(study)
    return Group(
        Text(study.name, style="bold"),
        Text(counts_sentence(study)),
        *why,
        *([TerminalTable(columns)] if outputs else []),
        *([Text(restitution)] if restitution else []),
        *doubt_lines(doubts),
        *([Text(COUNTED_FROM, style="dim")] if doubts else []),
    )


def _strongest(found: Sensitivity, output: str) -> str:
    """Return the key that moves a result most and how strongly; "" where it can't be told."""
    key = strongest(found, output)
    if key is None:
        return ""
    place = found.keys.index(key)
    if found.way == RANKS:
        return f"{key} (rank correlation {digits(float(found.rows[output]['rank_correlation'][place]), 2)})"
    return f"{key} ({'index' if found.way == SOBOL else 'range'} {percent(float(found.strength[output][place]))})"
