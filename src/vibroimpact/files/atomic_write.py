"""Atomic writes of files and folders: complete, or not at all.

There are those of a file, of a folder, and of several files into an existing folder. Everything is
written under a working name on the same file system (`vibroimpact.files.working_files`) and renamed
at the end. What a process that died has left is cleared or completed by
`vibroimpact.files.recover`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from errno import EACCES, EISDIR, ELOOP
from functools import partial
from os import PathLike
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.files.working_files import (
    COMPLETE,
    NEW,
    OLD,
    inner_path,
    locked,
    new_working_path,
    remove,
    working_path,
)

# subfolders of a working folder
_PUT = "put"  # files to be moved to their destinations
_GONE = "gone"  # empty files, named as those to be deleted


# one file


@contextmanager
def atomic_file(target: Path) -> Iterator[Path]:
    """Yield the path of an empty working file, which replaces `target` at the end of the block.

    It does not if the block raises an error.

    The working file is locked; HDF5 locks the files that it writes too, so open it there with
    `locking=False`.

    Parameters
    ----------
    target : pathlib.Path
        The destination, unchanged until then. If it is a symbolic link, the file that it points to
        is replaced.

    Raises
    ------
    OSError
        If it can't be written.
    """
    file = target
    if target.is_symlink():  # the link stays, and what it points to is replaced
        file = target.resolve()
    with new_working_path(partial(working_path, file, NEW), _make_empty_file, target) as working:
        yield working
        os.replace(working, file)


def write_file(target: Path, content: bytes | Iterable[bytes], *, durable: bool = False) -> None:
    """Write a file atomically.

    Parameters
    ----------
    target : pathlib.Path
        The destination; an existing file is replaced. A device or a pipe is written to directly.
    content : bytes or iterable of bytes
        The content of the file.
    durable : bool, default False
        Flush it to the disk (fsync) before it is renamed, so that a loss of power leaves no
        incomplete file.

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
    with atomic_file(target) as working, working.open("wb") as file:
        file.writelines(pieces)
        file.flush()
        if durable:
            os.fsync(file.fileno())


def write_text_file(path: str | PathLike[str], text: str) -> None:
    """Write a text file atomically.

    Raises
    ------
    InputError
        If it can't be written.
    """
    try:
        write_file(Path(path), text.encode())
    except OSError as error:
        raise InputError(f"{path}: the file can't be written: {error.strerror or error}") from None


def _make_empty_file(path: Path) -> None:
    os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))


# one folder


@contextmanager
def atomic_folder(target: Path, check: Callable[[], None]) -> Iterator[Path]:
    """Yield the path of an empty working folder, which replaces `target` at the end of the block.

    It does not if the block raises an error.

    Parameters
    ----------
    target : pathlib.Path
        The destination; an existing folder stays until then.
    check : callable
        Raises if the folder may not be placed there. Called just before the replacement, since
        another process may have created `target` in the meantime.

    Raises
    ------
    OSError
        If it can't be written.
    """
    with new_working_path(partial(working_path, target, NEW), Path.mkdir, target) as working:
        yield working
        check()
        _put_in_place(working, target)


def _put_in_place(working: Path, target: Path) -> None:
    """Rename a folder to `target`; an existing one has another name until then, and is removed."""
    if not os.path.lexists(target):
        working.rename(target)
        return
    _flush(working)  # before the old folder is removed
    # between the two renames nothing has the name `target`; if this process dies then, `recover`
    # restores the old folder
    old = working_path(target, OLD)
    with locked(target):
        target.rename(old)
        try:
            working.rename(target)
        except OSError:
            old.rename(target)
            raise
        remove(old)


def _flush(folder: Path) -> None:
    """Flush the files of a folder to the disk (fsync).

    Then either the old or the new folder survives a loss of power.
    """
    for subfolder, _, names in os.walk(folder):
        for name in names:
            descriptor = os.open(os.path.join(subfolder, name), os.O_RDWR)
            try:
                os.fsync(descriptor)
            finally:
                os.close(descriptor)


# several files into an existing folder


def write_into(folder: Path, write: Callable[[Path], None], goes: tuple[str, ...] = ()) -> None:
    """Write files into an existing folder: all of them or none.

    They are written into a working folder inside it, which is renamed once all are complete; then
    each file is moved to its destination. If the process dies in between, `recover` moves the rest,
    so that files of two writes never stay mixed.

    Parameters
    ----------
    folder : pathlib.Path
        The destination.
    write : callable
        Writes the files into an empty folder, and into subfolders of it.
    goes : tuple of str
        Glob patterns of the files of `folder` that are deleted unless they are written again.

    Raises
    ------
    OSError
        If the folder can't be written to.
    """
    with new_working_path(partial(inner_path, folder, NEW), Path.mkdir, folder) as working:
        (working / _PUT).mkdir()
        write(working / _PUT)
        old = {file.relative_to(folder) for pattern in goes for file in folder.glob(pattern)}
        for name in old - set(_files(working / _PUT)):
            (working / _GONE / name).parent.mkdir(parents=True, exist_ok=True)
            (working / _GONE / name).touch()
        check_destinations(working, folder)
        complete = working.with_suffix(f".{COMPLETE}")
        working.rename(complete)
        move_files(complete, folder)


def check_destinations(working: Path, folder: Path) -> None:
    """Check that the files of a working folder can be moved to their destinations.

    Those to be deleted must be where they can be. OSError is raised otherwise.

    A link that leads out of `folder` is refused: nothing outside of it is written or deleted.
    """
    root = folder.resolve()
    for name in [*_files(working / _PUT), *_files(working / _GONE)]:
        destination = folder / name
        parent = destination.parent
        if destination.is_dir():
            raise IsADirectoryError(EISDIR, os.strerror(EISDIR), str(destination))
        if not parent.resolve().is_relative_to(root):
            raise OSError(ELOOP, "this is a link that leads out of the folder", str(parent))
        if parent.exists() and not os.access(parent, os.W_OK):
            raise PermissionError(EACCES, os.strerror(EACCES), str(parent))


def move_files(complete: Path, folder: Path) -> None:
    """Move the files of a complete working folder to their destinations, and remove it.

    Files that it lists for deletion are deleted.

    Raises
    ------
    OSError
        If a file can't be moved; the others remain in the working folder.
    """
    for name in _files(complete / _PUT):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(complete / _PUT / name, folder / name)
    for name in _files(complete / _GONE):
        (folder / name).unlink(missing_ok=True)
    remove(complete)


def _files(folder: Path) -> list[Path]:
    """Return the relative paths of all files below a folder, sorted."""
    return [
        path.relative_to(folder)
        for path in sorted(folder.rglob("*"))
        if not path.is_dir() or path.is_symlink()
    ]
