"""Writes a recognition as a folder: tables, summary, page, and the model with its card."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

from vibroimpact._version import __version__
from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.recognition.charts import recognition_charts
from vibroimpact.recognition.classifiers import CLASSIFIER
from vibroimpact.recognition.recognise import Recognition
from vibroimpact.recognition.recogniser import FOLDER, save_recogniser
from vibroimpact.recognition.tables import (
    SCORE_HEADERS,
    TABLES,
    Row,
    confusion_cells,
    score_cells,
    sentences,
    summary_of_recognition,
)
from vibroimpact.report.page import render_page
from vibroimpact.results.csv_files import write_csv
from vibroimpact.results.folder import new_folder, write_summary

_COLUMNS = {
    "unseen.csv": ["key", "range", "signals"],
    "fraction.csv": ["class", "fraction", "impacts"],
}
"""First columns of tables that may have no rows."""


def save_recognition(
    found: Recognition,
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
) -> Path:
    """Write a recognition atomically: CSV files, `summary.json`, `report.html`, and the model in
    the folder `model`.

    Parameters
    ----------
    found : Recognition
        The recognition.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing result folder.
    figures : sequence of str
        Formats in which the charts are also written as files, into a folder `figures`: of "png",
        "svg" and "pdf".

    Returns
    -------
    pathlib.Path
        The folder.

    Raises
    ------
    InputError
        If the folder exists and may not be replaced, or it can't be written to.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> place = vi.save_recognition(vi.recognise("falls", folds=2, seeds=1), "found")
    >>> vi.load_recogniser(place).class_names
    ('coal', 'gangue')
    """
    with new_folder(directory, force=force) as folder:
        for name, rows_of in TABLES.items():
            write_rows(rows_of(found), folder / name)
        write_summary(summary_of_recognition(found), folder)
        (folder / FOLDER).mkdir()
        save_recogniser(found.recogniser, folder / FOLDER)
        charts = recognition_charts(found)
        write_figures(charts, folder, figures)
        kinds = {one.name: one.kind for one in found.compared}
        page = render_page(
            __package__,
            charts,
            name=found.name[:1].upper() + found.name[1:],
            counts=[
                f"{count:,} {name}"
                for name, count in zip(found.class_names, found.counts, strict=True)
            ],
            found=found,
            sentences=list(sentences(found)),
            confusion=confusion_cells(found),
            headers=SCORE_HEADERS,
            rows=[
                (f"{row[0]} ({kinds[row[0]]})" if kinds[row[0]] != CLASSIFIER else row[0], *row[1:])
                for row in score_cells(found)
            ],
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)


def write_rows(rows: Sequence[Row], path: Path) -> None:
    """Write rows as CSV; a table without rows has the first columns alone."""
    write_csv(rows, list(rows[0]) if rows else _COLUMNS[path.name], path)
