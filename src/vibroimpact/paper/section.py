"""A section of the reproduction: words, printed beside computed, and further tables."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.paper.printed_and_computed import Row


@dataclass(frozen=True)
class Table:
    """A table of words and numbers that are not printed in the paper.

    Parameters
    ----------
    headers : tuple of str
        What the columns are, with units in brackets.
    cells : tuple of tuples of str
        The rows.
    title : str
        What it shows.
    """

    headers: tuple[str, ...]
    cells: tuple[tuple[str, ...], ...]
    title: str = ""


def holds_text(holds: bool) -> str:
    """Return in words whether a statement of the paper holds."""
    return "holds" if holds else "does not hold"


@dataclass(frozen=True)
class Section:
    """A section of the reproduction.

    Parameters
    ----------
    title : str
        Its heading.
    words : tuple of str
        Paragraphs that go before the tables.
    rows : tuple of Row
        What is printed beside what is computed.
    tables : tuple of Table
        Further tables.
    conclusion : tuple of str
        Paragraphs that go after the tables.
    """

    title: str
    words: tuple[str, ...] = ()
    rows: tuple[Row, ...] = ()
    tables: tuple[Table, ...] = ()
    conclusion: tuple[str, ...] = ()
