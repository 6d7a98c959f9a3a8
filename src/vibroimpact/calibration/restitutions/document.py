"""Measured restitutions as data: the rows of restitutions.csv, and the content of summary.json."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.calibration.bounces.document import fits_document
from vibroimpact.calibration.restitutions.restitutions import Restitutions


def restitution_rows(found: Restitutions) -> list[dict[str, Any]]:
    """Return the restitutions, one mapping each; None where there is no value."""
    columns = {
        "approach_speed_m_s": found.approach_speed,
        "restitution": found.restitution,
        "restitution_standard_deviation": found.deviation,
        "restitution_low": found.intervals[:, 0],
        "restitution_high": found.intervals[:, 1],
        **{f"{law.name}": law(found.approach_speed) for law in found.laws},
    }
    return [
        {
            "count": int(number),
            **{
                name: float(values[row]) if math.isfinite(values[row]) else None
                for name, values in columns.items()
            },
        }
        for row, number in enumerate(found.count)
    ]


def restitution_document(found: Restitutions) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    return {
        "name": Path(found.source).name,
        "version": __version__,
        "restitutions": {
            "file": found.source,
            "confidence": found.confidence,
            "rounding": found.rounding,
            "rows": restitution_rows(found),
            "fits": fits_document(found.laws, found.confidence),
            "by_speed": None if found.function is None else found.function.table(),
            "doubts": list(found.doubts),
        },
    }
