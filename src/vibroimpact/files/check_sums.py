"""Check sums of what is read back, so that a number which was damaged on disk is never believed."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

SHA256, CHECK_SUMS = "sha256", "check_sums"
"""The keys of a JSON file that hold the check sum of all else in it, and those of other files."""


class DamageError(ValueError):
    """What was read is not what was written."""


def digest(content: Any) -> str:
    """Return a check sum of numbers, texts, and tables and lists of them; it does not depend on how they are written down.

    Examples
    --------
    >>> digest({"a": 1.0, "b": [2.0]}) == digest({"b": [2.0], "a": 1.0}), digest([1.0]) == digest([1.5])
    (True, False)
    """
    return hashlib.sha256(json.dumps(content, sort_keys=True, default=_plain).encode()).hexdigest()


def sealed(table: Mapping[str, Any]) -> str:
    """Return a table as JSON that holds its own check sum."""
    plain = json.loads(json.dumps(table, allow_nan=False))
    return json.dumps({**plain, SHA256: digest(plain)}, indent=2) + "\n"


def read_sealed(path: Path) -> dict[str, Any]:
    """Read a table that was written as `sealed` gives it; one without a check sum, of an earlier version, is taken as it is.

    Raises
    ------
    OSError
        If it can't be read.
    ValueError
        If it is no JSON, no table, or not what was written.
    """
    table = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(table, dict):
        raise DamageError("the file is damaged (it holds no table)")
    expected = table.pop(SHA256, None)
    if expected is not None and digest(table) != expected:
        raise DamageError(CHANGED)
    return table


def file_digest(path: Path) -> str:
    """Return the SHA-256 of a file, as `sha256sum` prints it."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def check_file(path: Path, expected: str | None) -> None:
    """Raise unless a file is as it was written, before anything tries to read it; None knows of no check sum.

    Raises
    ------
    OSError
        If it can't be read.
    DamageError
        If it is another.
    """
    if expected is not None and file_digest(path) != expected:
        raise DamageError(CHANGED)


CHANGED = "the file is damaged, or was changed after it was written (its check sum does not match)"
"""What is told of a file that is not as it was written."""


def _plain(value: Any) -> Any:
    """Return what JSON does not know as what it does."""
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else str(value)
