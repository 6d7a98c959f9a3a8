"""What a task tells of its finding, as data: page, terminal, JSON and folder are made from it.

A task has a module `report` with a function `report_of`, which returns the `Report` of its finding.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Literal

from vibroimpact._version import __version__
from vibroimpact.charts.chart import Chart
from vibroimpact.units.display import Multiple, column_texts, fixed, multiple, text


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
    note : str
        A sentence on how it is read, which the terminal shows where it shows the column.
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
    note: str = ""
    wraps: bool = False
    tones: Sequence[str] = ()
    least_width: int = 0


@dataclass(frozen=True)
class Gap:
    """Rows that are left out of a long table.

    Parameters
    ----------
    row : int
        How many rows stand before it.
    left_out : int
        How many rows are left out.
    """

    row: int
    left_out: int


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
    gap : Gap, optional
        Where rows are left out.
    file : str
        File of the folder that has all rows and columns, in SI.
    shows_views : bool
        Whether its rows are named as the views of the charts, each of which a button shows.
    expendable : sequence of str
        Headings of columns that a narrow terminal leaves out, the first one first.
    short : Table, optional
        The table with shorter words and fewer rows, which the terminal shows in its place.
    """

    kind: ClassVar[str] = "table"

    columns: Sequence[Column]
    title: str = ""
    bold: Sequence[int] = ()
    gap: Gap | None = None
    file: str = ""
    shows_views: bool = False
    expendable: Sequence[str] = ()
    short: Table | None = None

    @property
    def headings(self) -> list[tuple[str, str]]:
        """Heading and unit of each column."""
        return [(column.heading, column.unit) for column in self.columns]

    @property
    def rows(self) -> list[list[str]]:
        """The cells of each row that is there."""
        cells = zip(*(column.cells for column in self.columns), strict=True)
        return [list(row) for row in cells]


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
    """Longer sentences on methods and definitions, for the page alone.

    Parameters
    ----------
    text : str
        The sentences.
    short : str
        What the terminal says in their place.
    """

    kind: ClassVar[str] = "note"

    text: str
    short: str = ""


@dataclass(frozen=True)
class Warnings:
    """What may be wrong, where the page says it; the terminal says it at its end.

    Parameters
    ----------
    texts : sequence of str
        Sentences, each without the full stop.
    """

    kind: ClassVar[str] = "warnings"

    texts: Sequence[str]


@dataclass(frozen=True)
class Figure:
    """A chart within a section of the page.

    Parameters
    ----------
    chart : Chart
        The chart.
    has_title : bool
        Whether its title stands above it.
    """

    kind: ClassVar[str] = "figure"

    chart: Chart
    has_title: bool = True


@dataclass(frozen=True)
class Scene:
    """A plate in motion on the page.

    Parameters
    ----------
    data : mapping
        What is drawn, with arrays in SI.
    label : str
        What moves, in words.
    caption : str
        How it is drawn, in sentences.
    modes : sequence of str
        Names of the motions to choose from, if there are several.
    still : Chart, optional
        The chart that shows the same in files and notebooks.
    animation : callable, optional
        Returns the motion as GIF, for the files of the figures.
    """

    kind: ClassVar[str] = "scene"

    data: Mapping[str, Any]
    label: str
    caption: str
    modes: Sequence[str] = ()
    still: Chart | None = None
    animation: Callable[[], bytes] | None = None


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


Block = Table | Facts | Paragraph | Heading | Note | Explanation | Warnings | Figure | Scene | Code


_EXACT = 1e-6
"""Relative error below which a result is as exact as it is shown."""

_FIGURES = 5
_LEAST_FIGURES = 2
_RANGE_FIGURES = 4


