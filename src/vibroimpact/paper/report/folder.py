"""The folder of a reproduction: parts, each written atomically with its chart, and the
report on those available.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.charts.made import drawn
from vibroimpact.charts.pack import pack
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_into
from vibroimpact.files.check_sums import CHECK_SUMS, file_digest, sealed
from vibroimpact.files.recover import recover
from vibroimpact.files.result_folder import FIGURES, new_folder, write_summary
from vibroimpact.paper.report.outline import PARTS, ReportPart, find_parts, render_part
from vibroimpact.paper.report.reproduction import (
    PARTS_FOLDER,
    chart_file,
    is_reproduction,
    load_reproduction,
    part_file,
    version_of_part,
)
from vibroimpact.paper.runs import Runs
from vibroimpact.report.page import replace_report_files
from vibroimpact.report.save_report import write_report


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
        only = list(PARTS)
        if exists:
            only = missing_parts(folder)
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
            write_summary(summary, working)
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
    folder = Path(directory)
    return [name for name in PARTS if version_of_part(folder, name) != __version__]


def write_reproduction_report(folder: Path) -> None:
    """Write the report and the table of values from the available parts of a folder.

    Raises
    ------
    InputError
        If a part is damaged, or the folder can't be written to.
    """
    report = load_reproduction(folder).report
    replace_report_files(folder, partial(write_report, report))


def _write_part(part: ReportPart, runs: Runs, folder: Path) -> None:
    """Compute a part and write its files atomically."""
    rendered = render_part(part, runs)

    def write(working: Path) -> None:
        for name in (PARTS_FOLDER, FIGURES):
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
            file = chart_file(working, part.name)
            file.write_bytes(pack(drawn(rendered.chart, plotly_chart)))
            table[CHECK_SUMS] = {file.name: file_digest(file)}
        part_file(working, part.name).write_bytes(sealed(table))

    try:
        write_into(folder, write)
    except OSError as error:
        raise InputError(
            f"{folder}: the part {part.name} can't be written: {error.strerror or error}"
        ) from None
