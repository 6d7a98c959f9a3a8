"""Folders that are made for what is written into them, and go again if it can't be written."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def made_folder(folder: Path) -> Iterator[None]:
    """Make a folder with those above it.

    If the block fails, those that were made are removed where they are empty.

    Raises
    ------
    OSError
        If it can't be made.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as place, suppress(ZeroDivisionError):
    ...     with made_folder(Path(place, "a", "b")):
    ...         print(Path(place, "a", "b").is_dir(), 1 / 0)
    """
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        yield
    except BaseException:
        for path in missing:  # the innermost first
            with suppress(OSError):
                path.rmdir()
        raise
