"""The content of `summary.json`, and a check of its types when it is read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from vibroimpact.cases.validity.plate_mesh import PLATE_MESH_COMPLIANCE
from vibroimpact.cases.validity.plate_waves import PLATE_THEORY_INERTIA
from vibroimpact.results.csv_files import impact_rows
from vibroimpact.results.peaks import FREQUENCIES
from vibroimpact.results.result import Result


def summary_of(result: Result) -> dict[str, Any]:
    """Return the summary of a result: impact table, final energy ledger, doubts,
    provenance, and peaks of elastic bodies.
    """
    return {
        "name": result.name,
        "status": result.status,
        "version": result.provenance.get("version", ""),
        "impacts": impact_rows(result.impacts),
        "energy": result.energy,
        **_of_vibration(result),
        "doubts": result.doubts,
        "provenance": dict(result.provenance),
    }


def _of_vibration(result: Result) -> dict[str, Any]:
    """Return the entries of a summary that exist only where bodies vibrate; None stands
    for a number that is not finite.
    """
    if not result.vibrates:
        return {}
    truncation = {
        name: value if math.isfinite(value) else None for name, value in result.truncation.items()
    }
    sensors = {
        name: {
            "quantity": signal.sensor.quantity,
            "unit": signal.sensor.unit,
            "rate_Hz": signal.sensor.rate,
            "samples": len(signal.value),
            "max_magnitude": signal.largest,
            "filter": signal.sensor.filter,
            "relative_uncertainty": signal.uncertainty
            if math.isfinite(signal.uncertainty)
            else None,
            "peak_before_range": signal.peak if math.isfinite(signal.peak) else None,
            "overload_time_s": signal.overload_time,
        }
        for name, signal in result.signals.items()
    }
    change = [float(value) if math.isfinite(value) else None for value in result.change_by_impact]
    return {
        **result.peaks,
        "deformation": dict(result.deformation),
        "truncation": truncation,
        "change_by_impact": change,
        "sensors": sensors,
    }


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
    for key, kinds in (
        ("provenance", (str,)),
        ("deformation", (str, int, float)),
        ("truncation", (int, float, type(None))),
    ):
        table = summary.get(key, {})
        _check(
            key,
            isinstance(table, dict) and all(isinstance(value, kinds) for value in table.values()),
        )
    for fact in (PLATE_THEORY_INERTIA, PLATE_MESH_COMPLIANCE):
        _check(fact, isinstance(summary.get("deformation", {}).get(fact, 0.0), (int, float)))
    for body in ("sphere", "plate"):
        peaks = summary.get(body, {})
        _check(body, isinstance(peaks, dict) and all(_is_peak(value) for value in peaks.values()))
        frequencies = peaks.get(FREQUENCIES[0], [])
        _check(
            FREQUENCIES[0],
            isinstance(frequencies, list) and all(_is_positive(value) for value in frequencies),
        )
        # peaks and truncation are those of a body that has modes
        _check(
            FREQUENCIES[0],
            bool(frequencies) or not (peaks or body in summary.get("truncation", {})),
        )


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


def _is_peak(value: Any) -> bool:
    return all(
        one is None or isinstance(one, (int, float))
        for one in (value if isinstance(value, list) else [value])
    )


def _is_positive(value: Any) -> bool:
    return isinstance(value, (int, float)) and value > 0.0


def _check(key: str, right: bool) -> None:
    if not right:
        raise ValueError(f"{key} has the wrong type")