@dataclass(frozen=True)
class Quantity:
    """A main result of a finding, with its error.

    Parameters
    ----------
    name : str
        What it is.
    value : float
        Its value in SI, or in per cent; an integer is a count.
    unit : str
        Its SI unit, or "%"; empty for a ratio or a count.
    error : float, default NaN
        Its estimated relative error; NaN if it is not estimated.
    note : str
        What else is said of it, such as its impact, or the value in another unit.
    is_least : bool
        Whether the error may be larger.
    interval : (float, float), optional
        Its 95 % interval, where one is known in place of the error.
    largest : float, default NaN
        The largest value, where it is a range, of which `value` is the smallest.
    figures : int, default 5
        Its significant figures at most.

    Examples
    --------
    >>> accuracy = Quantity("Balanced accuracy", 98.1, "%", interval=(78.2, 99.8))
    >>> accuracy.text.replace("\u00a0", " "), accuracy.error_text.replace("\u00a0", " ")
    ('98 %', '95 %: 78 to 100 %')
    >>> Quantity("Largest force", 7940.0, "N", largest=17034.0).text.replace("\u00a0", " ")
    '7.94 to 17.03 kN'
    """

    name: str
    value: float
    unit: str = ""
    error: float = math.nan
    note: str = ""
    is_least: bool = False
    interval: tuple[float, float] | None = None
    largest: float = math.nan
    figures: int = _FIGURES

    @property
    def cells(self) -> tuple[str, str, str, str]:
        """Its name, value, error and note, as a row of the answer."""
        return self.name, self.text, self.error_text, self.note

    @property
    def is_range(self) -> bool:
        """Whether it is a range."""
        return not math.isnan(self.largest)

    @property
    def text(self) -> str:
        """The value with its unit, in the digits that its error leaves."""
        if isinstance(self.value, int):
            return f"{self.value:,}"
        if self.is_range:
            return self._range_text
        if self.interval is not None:
            return self._in_unit(self._with_decimals(self.value))
        figures = self.figures
        if self.error > _EXACT:
            # the last one may be off by five
            figures = math.floor(1.3 - math.log10(self.error))
        figures = min(max(figures, _LEAST_FIGURES), self.figures)
        rounded = float(f"{self.value:.{figures - 1}e}")
        # zeros ahead of the decimal point are shown: the error tells that they are not certain
        scaled = abs(rounded) / multiple(self.unit, rounded).size
        return text(rounded, self.unit, max(figures, len(f"{scaled:.0f}")))

    @property
    def error_text(self) -> str:
        """The error in per cent, or the interval; empty if there is none, or none is known."""
        error = self.error
        if self.interval is not None:
            low, high = map(self._with_decimals, self.interval)
            if low != high:
                return f"95\u00a0%: {self._in_unit(f'{low} to {high}')}"
            if self.value == 0.0:  # to all its figures
                return ""
            error = 0.5 * (self.interval[1] - self.interval[0]) / abs(self.value)
        if not error > _EXACT:
            return ""
        bound = "± {} % or more" if self.is_least else "± {} %"
        return bound.format(f"{float(f'{100.0 * error:.2g}'):g}")

    @property
    def _range_text(self) -> str:
        """The smallest and the largest value, in digits that tell them apart."""
        size = multiple(self.unit, [self.value, self.largest]).size
        ends = [self.value / size, self.largest / size]
        smallest, largest = column_texts(ends, min(self.figures, _RANGE_FIGURES))
        if smallest == largest:
            return self._in_unit(smallest)
        return self._in_unit(f"{smallest} to {largest}")

    @property
    def _multiple(self) -> Multiple:
        """The multiple of the unit in which value and ends are shown."""
        values = [self.value, self.largest, *(self.interval or ())]
        return multiple(self.unit, values)

    def _in_unit(self, number: str) -> str:
        """Return a number, or two, with the unit."""
        return f"{number}\u00a0{self._multiple.unit}".rstrip("\u00a0")

    def _with_decimals(self, value: float) -> str:
        """Return a value in the decimals that the interval leaves."""
        assert self.interval is not None
        size = self._multiple.size
        # half an interval is 3 to 30 of the last digit
        digit = (self.interval[1] - self.interval[0]) / (6.0 * size)
        decimals = _FIGURES - 1
        if digit > 0.0:
            decimals = -math.floor(math.log10(digit))
        before_point = len(f"{abs(self.value) / size:.0f}")
        return fixed(value / size, min(max(decimals, 0), max(_FIGURES - before_point, 0)))

    @property
    def document(self) -> dict[str, Any]:
        """The result as data for JSON; interval and largest value only where there are any."""
        error = self.error if math.isfinite(self.error) else None
        document = {
            "name": self.name,
            "value": self.value,
            "unit": self.unit,
            "relative_error": error,
            "error_may_be_larger": self.is_least,
            "text": self.text.replace("\u00a0", " "),
        }
        if self.interval is not None:
            document["interval"] = list(self.interval)
        if self.is_range:
            document["largest"] = self.largest
        return document


