"""Sections and charts of the reproduction as Markdown, the common source of the report
and the page of the documentation.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from vibroimpact.charts.chart import Chart
from vibroimpact.files.result_folder import FIGURES
from vibroimpact.paper.printed import PrintedValue
from vibroimpact.paper.report_section import ComparedValue, ReportSection
from vibroimpact.report.markdown_table import markdown_table
from vibroimpact.units.display import MISSING, digits

_ROUNDING = 1e-7  # per cent: smaller differences depend on the machine
_NO_BREAK = "\u00a0"  # no-break space
_UNITS = {"1": "", "m^2": "m²", "m/s^2": "m/s²", "kg/m^3": "kg/m³", "N/m^1.5": "N/m¹·⁵", "SI": ""}


def section_text(section: ReportSection) -> str:
    """Return a section as Markdown."""
    parts = [f"### {escape_markdown(section.title)}", *map(escape_markdown, section.paragraphs)]
    if section.rows:
        parts.append(rows_table(section.rows))
    for further in section.tables:
        if further.title:
            parts.append(f"**{escape_markdown(further.title)}**")
        parts.append(table(further.headers, further.cells))
    return "\n\n".join([*parts, *map(escape_markdown, section.conclusion)]) + "\n"


def chart_text(chart: Chart, heading: bool = True) -> str:
    """Return a chart as Markdown: an optional heading, the image, and the caption."""
    title = escape_markdown(chart.title)
    image = f"![{title}]({FIGURES}/{chart.name}.png)"
    parts = [image, escape_markdown(chart.caption)]
    if heading:
        parts.insert(0, f"### {title}")
    return "\n\n".join(parts) + "\n"


def rows_table(rows: Sequence[ComparedValue]) -> str:
    """Return the table of printed and computed values; consecutive rows of one printed
    value show it once.
    """
    cells = []
    before = None
    for row in rows:
        value_cells = ("", "", "")
        if row.printed is not before:
            value_cells = (row.printed.what, row.printed.place, printed_text(row.printed))
        before = row.printed
        cells.append(
            (
                *value_cells,
                row.by,
                computed_text(row),
                difference_text(row),
                allowed_text(row),
                row.kind.value,
                verdict_text(row),
            )
        )
    return table(
        (
            "What",
            "Where",
            "Printed",
            "Computed by",
            "Computed",
            "Difference",
            "Allowed",
            "Kind",
            "Verdict",
        ),
        cells,
    )


def printed_text(value: PrintedValue) -> str:
    """Return a printed value with its relation and unit.

    Examples
    --------
    >>> from vibroimpact.paper.printed import printed
    >>> [
    ...     printed_text(printed(name)).replace("\u00a0", " ")
    ...     for name in ("type1.rebound_height", "stiffness", "plate.energy_part")
    ... ]
    ['2.41132 m', '5.1154524848·10⁸ N/m¹·⁵', '> 11 %']
    """
    number = value.text.replace("-", "\u2212")
    if "e" in number:
        number = digits(value.value, len(re.sub(r"e.*|\.", "", number)))
    sign = ""
    if value.relation != "=":
        sign = f"{value.relation}{_NO_BREAK}"
    return f"{sign}{number}{_unit(value)}"


def computed_text(row: ComparedValue) -> str:
    """Return the computed value with one digit more than printed, at least four, and at
    most `row.digits`.
    """
    significant = len(
        re.sub(r"e.*", "", row.printed.text).replace(".", "").replace("-", "").lstrip("0")
    )
    return f"{digits(row.computed, min(max(significant + 1, 4), row.digits))}{_unit(row.printed)}"


def difference_text(row: ComparedValue) -> str:
    """Return the relative difference of the computed value in per cent; a dash for a
    printed bound.
    """
    if row.printed.relation != "=":
        return MISSING
    part = 100.0 * row.difference
    least = min(_ROUNDING, 100.0 * row.allowed / abs(row.printed.value))
    if part == 0.0:
        return "0"
    if abs(part) < least:
        return f"below {digits(least, 1)}{_NO_BREAK}%"
    sign = "+" if part > 0 else ""  # a negative number has its own
    return f"{sign}{digits(part, 2)}{_NO_BREAK}%"


def allowed_text(row: ComparedValue) -> str:
    """Return the allowed relative difference in per cent; a dash for a printed bound."""
    if row.printed.relation == "=":
        return f"±{_NO_BREAK}{digits(100.0 * row.allowed / abs(row.printed.value), 1)}{_NO_BREAK}%"
    return MISSING


def verdict_text(row: ComparedValue) -> str:
    """Return the verdict and its reason."""
    if not row.reason:
        return row.verdict.value
    return f"{row.verdict.value}: {row.reason}"


def escape_markdown(text: str) -> str:
    """Return a text with the special characters of Markdown escaped.

    Examples
    --------
    >>> print(escape_markdown("E* of |a_b|"))
    E\\* of \\|a\\_b\\|
    """
    return re.sub(r"([\\`*_|<\[\]])", r"\\\1", text)


def _unit(value: PrintedValue) -> str:
    """Return the unit with no-break spaces, to follow its number; empty for dimensionless
    values.
    """
    unit = _UNITS.get(value.unit, value.unit)
    if not unit:
        return ""
    return _NO_BREAK + unit.replace(" ", _NO_BREAK)


def table(headers: Sequence[str], cells: Iterable[Sequence[str]]) -> str:
    """Return a table as Markdown, with all cells escaped."""
    return markdown_table(
        [escape_markdown(header) for header in headers],
        ([escape_markdown(cell) for cell in line] for line in cells),
    )
