"""The folder of a reproduction: parts, each written atomically with its chart, and the
report on those available.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from os import PathLike
from pathlib import Path
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.charts.made import drawn
from vibroimpact.charts.pack import pack, unpack
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_into
from vibroimpact.files.check_sums import CHECK_SUMS, check_file, file_digest, read_sealed, sealed
from vibroimpact.files.json_reading import read_json_table
from vibroimpact.files.recover import recover
from vibroimpact.files.result_folder import FIGURES, SUMMARY, new_folder
from vibroimpact.paper.report.outline import (
    PARTS,
    VALUE_COLUMNS,
    ReportPart,
    find_parts,
    render_part,
)
from vibroimpact.paper.report.page import report_html, report_text
from vibroimpact.paper.report_section import Kind, Verdict
from vibroimpact.paper.runs import Runs
from vibroimpact.report.page import replace_report_files
from vibroimpact.results.csv_files import write_csv

_PARTS = "parts"


def reproduce_paper(
    directory: str | PathLike[str],
    only: Iterable[str] | None = None,
    *,
    force: bool = False,
    progress: Callable[[float], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> Path:
    """Reproduce the paper, or parts of it, in a folder: report, figures and a table of all values.

    Each part is written atomically, and is kept if the run is interrupted.

    Parameters
    ----------
    directory : path
        The folder to create, or that of an earlier reproduction, whose other parts are kept.
    only : iterable of str, optional
        Names of parts, such as "table2" and "fig4"; by default all parts that the folder lacks.
    force : bool, default False
        Replace an existing folder and all its parts.
    progress : callable, optional
        Called with the fraction done, in [0, 1].
    tell : callable, optional
        Called with a message before a long computation.

    Returns
    -------
    pathlib.Path
        The folder; it holds `report.html`, `report.md`, `values.csv` and `figures`.

    Raises
    ------
    InputError
        If a part is unknown, none is missing, or the folder holds something else or can't be
        written to.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> with TemporaryDirectory() as folder:
    ...     place = vi.reproduce_paper(f"{folder}/paper", only=["table1"])
    ...     sorted(file.name for file in place.iterdir())
    ['parts', 'report.html', 'report.md', 'summary.json', 'values.csv']
    """
    folder = Path(directory)
    recover(folder)
    exists = is_reproduction(folder) and not force
    if isinstance(only, str):
        only = [only]
    elif only is None:
        only = missing_parts(folder) if exists else list(PARTS)
        if not only:
            raise InputError(
                f"{folder}: all parts are there already; make some of them anew with "
                "--only, or all with --force"
            )
    parts = find_parts(only)
    if not exists:
        with new_folder(folder, force=force) as working:
            summary = {
                "name": "the paper, reproduced",
                "version": __version__,
                "reproduction": True,
            }
            (working / SUMMARY).write_text(json.dumps(summary) + "\n", encoding="utf-8")
    runs = Runs(tell)
    try:
        for done, part in enumerate(parts):
            if progress is not None:
                progress(done / len(parts))
            _write_part(part, runs, folder)
    except BaseException:
        with suppress(OSError, InputError):  # the error that stopped the run must not be masked
            write_reproduction_report(folder)
        raise
    write_reproduction_report(folder)
    if progress is not None:
        progress(1.0)
    return folder


def missing_parts(directory: str | PathLike[str]) -> list[str]:
    """Return the names of the parts that a folder lacks or has damaged, or that another
    version of this package wrote.
    """
    return [name for name in PARTS if _version(Path(directory), name) != __version__]


def _version(folder: Path, name: str) -> str | None:
    """Return the version of the package that wrote a part; None if the part or its chart
    is missing or damaged.
    """
    try:
        table = read_sealed(_file(folder, name))
        if _has_chart(table["text"]):
            _check_chart(folder, name, table)
        return str(table["version"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None


def write_reproduction_report(folder: Path) -> None:
    """Write the report and the table of values from the available parts of a folder.

    Raises
    ------
    InputError
        If a part is damaged, or the folder can't be written to.
    """
    parts = read_parts(folder)
    charts = read_charts(folder, parts)
    rows, text = reproduced_values(parts), report_text(parts)

    def write(working: Path) -> None:
        for name, page in {"report.md": text, "report.html": report_html(text, charts)}.items():
            (working / name).write_text(page, encoding="utf-8")
        if rows:
            write_csv(rows, list(rows[0]), working / "values.csv")

    replace_report_files(folder, write)


def read_parts(folder: Path) -> dict[str, dict[str, Any]]:
    """Return the available parts of a folder by name, in the order of the report.

    Raises
    ------
    InputError
        If the folder is not that of a reproduction, or a part is damaged.
    """
    if not is_reproduction(folder):
        raise InputError(f"{folder}: this is not the folder of a reproduction")
    found = {}
    for name in PARTS:
        file = _file(folder, name)
        if file.is_file():
            try:
                table = read_sealed(file)
                rows = [_row(row) for row in table["rows"]]
                texts = {"title": str(table["title"]), "text": str(table["text"])}
                found[name] = {**texts, "rows": rows, CHECK_SUMS: dict(table.get(CHECK_SUMS, {}))}
            except (OSError, ValueError, KeyError, TypeError):
                raise InputError(
                    f"{file}: the file is damaged; {_repair_hint(folder, name)}"
                ) from None
    return found


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


def reproduced_values(parts: Mapping[str, Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return the rows of `values.csv`: each value that the parts compare."""
    return [row for part in parts.values() for row in part["rows"]]


