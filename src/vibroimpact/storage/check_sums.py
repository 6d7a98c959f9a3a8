"""Check sums of what is read back, so that a number which was damaged on disk is never believed."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

SHA256, CHECK_SUMS = "sha256", "check_sums"
"""The keys of a JSON file that hold the check sum of all else in it, and those of other files."""


class DamageError(ValueError):
    """What was read is not what was written."""


def digest(content: Any) -> str:
    """Return a check sum of numbers, texts, arrays, and tables and lists of them; it does not depend on how they are written down.

    Examples
    --------
    >>> digest({"a": 1.0, "b": [2.0]}) == digest({"b": [2.0], "a": 1.0}), digest([1.0]) == digest([1.5])
    (True, False)
    """
    return sha256(json.dumps(content, sort_keys=True, default=_plain).encode()).hexdigest()


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
        raise DamageError("it holds no table")
    expected = table.pop(SHA256, None)
    if expected is not None and digest(table) != expected:
        raise DamageError(MISMATCH)
    return table


def read_toml(path: Path, expected: str | None) -> dict[str, Any]:
    """Read a TOML file whose check sum is known; None takes it as it is.

    Raises
    ------
    OSError
        If it can't be read.
    ValueError
        If it is no TOML, or not what was written.
    """
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    if expected is not None and digest(table) != expected:
        raise DamageError(MISMATCH)
    return table


MISMATCH = "its check sum does not match: it is not as it was written"


def _plain(value: Any) -> Any:
    """Return what JSON does not know as what it does: arrays by their bytes."""
    if isinstance(value, np.ndarray):
        return [value.dtype.str, value.shape, sha256(np.ascontiguousarray(value).tobytes()).hexdigest()]
    return value.item() if isinstance(value, np.generic) else str(value)
