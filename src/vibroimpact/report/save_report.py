"""The folder of a report: data files, summary, page, and charts as files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path

from vibroimpact.charts.made import SCENE, warn_of_lost
from vibroimpact.files.result_folder import (
    FIGURES,
    REPORT,
    new_folder,
    write_files,
    write_summary,
)
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.report.report import Report

ANIMATION = "plate.gif"
"""The plate in motion, in the folder of the figures."""


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
        fill_folder(report, folder, figures)
    return Path(directory)


def fill_folder(
    report: Report,
    folder: Path,
    figures: Sequence[str] = (),
    progress: Callable[[float], None] = lambda done: None,
) -> None:
    """Write the files of a report into an empty folder.

    Parameters
    ----------
    report : Report
        The report.
    folder : pathlib.Path
        The folder.
    figures : sequence of str
        As `save_report` takes them.
    progress : callable, optional
        Called with the part of the figures that is written, up to 1.
    """
    write_report(report, folder)
    write_summary(report.stored_summary, folder, report.checked_files)
    if figures:
        (folder / FIGURES).mkdir()
        write_figures(report, folder / FIGURES, figures, progress)


def write_report(report: Report, folder: Path) -> None:
    """Write the page of a report, and its further files, into an existing folder."""
    write_files(report.files, folder)
    write_page(report, folder)


def write_page(report: Report, folder: Path) -> None:
    """Write the page of a report into an existing folder."""
    (folder / REPORT).write_text(page_of_report(report), encoding="utf-8")


def write_figures(
    report: Report,
    directory: Path,
    formats: Sequence[str],
    progress: Callable[[float], None] = lambda done: None,
) -> None:
    """Write the charts of a report into an existing directory, and what moves as `plate.gif`.

    Parameters
    ----------
    report : Report
        The report.
    directory : pathlib.Path
        The directory.
    formats : sequence of str
        Of "png", "svg" and "pdf".
    progress : callable, optional
        Called with the part of the charts that is written, up to 1.
    """
    from vibroimpact.charts.files import save_charts  # here, as it imports matplotlib

    save_charts(report.all_charts, directory, formats, progress)
    for scene in report.scenes:
        if scene.animation is not None:
            _write_animation(scene.animation, directory / ANIMATION)


def _write_animation(animation: Callable[[], bytes], path: Path) -> None:
    """Write an animation; one that can't be drawn is left out, with a `ChartWarning`."""
    try:
        content = animation()
    except Exception as error:
        warn_of_lost(SCENE, error)
        return
    path.write_bytes(content)
