"""The outline of the reproduction: its chapters and parts, and the rendering of a part as
text, values and chart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any, NamedTuple

from vibroimpact.charts.chart import Chart
from vibroimpact.errors import InputError
from vibroimpact.paper.conclusions import conclusions
from vibroimpact.paper.elastic import section_5_1, section_5_2, section_5_3
from vibroimpact.paper.inputs import corrections_section, section_3_1, section_4, table1
from vibroimpact.paper.recovery import recovery_section
from vibroimpact.paper.report.elastic_charts import (
    PLATE_QUANTITIES,
    SPHERE_ENERGY,
    SPHERE_MOTION,
    plate_chart,
    sphere_chart,
)
from vibroimpact.paper.report.markdown import chart_text, section_text
from vibroimpact.paper.report.mesh_chart import mesh_chart
from vibroimpact.paper.report.model_chart import model_chart
from vibroimpact.paper.report.recovery_chart import recovery_chart
from vibroimpact.paper.report.rigid_charts import RIGID_FIGURES, rigid_chart
from vibroimpact.paper.report.sampling_chart import sampling_chart
from vibroimpact.paper.report.unresolved_chart import unresolved_chart
from vibroimpact.paper.report_section import ComparedValue, ReportSection, Verdict
from vibroimpact.paper.runs import Runs
from vibroimpact.paper.sampling import sampling_section
from vibroimpact.paper.type1 import damping_section, section_3_2, table2
from vibroimpact.paper.unresolved import unresolved_section
from vibroimpact.registry import find_named


class ReportPart(NamedTuple):
    """A part of the reproduction: a section, a chart, or both.

    Parameters
    ----------
    name : str
        Name in the option `--only`.
    section : callable, optional
        Function that computes the section.
    chart : callable, optional
        Function that returns the chart, which has the name of the part.
    """

    name: str
    section: Callable[[Runs], ReportSection] | None = None
    chart: Callable[[Runs], Chart] | None = None


PAPER_FIGURES: Mapping[str, Callable[[Runs], Chart]] = {
    "fig3": lambda runs: model_chart(),
    **{f"fig{figure.number}": partial(rigid_chart, figure) for figure in RIGID_FIGURES},
    "fig9": mesh_chart,
    **{
        f"fig{quantity.number}": partial(sphere_chart, quantity)
        for quantity in (*SPHERE_MOTION, *SPHERE_ENERGY)
    },
    **{f"fig{quantity.number}": partial(plate_chart, quantity) for quantity in PLATE_QUANTITIES},
}
"""Functions that return the charts of the paper's figures, by name and in its order."""


def _figures(first: int, last: int) -> tuple[ReportPart, ...]:
    names = [f"fig{number}" for number in range(first, last + 1)]
    return tuple(ReportPart(name, chart=PAPER_FIGURES[name]) for name in names)


CHAPTERS: dict[str, tuple[ReportPart, ...]] = {
    "The inputs": (
        ReportPart("table1", table1),
        ReportPart("section3.1", section_3_1),
        *_figures(3, 3),
    ),
    "Type 1: repeated impacts of rigid bodies": (
        ReportPart("section3.2", section_3_2),
        *_figures(4, 8),
        ReportPart("damping", damping_section),
        ReportPart("table2", table2),
    ),
    "Types 1, 2 and 3: elastic bodies": (
        ReportPart("section4", section_4),
        *_figures(9, 9),
        ReportPart("section5.1", section_5_1),
        *_figures(10, 13),
    ),
    "The energy of the sphere": (ReportPart("section5.2", section_5_2), *_figures(14, 17)),
    "The vibration of the plate": (ReportPart("section5.3", section_5_3), *_figures(18, 23)),
    "The conclusions": (ReportPart("conclusions", conclusions),),
    "Inferences from the printed numbers": (
        ReportPart("recovery", recovery_section, recovery_chart),
        ReportPart("sampling", sampling_section, sampling_chart),
        ReportPart("unresolved", unresolved_section, unresolved_chart),
    ),
    "Corrections": (ReportPart("corrections", corrections_section),),
}
"""The chapters of the report, and the parts of each."""

