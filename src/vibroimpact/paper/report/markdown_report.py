"""The report of the reproduction as Markdown."""

from __future__ import annotations

import re
from collections.abc import Mapping

from vibroimpact._version import __version__
from vibroimpact.paper.report.markdown import table
from vibroimpact.paper.report.opening import IN_SHORT, OPENING, summary_blocks
from vibroimpact.paper.report.outline import RenderedPart, chapters_of, missing_from
from vibroimpact.report.report import Block, Facts, Paragraph, Table

TITLE = "The paper, reproduced"


def markdown_report(parts: Mapping[str, RenderedPart]) -> str:
    """Return the report as Markdown.

    Parameters
    ----------
    parts : mapping of str to RenderedPart
        The available parts by name.
    """
    missing = missing_from(parts)
    chapters = chapters_of(parts)
    opening = OPENING if missing else (*OPENING, IN_SHORT)
    pieces = [f"# {TITLE}\n", *map(_markdown_block, opening)]
    pieces += [f"- [{chapter}](#{anchor(chapter)})" for chapter in chapters]
    pieces += ["", *map(_markdown_block, summary_blocks(parts))]
    for chapter, members in chapters.items():
        pieces += [f"## {chapter}\n", *(part.text for part in members)]
    if missing:
        pieces.append(
            f"Not made yet: {', '.join(missing)}. `vibroimpact reproduce -o DIR` makes them.\n"
        )
    pieces.append(f"Made by vibroimpact {__version__}: `vibroimpact reproduce`.\n")
    return "\n".join(pieces)


def anchor(heading: str) -> str:
    """Return the anchor of a heading, formed as on GitHub.

    Examples
    --------
    >>> anchor("Type 1: repeated impacts")
    'type-1-repeated-impacts'
    """
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def _markdown_block(block: Block) -> str:
    """Return a block of the opening as Markdown, with a line break at its end."""
    match block:
        case Paragraph(text):
            return f"{text}\n"
        case Facts(rows):
            return "\n".join(f"- {name}: {meaning}" for name, meaning in rows) + "\n"
        case Table(columns):
            cells = zip(*(column.cells for column in columns), strict=True)
            return table([column.heading for column in columns], cells) + "\n"
    raise TypeError(block)
