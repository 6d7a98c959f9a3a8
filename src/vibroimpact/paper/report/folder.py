"""The folder of a reproduction: part by part, each whole or not at all, and a report of the parts that are there."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Callable, Iterable
from contextlib import suppress
from os import PathLike
from pathlib import Path
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.errors import InputError
from vibroimpact.files.check_sums import read_sealed, sealed
from vibroimpact.files.recover import recover
from vibroimpact.files.write_into_folder import write_into
from vibroimpact.paper.report.markdown import FIGURES
from vibroimpact.paper.report.outline import PARTS, Part, find_parts
from vibroimpact.paper.report.page import report_html, report_text
from vibroimpact.paper.report.rendered_part import make_part
from vibroimpact.paper.runs import Runs
from vibroimpact.report.figure_files import save_figures
from vibroimpact.report.write_files import write_beside
from vibroimpact.results.csv_files import write_csv
from vibroimpact.results.folder import SUMMARY, new_folder

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

    Each part appears whole or not at all, and stays if the run is interrupted.

    Parameters
    ----------
    directory : path
        The folder to make, or one that was made before: its parts stay, unless they are made anew.
    only : iterable of str, optional
        Names of parts, such as "table2" and "fig4"; by default all that the folder does not have yet.
    force : bool, default False
        Replace a folder that is there, with all its parts.
    progress : callable, optional
        Is told the fraction done, in [0, 1].
    tell : callable, optional
        Is told, in words, what takes long.

    Returns
    -------
    pathlib.Path
        The folder; it holds `report.html`, `report.md`, `values.csv` and `figures`.

    Raises
    ------
    InputError
        If there is no part of a name, something else is there already, or it can't be written to.
    """
    folder = Path(directory)
    recover(folder)
    there = is_reproduction(folder) and not force
    if isinstance(only, str):
        only = [only]
    elif only is None:
        only = missing_parts(folder) if there else list(PARTS)
        if not only:
            raise InputError(f"{folder}: all parts are there already; make some of them anew with --only, or all with --force")
    parts = find_parts(only)
    if not there:
        with new_folder(folder, force=force) as working:
            summary = {"name": "the paper, reproduced", "version": __version__, "reproduction": True}
            (working / SUMMARY).write_text(json.dumps(summary) + "\n", encoding="utf-8")
    runs = Runs(tell)
    try:
        for done, part in enumerate(parts):
            if progress is not None:
                progress(done / len(parts))
            _write_part(part, runs, folder)
    except BaseException:
        with suppress(OSError, InputError):  # what stopped the run is what is to be told
            write_reproduction_report(folder)
        raise
    write_reproduction_report(folder)
    if progress is not None:
        progress(1.0)
    return folder


def missing_parts(directory: str | PathLike[str]) -> list[str]:
    """Return the names of the parts that a folder does not have yet, or has of another version of this package."""
    return [name for name in PARTS if _version(_file(Path(directory), name)) != __version__]


def _version(part: Path) -> str | None:
    """Return by which version a part was made; None if there is none, or it is damaged."""
    try:
        return str(read_sealed(part)["version"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def write_reproduction_report(folder: Path) -> None:
    """Write the report and the table of values from the parts that a folder has.

    Raises
    ------
    InputError
        If a part is damaged, or the folder can't be written to.
    """
    parts = read_parts(folder)
    for name, part in parts.items():
        for picture in re.findall(rf"\]\(({FIGURES}/[^)]+)\.png\)", part["text"]):
            if not (folder / f"{picture}.svg").is_file():
                raise InputError(f"{folder / picture}.svg: the figure is missing; {_anew(folder, name)}")
    rows = [row for part in parts.values() for row in part["rows"]]
    text = report_text(parts)

    def write(working: Path) -> None:
        for name, page in {"report.md": text, "report.html": report_html(text, folder)}.items():
            (working / name).write_text(page, encoding="utf-8")
        if rows:
            write_csv(rows, list(rows[0]), working / "values.csv")

    write_beside(folder, write)


def read_parts(folder: Path) -> dict[str, dict[str, Any]]:
    """Return the parts that a folder has, by their names, in the order of the report.

    Raises
    ------
    InputError
        If it is not the folder of a reproduction, or a part is damaged.
    """
    if not is_reproduction(folder):
        raise InputError(f"{folder}: this is not the folder of a reproduction")
    found = {}
    for name in PARTS:
        file = _file(folder, name)
        if file.is_file():
            try:
                table = read_sealed(file)
                rows = [{**row, "verdict": str(row["verdict"])} for row in table["rows"]]
                found[name] = {"title": str(table["title"]), "text": str(table["text"]), "rows": rows}
            except (OSError, ValueError, KeyError, TypeError):
                raise InputError(f"{file}: the file is damaged; {_anew(folder, name)}") from None
    return found


def _anew(folder: Path, name: str) -> str:
    return f"make it anew: vibroimpact reproduce -o {shlex.quote(str(folder))} --only {name}"


def is_reproduction(folder: Path) -> bool:
    """Is it the folder of a reproduction?"""
    try:
        return bool(json.loads((folder / SUMMARY).read_text(encoding="utf-8")).get("reproduction"))
    except (OSError, ValueError, AttributeError):
        return False


def _file(folder: Path, part: str) -> Path:
    return folder / _PARTS / f"{part}.json"


def _write_part(part: Part, runs: Runs, folder: Path) -> None:
    """Make a part, and put it in place once all of it is there."""
    made = make_part(part, runs)

    def write(working: Path) -> None:
        for name in (_PARTS, FIGURES):
            (working / name).mkdir()
        if made.drawing is not None:
            save_figures({part.name: made.drawing.figure}, working / FIGURES)
        table = {"version": __version__, "title": made.title, "text": made.text, "rows": made.rows}
        _file(working, part.name).write_text(sealed(table), encoding="utf-8")

    try:
        write_into(folder, write)
    except OSError as error:
        raise InputError(f"{folder}: the part {part.name} can't be written: {error.strerror or error}") from None
