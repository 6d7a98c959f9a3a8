"""The files of the report of a study, in its folder."""

from __future__ import annotations

from functools import partial

from vibroimpact.report.page import replace_report_files
from vibroimpact.report.save_report import write_report
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.card import CARD
from vibroimpact.studies.report.report import SENSITIVITY


def write_study_report(study: Study) -> None:
    """Write the report of a study into its folder: `report.html` and the files of its tables.

    All files are written to a temporary folder and then moved into place one by one.

    Parameters
    ----------
    study : Study
        The completed study.

    Raises
    ------
    InputError
        If the folder can't be written.
    """
    write = partial(write_report, study.report)
    replace_report_files(study.path.parent, write, stale=(SENSITIVITY, CARD))
