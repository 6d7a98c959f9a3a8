"""Sections and figures of the reproduction as Markdown: one text for the report and for the documentation."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from vibroimpact.paper.printed import Printed
from vibroimpact.paper.printed_and_computed import Row
from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.section import Section
from vibroimpact.report.markdown_table import markdown_table
from vibroimpact.units.display import MISSING, digits

FIGURES = "figures"
"""The folder of the figures, beside the report."""

_ROUNDING = 1e-7  # per cent: differences that are not the same on all machines
_APART = "\u00a0"  # a space that does not break
_UNITS = {"1": "", "m^2": "m²", "m/s^2": "m/s²", "kg/m^3": "kg/m³", "N/m^1.5": "N/m¹·⁵", "SI": ""}


def section_text(section: Section) -> str:
    """Return a section as Markdown."""
    parts = [f"### {plain(section.title)}", *map(plain, section.words)]
    parts += [rows_table(section.rows)] if section.rows else []
    for further in section.tables:
        parts += [f"**{plain(further.title)}**"] if further.title else []
        parts.append(table(further.headers, further.cells))
    return "\n\n".join([*parts, *map(plain, section.conclusion)]) + "\n"


def drawing_text(name: str, drawing: Drawing, heading: bool = True) -> str:
    """Return a figure as Markdown: its heading, if it stands by itself, the picture, and what to see in it."""
    title = f"### {plain(drawing.title)}\n\n" if heading else ""
    return f"{title}![{plain(drawing.title)}]({FIGURES}/{name}.png)\n\n{plain(drawing.sentence)}\n"


def rows_table(rows: Sequence[Row]) -> str:
    """Return printed beside computed; what is printed is said once where several things compute it."""
    cells, before = [], None
    for row in rows:
        again = row.printed is before
        before = row.printed
        cells.append(
            (
                "" if again else row.printed.what,
                "" if again else row.printed.place,
                "" if again else printed_text(row.printed),
                row.by,
                computed_text(row),
                difference_text(row),
                allowed_text(row),
                verdict_text(row),
            )
        )
    return table(("What", "Where", "Printed", "Computed by", "Computed", "Difference", "Allowed", "Verdict"), cells)


def printed_text(value: Printed) -> str:
    """Return a value as the paper prints it, with its unit.

    Examples
    --------
    >>> from vibroimpact.paper.printed import printed
    >>> [printed_text(printed(name)).replace("\u00a0", " ") for name in ("type1.rebound_height", "stiffness", "plate.energy_part")]
    ['2.41132 m', '5.1154524848·10⁸ N/m¹·⁵', '> 11 %']
    """
    number = value.text.replace("-", "\u2212")
    if "e" in number:
        number = digits(value.value, len(re.sub(r"e.*|\.", "", number)))
    sign = "" if value.relation == "=" else f"{value.relation}{_APART}"
    return f"{sign}{number}{_unit(value)}"


def computed_text(row: Row) -> str:
    """Return the computed value with a digit more than is printed."""
    significant = len(re.sub(r"e.*", "", row.printed.text).replace(".", "").replace("-", "").lstrip("0"))
    return f"{digits(row.computed, min(max(significant + 1, 4), row.digits))}{_unit(row.printed)}"


def difference_text(row: Row) -> str:
    """Return by which part the computed value differs, in per cent; a dash where a bound is printed."""
    if row.printed.relation != "=":
        return MISSING
    part = 100.0 * row.difference
    if abs(part) < _ROUNDING:
        return "0"
    return f"{'+' if part > 0 else ''}{digits(part, 2)}{_APART}%"


def allowed_text(row: Row) -> str:
    """Return by which part the computed value may be off, in per cent; a dash where a bound is printed."""
    return f"±{_APART}{digits(100.0 * row.allowed / abs(row.printed.value), 1)}{_APART}%" if row.printed.relation == "=" else MISSING


def verdict_text(row: Row) -> str:
    """Return the verdict, with its reason."""
    return f"{row.verdict.value}: {row.reason}" if row.reason else row.verdict.value


def plain(text: str) -> str:
    """Return a text such that Markdown takes it as it stands.

    Examples
    --------
    >>> print(plain("E* of |a_b|"))
    E\\* of \\|a\\_b\\|
    """
    return re.sub(r"([\\`*_|<\[\]])", r"\\\1", text)


def _unit(value: Printed) -> str:
    """Return the unit, set apart from its number by spaces that do not break."""
    unit = _UNITS.get(value.unit, value.unit)
    return _APART + unit.replace(" ", _APART) if unit else ""


def table(headers: Sequence[str], cells: Iterable[Sequence[str]]) -> str:
    """Return a table as Markdown; its words are taken as they stand."""
    return markdown_table([plain(header) for header in headers], ([plain(cell) for cell in line] for line in cells))
