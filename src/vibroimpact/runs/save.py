"""Write a whole result folder."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from vibroimpact.dynamics.response import Response
from vibroimpact.results.folder import new_folder, write_result
from vibroimpact.results.result import result_of
from vibroimpact.runs.page import write_report
from vibroimpact.runs.paraview import write_paraview


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