def finite_interval(low: float, high: float) -> tuple[float, float] | None:
    """Return an interval as a `Quantity` has it; None if it is not bounded.

    Examples
    --------
    >>> finite_interval(0.1, 0.2), finite_interval(0.1, math.inf)
    ((0.1, 0.2), None)
    """
    if math.isfinite(low) and math.isfinite(high):
        return float(low), float(high)
    return None


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
    is_folded : bool
        Whether the page shows it only when it is opened; one with a text, such as the case, always.
    """

    name: str
    title: str
    blocks: Sequence[Block]
    after_charts: bool = False
    medium: Literal["page", "terminal", "both"] = "both"
    is_folded: bool = False

    @property
    def folds(self) -> bool:
        """Whether the page shows it only when it is opened."""
        return self.is_folded or any(isinstance(block, Code) for block in self.blocks)

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
        Content of `summary.json` in the folder, after the main results; in SI.
    charts : sequence of Chart
        The charts that follow the sections.
    main_chart : str
        Name of the chart that is plotted where none is named; by default the first one.
    further_charts : mapping of str to callable
        What makes each chart that is plotted by its name alone.
    above_charts, below_charts : str
        Sentences above and below the charts on the page.
    files : mapping of str to callable
        Further files of the folder by their names, each with the function that writes it to a path.
    checked_files : sequence of str
        Those of them whose checksums `summary.json` records.
    answer : str
        The finding in a sentence.
    quantities : sequence of Quantity
        The main results, which page and terminal show first.
    has_failed : bool
        Whether the answer is that there is no result.
    sentences : sequence of str
        What else is said of it.
    warnings : sequence of str
        What may be wrong with it, each without the full stop.
    provenance : str or Facts
        What it was made from: words that follow the version of the program, or facts with it.
    data : mapping, optional
        What `--json` prints; by default the summary.
    opening : sequence of Block
        What precedes the contents of the page.
    warnings_note : str
        How the warnings are read.
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
    main_chart: str = ""
    further_charts: Mapping[str, Callable[[], Chart]] = field(default_factory=dict)
    above_charts: str = ""
    below_charts: str = ""
    files: Mapping[str, Callable[[Path], object]] = field(default_factory=dict)
    checked_files: Sequence[str] = ()
    answer: str = ""
    quantities: Sequence[Quantity] = ()
    has_failed: bool = False
    sentences: Sequence[str] = ()
    warnings: Sequence[str] = ()
    provenance: str | Facts = ""
    data: Mapping[str, Any] | None = None
    opening: Sequence[Block] = ()
    warnings_note: str = ""
    commands: str = ""
    version: str = __version__

    @property
    def document(self) -> dict[str, Any]:
        """What `--json` prints: the main results first."""
        return self._after_answer(self.summary if self.data is None else self.data)

    @property
    def stored_summary(self) -> dict[str, Any]:
        """The content of `summary.json`: the main results first."""
        return self._after_answer(self.summary)

    def _after_answer(self, data: Mapping[str, Any]) -> dict[str, Any]:
        """Return data with the main results ahead, if there are any."""
        if not self.quantities:
            return dict(data)
        return {"answer": [quantity.document for quantity in self.quantities], **data}

    @property
    def page_charts(self) -> tuple[Chart, ...]:
        """The charts of the page, in its order."""
        ahead = [
            chart
            for section in self.sections
            if not section.after_charts
            for chart in section.charts
        ]
        behind = [
            chart for section in self.sections if section.after_charts for chart in section.charts
        ]
        return (*ahead, *self.charts, *behind)

    @property
    def all_charts(self) -> tuple[Chart, ...]:
        """The charts of the page, and those that show in files what moves on it."""
        stills = [scene.still for scene in self.scenes if scene.still is not None]
        return (*self.page_charts, *stills)

    @property
    def scenes(self) -> list[Scene]:
        """What moves on the page."""
        return [
            block
            for section in self.sections
            for block in section.blocks
            if isinstance(block, Scene)
        ]

    @property
    def all_warnings(self) -> list[str]:
        """The warnings, with those of the sections."""
        of_sections = [
            text
            for section in self.sections
            for block in section.blocks
            if isinstance(block, Warnings)
            for text in block.texts
        ]
        return [*self.warnings, *of_sections]


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
