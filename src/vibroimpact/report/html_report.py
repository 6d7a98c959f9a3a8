"""A report as a piece of HTML without styles, charts and scripts, as notebooks show it."""

from __future__ import annotations

from collections.abc import Iterable

from markupsafe import Markup

from vibroimpact.quoting import visible
from vibroimpact.report.html_table import html_table
from vibroimpact.report.report import Block, Facts, Paragraph, Report, Table, first_rows


def html_report(report: Report) -> str:
    """Return title, answer, facts and tables of a report as HTML; texts are escaped.

    The answer begins with the main results and their errors.

    Examples
    --------
    >>> from vibroimpact.report.report import Section
    >>> section = Section("balls", "Balls", (Facts([("radius", "10 mm")]),))
    >>> print(html_report(Report("Two balls", (section,), {}, answer="They collide.")))
    <p><strong>Two balls</strong><br>They collide.</p>
    <table><thead><tr></tr></thead><tbody><tr><td>radius</td><td>10 mm</td></tr></tbody></table>
    """
    sections = [section for section in report.sections if section.medium != "terminal"]
    blocks = [block for section in sections for block in section.blocks]
    tables = [_html_block(block) for block in blocks if isinstance(block, Table | Facts)]
    return _joined([_head(report), *tables])


def html_summary(report: Report) -> str:
    """Return title, answer, first tables and warnings of a report as HTML; texts are escaped.

    Examples
    --------
    >>> print(html_summary(Report("Two balls", (), {}, warnings=("they may break",))))
    <p><strong>Two balls</strong><br></p>
    <p>Warning: they may break.</p>
    """
    # the first section that is more than a picture of the set-up
    main = next((section for section in report.sections if section.medium != "page"), None)
    blocks = [] if main is None else [_html_block(block) for block in main.blocks]
    warnings = [Markup("<p>Warning: {}.</p>").format(visible(text)) for text in report.all_warnings]
    return _joined([_head(report), *blocks, *warnings])


def _head(report: Report) -> Markup:
    """Return the title, the answer in words, and the main results with their errors."""
    head = Markup("<p><strong>{}</strong><br>{}</p>")
    words = head.format(visible(report.title), visible(report.answer))
    if not report.quantities:
        return words
    answer = html_table((), [quantity.cells for quantity in report.quantities])
    return words + Markup("\n") + answer


def _html_block(block: Block) -> Markup:
    """Return a table, facts or a paragraph as HTML; "" for what else there may be in a section."""
    if isinstance(block, Paragraph):
        return Markup("<p>{}</p>").format(visible(block.text))
    if isinstance(block, Facts) and block.rows:
        return html_table((), first_rows(block.rows))
    if isinstance(block, Table) and block.columns[0].cells:
        return _html_table(block)
    return Markup()


def _html_table(table: Table) -> Markup:
    units = any(column.unit for column in table.columns)
    headings = table.headings if units else [column.heading for column in table.columns]
    if table.gap is None:
        return html_table(headings, first_rows(table.rows))
    rows: list[list[str] | str] = [*table.rows]
    rows.insert(table.gap.row, f"\u2026 {table.gap.left_out} more \u2026")
    return html_table(headings, rows)


def _joined(parts: Iterable[Markup]) -> str:
    return str(Markup("\n").join(filter(None, parts)))
