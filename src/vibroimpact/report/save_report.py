"""The folder of a report: data files, summary, page, and charts as files."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.report.report import Report
from vibroimpact.results.folder import REPORT, new_folder, write_summary


def save_report(
    report: Report,
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
) -> Path:
    """Write the folder of a report atomically, and return its path.

    Parameters
    ----------
    report : Report
        The report.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing result folder.
    figures : sequence of str
        Formats in which the charts are also written as files, into a folder `figures`: of "png",
        "svg" and "pdf".

    Raises
    ------
    InputError
        If the folder exists and may not be replaced, or it can't be written to.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     saved = save_report(Report("Two balls", (), {"name": "balls"}), f"{folder}/balls")
    ...     sorted(file.name for file in saved.iterdir())
    ['report.html', 'summary.json']
    """
    with new_folder(directory, force=force) as folder:
        write_report(report, folder)
        write_summary(report.summary, folder)
        write_figures(report.all_charts, folder, figures)
    return Path(directory)


def write_report(report: Report, folder: Path) -> None:
    """Write the page of a report, and its further files, into an existing folder.

    Parameters
    ----------
    report : Report
        The report.
    folder : pathlib.Path
        The existing folder.
    """
    for name, write in report.files.items():
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        write(path)
    (folder / REPORT).write_text(page_of_report(report), encoding="utf-8")
