"""Tables and sentences of calibrated friction, and the contents of its files."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.arrays import Floats
from vibroimpact.calibration.contact_law.calibration import case_name
from vibroimpact.calibration.friction.calibrate import FrictionCalibration
from vibroimpact.calibration.observed.matchable import ALONG_PLATE
from vibroimpact.calibration.observed.noise import standard_deviations
from vibroimpact.report.report import Table, first_rows, table_of
from vibroimpact.runs.tables import formatted_column
from vibroimpact.units.display import column_texts, digits, fixed, text

_ROUNDING = 1e-9
"""Difference between computed and measured, over the largest that was measured, below
which it is none.
"""


def friction_words(calibration: FrictionCalibration) -> str:
    """Return the values found as text."""
    each = zip(calibration.names, calibration.values, calibration.parameters.units, strict=True)
    return ", ".join(f"{name} = {text(float(value), unit)}" for name, value, unit in each)


def together_words(calibration: FrictionCalibration) -> str:
    """Return in words what was matched."""
    every = " and the ".join(ALONG_PLATE[name].phrase for name in calibration.weights)
    verb = "is" if len(calibration.weights) == 1 else "are"
    return f"the {every} of all impacts {verb} fitted jointly to the measurement"


def friction_sentences(calibration: FrictionCalibration) -> list[str]:
    """Return sentences on the intervals of the values, and on the residuals."""
    percent = f"{100.0 * calibration.confidence:g} %"
    sentences = []
    if calibration.intervals is not None:
        each = [
            f"{name} {_interval_words(interval, ends, unit)}"
            for name, interval, ends, unit in zip(
                calibration.names,
                calibration.intervals,
                calibration.parameters.allowed,
                calibration.parameters.units,
                strict=True,
            )
        ]
        if calibration.bootstrap:
            way = f"by bootstrap with {calibration.bootstrap} draws"
        else:
            way = "by the profile of the sum of squares"
        source = "the scatter of the measurement"
        if calibration.impacts.seen.deviations_known:
            source = "the given standard deviations"
            if math.isfinite(calibration.freedom):
                source += " and the scatter beyond them"
        sentences.append(f"At {percent}: {', '.join(each)}. Intervals are {way}, from {source}.")
    for name, (_, unit, phrase) in ALONG_PLATE.items():
        if name in calibration.weights:
            off = calibration.outcomes[name] - calibration.impacts.measured[name]
            off = np.where(
                np.abs(off) > _ROUNDING * np.abs(calibration.impacts.measured[name]).max(),
                np.abs(off),
                0.0,
            )
            mean, most = (text(float(value), unit, 3) for value in (off.mean(), off.max()))
            sentences.append(
                f"Computed and measured {phrase} differ by {mean} in the mean and {most} at most."
            )
    if calibration.impacts.seen.deviations_known and math.isfinite(calibration.scatter):
        sentences.append(
            f"Residuals are {digits(calibration.scatter, 3)} times as large as their standard "
            "deviations."
        )
    slip = int(calibration.slips.sum())
    number = len(calibration.slips)
    alone = ""
    if slip:
        depends = "these depend" if slip > 1 else "it depends"
        alone = f"; of friction, {depends} on the coefficient alone"
    if number > 1:
        verb = "slips" if slip == 1 else "slip"
        which = f"Of {number} impacts {slip or 'none'} {verb}"
    elif slip:
        which = "The impact slips"
    else:
        which = "The impact does not slip"
    sentences.append(f"{which} throughout{alone}.")
    if calibration.impacts.separation_speed is not None:
        sentences.append(
            "The normal rebound was measured too: the contact law is matched to it at each impact."
        )
    return sentences


def given_values_sentences(calibration: FrictionCalibration) -> list[str]:
    """Return sentences on the values that the case gives."""
    sentences = []
    for place, (name, unit) in enumerate(
        zip(calibration.names, calibration.parameters.units, strict=True)
    ):
        value = float(calibration.given[place])
        if not math.isfinite(value) or math.isclose(value, calibration.values[place], rel_tol=1e-3):
            continue
        verdict = ""
        if calibration.intervals is not None:
            low, high = calibration.intervals[place]
            verdict = ", inside the interval" if low <= value <= high else ", outside the interval"
        sentences.append(f"The case gives {name} = {text(value, unit)}{verdict}.")
    return sentences


def friction_table(calibration: FrictionCalibration) -> Table:
    """Return the table of the impacts."""
    impacts = calibration.impacts
    headers = [("", ""), ("Angle", "deg"), ("Speed", "m/s")]
    columns = [
        list(impacts.seen.labels),
        column_texts(impacts.angle),
        column_texts(np.hypot(impacts.velocity, impacts.seen.speeds)),
    ]
    for name, (column, _, phrase) in ALONG_PLATE.items():
        if name not in impacts.measured:
            continue
        measured = impacts.measured[name]
        number = len(impacts.velocity)
        unit, cells = formatted_column(
            column, np.concatenate([measured, calibration.outcomes[name]])
        )
        headers += [(phrase.capitalize(), unit), ("computed", unit)]
        columns += [cells[:number], cells[number:]]
        if name in calibration.weights and impacts.seen.deviations_known:
            headers.append(("off by standard deviations", ""))
            columns.append(
                [
                    fixed(float(part), 2)
                    for part in (calibration.outcomes[name] - measured)
                    / _deviations(calibration, name)
                ]
            )
        if calibration.as_given:
            headers.append(("as the case gives it", unit))
            columns.append(
                formatted_column(column, np.concatenate([measured, calibration.as_given[name]]))[1][
                    number:
                ]
            )
    headers.append(("Slips throughout", ""))
    columns.append(["yes" if slips else "no" for slips in calibration.slips])
    rows = [list(row) for row in zip(*columns, strict=True)]
    return table_of(headers, first_rows(rows))


def friction_document(calibration: FrictionCalibration) -> dict[str, Any]:
    """Return the contents of `calibration.json`; None where there is no finite value.

    Parameters
    ----------
    calibration : FrictionCalibration
        The calibration.
    """
    if calibration.intervals is None:
        ends = np.full((len(calibration.values), 2), np.nan)
    else:
        ends = calibration.intervals
    return {
        "version": __version__,
        "name": case_name(calibration.problem),
        "law": calibration.parameters.law.name,
        "match": dict(calibration.weights),
        "parameters": [
            {
                "parameter": name,
                "unit": unit,
                "value": float(value),
                "low": _finite(low),
                "high": _finite(high),
                "given": _finite(given),
            }
            for name, unit, value, (low, high), given in zip(
                calibration.names,
                calibration.parameters.units,
                calibration.values,
                ends,
                calibration.given,
                strict=True,
            )
        ],
        "degrees_of_freedom": _finite(calibration.freedom),
        "scatter": _finite(calibration.scatter),
        "confidence": calibration.confidence,
        "bootstrap": calibration.bootstrap,
        "matched": friction_rows(calibration),
        "doubts": list(calibration.doubts),
        "case": calibration.problem.source or None,
    }


def friction_rows(calibration: FrictionCalibration) -> list[dict[str, Any]]:
    """Return the impacts, one mapping each: how they came, what was measured, and what is
    computed.
    """
    impacts = calibration.impacts
    columns: dict[str, list[Any]] = {
        "label": list(impacts.seen.labels),
        "angle_deg": impacts.angle.tolist(),
        "approach_speed_m_s": impacts.seen.speeds.tolist(),
        "approach_velocity_x_m_s": impacts.velocity.tolist(),
        "spin_y_before_rad_s": impacts.spin.tolist(),
    }
    for name, (column, *_) in ALONG_PLATE.items():
        if name in impacts.measured:
            columns[f"measured_{column}"] = _finite_values(impacts.measured[name])
        if name in calibration.weights and impacts.seen.deviations_known:
            columns[f"standard_deviation_{column}"] = _deviations(calibration, name).tolist()
        columns[column] = _finite_values(calibration.outcomes[name])
        if calibration.as_given:
            columns[f"as_given_{column}"] = _finite_values(calibration.as_given[name])
    columns["slips_throughout"] = calibration.slips.tolist()
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def _deviations(calibration: FrictionCalibration, name: str) -> Floats:
    return standard_deviations(calibration.impacts.seen.noise[name])


def _interval_words(interval: Floats, ends: Floats, unit: str) -> str:
    if np.array_equal(interval, ends):
        return "of any value"
    low, high = (text(float(end), unit) for end in interval)
    if not np.isfinite(interval[1]):
        return f"at least {low}"
    return f"{low} to {high}"


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _finite_values(values: Floats) -> list[float | None]:
    return [_finite(value) for value in values.tolist()]
