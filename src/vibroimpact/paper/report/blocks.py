"""The text of a part of the reproduction as blocks of a report."""

from __future__ import annotations

import re
from collections.abc import Sequence

from markdown_it import MarkdownIt
from markdown_it.tree import SyntaxTreeNode

from vibroimpact.charts.chart import Chart
from vibroimpact.paper.report_section import Verdict
from vibroimpact.report.report import Block, Column, Figure, Heading, Paragraph, Table

_TONES = {
    Verdict.REPRODUCED.value: "good",
    Verdict.EXPLAINED.value: "fair",
    Verdict.FITTED.value: "soft",
    Verdict.NOT_REPRODUCED.value: "bad",
}
"""How the cells of verdicts are coloured."""


def blocks_of(text: str, chart: Chart | None = None) -> list[Block]:
    r"""Return the headings, paragraphs and tables of a text, and the chart in place of its image.

    Parameters
    ----------
    text : str
        The text of a part, as Markdown.
    chart : Chart, optional
        Its chart, which has a title and a caption itself.

    Examples
    --------
    >>> blocks_of("### Table 1\n\nAll values are exact.\n")
    [Heading(text='Table 1'), Paragraph(text='All values are exact.')]
    """
    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    nodes = list(SyntaxTreeNode(markdown.parse(text)).children)
    blocks: list[Block] = []
    title = ""
    while nodes:
        node = nodes.pop(0)
        if node.type == "table":
            blocks.append(_table(node, title))
            title = ""
        elif node.type == "heading":
            blocks.append(Heading(_plain(node)))
        elif _holds(node, "image") and chart is not None:
            nodes.pop(0)  # the caption
            if blocks and blocks[-1] == Heading(chart.title):
                blocks.pop()
            blocks.append(Figure(chart))
        elif _holds(node, "strong"):
            title = _plain(node)
        else:
            blocks.append(Paragraph(_plain(node)))
    return blocks


def _holds(paragraph: SyntaxTreeNode, kind: str) -> bool:
    """Return whether a paragraph consists of one element of a kind, such as an image."""
    (inline,) = paragraph.children
    return [child.type for child in inline.children if child.type != "text" or child.content] == [
        kind
    ]


def _plain(node: SyntaxTreeNode) -> str:
    """Return the text in a node without its markup."""
    return "".join(child.content for child in node.walk() if child.type == "text")


def _table(node: SyntaxTreeNode, title: str) -> Table:
    """Return a table of texts, with the colours of verdicts."""
    head, *bodies = node.children
    headings = [_plain(cell) for cell in head.children[0].children]
    rows = [[_plain(cell) for cell in row.children] for body in bodies for row in body.children]
    return text_table(headings, rows, title)


def text_table(headings: Sequence[str], rows: Sequence[Sequence[str]], title: str = "") -> Table:
    """Return a table of texts, with the colours of verdicts.

    Examples
    --------
    >>> table = text_table(["Value", "Verdict"], [["mass", "explained: by samples"]])
    >>> table.columns[1].tones
    ['fair']
    """
    columns = []
    for number, heading in enumerate(headings):
        cells = [row[number] for row in rows]
        tones = [_tone(cell) for cell in cells]
        columns.append(Column(heading, cells, is_text=True, wraps=True, tones=tones))
    return Table(columns, title)


def _tone(cell: str) -> str:
    """Return the colour of a cell, which may be a verdict that a reason follows."""
    verdict = re.split("[:,]", cell, maxsplit=1)[0]
    return _TONES.get(verdict, "")
