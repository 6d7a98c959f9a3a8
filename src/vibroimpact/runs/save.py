"""Writing of the result folder of one drop: data files, ParaView files and report."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from vibroimpact.dynamics.response import Response
from vibroimpact.results.folder import new_folder, write_result
from vibroimpact.results.result import Result, result_of
from vibroimpact.runs.page import write_report
from vibroimpact.runs.paraview import write_paraview


def save_result(response: Response, directory: str | PathLike[str], *, force: bool = False) -> Path:
    """Write the result folder of one drop: data and report. The write is atomic: the folder appears
    complete or not at all.

    Parameters
    ----------
    response : Response
        Response to one drop.
    directory : path
        Folder to create.
    force : bool, default False
        Replace an existing result folder.

    Returns
    -------
    pathlib.Path
        The folder.

    Raises
    ------
    InputError
        If the path exists and may not be replaced, or can't be written to.

    Examples
    --------
    >>> import tempfile
    >>> import vibroimpact as vi
    >>> with tempfile.TemporaryDirectory() as place:
    ...     folder = vi.save_result(
    ...         vi.simulate(vi.load_case("paper:type1-theory")), f"{place}/theory"
    ...     )
    ...     len(vi.load_result(folder).impacts["impact"])
    5
    """
    with new_folder(directory, force=force) as folder:
        write_report(write_data(response, folder), folder)
    return Path(directory)


def write_data(response: Response, folder: Path) -> Result:
    """Write the data and ParaView files of one drop into a folder, and return the result that they
    hold.

    Report and figures need the result only: a caller that is done with the response can release its
    memory before they are made.
    """
    result = result_of(response)
    write_result(result, folder)
    write_paraview(response, folder)
    return result
