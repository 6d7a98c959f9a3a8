"""Make the report of a folder again: of a run, a study or a reproduction of the paper."""

from __future__ import annotations

from functools import partial
from os import PathLike
from pathlib import Path

from vibroimpact.files.recover import recover
from vibroimpact.report.page import replace_report_files
from vibroimpact.results.folder import read_result
from vibroimpact.runs.page import write_report


def remake_report(directory: str | PathLike[str]) -> Path:
    """Make figures and report of a result folder again, from its data; its other files stay as they are.

    Of a reproduction of the paper, the report is made again from the parts that are there; of a study, from its dataset.

    Raises
    ------
    InputError
        If it is not a result folder, its data are damaged, or it can't be written to.
    """
    # which load what a run does not need
    from vibroimpact.paper.report.folder import is_reproduction, write_reproduction_report
    from vibroimpact.studies.report.page import write_study_report
    from vibroimpact.studies.study import is_study, read_study

    folder = Path(directory)
    recover(folder)
    if is_study(folder):
        write_study_report(read_study(folder), folder)
        return folder
    if is_reproduction(folder):
        write_reproduction_report(folder)
        return folder
    result = read_result(directory)
    replace_report_files(folder, partial(write_report, result))
    return folder