PARTS: dict[str, ReportPart] = {part.name: part for parts in CHAPTERS.values() for part in parts}
"""All parts by name, in the order of the report."""


def find_parts(names: Iterable[str]) -> list[ReportPart]:
    """Return the parts with the given names, in the order of the report.

    Raises
    ------
    InputError
        If a name is unknown, or no name is given.

    Examples
    --------
    >>> [part.name for part in find_parts(["fig4", "table1"])]
    ['table1', 'fig4']
    """
    wanted = {find_named("part", name, PARTS).name for name in sorted(set(names))}
    if not wanted:
        raise InputError(f"name at least one of {', '.join(PARTS)}")
    return [part for name, part in PARTS.items() if name in wanted]


class RenderedPart(NamedTuple):
    """A rendered part of the reproduction, computed or read from a folder.

    Parameters
    ----------
    title : str
        Heading.
    text : str
        Paragraphs, tables and the reference to the figure, as Markdown.
    rows : list of mappings
        Printed and computed values, as rows of `values.csv`.
    chart : Chart, optional
        The chart.
    """

    title: str
    text: str
    rows: list[dict[str, Any]]
    chart: Chart | None


def render_part(part: ReportPart, runs: Runs) -> RenderedPart:
    """Return a part, computed and rendered."""
    title = part.name
    texts = []
    rows: list[dict[str, Any]] = []
    if part.section is not None:
        section = part.section(runs)
        title = section.title
        texts.append(section_text(section))
        rows = [_values_row(part.name, row) for row in section.rows]
    # it computes what it shows: an error of it ends the reproduction
    chart = None
    if part.chart is not None:
        chart = part.chart(runs)
    if chart is not None:
        texts.append(chart_text(chart, heading=part.section is None))
        if part.section is None:
            title = chart.title
    return RenderedPart(title, "\n".join(texts), rows, chart)


def chapters_of(parts: Mapping[str, RenderedPart]) -> dict[str, list[RenderedPart]]:
    """Return the chapters that have parts, in the order of the report."""
    chapters = {
        chapter: [parts[member.name] for member in members if member.name in parts]
        for chapter, members in CHAPTERS.items()
    }
    return {chapter: members for chapter, members in chapters.items() if members}


def missing_from(parts: Mapping[str, RenderedPart]) -> list[str]:
    """Return the names of the parts that are not there, in the order of the report."""
    return [name for name in PARTS if name not in parts]


VALUE_COLUMNS = (
    "part", "name", "what", "place", "read", "unit", "relation", "printed", "by", "computed",
    "difference", "allowed", "verdict", "why", "kind", "range_low", "range_high",
)  # fmt: skip
"""The columns of `values.csv`."""


def _values_row(part: str, row: ComparedValue) -> dict[str, Any]:
    """Return a compared value as a row of `values.csv`, in full precision."""
    value = row.printed
    # a bound has no difference, and a range is given only where it explains
    is_equation = value.relation == "="
    difference = row.difference if is_equation else None
    allowed = row.allowed if is_equation else None
    range_low = None
    range_high = None
    if row.verdict is Verdict.EXPLAINED and row.explanation is not None:
        range_low = row.explanation.low
        range_high = row.explanation.high
    return {
        "part": part,
        "name": value.name,
        "what": value.what,
        "place": value.place,
        "read": value.read,
        "unit": value.unit,
        "relation": value.relation,
        "printed": value.text,
        "by": row.by,
        "computed": row.computed,
        "difference": difference,
        "allowed": allowed,
        "verdict": row.verdict.value,
        "why": row.reason,
        "kind": row.kind.value,
        "range_low": range_low,
        "range_high": range_high,
    }
