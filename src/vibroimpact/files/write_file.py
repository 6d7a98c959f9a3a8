"""Write one file, whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from vibroimpact.files.leftovers import NEW, begun, working_path


@contextmanager
def new_file(target: Path) -> Iterator[Path]:
    """Give an empty file to fill, which takes the place of `target` when the block ends without an error.

    HDF5 locks what it writes, and this file is locked: open it with `locking=False`.

    Parameters
    ----------
    target : pathlib.Path
        Where it is to be; what is there stays until then. Of a link, the file that it leads to is replaced.

    Raises
    ------
    OSError
        If it can't be written.
    """
    place = target.resolve() if target.is_symlink() else target
    with begun(partial(working_path, place, NEW), _empty, target) as working:
        yield working
        os.replace(working, place)


def write_file(target: Path, content: bytes | Iterable[bytes], *, durable: bool = False) -> None:
    """Write a file, whole or not at all.

    Parameters
    ----------
    target : pathlib.Path
        Where it is to be; takes the place of a file that is there. A device or a pipe is written to as it is.
    content : bytes or iterable of bytes
        What it holds.
    durable : bool, default False
        Have it on the disk before it is in its place, so that a loss of power does not tear it.

    Raises
    ------
    OSError
        If it can't be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     write_file(Path(folder, "a.txt"), b"all of it")
    ...     Path(folder, "a.txt").read_text()
    'all of it'
    """
    pieces = [content] if isinstance(content, bytes) else content
    if target.exists() and not target.is_file():
        with target.open("wb") as stream:
            stream.writelines(pieces)
        return
    with new_file(target) as working, working.open("wb") as file:
        file.writelines(pieces)
        file.flush()
        if durable:
            os.fsync(file.fileno())


def _empty(path: Path) -> None:
    os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
