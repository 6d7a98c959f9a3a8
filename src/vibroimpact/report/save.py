"""Write a whole result folder, and remake the report of one."""

from __future__ import annotations

from functools import partial
from os import PathLike
from pathlib import Path

from vibroimpact.dynamics.response import Response
from vibroimpact.report.beside import write_beside
from vibroimpact.report.page import write_report
from vibroimpact.storage.folder import new_folder, read_result, write_result
from vibroimpact.storage.paraview import write_paraview
from vibroimpact.storage.result import result_of
from vibroimpact.writing.recover import recover


def save_result(response: Response, directory: str | PathLike[str], *, force: bool = False) -> Path:
    """Write the result folder of one drop: data, figures and report; it appears whole or not at all.

    Parameters
    ----------
    response : Response
        The response to one drop.
    directory : path
        The folder to make.
    force : bool, default False
        Replace a result folder that is there.

    Returns
    -------
    pathlib.Path
        The folder.

    Raises
    ------
    InputError
        If something is there already, or the place can't be written to.
    """
    with new_folder(directory, force=force) as folder:
        result = result_of(response)
        write_result(result, folder)
        write_paraview(response, folder)
        write_report(result, folder)
    return Path(directory)


def remake_report(directory: str | PathLike[str]) -> Path:
    """Make figures and report of a result folder again, from its data; its other files stay as they are.

    Of a reproduction of the paper, the report is made again from the parts that are there; of a study, from its dataset.

    Raises
    ------
    InputError
        If it is not a result folder, its data are damaged, or it can't be written to.
    """
    # which load what a run does not need
    from vibroimpact.report.reproduction.folder import is_reproduction, write_reproduction_report
    from vibroimpact.report.study.page import write_study_report
    from vibroimpact.storage.study import is_study, read_study

    folder = Path(directory)
    recover(folder)
    if is_study(folder):
        write_study_report(read_study(folder), folder)
        return folder
    if is_reproduction(folder):
        write_reproduction_report(folder)
        return folder
    result = read_result(directory)
    write_beside(folder, partial(write_report, result))
    return folder
