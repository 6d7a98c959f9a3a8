"""Write the folder of a calibration: data, the calibrated case and the report page, and figures where they are asked for."""

from __future__ import annotations

import json
from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import tomli_w

from vibroimpact._version import __version__
from vibroimpact.calibration.calibrate_case import calibrated_case
from vibroimpact.calibration.calibration import Calibration
from vibroimpact.calibration.charts import calibration_charts
from vibroimpact.calibration.file_contents import CALIBRATION, calibration_table, columns_of, comparison_rows, matched_rows
from vibroimpact.calibration.tables import (
    differences_tables,
    fit_sentences,
    function_words,
    given_sentences,
    match_words,
    values_table,
    ways_words,
)
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.files.check_sums import CHECK_SUMS, file_digest, sealed
from vibroimpact.report.page import render_page
from vibroimpact.results.csv_files import write_csv
from vibroimpact.results.folder import SUMMARY, new_folder


def save_calibration(
    case: Case, found: Calibration, directory: str | PathLike[str], *, force: bool = False, figures: Sequence[str] = ()
) -> Path:
    """Write a calibration folder, atomically.

    It contains `calibration.json`, `case.toml` (the case with the calibrated values, ready to run), `matched.csv`, `comparison.csv`
    and `report.html`.

    Parameters
    ----------
    case : Case
        The calibrated case.
    found : Calibration
        Result of its calibration.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing folder.
    figures : sequence of str
        Formats in which the charts are also written as files, into a folder `figures`: of "png", "svg" and "pdf".

    Returns
    -------
    pathlib.Path
        The folder.

    Raises
    ------
    InputError
        If the folder exists already, or can't be written.
    """
    with new_folder(directory, force=force) as folder:
        (folder / "case.toml").write_text(tomli_w.dumps(resolved_case(calibrated_case(case, found))), encoding="utf-8")
        table = {**calibration_table(case, found), CHECK_SUMS: {"case.toml": file_digest(folder / "case.toml")}}
        (folder / CALIBRATION).write_text(sealed(table), encoding="utf-8")
        summary = {"name": case.name, "version": __version__, "calibration": found.parameter}
        (folder / SUMMARY).write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
        for name, rows in (("matched", matched_rows(found)), ("comparison", comparison_rows(found))):
            write_csv(rows, columns_of(rows), folder / f"{name}.csv")
        charts = calibration_charts(found)
        write_figures(charts, folder, figures)
        name = case.name or "a drop"
        page = render_page(
            __package__,
            charts,
            name=name[:1].upper() + name[1:],
            law=case.contact.law,
            function=function_words(found),
            matched=match_words(found),
            fit=fit_sentences(found),
            given=given_sentences(found),
            values=values_table(found),
            differences=differences_tables(found),
            ways=ways_words(found),
            doubts=found.doubts,
            case=tomli_w.dumps(resolved_case(case)),
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)
