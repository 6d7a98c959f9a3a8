"""Regeneration of the report of a run, a study or a reproduction of the paper."""

from __future__ import annotations

from functools import partial
from os import PathLike
from pathlib import Path

from vibroimpact.files.recover import recover
from vibroimpact.report.page import replace_report_files
from vibroimpact.report.save_report import write_page
from vibroimpact.results.folder import load_result


def remake_report(directory: str | PathLike[str]) -> Path:
    """Regenerate the report of a result folder from its data; other files are left unchanged.

    The report of a reproduction of the paper is regenerated from its existing parts, that of a
    study from its dataset.

    Raises
    ------
    InputError
        If it is not a result folder, its data are damaged, or it can't be written to.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> response = vi.simulate(vi.load_case("paper:type1-theory"))
    >>> with TemporaryDirectory() as temporary:
    ...     folder = response.save(f"{temporary}/theory")
    ...     vi.remake_report(folder).name
    'theory'
    """
    # imported here, since a run does not need them
    from vibroimpact.studies.computation.study import load_study
    from vibroimpact.studies.computation.study_folder import is_study
    from vibroimpact.studies.report.write_report import write_study_report

    folder = Path(directory)
    recover(folder)
    if is_study(folder):
        write_study_report(load_study(folder))
        return folder
    from vibroimpact.paper.report.folder import write_reproduction_report
    from vibroimpact.paper.report.reproduction import is_reproduction

    if is_reproduction(folder):
        write_reproduction_report(folder)
        return folder
    report = load_result(directory).report
    replace_report_files(folder, partial(write_page, report))
    return folder