def read_charts(folder: Path, parts: Mapping[str, Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return the charts of parts that `read_parts` returned, as `plotly_chart` returns them.

    Raises
    ------
    InputError
        If a chart is missing, as in a folder of an earlier version, or damaged.
    """
    found, lacking = [], []
    for name, part in parts.items():
        if _has_chart(part["text"]):
            try:
                _check_chart(folder, name, part)
                found.append(unpack(_chart_file(folder, name).read_bytes()))
            except (OSError, ValueError):
                lacking.append(name)
    if lacking:
        others = f", and those of {', '.join(lacking[1:])}" if lacking[1:] else ""
        raise InputError(
            f"{_chart_file(folder, lacking[0])}: the chart is missing or damaged{others}; "
            f"{_repair_hint(folder, *lacking)}"
        )
    return found


def _has_chart(text: str) -> bool:
    return f"]({FIGURES}/" in text


def _check_chart(folder: Path, name: str, part: Mapping[str, Any]) -> None:
    """Check that the file of a part's chart is the one that was written with it."""
    file = _chart_file(folder, name)
    check_file(file, part.get(CHECK_SUMS, {}).get(file.name, ""))


def _repair_hint(folder: Path, *names: str) -> str:
    """Return the command that writes parts again."""
    which = "it" if len(names) == 1 else "them"
    return (
        f"make {which} anew: vibroimpact reproduce -o {shlex.quote(str(folder))} --only "
        f"{','.join(names)}"
    )


def is_reproduction(folder: Path) -> bool:
    """Return whether a folder is that of a reproduction."""
    try:
        return bool(read_json_table(folder / SUMMARY).get("reproduction"))
    except InputError:
        return False


def _file(folder: Path, part: str) -> Path:
    return folder / _PARTS / f"{part}.json"


def _chart_file(folder: Path, part: str) -> Path:
    return folder / _PARTS / f"{part}.chart"


def _write_part(part: ReportPart, runs: Runs, folder: Path) -> None:
    """Compute a part and write its files atomically."""
    rendered = render_part(part, runs)

    def write(working: Path) -> None:
        for name in (_PARTS, FIGURES):
            (working / name).mkdir()
        table: dict[str, Any] = {
            "version": __version__,
            "title": rendered.title,
            "text": rendered.text,
            "rows": rendered.rows,
        }
        if rendered.chart is not None:
            # here, as it imports matplotlib, which `report` does without
            from vibroimpact.charts.files import save_charts

            save_charts([rendered.chart], working / FIGURES)
            file = _chart_file(working, part.name)
            file.write_bytes(pack(drawn(rendered.chart, plotly_chart)))
            table[CHECK_SUMS] = {file.name: file_digest(file)}
        _file(working, part.name).write_bytes(sealed(table))

    try:
        write_into(folder, write)
    except OSError as error:
        raise InputError(
            f"{folder}: the part {part.name} can't be written: {error.strerror or error}"
        ) from None
