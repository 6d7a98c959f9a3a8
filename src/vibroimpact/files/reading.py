"""Checked reading of input files: regular files of limited size; everything else is an InputError.

The file type is checked before opening, since reading a pipe or a device may block or never end.
"""

from __future__ import annotations

import os
import stat
from codecs import register_error
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from hashlib import sha256
from io import BufferedReader, BytesIO, FileIO, TextIOWrapper
from os import PathLike
from typing import NamedTuple

from vibroimpact.errors import InputError
from vibroimpact.quoting import shortened

_BLOCK = 4_000_000
"""Bytes per read."""

_UTF16 = (b"\xff\xfe", b"\xfe\xff")
_SAVE_AS_UTF8 = "the file is not UTF-8 text but UTF-16; save it as UTF-8"
_LONG_NAME = 200
"""Largest length of a path in messages."""

_OPENING = (
    os.O_RDONLY
    | getattr(os, "O_NONBLOCK", 0)
    | getattr(os, "O_CLOEXEC", 0)
    | getattr(os, "O_BINARY", 0)
)
"""Non-blocking, since a pipe may have taken the place of the file since its type was checked."""

_RECEIVED: ContextVar[tuple[str, bytes] | None] = ContextVar("received", default=None)
"""Name and content of the file that is read from memory."""

