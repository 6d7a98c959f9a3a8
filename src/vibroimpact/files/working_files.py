"""Working files and folders of atomic writes: names, locks, and leftovers of dead processes.

A working file or folder is called `.vibroimpact-PLACE-NUMBER.KIND`: a digest of the name of its
target, a random number, and its kind. The writing process holds an advisory lock (flock) on the
working file or folder itself; the kernel releases the lock when the process ends, however it ends.
A working file that nobody has locked is a leftover. This needs no lock file and no process number
(which may be reused), and the lock stays in force when the file or folder is renamed.
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

# kinds
NEW = "new"  # not yet complete
OLD = "old"  # the replaced folder, kept until the new one is in place
COMPLETE = "whole"  # complete, its files being moved

_NAME = re.compile(rf"\.vibroimpact-([0-9a-f]{{16}})-[0-9a-f]{{12}}\.({NEW}|{OLD}|{COMPLETE})")
_TRIES = 100
_PAUSE = 0.05  # seconds between two looks at a lock
# seconds without a change after which it counts as a leftover, on file systems without locks
_ABANDONED = 86_400.0


def working_path(target: Path, kind: str) -> Path:
    """Return an unused path in the folder of `target`.

    Examples
    --------
    >>> working_path(Path("runs/first"), NEW).parent.as_posix()
    'runs'
    """
    return target.with_name(f".vibroimpact-{_digest(target.name)}-{secrets.token_hex(6)}.{kind}")


def inner_path(folder: Path, kind: str) -> Path:
    """Return an unused path inside a folder, for files to be written into that folder."""
    return folder / f".vibroimpact-{_digest('')}-{secrets.token_hex(6)}.{kind}"


def working_paths(target: Path) -> list[tuple[Path, str]]:
    """Return the working files and folders of `target`, each with its kind.

    They are in use or left over.
    """
    return _working_paths_in(target.parent, _digest(target.name))


def inner_working_paths(folder: Path) -> list[tuple[Path, str]]:
    """Return the working folders of files to be written into a folder, each with its kind.

    They are in use or left over.
    """
    return _working_paths_in(folder, _digest(""))


def all_working_paths(folder: Path) -> list[tuple[Path, str]]:
    """Return all working files and folders in a folder, each with its kind.

    Their targets may be any.
    """
    return _working_paths_in(folder, None)


@contextmanager
def new_working_path(
    name: Callable[[], Path], make: Callable[[Path], object], target: Path
) -> Iterator[Path]:
    """Create a working file or folder, and lock it for the duration of the block.

    It is removed if the block raises.

    Parameters
    ----------
    name : callable
        Returns an unused path.
    make : callable
        Creates an empty file or folder at a path.
    target : pathlib.Path
        The destination; an OSError names it in place of the working path.

    Raises
    ------
    OSError
        If it can't be created, or the block raises one.
    """
    # another process may clear a working file between its creation and its lock: then try the next
    # name
    for _ in range(_TRIES):
        working = name()
        try:
            make(working)
            with locked(working) as is_locked:
                if is_locked:
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
def locked(path: Path) -> Iterator[bool]:
    """Lock a file or a folder for the duration of the block, also if it is renamed there.

    Yields False if another process is clearing it as a leftover, or has done so.
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
def alone(folder: Path, longest: float) -> Iterator[None]:
    """Keep other processes that ask for the same out of a folder during the block.

    They are waited for, but not longer than `longest` [s].

    Where the system or the file system has no locks, nothing is waited for.
    """
    descriptor = _opened(folder)
    if descriptor is None:
        yield
        return
    try:
        end = time.monotonic() + longest
        while _lock(descriptor, shared=False) is False and time.monotonic() < end:
            time.sleep(_PAUSE)
        yield
    finally:
        os.close(descriptor)


@contextmanager
def abandoned(path: Path) -> Iterator[bool]:
    """Yield whether a working file or folder is a leftover.

    If so, it is locked against other processes during the block.
    """
    if path.is_symlink():
        yield True  # the replaced target was a symbolic link
        return
    descriptor = _opened(path)
    if descriptor is None:
        yield _is_old(path)
        return
    try:
        is_free = _lock(descriptor, shared=False)
        if is_free is None:  # without locks its age tells
            is_free = _is_old(path)
        yield _is_still(path, descriptor) and is_free
    finally:
        os.close(descriptor)


def remove(path: Path) -> None:
    """Remove a file, a link or a folder, ignoring errors."""
    with suppress(OSError):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


def _digest(name: str) -> str:
    """Return the digest of a target's name; "" stands for the folder itself."""
    return sha256(name.encode("utf-8", "surrogateescape")).hexdigest()[:16]


def _working_paths_in(folder: Path, target_digest: str | None) -> list[tuple[Path, str]]:
    """Return the working files in a folder, each with its kind.

    They are those of one target, or of all if `target_digest` is None.
    """
    try:
        names = os.listdir(folder)
    except OSError:
        return []
    paths = []
    for name in sorted(names):
        match = _NAME.fullmatch(name)
        if match and target_digest in (None, match[1]):
            paths.append((folder / name, match[2]))
    return paths


def _opened(path: Path) -> int | None:
    """Return a descriptor to lock; None if the system has no flock, or the path can't be opened."""
    if fcntl is None:
        return None
    try:
        return os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return None


def _lock(descriptor: int, *, shared: bool) -> bool | None:
    """Try to lock a descriptor without waiting, and return whether it succeeded.

    None if the file system does not support the lock.
    """
    kind = fcntl.LOCK_SH if shared else fcntl.LOCK_EX
    try:
        fcntl.flock(descriptor, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # such as folders on NFS
        return None
    return True


def _is_still(path: Path, descriptor: int) -> bool:
    """Return whether a path still refers to the file that was opened."""
    try:
        return os.path.samestat(os.lstat(path), os.fstat(descriptor))
    except OSError:
        return False


def _is_old(path: Path) -> bool:
    """Return whether a file or folder has not changed for `_ABANDONED` seconds."""
    try:
        return time.time() - os.lstat(path).st_mtime > _ABANDONED
    except OSError:
        return False
