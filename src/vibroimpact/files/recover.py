"""Put right what processes that died while they wrote have left: the next command that meets a place does."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from vibroimpact.files.leftovers import OLD, WHOLE, all_leftovers, inner_leftovers, left_over, leftovers, remove
from vibroimpact.files.write_into_folder import check_places, finish


def recover(target: Path) -> None:
    """Clear what dead processes left of a file or a folder, beside it and in it; what a living one writes stays.

    A folder that made way for a new one which never came gets its name back. Files that were whole and on their way into the folder
    get there. Where nothing can be written, all stays as it is.

    Parameters
    ----------
    target : pathlib.Path
        The file or the folder, which need not be there.
    """
    target = Path(os.path.abspath(target))
    for path, kind in leftovers(target):
        with left_over(path) as dead:
            if not dead:
                continue
            if kind == OLD and not os.path.lexists(target):
                with suppress(OSError):
                    path.rename(target)
            else:
                remove(path)
    if target.is_dir():
        for path, kind in inner_leftovers(target):
            with left_over(path) as dead:
                if dead:
                    _finish(path, kind, target)


def _finish(path: Path, kind: str, folder: Path) -> None:
    """Have files that were whole go to their places, if they can; what was not whole goes."""
    if kind == WHOLE:
        try:
            check_places(path, folder)
        except OSError:
            remove(path)
            return
        with suppress(OSError):
            finish(path, folder)
    else:
        remove(path)


def clear(folder: Path) -> None:
    """Clear all that dead processes left of files in a folder."""
    for path, _ in all_leftovers(folder):
        with left_over(path) as dead:
            if dead:
                remove(path)
