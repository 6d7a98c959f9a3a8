"""What is being written has a name of its own beside its place, and is locked by who writes it: what no living process holds is left over.

A working file or folder is called `.vibroimpact-PLACE-NUMBER.KIND`: a digest of the name that it is to have, a random number, and
what it is. The kernel frees the lock of a process that dies, whatever ended it, and no number of a process can be mistaken for another's.
"""

from __future__ import annotations

import os
import re
import secrets
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

NEW, OLD, WHOLE = "new", "old", "whole"
"""What is not whole yet; what made way for it, and is needed until that is in place; and what is whole, and on its way."""

_NAME = re.compile(rf"\.vibroimpact-([0-9a-f]{{16}})-[0-9a-f]{{12}}\.({NEW}|{OLD}|{WHOLE})")
_TRIES = 100
_ABANDONED = 86_400.0  # seconds without a change after which it is left over, where a file system knows no locks


def working_path(target: Path, kind: str) -> Path:
    """Return a path beside `target` that nothing else has.

    Examples
    --------
    >>> working_path(Path("runs/first"), NEW).parent.as_posix()
    'runs'
    """
    return target.with_name(f".vibroimpact-{_place(target.name)}-{secrets.token_hex(6)}.{kind}")


def inner_path(folder: Path, kind: str) -> Path:
    """Return a path in a folder, for files that are on their way into it, that nothing else has."""
    return folder / f".vibroimpact-{_place('')}-{secrets.token_hex(6)}.{kind}"


def leftovers(target: Path) -> list[tuple[Path, str]]:
    """Return what is being written, or was left over, beside `target`, each with its kind."""
    return _found(target.parent, _place(target.name))


def inner_leftovers(folder: Path) -> list[tuple[Path, str]]:
    """Return what is on its way, or was left over, in a folder, each with its kind."""
    return _found(folder, _place(""))


def all_leftovers(folder: Path) -> list[tuple[Path, str]]:
    """Return all that is being written, or was left over, in a folder, whatever it is to be."""
    return _found(folder, None)


@contextmanager
def begun(name: Callable[[], Path], make: Callable[[Path], object], target: Path) -> Iterator[Path]:
    """Make a working file or folder and hold it; remove it if the block ends with an error.

    Parameters
    ----------
    name : callable
        Returns a path that nothing has.
    make : callable
        Makes an empty file or folder there.
    target : pathlib.Path
        What it is for; errors of the disk name this, and not the working name.

    Raises
    ------
    OSError
        If it can't be made, or what is written in the block can't be.
    """
    for _ in range(_TRIES):
        working = name()
        try:
            make(working)
            with held(working) as mine:
                if mine:
                    yield working
                    return
        except OSError as error:
            remove(working)
            if isinstance(error.filename, str) and error.filename.startswith(str(working)):
                error.filename = f"{target}{error.filename.removeprefix(str(working))}"
            raise
        except BaseException:
            remove(working)
            raise
    raise OSError(f"{target}: other processes take away what is being written")


@contextmanager
def held(path: Path) -> Iterator[bool]:
    """Hold a file or a folder for as long as the block lasts, by whatever name it goes then.

    Gives False if another process has just taken it for left over: it is gone, or going.
    """
    descriptor = _opened(path)
    if descriptor is None:
        yield path.exists()
        return
    try:
        yield _lock(descriptor, shared=True) is not False and _is_still(path, descriptor)
    finally:
        os.close(descriptor)


@contextmanager
def left_over(path: Path) -> Iterator[bool]:
    """Is it left over? Then no other process takes it for its own, or clears it, within the block."""
    if path.is_symlink():
        yield True  # it stood for a folder until that was replaced
        return
    descriptor = _opened(path)
    if descriptor is None:
        yield _is_old(path)
        return
    try:
        locked = _lock(descriptor, shared=False)
        yield _is_still(path, descriptor) and (_is_old(path) if locked is None else locked)
    finally:
        os.close(descriptor)


def remove(path: Path) -> None:
    """Remove a file, a link or a folder as far as that can be done."""
    with suppress(OSError):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


def _place(name: str) -> str:
    return sha256(name.encode("utf-8", "surrogateescape")).hexdigest()[:16]


def _found(folder: Path, place: str | None) -> list[tuple[Path, str]]:
    try:
        names = os.listdir(folder)
    except OSError:
        return []
    matches = (match for name in sorted(names) if (match := _NAME.fullmatch(name)))
    return [(folder / match[0], match[2]) for match in matches if place in (None, match[1])]


def _opened(path: Path) -> int | None:
    """Return a descriptor to be locked; None where there are no locks, or nothing to open."""
    if fcntl is None:
        return None
    try:
        return os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return None


def _lock(descriptor: int, *, shared: bool) -> bool | None:
    """Lock, and return whether that was possible; None where the file system knows no such lock."""
    try:
        fcntl.flock(descriptor, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # such as folders on NFS
        return None
    return True


def _is_still(path: Path, descriptor: int) -> bool:
    """Does a name still stand for what was opened?"""
    try:
        return os.path.samestat(os.lstat(path), os.fstat(descriptor))
    except OSError:
        return False


def _is_old(path: Path) -> bool:
    try:
        return time.time() - os.lstat(path).st_mtime > _ABANDONED
    except OSError:
        return False
