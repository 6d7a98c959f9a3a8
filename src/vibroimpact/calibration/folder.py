"""Write the folder of a calibration: data, the calibrated case and the report page, and
figures where they are asked for.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import tomli_w

from vibroimpact._version import __version__
from vibroimpact.calibration.adams_dialog import DIALOG_TITLE, dialog_note
from vibroimpact.calibration.calibration import Calibration
from vibroimpact.calibration.file_contents import CALIBRATION, columns_of
from vibroimpact.calibration.friction.calibrate import FrictionCalibration
from vibroimpact.calibration.reported import report_of
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.files.check_sums import CHECK_SUMS, file_digest, sealed
from vibroimpact.report.page import render_page
from vibroimpact.results.csv_files import write_csv
from vibroimpact.results.folder import SUMMARY, new_folder


def save_calibration(
    case: Case,
    found: Calibration | FrictionCalibration,
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
) -> Path:
    """Write a calibration folder, atomically.

    It contains `calibration.json`, `case.toml` (the case with the calibrated values, ready to run),
    `matched.csv`, `comparison.csv` (not of friction) and `report.html`.

    Parameters
    ----------
    case : Case
        The calibrated case.
    found : Calibration or FrictionCalibration
        Result of its calibration.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing folder.
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
        If the folder exists already, or can't be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> what = vi.load_calibration("paper:type1-theory")
    >>> with TemporaryDirectory() as folder:
    ...     place = vi.save_calibration(what.case, vi.calibrate_case(what), f"{folder}/calibrated")
    ...     vi.load_case(place / "case.toml").contact.law
    'adams-impact'
    """
    told = report_of(case, found)
    with new_folder(directory, force=force) as folder:
        (folder / "case.toml").write_text(
            tomli_w.dumps(resolved_case(told.calibrated)), encoding="utf-8"
        )
        table = {**told.document, CHECK_SUMS: {"case.toml": file_digest(folder / "case.toml")}}
        (folder / CALIBRATION).write_bytes(sealed(table))
        summary = {"name": case.name, "version": __version__, "calibration": told.parameter}
        (folder / SUMMARY).write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
        for name, rows in told.tables.items():
            write_csv(rows, columns_of(rows), folder / f"{name}.csv")
        write_figures(told.charts, folder, figures)
        name = case.name or "a drop"
        page = render_page(
            __package__,
            told.charts,
            name=name[:1].upper() + name[1:],
            law=told.law,
            function=told.function,
            matched=told.matched,
            fit=told.fit,
            given=told.given,
            values=told.values,
            dialog=told.dialog,
            dialog_title=DIALOG_TITLE,
            dialog_note=dialog_note(told.parameter),
            differences=told.differences,
            ways=told.ways,
            doubts=told.doubts,
            case=tomli_w.dumps(resolved_case(case)),
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)
