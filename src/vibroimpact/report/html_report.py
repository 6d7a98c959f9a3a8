"""A report in short as a piece of HTML without scripts, as notebooks show it."""

from __future__ import annotations

from collections.abc import Iterator

from markupsafe import Markup

from vibroimpact.quoting import visible
from vibroimpact.report.html_table import html_table
from vibroimpact.report.report import Paragraph, Report, Section, Table


def html_report(report: Report) -> str:
    """Return title, answer, first tables and warnings of a report as HTML.

    Parameters
    ----------
    report : Report
        The report.

    Examples
    --------
    >>> print(html_report(Report("Two balls", (), {}, answer="They collide.")))
    <p><strong>Two balls</strong><br>They collide.</p>
    """
    head = Markup("<p><strong>{}</strong><br>{}</p>")
    parts = [head.format(visible(report.title), visible(report.answer))]
    # the first section that is more than a picture of the set-up
    main = next((section for section in report.sections if section.medium != "page"), None)
    if main is not None:
        parts.extend(_blocks(main))
    parts += [Markup("<p>Doubt: {}.</p>").format(visible(text)) for text in report.all_warnings]
    return str(Markup("\n").join(parts))


def _blocks(section: Section) -> Iterator[Markup]:
    """Yield tables and paragraphs of a section."""
    for block in section.blocks:
        if isinstance(block, Table):
            yield _table(block)
        elif isinstance(block, Paragraph):
            yield Markup("<p>{}</p>").format(visible(block.text))


def _table(table: Table) -> Markup:
    rows: list[list[str] | str] = [*table.rows]
    if table.gap is not None:
        rows.insert(table.gap.row, f"\u2026 {table.gap.left_out} more \u2026")
    return html_table(table.headings, rows)