_NO_FILES = {
    stat.S_IFDIR: "a directory",
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


class FileKind(NamedTuple):
    """Requirements on an input file.

    Parameters
    ----------
    what : str
        What the file should be, for messages: "a case is a TOML file".
    largest : int
        Largest size [bytes].
    smaller : str
        Remedy for a larger file, for messages: "keep the part with the impacts".
    """

    what: str
    largest: int
    smaller: str


@contextmanager
def received(name: str, content: bytes) -> Iterator[None]:
    """Read a file from memory within the block, such as one that came through a browser.

    Parameters
    ----------
    name : str
        The path by which it is read; a file of this path on the disk is not touched.
    content : bytes
        Its content.

    Examples
    --------
    >>> with received("drop.csv", b"time_s,force_N"):
    ...     read_bytes("drop.csv", FileKind("a table is text", 1000, "keep a part"))
    b'time_s,force_N'
    """
    token = _RECEIVED.set((name, content))
    try:
        yield
    finally:
        _RECEIVED.reset(token)


def read_bytes(path: str | PathLike[str], kind: FileKind) -> bytes:
    """Return the content of a file.

    Raises
    ------
    InputError
        If it is not a regular file, can't be read or is too large; the message does not include the
        path.

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
    with opened(path, kind) as file:
        return file.read(size) or b""


def read_text(path: str | PathLike[str], kind: FileKind) -> str:
    """Return the text of a UTF-8 file, with or without byte-order mark.

    Raises
    ------
    InputError
        As `read_bytes`, or if it is not UTF-8 text.
    """
    return decoded(read_text_bytes(path, kind), kind)


def read_text_bytes(path: str | PathLike[str], kind: FileKind) -> bytes:
    """Return the bytes of a text file; reading stops at a block with a zero byte.

    Raises
    ------
    InputError
        As `read_bytes`, or if it has a zero byte, as binary files and UTF-16 text have.
    """
    blocks = []
    for block in _blocks(path, kind):
        blocks.append(block)
        if b"\0" in block:
            if blocks[0].startswith(_UTF16):
                raise InputError(_SAVE_AS_UTF8)
            raise InputError(f"this is not a text file; {kind.what}")
    return b"".join(blocks)


def text_lines(
    path: str | PathLike[str], kind: FileKind, longest: int, doubts: list[str] | None = None
) -> Generator[str, None, None]:
    """Yield the lines of a text file in blocks; of a line `longest` + 1 characters at most.

    It is UTF-8, with or without byte-order mark, or UTF-16 with one. A byte that is not UTF-8 but a
    printable character of Latin-1, as older programs write units, is read as that.

    Parameters
    ----------
    path, kind
        As those of `read_text`.
    longest : int
        Characters of a line.
    doubts : list of str, optional
        A sentence on the first byte that is read as Latin-1 is added to it; without it such a byte
        is refused.

    Raises
    ------
    InputError
        As `read_text`.
    """
    with opened(path, kind) as file:
        buffered = BufferedReader(file, _BLOCK)
        encoding = "utf-16" if buffered.peek(2).startswith(_UTF16) else "utf-8-sig"
        errors = "strict" if doubts is None else _OR_LATIN_1
        text = TextIOWrapper(buffered, encoding=encoding, errors=errors, newline=None)
        remaining = kind.largest
        number = 0
        try:
            while line := text.readline(longest + 1):
                remaining -= len(line)
                if remaining < 0:  # the file may have grown since it was checked
                    raise _too_large(kind)
                if "\0" in line:
                    raise InputError(f"this is not a text file; {kind.what}")
                number += 1
                if doubts is not None and not line.isascii():
                    line = _with_latin_1(line, number, doubts)
                yield line
        except UnicodeError:
            if encoding == "utf-16":
                raise InputError(
                    "the file begins with the mark of UTF-16 text, and is no such text; "
                    "save it as UTF-8"
                ) from None
            raise _not_utf8(kind) from None


def _or_latin_1(error: UnicodeError) -> tuple[str, int]:
    """Decode a byte that is not UTF-8 to a mark of its own.

    It must be a printable character of Latin-1.
    """
    if not isinstance(error, UnicodeDecodeError) or error.object[error.start] < _FIRST_PRINTABLE:
        raise error
    return chr(_PRIVATE + error.object[error.start]), error.start + 1


def _with_latin_1(line: str, number: int, doubts: list[str]) -> str:
    """Return a line with characters of Latin-1 in place of their marks.

    A sentence on the first of them in the file is added to the doubts.
    """
    mark = next((character for character in line if ord(character) in _FROM_LATIN_1), None)
    if mark is None:
        return line
    if not doubts:
        byte = ord(mark) - _PRIVATE
        doubts.append(
            f"line {number} has the byte {byte:02X}, which is not UTF-8: it is "
            f'read as "{chr(byte)}" of Latin-1; save the file as UTF-8 if it should be another'
        )
    return line.translate(_FROM_LATIN_1)


_OR_LATIN_1 = "vibroimpact-or-latin-1"
"""Name of the decoding."""

_PRIVATE = 0x10FF00
"""First of the characters for private use that mark its bytes until a line is complete."""

_FIRST_PRINTABLE = 0xA0
_FROM_LATIN_1 = {_PRIVATE + byte: byte for byte in range(_FIRST_PRINTABLE, 0x100)}
register_error(_OR_LATIN_1, _or_latin_1)


def decoded(data: bytes, kind: FileKind) -> str:
    """Return UTF-8 bytes as text.

    Raises
    ------
    InputError
        If they are not UTF-8.
    """
    try:
        return data.decode("utf-8-sig")  # some editors put a byte-order mark first
    except UnicodeDecodeError:
        raise _not_utf8(kind) from None


def input_file_digest(path: str | PathLike[str], kind: FileKind) -> str:
    """Return the SHA-256 of an input file, in hexadecimal digits.

    Raises
    ------
    InputError
        As `read_bytes`.
    """
    digest = sha256()
    for block in _blocks(path, kind):
        digest.update(block)
    return digest.hexdigest()


def with_path(path: str | PathLike[str], error: InputError, key: str = "") -> InputError:
    """Return an error with the path of the file prepended to its message.

    Examples
    --------
    >>> with_path("drop.csv", InputError("there is no such file")).message
    'drop.csv: there is no such file'
    """
    return InputError(f"{shortened(str(path), _LONG_NAME)}: {error}", key)


def _blocks(path: str | PathLike[str], kind: FileKind) -> Iterator[bytes]:
    """Yield the content of a file in blocks."""
    with opened(path, kind) as file:
        remaining = kind.largest
        while block := file.read(min(_BLOCK, remaining + 1)):
            remaining -= len(block)
            if remaining < 0:  # the file may have grown since it was checked
                raise _too_large(kind)
            yield block


@contextmanager
def opened(path: str | PathLike[str], kind: FileKind) -> Iterator[FileIO | BytesIO]:
    """Yield a regular file of allowed size, opened for reading, or one that was `received`.

    Errors in the block are raised as InputError too.

    Raises
    ------
    InputError
        As `read_bytes`.
    """
    held = _RECEIVED.get()
    if held is not None and os.fspath(path) == held[0]:
        if len(held[1]) > kind.largest:
            raise _too_large(kind)
        yield BytesIO(held[1])
        return
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
    except ValueError:  # a NUL character, or an unpaired surrogate
        raise InputError(
            "no file can have such a name: it holds a character that names of files can't hold"
        ) from None


def _check(status: os.stat_result, kind: FileKind) -> None:
    """Raise unless it is a regular file of allowed size."""
    if not stat.S_ISREG(status.st_mode):
        type_of_file = _NO_FILES.get(stat.S_IFMT(status.st_mode), "no regular file")
        raise InputError(f"this is {type_of_file}; {kind.what}")
    if status.st_size > kind.largest:
        raise _too_large(kind)


def _not_utf8(kind: FileKind) -> InputError:
    return InputError(f"the file is not UTF-8 text; {kind.what}")


def _too_large(kind: FileKind) -> InputError:
    size = f"{kind.largest / 1e6:g} MB"
    if kind.largest >= 1_000_000_000:
        size = f"{kind.largest / 1e9:g} GB"
    return InputError(f"the file is larger than {size}; {kind.smaller}")
