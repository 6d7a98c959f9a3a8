"""What a task tells of its finding, as data: page, terminal, JSON and folder are made from it.

A task has a module `report` with a function `report_of`, which returns the `Report` of its finding.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Literal

from vibroimpact._version import __version__
from vibroimpact.charts.chart import Chart


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Parameters
    ----------
    heading : str
        What the column holds.
    cells : sequence of str
        A cell per row, with the digits that are shown.
    unit : str
        Unit of the cells; empty if there is none.
    is_text : bool
        Texts, aligned on the left; otherwise numbers.
    wraps : bool
        Long texts, which the page breaks into lines.
    tones : sequence of str
        How each cell is coloured on the page: "good", "fair", "soft", "bad", or "" for none; by
        default no cell is.
    least_width : int
        Width of a terminal [characters] below which the column is left out.
    """

    heading: str
    cells: Sequence[str]
    unit: str = ""
    is_text: bool = False
    wraps: bool = False
    tones: Sequence[str] = ()
    least_width: int = 0


@dataclass(frozen=True)
class Table:
    """Rows under headings; the first column names the rows.

    Parameters
    ----------
    columns : sequence of Column
        The columns.
    title : str
        What the table holds, where its section has several.
    bold : collection of int
        Numbers of rows that are set apart, from 0.
    """

    kind: ClassVar[str] = "table"

    columns: Sequence[Column]
    title: str = ""
    bold: Sequence[int] = ()


@dataclass(frozen=True)
class Facts:
    """Rows without headings: a name, and what is said of it in one or more texts."""

    kind: ClassVar[str] = "facts"
    rows: Sequence[tuple[str, ...]]


@dataclass(frozen=True)
class Paragraph:
    """Sentences on the finding."""

    kind: ClassVar[str] = "paragraph"

    text: str


@dataclass(frozen=True)
class Heading:
    """A heading within a section."""

    kind: ClassVar[str] = "heading"

    text: str


@dataclass(frozen=True)
class Figure:
    """A chart within a section of the page."""

    kind: ClassVar[str] = "figure"

    chart: Chart


@dataclass(frozen=True)
class Note:
    """Sentences on how a table is read, or on what went wrong.

    Parameters
    ----------
    text : str
        The sentences.
    is_warning : bool
        Whether the terminal sets them apart as a warning.
    """

    kind: ClassVar[str] = "note"

    text: str
    is_warning: bool = False


@dataclass(frozen=True)
class Explanation:
    """Longer sentences on methods and definitions, for the page alone."""

    kind: ClassVar[str] = "note"

    text: str


@dataclass(frozen=True)
class Code:
    """A text to copy from the page, such as lines of a case.

    Parameters
    ----------
    name : str
        Plain name.
    lead : str
        What the text is.
    text : str
        The text.
    is_short : bool
        Whether the terminal shows it too, and its lines may be broken.
    """

    kind: ClassVar[str] = "code"

    name: str
    lead: str
    text: str
    is_short: bool = False


Block = Table | Facts | Paragraph | Heading | Figure | Note | Explanation | Code


@dataclass(frozen=True)
class Section:
    """A part of a report under a heading.

    Parameters
    ----------
    name : str
        Plain name, to which the contents link.
    title : str
        The heading; without one it is not in the contents.
    blocks : sequence of Block
        What it consists of.
    after_charts : bool
        Whether it follows the charts.
    medium : str
        Where it is shown: on the "page", in the "terminal", or in "both".
    """

    name: str
    title: str
    blocks: Sequence[Block]
    after_charts: bool = False
    medium: Literal["page", "terminal", "both"] = "both"

    @property
    def charts(self) -> tuple[Chart, ...]:
        """The charts within it."""
        return tuple(block.chart for block in self.blocks if isinstance(block, Figure))


@dataclass(frozen=True)
class Report:
    """A finding as it is told, in every medium.

    Parameters
    ----------
    title : str
        The title.
    sections : sequence of Section
        Tables with their notes.
    summary : mapping
        Content of `summary.json` in the folder; in SI.
    charts : sequence of Chart
        The charts that follow the sections.
    files : mapping of str to callable
        Further files of the folder by their names, each with the function that writes it to a path.
    answer : str
        The finding in a sentence.
    sentences : sequence of str
        What else is said of it.
    warnings : sequence of str
        What may be wrong with it, each without the full stop.
    provenance : str
        What it was made from, in words that follow the version of the program.
    data : mapping, optional
        What `--json` prints; by default the summary.
    opening : sequence of Block
        What precedes the contents of the page.
    has_failed : bool
        Whether the answer is that there is no result.
    warnings_note : str
        How the warnings are read.
    above_charts : str
        How the charts are read.
    commands : str
        Where the commands are run that end the labels of points in charts, such as "In the study's
        folder"; empty if they end with none.
    version : str
        Version of the program that computed the finding.
    """

    title: str
    sections: Sequence[Section]
    summary: Mapping[str, Any]
    charts: Sequence[Chart] = ()
    files: Mapping[str, Callable[[Path], object]] = field(default_factory=dict)
    answer: str = ""
    sentences: Sequence[str] = ()
    warnings: Sequence[str] = ()
    provenance: str = ""
    data: Mapping[str, Any] | None = None
    opening: Sequence[Block] = ()
    has_failed: bool = False
    warnings_note: str = ""
    above_charts: str = ""
    commands: str = ""
    version: str = __version__

    @property
    def document(self) -> dict[str, Any]:
        """What `--json` prints."""
        return dict(self.summary if self.data is None else self.data)

    @property
    def all_charts(self) -> tuple[Chart, ...]:
        """The charts within the sections, and those that follow them."""
        return (*(chart for section in self.sections for chart in section.charts), *self.charts)


_MOST_ROWS = 50
"""Rows of a table beyond which its first ones are shown."""


def first_rows(rows: Sequence[Sequence[str]]) -> list[Sequence[str]]:
    """Return the first rows of a table, and an ellipsis if there are more.

    Examples
    --------
    >>> first_rows([[str(number), "1"] for number in range(60)])[-2:]
    [['48', '1'], ['…', '']]
    """
    if len(rows) <= _MOST_ROWS:
        return list(rows)
    ellipsis = ["…", *[""] * (len(rows[0]) - 1)]
    return [*rows[: _MOST_ROWS - 1], ellipsis]


def table_of(
    headings: Sequence[str | tuple[str, str]],
    rows: Sequence[Sequence[str]],
    texts: Sequence[str] = (),
    title: str = "",
    bold: Sequence[int] = (),
) -> Table:
    """Return a table from its rows.

    Parameters
    ----------
    headings : sequence of str or tuple of str
        Heading of each column: a text, or a text and a unit.
    rows : sequence of sequence of str
        The rows.
    texts : sequence of str
        Headings of columns of texts; the first column is one anyhow.
    title : str
        Title of the table.
    bold : sequence of int
        Numbers of rows that are set apart, from 0.

    Examples
    --------
    >>> table = table_of(["Law", ("Force", "N")], [["hertz", "20"], ["tsuji", "19"]])
    >>> force = table.columns[1]
    >>> force.heading, force.unit, force.cells
    ('Force', 'N', ('20', '19'))
    """
    columns = []
    for number, heading in enumerate(headings):
        name, unit = (heading, "") if isinstance(heading, str) else heading
        cells = tuple(row[number] for row in rows)
        columns.append(Column(name, cells, unit, is_text=number == 0 or name in texts))
    return Table(tuple(columns), title, bold)
