"""Checksums of files and JSON tables, to detect damage on disk."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact.errors import InputError
from vibroimpact.files.json_reading import JSON_TABLE, read_json_table
from vibroimpact.files.json_text import json_file_text
from vibroimpact.files.reading import FileKind, with_path

SHA256 = "sha256"
"""Key of a JSON file: the checksum of the rest of its content."""

CHECK_SUMS = "check_sums"
"""Key of a JSON file: the checksums of other files."""

_SUMMARY = "summary.json"


class DamageError(ValueError):
    """A file or dataset whose content differs from what was written."""


def digest(content: Any) -> str:
    """Return the SHA-256 of numbers, texts, and nested tables and lists of them.

    It is independent of the order of keys.

    Examples
    --------
    >>> (
    ...     digest({"a": 1.0, "b": [2.0]}) == digest({"b": [2.0], "a": 1.0}),
    ...     digest([1.0]) == digest([1.5]),
    ... )
    (True, False)
    """
    return hashlib.sha256(json.dumps(content, sort_keys=True, default=_plain).encode()).hexdigest()


def sealed(table: Mapping[str, Any]) -> bytes:
    """Return a table as JSON in UTF-8 that includes its own checksum."""
    return json_file_text({**table, SHA256: digest(table)}).encode()


def read_sealed(path: Path, kind: FileKind = JSON_TABLE) -> dict[str, Any]:
    """Read a table written by `sealed` and verify its checksum.

    One without checksum, from an earlier version, is not verified.

    Raises
    ------
    DamageError
        If it can't be read, is not a table in JSON of bounded size, or its checksum does not match;
        the message does not include the path.
    """
    try:
        table = read_json_table(path, kind)
    except InputError as error:
        raise DamageError(f"the file can't be used: {error}") from None
    expected = table.pop(SHA256, None)
    if expected is not None and digest(table) != expected:
        raise DamageError(CHANGED)
    return table


def file_digest(path: Path) -> str:
    """Return the SHA-256 of a file, as `sha256sum` prints it."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def digests_of(folder: Path, names: Iterable[str]) -> dict[str, str]:
    """Return the SHA-256 of files of a folder by their names, of those that are there."""
    return {name: file_digest(folder / name) for name in names if (folder / name).is_file()}


def check_file(path: Path, expected: str | None) -> None:
    """Verify the SHA-256 of a file before it is parsed; None skips the check.

    Raises
    ------
    OSError
        If it can't be read.
    DamageError
        If it does not match.
    """
    if expected is not None and file_digest(path) != expected:
        raise DamageError(CHANGED)


def recorded_digest(path: Path) -> str | None:
    """Return the SHA-256 of a file that the `summary.json` beside it records.

    None if there is no summary, or it records none.

    Raises
    ------
    InputError
        If the summary is damaged.
    """
    summary = path.with_name(_SUMMARY)
    if not summary.is_file():
        return None
    try:
        recorded = read_sealed(summary).get(CHECK_SUMS, {})
    except DamageError as error:
        remedy = f"delete it, and {path.name} is read without a comparison of its check sum"
        raise with_path(summary, InputError(f"{error}; {remedy}")) from None
    if not isinstance(recorded, dict):
        return None
    expected = recorded.get(path.name)
    return expected if isinstance(expected, str) else None


CHANGED = "the file is damaged, or was changed after it was written (its check sum does not match)"
"""Message for a file whose checksum does not match."""


def _plain(value: Any) -> Any:
    """Return a value that JSON can't represent as one that it can."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    return str(value)
