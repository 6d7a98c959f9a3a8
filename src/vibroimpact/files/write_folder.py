"""Write a folder, whole or not at all; it takes the place of one that is there in one step."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from vibroimpact.files.exchange import exchange
from vibroimpact.files.leftovers import NEW, OLD, begun, held, remove, working_path


@contextmanager
def whole_folder(target: Path, check: Callable[[], None]) -> Iterator[Path]:
    """Give an empty folder to fill, which takes the place of `target` when the block ends without an error.

    Parameters
    ----------
    target : pathlib.Path
        Where it is to be. The folder that is there stays until then.
    check : callable
        Raises if the folder may not go there; is called last, as another process may have been quicker.

    Raises
    ------
    OSError
        If it can't be written.
    """
    with begun(partial(working_path, target, NEW), Path.mkdir, target) as working:
        yield working
        check()
        _put_in_place(working, target)


def _put_in_place(working: Path, target: Path) -> None:
    """Rename a folder, or exchange it with the one that is there."""
    if not os.path.lexists(target):
        working.rename(target)
        return
    _to_disk(working)  # before the old one goes
    if exchange(working, target):
        remove(working)
        return
    # for a moment neither has the name; if this process dies then, `recover` gives it back to the old one
    aside = working_path(target, OLD)
    with held(target):
        target.rename(aside)
        try:
            working.rename(target)
        except OSError:
            aside.rename(target)
            raise
        remove(aside)


def _to_disk(folder: Path) -> None:
    """Have the files of a folder on the disk, so that a loss of power finds the old one or the new one."""
    for place, _, names in os.walk(folder):
        for name in names:
            descriptor = os.open(os.path.join(place, name), os.O_RDWR)
            try:
                os.fsync(descriptor)
            finally:
                os.close(descriptor)
