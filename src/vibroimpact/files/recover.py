"""Recovery after a process died while it wrote.

It is run by the next command that uses the file or folder.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from vibroimpact.files.atomic_write import check_destinations, move_files
from vibroimpact.files.working_files import (
    COMPLETE,
    OLD,
    abandoned,
    all_working_paths,
    inner_working_paths,
    remove,
    working_paths,
)


def recover(target: Path) -> None:
    """Clear or complete the leftovers of a file or a folder, next to it and inside it.

    Those of running processes stay.

    A replaced folder whose successor is missing gets its name back. Files of a complete working
    folder are moved to their destinations. Where nothing can be written, everything stays as it is.

    Parameters
    ----------
    target : pathlib.Path
        The file or the folder; it need not exist.
    """
    target = Path(os.path.abspath(target))
    for path, kind in working_paths(target):
        with abandoned(path) as is_abandoned:
            if not is_abandoned:
                continue
            if kind == OLD and not os.path.lexists(target):
                with suppress(OSError):
                    path.rename(target)
            else:
                remove(path)
    if target.is_dir():
        for path, kind in inner_working_paths(target):
            with abandoned(path) as is_abandoned:
                if is_abandoned:
                    _complete(path, kind, target)


def _complete(path: Path, kind: str, folder: Path) -> None:
    """Move the files of a complete working folder to their destinations.

    One that is incomplete, or whose files may not go there, is removed.
    """
    if kind != COMPLETE:
        remove(path)
        return
    try:
        check_destinations(path, folder)
    except OSError:
        remove(path)
        return
    with suppress(OSError):
        move_files(path, folder)


def clear(folder: Path) -> None:
    """Remove all leftovers of files in a folder."""
    for path, _ in all_working_paths(folder):
        with abandoned(path) as is_abandoned:
            if is_abandoned:
                remove(path)
