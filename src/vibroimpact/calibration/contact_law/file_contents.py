"""Contents of the files of a calibration: calibration.json, matched.csv and comparison.csv."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.calibration.contact_law.adams_dialog import calibrated_dialog
from vibroimpact.calibration.contact_law.calibration import Calibration, case_name
from vibroimpact.calibration.contact_law.differences import (
    COMPARED,
    WAYS,
    differences,
    largest_misfit,
    reference,
)
from vibroimpact.calibration.observed.inputs import inputs_document
from vibroimpact.calibration.observed.matchable import MATCHABLE

CALIBRATION = "calibration.json"
_SHORT = {quantity.column: name for name, quantity in MATCHABLE.items()}


def calibration_table(calibration: Calibration) -> dict[str, Any]:
    """Return the contents of `calibration.json`; None where there is no finite value.

    Parameters
    ----------
    calibration : Calibration
        The calibration.
    """
    fit, (speeds, values) = calibration.fit, calibration.impacts
    if calibration.curve is None:
        curve = None
    else:
        curve = {
            "approach_speed_m_s": _plain(calibration.curve[0]),
            "value": _plain(calibration.curve[1]),
        }
    effects = calibration.observations.effects
    inputs = () if effects is None else effects.inputs
    return {
        "version": __version__,
        "name": case_name(calibration.problem),
        "law": calibration.problem.laws[0].name,
        "parameter": calibration.parameter,
        "unit": calibration.unit,
        "match": dict(calibration.weights),
        "impacts": [
            {"impact": number + 1, "approach_speed_m_s": float(speed), "value": float(value)}
            for number, (speed, value) in enumerate(zip(speeds, values, strict=True))
        ],
        "fit": {
            "degree": fit.function.degree,
            "coefficients": list(fit.function.coefficients),
            "from_speed_m_s": fit.function.slowest,
            "to_speed_m_s": fit.function.fastest,
            "half_widths": _plain(fit.half_widths(calibration.confidence)),
            "covariance": [_plain(row) for row in fit.covariance],
            "degrees_of_freedom": _finite(fit.freedom),
            "scatter": _finite(fit.scatter),
            "largest_misfit": largest_misfit(calibration),
        },
        "by_speed": fit.function.table(),
        "confidence": calibration.confidence,
        "bootstrap": calibration.bootstrap,
        "matched": matched_rows(calibration),
        "adams_dialog": calibrated_dialog(calibration),
        "curve": curve,
        "differences": {
            column: {way: _plain(values) for way, values in ways.items()}
            for column, ways in differences(calibration).items()
        },
        "other_parameters": dict(calibration.others),
        "corrections": {
            name: {
                "value": correction.value,
                "standard_deviation": correction.deviation,
                "unit": correction.unit,
            }
            for name, correction in calibration.observations.corrections.items()
        },
        "inputs": inputs_document(inputs),
        "doubts": list(calibration.doubts),
        "case": calibration.problem.source or None,
    }


def matched_rows(calibration: Calibration) -> list[dict[str, Any]]:
    """Return the matched impacts, one mapping each: target, computed with the value
    found, and computed with the given value.
    """
    rows = []
    for number, label in enumerate(calibration.observations.labels):
        row: dict[str, Any] = {
            "label": label,
            "approach_speed_m_s": float(calibration.observations.speeds[number]),
        }
        row["value"] = _finite(calibration.values[number])
        row["low"] = None
        row["high"] = None
        if calibration.intervals is not None:
            row["low"] = _finite(calibration.intervals[number, 0])
            row["high"] = _finite(calibration.intervals[number, 1])
        row["given"] = _finite(calibration.given[number])
        for name, (column, *_) in MATCHABLE.items():
            if name in calibration.observations.wanted:
                row[f"wanted_{column}"] = _finite(calibration.observations.wanted[name][number])
            row[column] = _finite(calibration.outcomes[name][number])
            if calibration.as_given:
                row[f"as_given_{column}"] = _finite(calibration.as_given[name][number])
        rows.append(row)
    return rows


def comparison_rows(calibration: Calibration) -> list[dict[str, Any]]:
    """Return the impacts of the drop with the target values, one mapping per impact and
    way of prescribing the value.
    """
    wanted = reference(calibration)
    off = differences(calibration)
    rows = []
    for way in WAYS:
        table = calibration.drops[way]
        for number in range(len(table["impact"])):
            row: dict[str, Any] = {
                "way": way,
                "impact": number + 1,
                "approach_speed_m_s": float(table["approach_speed_m_s"][number]),
            }
            for column in COMPARED:
                row[column] = _finite(table[column][number])
                if column in wanted and number < len(wanted[column]):
                    row[f"wanted_{column}"] = _finite(wanted[column][number])
                    row[f"difference_{_SHORT[column]}_percent"] = _finite(
                        100.0 * off[column][way][number]
                    )
            rows.append(row)
    return rows


def columns_of(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return the columns of the rows in order of first occurrence."""
    return list(dict.fromkeys(name for row in rows for name in row))


def _plain(values: Any) -> list[float | None]:
    return [_finite(value) for value in np.asarray(values, dtype=float)]


def _finite(value: Any) -> float | None:
    return float(value) if math.isfinite(value) else None
