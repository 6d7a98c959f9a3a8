"""Whether what is read back of `summary.json` is of the kinds that it should be."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def check_types(summary: Mapping[str, Any]) -> None:
    """Raise unless what is read back of a summary is of the kinds that it should be.

    Raises
    ------
    ValueError
        If something is of another kind.
    """
    _check("status", isinstance(summary["status"], str))
    for key, kinds in (("provenance", (str,)), ("deformation", (str, int, float)), ("truncation", (int, float, type(None)))):
        table = summary.get(key, {})
        _check(key, isinstance(table, dict) and all(isinstance(value, kinds) for value in table.values()))
    for body in ("sphere", "plate"):
        peaks = summary.get(body, {})
        _check(body, isinstance(peaks, dict) and all(_is_peak(value) for value in peaks.values()))


def _is_peak(value: Any) -> bool:
    return all(one is None or isinstance(one, (int, float)) for one in (value if isinstance(value, list) else [value]))


def _check(key: str, right: bool) -> None:
    if not right:
        raise ValueError(f"{key} is not of the kind that it should be")
