"""Rebounds as data: the rows of bounces.csv, and the content of summary.json."""

from __future__ import annotations

import math
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.calibration.bounces.rebounds import Rebounds
from vibroimpact.calibration.bounces.speed_laws import SpeedLaw
from vibroimpact.calibration.inputs import inputs_document


def bounce_rows(found: Rebounds) -> list[dict[str, Any]]:
    """Return the impacts, one mapping each; None where there is no value."""
    bounces = found.bounces
    columns = {
        "time_s": bounces.time,
        "time_standard_deviation_s": bounces.deviation,
        "peak": bounces.peak,
        "approach_speed_m_s": found.approach_speed,
        "separation_speed_m_s": found.separation_speed,
        "restitution": found.restitution,
        "restitution_standard_deviation": found.deviation,
        "restitution_low": found.intervals[:, 0],
        "restitution_high": found.intervals[:, 1],
    }
    return [
        {
            "impact": number + 1,
            **{name: _finite(values[number]) for name, values in columns.items()},
        }
        for number in range(len(bounces.time))
    ]


def bounce_document(found: Rebounds) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    record = found.bounces.record
    return {
        "name": record.name,
        "version": __version__,
        "bounces": {
            "file": record.source,
            "channel": record.name,
            "unit": record.unit,
            "rate_Hz": record.rate,
            "duration_s": record.duration,
            "gravity_m_s2": found.gravity,
            "contact_duration_s": found.bounces.contact,
            "confidence": found.confidence,
            "drop_height_m": found.drop_height,
            "drop_height_given": found.height is not None,
            "drop_height_standard_deviation_m": found.drop_deviation,
            "inputs": inputs_document(found.inputs),
            "impacts": bounce_rows(found),
            "fits": fits_document(found.laws, found.confidence),
            "others": [
                {"time_s": float(time), "reason": reason}
                for time, reason in zip(found.bounces.others, found.bounces.reasons, strict=True)
            ],
            "doubts": list(found.doubts),
        },
    }


def fits_document(laws: list[SpeedLaw], confidence: float) -> dict[str, Any]:
    """Return the fits of a restitution over the approach speed by name; None where there
    is no finite number.
    """
    return {
        law.name: {
            "coefficients": law.coefficients.tolist(),
            "intervals": [[_finite(end) for end in ends] for ends in law.intervals(confidence)],
            "scatter": law.scatter,
            "degrees_of_freedom": _finite(law.freedom),
        }
        for law in laws
    }


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
