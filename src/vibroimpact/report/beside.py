"""Write the files of a report beside those that are there, and put them in their places once all are written."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from vibroimpact.errors import InputError


def write_beside(folder: Path, write: Callable[[Path], None], goes: tuple[str, ...] = ()) -> None:
    """Write files into a folder that is there: all of them beside, then each in its place; if one can't be written, none is.

    Parameters
    ----------
    folder : pathlib.Path
        Where they go.
    write : callable
        Writes them into an empty folder. Their names have a dot.
    goes : tuple of str
        Patterns of the files of `folder` that go if they were not written again.

    Raises
    ------
    InputError
        If the folder can't be written to.
    """
    try:
        with TemporaryDirectory(prefix=".report.", dir=folder) as name:
            write(Path(name))
            written = [file.relative_to(name) for file in sorted(Path(name).rglob("*.*"))]
            for file in written:
                (folder / file).parent.mkdir(exist_ok=True)
                os.replace(Path(name) / file, folder / file)
        for old in {file for pattern in goes for file in folder.glob(pattern)} - {folder / file for file in written}:
            old.unlink()
    except OSError as error:
        raise InputError(f"{folder}: the report can't be written: {error.strerror}") from None
