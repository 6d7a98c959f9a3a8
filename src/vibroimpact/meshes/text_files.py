"""Text files of meshes: lines with their file and line number, included files, and numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from vibroimpact.errors import InputError
from vibroimpact.files.reading import FileKind, read_text_bytes, with_path
from vibroimpact.quoting import quoted, shortened

MESH = FileKind(
    "a mesh is a file of nodes and elements, in plain text (UTF-8 or Latin-1)",
    2_000_000_000,
    "write a coarser mesh",
)
"""Requirements on a mesh file."""


class TextLine(NamedTuple):
    """A line of a file, with its line number from 1."""

    path: Path
    number: int
    text: str

    def wrong(self, message: str) -> InputError:
        """Return an error that names file, line number and fault."""
        return InputError(f"{shortened(str(self.path), 200)}:{self.number}: {message}")


def read_lines(path: Path) -> list[TextLine]:
    """Return the lines of a text file in UTF-8, or else in Latin-1, which older programs write.

    Raises
    ------
    InputError
        If the file does not exist, is empty or is not text.
    """
    try:
        data = read_text_bytes(path, MESH)
    except InputError as error:
        raise with_path(path, error) from None
    if not data.strip():
        raise InputError(f"{path}: the file is empty; a mesh file holds nodes and elements")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    rows = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    return [TextLine(path, number, row) for number, row in enumerate(rows, 1)]


def read_lines_with_includes(
    path: Path, included: Callable[[str], str | None]
) -> Iterator[TextLine]:
    """Yield the lines of a file, and those of an included file after the line that includes it.

    A file may be included once, which rules out cycles and exponential growth.

    Parameters
    ----------
    path : Path
        The main file.
    included : callable
        Returns the name of the file that a line includes, relative to the including or the main
        file; None if it includes none.

    Raises
    ------
    InputError
        If a file can't be read, or is included twice.
    """
    stack = [iter(read_lines(path))]
    seen = {path.resolve()}
    while stack:
        line = next(stack[-1], None)
        if line is None:
            stack.pop()
            continue
        yield line
        name = included(line.text)
        if name is not None:
            stack.append(iter(_included_lines(line, name, path.parent, seen)))


def _included_lines(line: TextLine, name: str, root: Path, seen: set[Path]) -> list[TextLine]:
    """Return the lines of an included file.

    It is found relative to the including file or to the main file.
    """
    name = name.replace("\\", "/")
    try:
        path = line.path.parent / name
        if not path.is_file():
            path = root / name
        resolved = path.resolve()
        lines = read_lines(path)
    except (InputError, OSError, ValueError, RuntimeError) as error:
        raise line.wrong(
            f"the file to include can't be read: {getattr(error, 'strerror', None) or error}"
        ) from None
    if resolved in seen:
        raise line.wrong(f"{quoted(name)} is included a second time; a file may be included once")
    seen.add(resolved)
    return lines


def parse_integer(text: str, line: TextLine, what: str) -> int:
    """Return `text` as a non-negative integer.

    Raises
    ------
    InputError
        If it is not one, or has more than 18 digits.
    """
    text = text.strip()
    if not (text.isascii() and text.isdigit() and len(text) <= 18):
        raise line.wrong(
            f"{quoted(text)} is not {what}; it must be a whole number of at "
            "most 18 digits, without a sign"
        )
    return int(text)


def parse_real(text: str, line: TextLine, what: str = "a coordinate") -> float:
    """Return `text` as a float; the caller checks that it is finite.

    Raises
    ------
    InputError
        If it is not a number.
    """
    try:
        if "_" in text:
            raise ValueError
        return float(text)
    except ValueError:
        raise line.wrong(
            f"{quoted(text.strip())} is not {what}; it must be a number such as 0.25 or 2.5e-3"
        ) from None
