"""A report as a piece of HTML without styles, charts and scripts, as notebooks show it."""

from __future__ import annotations

from markupsafe import Markup

from vibroimpact.quoting import visible
from vibroimpact.report.html_table import html_table
from vibroimpact.report.report import Block, Facts, Report, Table, first_rows


def html_report(report: Report) -> str:
    """Return title, answer, facts and tables of a report as HTML; texts are escaped.

    Examples
    --------
    >>> from vibroimpact.report.report import Section
    >>> section = Section("balls", "Balls", (Facts([("radius", "10 mm")]),))
    >>> print(html_report(Report("Two balls", (section,), {}, answer="They collide.")))
    <p><strong>Two balls</strong><br>They collide.</p>
    <table><thead><tr></tr></thead><tbody><tr><td>radius</td><td>10 mm</td></tr></tbody></table>
    """
    head = Markup("<p><strong>{}</strong><br>{}</p>").format(visible(report.title), report.answer)
    sections = [section for section in report.sections if section.medium != "terminal"]
    tables = [_html_block(block) for section in sections for block in section.blocks]
    return str(Markup("\n").join([head, *filter(None, tables)]))


def _html_block(block: Block) -> Markup:
    """Return a table or facts as HTML; "" for what else there may be in a section."""
    if isinstance(block, Facts) and block.rows:
        return html_table((), first_rows(block.rows))
    if isinstance(block, Table) and block.columns[0].cells:
        units = any(column.unit for column in block.columns)
        headings = [
            (column.heading, column.unit) if units else column.heading for column in block.columns
        ]
        cells = zip(*(column.cells for column in block.columns), strict=True)
        return html_table(headings, first_rows(list(cells)))
    return Markup()
