"""A file that somebody names, read whole: or refused with a sentence, and never waited for.

What a path leads to is looked at before it is opened: a pipe has no end that is known, a device may have none at all.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import sha256
from io import FileIO
from os import PathLike
from typing import NamedTuple

from vibroimpact.errors import InputError
from vibroimpact.shown import shortened

_BLOCK = 4_000_000
"""Bytes that are read at once."""

_LONG_NAME = 200
"""Letters of a path that messages show."""

_OPENING = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)
"""Without waiting: between the look at a path and the opening of it there may have come a pipe."""

_NO_FILES = {
    stat.S_IFDIR: "a directory",
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


class FileKind(NamedTuple):
    """What is asked of a file.

    Parameters
    ----------
    what : str
        What it should be, as messages say it: "a case is a TOML file".
    largest : int
        Bytes that it may have.
    smaller : str
        What to do where it has more: "keep the part with the impacts".
    """

    what: str
    largest: int
    smaller: str


def read_bytes(path: str | PathLike[str], kind: FileKind) -> bytes:
    """Return what a file holds.

    Raises
    ------
    InputError
        If it is not a regular file, can't be read or is too large; the message does not name it.

    Examples
    --------
    >>> read_bytes("/", FileKind("a case is a TOML file", 1_000_000, "a case is a page of text"))
    Traceback (most recent call last):
    vibroimpact.errors.InputError: this is a directory; a case is a TOML file
    """
    return b"".join(_blocks(path, kind))


def beginning(path: str | PathLike[str], kind: FileKind, size: int) -> bytes:
    """Return the first bytes of a file, at most `size`.

    Raises
    ------
    InputError
        As `read_bytes`.
    """
    with _opened(path, kind) as file:
        return file.read(size) or b""


def read_text(path: str | PathLike[str], kind: FileKind) -> str:
    """Return the text of a file in UTF-8, with or without a byte-order mark.

    Raises
    ------
    InputError
        As `read_bytes`; and if it is not text in UTF-8.
    """
    return decoded(read_text_bytes(path, kind), kind)


def read_text_bytes(path: str | PathLike[str], kind: FileKind) -> bytes:
    """Return the bytes of a text file; one that holds a zero is read no further.

    Raises
    ------
    InputError
        As `read_bytes`; and if it is not text of single bytes.
    """
    blocks = []
    for block in _blocks(path, kind):
        blocks.append(block)
        if b"\0" in block:
            if blocks[0].startswith((b"\xff\xfe", b"\xfe\xff")):
                raise InputError("the file is not UTF-8 text but UTF-16; save it as UTF-8")
            raise InputError(f"this is not a text file; {kind.what}")
    return b"".join(blocks)


def decoded(data: bytes, kind: FileKind) -> str:
    """Return bytes as text.

    Raises
    ------
    InputError
        If they are not UTF-8.
    """
    try:
        return data.decode("utf-8-sig")  # some editors put a byte-order mark first
    except UnicodeDecodeError:
        raise InputError(f"the file is not UTF-8 text; {kind.what}") from None


def input_file_digest(path: str | PathLike[str], kind: FileKind) -> str:
    """Return the SHA-256 of what a file holds, in hexadecimal digits.

    Raises
    ------
    InputError
        As `read_bytes`.
    """
    found = sha256()
    for block in _blocks(path, kind):
        found.update(block)
    return found.hexdigest()


def with_path(path: str | PathLike[str], error: InputError, key: str = "") -> InputError:
    """Return an error with the name of the file before it.

    Examples
    --------
    >>> with_path("drop.csv", InputError("there is no such file")).message
    'drop.csv: there is no such file'
    """
    return InputError(f"{shortened(str(path), _LONG_NAME)}: {error}", key)


def _blocks(path: str | PathLike[str], kind: FileKind) -> Iterator[bytes]:
    with _opened(path, kind) as file:
        left = kind.largest
        while block := file.read(min(_BLOCK, left + 1)):
            left -= len(block)
            if left < 0:  # it may have grown
                raise _too_large(kind)
            yield block


@contextmanager
def _opened(path: str | PathLike[str], kind: FileKind) -> Iterator[FileIO]:
    """Give a regular file that is not too large; what goes wrong in reading it is an InputError too."""
    try:
        _check(os.stat(path), kind)
        with open(path, "rb", opener=lambda name, _: os.open(name, _OPENING), buffering=0) as file:
            _check(os.fstat(file.fileno()), kind)
            yield file
    except InputError:
        raise
    except FileNotFoundError:
        raise InputError(f"there is no such file; {kind.what}") from None
    except OSError as error:
        raise InputError(f"the file can't be read: {error.strerror or error}") from None
    except ValueError:  # a NUL, or half a surrogate pair
        raise InputError("no file can have such a name: it holds a character that names of files can't hold") from None


def _check(found: os.stat_result, kind: FileKind) -> None:
    if not stat.S_ISREG(found.st_mode):
        raise InputError(f"this is {_NO_FILES.get(stat.S_IFMT(found.st_mode), 'no regular file')}; {kind.what}")
    if found.st_size > kind.largest:
        raise _too_large(kind)


def _too_large(kind: FileKind) -> InputError:
    size = f"{kind.largest // 1_000_000_000} GB" if kind.largest >= 1_000_000_000 else f"{kind.largest // 1_000_000} MB"
    return InputError(f"the file is larger than {size}; {kind.smaller}")
