"""Write the files of a report into a folder that is there, all or none."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_into


def write_beside(folder: Path, write: Callable[[Path], None], goes: tuple[str, ...] = ()) -> None:
    """Write the files of a report into a folder that is there: all of them or none.

    Parameters
    ----------
    folder : pathlib.Path
        Where they go.
    write : callable
        Writes them into an empty folder.
    goes : tuple of str
        Patterns of the files of `folder` that go if they were not written again.

    Raises
    ------
    InputError
        If the folder can't be written to.
    """
    try:
        write_into(folder, write, goes)
    except OSError as error:
        raise InputError(f"{folder}: the report can't be written: {error.strerror or error}") from None
