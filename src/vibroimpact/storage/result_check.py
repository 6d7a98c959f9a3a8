"""Whether a result that was read back is what was written."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from vibroimpact.dynamics.columns import history_columns, impact_columns
from vibroimpact.storage.check_sums import DamageError, digest
from vibroimpact.storage.result import Result


def data_digests(result: Result) -> dict[str, str]:
    """Return the check sum of each part of a result that `result.nc` holds, by the name of its group."""
    parts: dict[str, Any] = {
        "impacts": _numbers(result.impacts, impact_columns(result.impacts)),
        "history": _numbers(result.history, history_columns(result.history)),
        "energy": _numbers(result.energy, result.energy),
        "deflection": None if result.deflection is None else asdict(result.deflection),
    }
    for name, signal in result.signals.items():
        sensor = signal.sensor
        told = (sensor.name, sensor.quantity, list(map(float, sensor.direction)), float(sensor.rate), sensor.filter, sensor.corner)
        facts = tuple(map(float, (signal.uncertainty, signal.peak, signal.overload_time)))
        parts[f"sensors/{name}"] = (*told, *facts, signal.time, signal.value)
    return {name: digest(part) for name, part in parts.items()}


def check_digests(result: Result, expected: Mapping[str, str] | None) -> None:
    """Raise unless a result has the check sums that were written with it; one of an earlier version has none.

    Raises
    ------
    DamageError
        If a part is not as it was written.
    """
    if expected is None:
        return
    found = data_digests(result)
    for name in {**expected, **found}:
        if found.get(name) != expected.get(name):
            raise DamageError(f"{name} is damaged (its check sum does not match)")


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


def _numbers(columns: Mapping[str, Any], names: Iterable[str]) -> dict[str, Any]:
    return {name: np.asarray(columns[name], dtype=np.float64) for name in names}


def _is_peak(value: Any) -> bool:
    return all(one is None or isinstance(one, (int, float)) for one in (value if isinstance(value, list) else [value]))


def _check(key: str, right: bool) -> None:
    if not right:
        raise ValueError(f"{key} is not of the kind that it should be")
