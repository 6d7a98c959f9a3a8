"""A reproduction of the paper in its folder: the parts that are there, with their charts."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from vibroimpact.charts.chart import Chart, stored_chart
from vibroimpact.charts.pack import unpack
from vibroimpact.errors import InputError
from vibroimpact.files.check_sums import CHECK_SUMS, check_file, read_sealed
from vibroimpact.files.json_reading import read_json_table
from vibroimpact.files.result_folder import FIGURES, SUMMARY
from vibroimpact.paper.report.outline import PARTS, VALUE_COLUMNS, RenderedPart
from vibroimpact.paper.report_section import Kind, Verdict
from vibroimpact.report.reported import WithReport

PARTS_FOLDER = "parts"
"""Folder of the files of parts, inside that of a reproduction."""


@dataclass(frozen=True, eq=False)
class Reproduction(WithReport, reported_in="vibroimpact.paper.report.report"):
    """The paper as reproduced, as far as its parts have been made.

    Its charts are as they were drawn for its page; the folder has them as pictures too. The folder
    also has its report: `remake_report` writes that anew.

    Attributes
    ----------
    path : Path
        The folder.
    parts : dict of str to RenderedPart
        The parts by name, in the order of the report.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> with TemporaryDirectory() as folder:
    ...     place = vi.reproduce_paper(f"{folder}/paper", only=["section3.1"])
    ...     reproduction = vi.load_reproduction(place)
    >>> list(reproduction.parts), [table.columns[-1].heading for table in reproduction.tables]
    (['section3.1'], ['Not reproduced', 'Not reproduced', 'Verdict'])
    """

    path: Path
    parts: dict[str, RenderedPart]

    @property
    def values(self) -> list[dict[str, Any]]:
        """The rows of `values.csv`: each printed value with the computed one and the verdict."""
        return [row for part in self.parts.values() for row in part.rows]


def load_reproduction(directory: str | PathLike[str]) -> Reproduction:
    """Return a reproduction of the paper from its folder.

    Parameters
    ----------
    directory : path
        The folder of the reproduction.

    Raises
    ------
    InputError
        If the folder is not that of a reproduction, or a part or its chart is damaged, or missing
        as in a folder of an earlier version.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> with TemporaryDirectory() as folder:
    ...     place = vi.reproduce_paper(f"{folder}/paper", only=["section3.1", "fig3"])
    ...     reproduction = vi.load_reproduction(place)
    >>> [value["verdict"] for value in reproduction.values]
    ['reproduced', 'reproduced', 'not reproduced']
    >>> reproduction.charts["fig3"].title
    'Figure 3: the rigid model'
    """
    folder = Path(directory)
    if not is_reproduction(folder):
        raise InputError(f"{folder}: this is not the folder of a reproduction")
    tables = {
        name: _read_table(folder, name) for name in PARTS if part_file(folder, name).is_file()
    }
    charts = _read_charts(folder, tables)
    parts = {
        name: RenderedPart(table["title"], table["text"], table["rows"], charts.get(name))
        for name, table in tables.items()
    }
    return Reproduction(folder, parts)


def is_reproduction(folder: Path) -> bool:
    """Return whether a folder is that of a reproduction."""
    try:
        return bool(read_json_table(folder / SUMMARY).get("reproduction"))
    except InputError:
        return False


def part_file(folder: Path, part: str) -> Path:
    """Return the file of a part: title, text and values."""
    return folder / PARTS_FOLDER / f"{part}.json"


def chart_file(folder: Path, part: str) -> Path:
    """Return the file of the chart of a part."""
    return folder / PARTS_FOLDER / f"{part}.chart"


def version_of_part(folder: Path, name: str) -> str | None:
    """Return the version of the package that wrote a part; None if the part or its chart
    is missing or damaged.
    """
    try:
        table = read_sealed(part_file(folder, name))
        if _has_chart(table["text"]):
            _check_chart(folder, name, table)
        return str(table["version"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None


def _read_table(folder: Path, name: str) -> dict[str, Any]:
    """Return title, text, values and checksums of a part.

    Raises
    ------
    InputError
        If its file is damaged.
    """
    file = part_file(folder, name)
    try:
        table = read_sealed(file)
        return {
            "title": str(table["title"]),
            "text": str(table["text"]),
            "rows": [_row(row) for row in table["rows"]],
            CHECK_SUMS: dict(table.get(CHECK_SUMS, {})),
        }
    except (OSError, ValueError, KeyError, TypeError):
        hint = _repair_hint(folder, name)
        raise InputError(f"{file}: the file is damaged; {hint}") from None


def _row(row: Any) -> dict[str, Any]:
    """Return a row of `values.csv` as it is stored.

    Raises
    ------
    KeyError, TypeError
        If it has not the columns that it must have.
    """
    if not isinstance(row, dict) or row.keys() != set(VALUE_COLUMNS):
        raise KeyError("its columns are not those of values.csv")
    return {**row, "verdict": Verdict(row["verdict"]).value, "kind": Kind(row["kind"]).value}


def _read_charts(folder: Path, tables: Mapping[str, Mapping[str, Any]]) -> dict[str, Chart]:
    """Return the charts of parts by the names of the parts.

    Raises
    ------
    InputError
        If charts are missing or damaged; all of them are named.
    """
    charts: dict[str, Chart] = {}
    damaged = []
    for name, table in tables.items():
        if not _has_chart(table["text"]):
            continue
        try:
            _check_chart(folder, name, table)
            charts[name] = stored_chart(unpack(chart_file(folder, name).read_bytes()))
        except (OSError, ValueError):
            damaged.append(name)
    if damaged:
        others = ""
        if damaged[1:]:
            others = f", and those of {', '.join(damaged[1:])}"
        raise InputError(
            f"{chart_file(folder, damaged[0])}: the chart is missing or damaged{others}; "
            f"{_repair_hint(folder, *damaged)}"
        )
    return charts


def _has_chart(text: str) -> bool:
    return f"]({FIGURES}/" in text


def _check_chart(folder: Path, name: str, table: Mapping[str, Any]) -> None:
    """Check that the file of a part's chart is the one that was written with it."""
    file = chart_file(folder, name)
    check_file(file, table.get(CHECK_SUMS, {}).get(file.name, ""))


def _repair_hint(folder: Path, *names: str) -> str:
    """Return the command that writes parts again."""
    which = "it" if len(names) == 1 else "them"
    return (
        f"make {which} anew: vibroimpact reproduce -o {shlex.quote(str(folder))} --only "
        f"{','.join(names)}"
    )
