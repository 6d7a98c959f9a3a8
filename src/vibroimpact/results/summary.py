"""The content of `summary.json`, and a check of its types when it is read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from vibroimpact.cases.validity.plate_mesh import PLATE_MESH_COMPLIANCE
from vibroimpact.cases.validity.plate_waves import PLATE_THEORY_INERTIA
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.results.csv_files import impact_rows
from vibroimpact.results.peaks import FREQUENCIES
from vibroimpact.results.result import Result


def summary_of(result: Result) -> dict[str, Any]:
    """Return the summary of a result, as it is stored in `summary.json`.

    It holds the impact table, the final energy ledger, doubts, provenance, and peaks of elastic
    bodies.
    """
    return {
        "name": result.name,
        "status": result.status,
        "version": result.provenance.get("version", ""),
        "impacts": impact_rows(result.impacts),
        "energy": result.energy,
        **_of_vibration(result),
        "doubts": list(map(str, result.doubts)),
        "provenance": dict(result.provenance),
    }


def _of_vibration(result: Result) -> dict[str, Any]:
    """Return the entries of a summary that exist only where bodies vibrate."""
    if not result.vibrates:
        return {}
    return {
        **result.peaks,
        "deformation": dict(result.deformation),
        "truncation": {body: _finite(error) for body, error in result.truncation.items()},
        "change_by_impact": [_finite(float(change)) for change in result.change_by_impact],
        "sensors": {name: _signal_summary(signal) for name, signal in result.signals.items()},
    }


def _signal_summary(signal: Signal) -> dict[str, Any]:
    """Return what a summary states of the signal of a sensor."""
    return {
        "quantity": signal.sensor.quantity,
        "unit": signal.sensor.unit,
        "rate_Hz": signal.sensor.rate,
        "samples": len(signal.value),
        "max_magnitude": signal.largest,
        "filter": signal.sensor.filter,
        "relative_uncertainty": _finite(signal.uncertainty),
        "peak_before_range": _finite(signal.peak),
        "overload_time_s": signal.overload_time,
    }


def _finite(number: float) -> float | None:
    """Return a number for JSON, which has no NaN and no infinity: None stands for them."""
    return number if math.isfinite(number) else None


def check_types(summary: Mapping[str, Any]) -> None:
    """Check the types of the entries of a summary that a result is built from.

    Raises
    ------
    ValueError
        If an entry has another type than `summary_of` writes.
    KeyError
        If the status is missing.
    """
    _check("status", isinstance(summary["status"], str))
    _check_table(summary, "provenance", (str,))
    _check_table(summary, "deformation", (str, int, float))
    _check_table(summary, "truncation", (int, float, type(None)))
    for key in (PLATE_THEORY_INERTIA, PLATE_MESH_COMPLIANCE):
        _check(key, isinstance(summary.get("deformation", {}).get(key, 0.0), (int, float)))
    for body in ("sphere", "plate"):
        peaks = summary.get(body, {})
        _check(body, isinstance(peaks, dict) and all(_is_peak(peak) for peak in peaks.values()))
        frequencies = peaks.get(FREQUENCIES[0], [])
        _check(
            FREQUENCIES[0],
            isinstance(frequencies, list) and all(_is_positive(number) for number in frequencies),
        )
        # peaks and truncation are those of a body that has modes
        needs_frequencies = bool(peaks) or body in summary.get("truncation", {})
        _check(FREQUENCIES[0], bool(frequencies) or not needs_frequencies)


def check_case(case: Mapping[str, Any]) -> None:
    """Check that a resolved case has the tables that `write_result` writes.

    Raises
    ------
    KeyError
        If one is missing.
    ValueError
        If one is no table.
    """
    for section in ("sphere", "plate", "drop", "contact", "run"):
        _check(section, isinstance(case[section], dict))
    sensors = case.get("sensors", [])
    _check(
        "sensors", isinstance(sensors, list) and all(isinstance(sensor, dict) for sensor in sensors)
    )
    _check("name", isinstance(case.get("name", ""), str))


def _check_table(summary: Mapping[str, Any], key: str, types: tuple[type, ...]) -> None:
    """Check that an entry, if it is there, is a table whose values have given types."""
    table = summary.get(key, {})
    _check(
        key, isinstance(table, dict) and all(isinstance(value, types) for value in table.values())
    )


def _is_peak(peak: Any) -> bool:
    """Return whether a peak is a number or None, or a list of such."""
    entries = peak if isinstance(peak, list) else [peak]
    return all(entry is None or isinstance(entry, (int, float)) for entry in entries)


def _is_positive(number: Any) -> bool:
    return isinstance(number, (int, float)) and number > 0.0


def _check(key: str, is_right: bool) -> None:
    if not is_right:
        raise ValueError(f"{key} has the wrong type")
