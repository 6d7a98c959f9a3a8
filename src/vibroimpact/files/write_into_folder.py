"""Write several files into a folder that is there: all, or none.

They are written in a working folder inside, which is given another name once all are whole. Then each goes to its place. If the process
dies on the way, the next command that meets the folder has the rest follow (`recover`), so that files of two writings never stay mixed.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from errno import EACCES, EISDIR, ELOOP
from functools import partial
from pathlib import Path

from vibroimpact.files.leftovers import NEW, WHOLE, begun, inner_path, remove

_PUT, _GONE = "put", "gone"


def write_into(folder: Path, write: Callable[[Path], None], goes: tuple[str, ...] = ()) -> None:
    """Write files into a folder that is there: all of them or none.

    Parameters
    ----------
    folder : pathlib.Path
        Where they go.
    write : callable
        Writes them into an empty folder, and into folders of that.
    goes : tuple of str
        Patterns of the files of `folder` that go if they were not written again.

    Raises
    ------
    OSError
        If the folder can't be written to.
    """
    with begun(partial(inner_path, folder, NEW), Path.mkdir, folder) as working:
        (working / _PUT).mkdir()
        write(working / _PUT)
        written = _files(working / _PUT)
        for name in {file.relative_to(folder) for pattern in goes for file in folder.glob(pattern)} - set(written):
            (working / _GONE / name).parent.mkdir(parents=True, exist_ok=True)
            (working / _GONE / name).touch()
        check_places(working, folder)
        whole = working.with_suffix(f".{WHOLE}")
        working.rename(whole)
        finish(whole, folder)


def check_places(whole: Path, folder: Path) -> None:
    """Raise OSError unless all files of a working folder can go to their places, which lie in `folder`, whatever links are there."""
    inside = folder.resolve()
    for part in (_PUT, _GONE):
        for name in _files(whole / part):
            place = folder / name
            if place.is_dir():
                raise IsADirectoryError(EISDIR, os.strerror(EISDIR), str(place))
            if not place.parent.resolve().is_relative_to(inside):
                raise OSError(ELOOP, "this is a link that leads out of the folder", str(place.parent))
            if place.parent.exists() and not os.access(place.parent, os.W_OK):
                raise PermissionError(EACCES, os.strerror(EACCES), str(place.parent))


def finish(whole: Path, folder: Path) -> None:
    """Put the files of a working folder that is whole in their places, and remove those that go with it.

    Raises
    ------
    OSError
        If one can't be put there; the rest waits.
    """
    for name in _files(whole / _PUT):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(whole / _PUT / name, folder / name)
    for name in _files(whole / _GONE):
        (folder / name).unlink(missing_ok=True)
    remove(whole)


def _files(folder: Path) -> list[Path]:
    """Return the files below a folder, in order."""
    return [path.relative_to(folder) for path in sorted(folder.rglob("*")) if not path.is_dir() or path.is_symlink()]
