"""A part of the reproduction, made: its text, its values and its figure."""

from __future__ import annotations

from typing import Any, NamedTuple

from vibroimpact.paper.printed_and_computed import Row
from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.report.markdown import drawing_text, section_text
from vibroimpact.paper.report.outline import Part
from vibroimpact.paper.runs import Runs
from vibroimpact.report.style import style


class Made(NamedTuple):
    """A part of the reproduction.

    Parameters
    ----------
    title : str
        Its heading.
    text : str
        Words, tables and the place of the figure, as Markdown.
    rows : list of mappings
        The values printed and computed, as the table of values has them.
    drawing : Drawing, optional
        The figure.
    """

    title: str
    text: str
    rows: list[dict[str, Any]]
    drawing: Drawing | None


def make_part(part: Part, runs: Runs) -> Made:
    """Make a part."""
    section = part.section(runs) if part.section is not None else None
    with style():
        drawing = part.draw(runs) if part.draw is not None else None
    texts = [] if section is None else [section_text(section)]
    if drawing is not None:
        texts.append(drawing_text(part.name, drawing, heading=section is None))
    title = section.title if section is not None else drawing.title if drawing is not None else part.name
    return Made(title, "\n".join(texts), [_told(part.name, row) for row in (section.rows if section else ())], drawing)


def _told(part: str, row: Row) -> dict[str, Any]:
    """Return a row as the table of values has it, with every digit."""
    value = row.printed
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
        "difference": row.difference if value.relation == "=" else None,
        "allowed": row.allowed if value.relation == "=" else None,
        "verdict": row.verdict.value,
        "why": row.reason,
    }
