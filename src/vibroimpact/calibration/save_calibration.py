"""Writes the folder of the calibration of a case."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

from vibroimpact.calibration.calibration import Calibration
from vibroimpact.calibration.friction.calibrate import FrictionCalibration
from vibroimpact.calibration.report import report_of
from vibroimpact.cases.case import Case
from vibroimpact.report.save_report import save_report


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
    return save_report(report_of(case, found), directory, force=force, figures=figures)
