"""What a sweep prints at its end: how many drops, the results that matter, and the key that moves them most."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from vibroimpact.quantity import digits
from vibroimpact.report.study.axes import study_axes
from vibroimpact.report.study.outputs import study_outputs
from vibroimpact.report.study.restitution import restitution_of, restitution_sentence
from vibroimpact.report.study.sensitivity import RANKS, SOBOL, Sensitivity, sensitivity_of, strongest
from vibroimpact.report.study.tables import counts_sentence, reasons
from vibroimpact.report.study.units import study_multiple, with_unit
from vibroimpact.storage.study import Study

_RESULTS, _REASONS = 5, 3
_NARROW = 70  # columns of a terminal


def study_summary(study: Study, width: int) -> RenderableType:
    """Return what a sweep prints in a terminal of a width: no more than a screen."""
    there = [one for one in study_outputs(study, most=_RESULTS + 3) if one.spread.drops]
    outputs = ([one for one in there if one.spread.varies] or there)[:_RESULTS]
    found = sensitivity_of(study, outputs)
    table = Table(box=None, padding=(0, 1), header_style="bold")
    table.add_column("result", overflow="fold")
    for heading in ("5 %", "50 %", "95 %"):
        table.add_column(heading, justify="right", no_wrap=True)
    if width >= _NARROW:
        named = found is not None and found.way == RANKS and any(not axis.numeric for axis in study_axes(study))
        table.add_column("moved most, of keys that are numbers, by" if named else "moved most by", overflow="fold")
    for one in outputs:
        scale = study_multiple(one.unit, one.spread.percentiles[-1])
        cells = [digits(one.spread.percentiles[place] / scale.size) for place in (0, 2, 4)]
        most = [escape(_strongest(found, one.name))] if width >= _NARROW else []
        table.add_row(escape(with_unit(one.title, scale.unit)), *cells, *most)
    why = [Text(f" {number}: {words}", style="yellow") for number, words in reasons(study)[:_REASONS]]
    restitution = restitution_sentence(restitution_of(study))
    return Group(
        Text(str(study.table.get("name") or "a study of drops"), style="bold"),
        Text(counts_sentence(study)),
        *why,
        *([table] if outputs else []),
        *([Text(restitution)] if restitution else []),
    )


def _strongest(found: Sensitivity | None, output: str) -> str:
    """Return the key that moves a result most and how strongly."""
    key = strongest(found, output) if found is not None else None
    if found is None or key is None:
        return ""
    strength, row = found.strength[output][found.keys.index(key)], found.rows[output]
    if found.way == RANKS:
        return f"{key} (rank correlation {digits(float(row['rank_correlation'][found.keys.index(key)]), 2)})"
    percent = f"{digits(100.0 * float(strength), 2)} %"
    return f"{key} (index {percent})" if found.way == SOBOL else f"{key} (range {percent})"
