"""What an identification tells: what was found with intervals, the charts, and the force."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.cases.build import resolved_case
from vibroimpact.files.result_folder import CASE, write_case
from vibroimpact.identification.charts import identification_charts
from vibroimpact.identification.identify import Identification
from vibroimpact.report.report import (
    Explanation,
    Note,
    Quantity,
    Report,
    Section,
    Table,
    finite_interval,
    table_of,
)
from vibroimpact.results.csv_files import write_columns
from vibroimpact.signals.estimate import Estimate
from vibroimpact.units.display import digits, multiple

_MEANINGS = {
    "place_x_m": ("position, x", "m"),
    "place_y_m": ("position, y", "m"),
    "first_touch_s": ("first touch", "s"),
    "radius_m": ("radius", "m"),
    "mass_kg": ("mass", "kg"),
    "speed_m_s": ("approach speed", "m/s"),
    "duration_s": ("contact time", "s"),
    "max_force_N": ("largest force", "N"),
    "impulse_N_s": ("impulse", "N s"),
    "recovered_max_force_N": ("largest force, from the records alone", "N"),
    "recovered_impulse_N_s": ("impulse, from the records alone", "N s"),
}
_FIGURES = 5


def report_of(identification: Identification) -> Report:
    """Return the report of an identification.

    A force from the records alone that is withheld, since it contradicts the contact, is not
    written.
    """
    certain = ", ".join(identification.certain)
    model_errors = ""
    if identification.plate.model_error:
        model_errors = ", the estimated errors of the plate's frequencies and of the modes left out"
    estimates = Section(
        "found",
        "Identified values",
        (
            estimates_table(identification),
            Note(f"Taken as certain, in no interval: {certain}."),
            Explanation(
                "Radius, mass and speed hold for the material of the sphere and the contact law "
                "that the case states. The force from the records alone assumes neither. The "
                f"intervals contain noise{model_errors}, and what was stated as uncertain."
            ),
        ),
    )
    files: dict[str, Callable[[Path], object]] = {
        CASE: partial(write_case, resolved_case(identification.plate.case))
    }
    if identification.force is not None:
        files = {"force.csv": partial(_write_force, identification), **files}
    return Report(
        title=f"{identification.plate.case.name or 'An impact'}, identified",
        quantities=answer_of(identification),
        sections=(estimates,),
        charts=identification_charts(identification),
        warnings=identification.doubts,
        files=files,
        summary=_summary(identification),
        provenance="the case is case.toml, beside this page.",
    )


_ANSWERED = ("radius_m", "speed_m_s", "place_x_m", "place_y_m", "max_force_N", "duration_s")
"""Estimates that the answer states; the table has all."""


def answer_of(identification: Identification) -> list[Quantity]:
    """Return the main identified values with their intervals."""
    quantities = []
    for name in _ANSWERED:
        if name not in identification.estimates:
            continue
        estimate = identification.estimates[name]
        meaning, unit = _MEANINGS[name]
        title = meaning[:1].upper() + meaning[1:]
        if estimate.deviation == 0.0:
            quantity = Quantity(title, estimate.value, unit, note="given")
        else:
            interval = finite_interval(*estimate.interval)
            quantity = Quantity(title, estimate.value, unit, interval=interval)
        quantities.append(quantity)
    return quantities


def estimates_table(identification: Identification) -> Table:
    """Return the table of what was found, a row for each quantity."""
    headings = ["Quantity", "Value", "95 % from", "to", "Unit"]
    rows = [_row(*_MEANINGS[name], estimate) for name, estimate in identification.estimates.items()]
    return table_of(headings, rows, texts=("Unit",))


def _row(meaning: str, unit: str, estimate: Estimate) -> list[str]:
    low, high = estimate.interval
    chosen = multiple(unit, [low, estimate.value, high])
    value, lower_end, upper_end = (
        digits(number / chosen.size, _FIGURES) for number in (estimate.value, low, high)
    )
    if estimate.deviation == 0.0:
        return [meaning, value, "given", "", chosen.unit]
    return [meaning, value, lower_end, upper_end, chosen.unit]


def _write_force(identification: Identification, path: Path) -> None:
    """Write the force from the records alone, with its interval."""
    assert identification.force is not None
    recovered = identification.force.found
    half_width = Estimate(0.0, 1.0).interval[1] * recovered.deviation
    columns = {
        "time_s": identification.measured.start + identification.force.time,
        "force_N": recovered.force,
        "force_low_N": recovered.force - half_width,
        "force_high_N": recovered.force + half_width,
    }
    write_columns(columns, path)


def _summary(identification: Identification) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    return {
        "name": identification.plate.case.name,
        "version": __version__,
        "estimates": {
            name: {
                "value": estimate.value,
                "low": estimate.interval[0],
                "high": estimate.interval[1],
            }
            for name, estimate in identification.estimates.items()
        },
        "other_places_m": [
            list(candidate.place) for candidate in identification.search.candidates[1:]
        ],
        "records": _records(identification),
        "differences": _differences(identification),
        "taken_as_certain": list(identification.certain),
        "doubts": list(identification.doubts),
    }


def _records(identification: Identification) -> dict[str, Any]:
    """Return what is said of each record: its noise, what the sphere leaves of it, and faults."""
    measured = identification.measured
    records = {}
    for number, sensor in enumerate(measured.sensors):
        residual = identification.sphere.residual[number]
        removed = measured.removed[number]
        records[sensor.name] = {
            "noise": float(measured.noise[number]),
            "left": float((residual**2).mean() ** 0.5),
            "rms": float((measured.value[number] ** 2).mean() ** 0.5),
            "offset": removed.offset,
            "drift": removed.drift,
            "clipped_samples": int(np.count_nonzero(~measured.heard[number])),
            "inverted": bool(measured.polarity[number] < 0.0),
        }
    return records


def _differences(identification: Identification) -> dict[str, Any]:
    """Return how the plate and its sensors differ from the case, of what is not taken as
    certain: values and standard deviations.
    """
    sensors = [sensor.name for sensor in identification.measured.sensors]
    setting = identification.sphere.setting
    numbers = setting.numbers
    deviations = setting.deviations
    differences: dict[str, Any] = {}
    for name, value, deviation in zip(
        ("thickness", "modulus"), numbers[:2].tolist(), deviations[:2].tolist(), strict=True
    ):
        if deviation:
            differences[name] = {"value": value, "deviation": deviation}
    for name, values, spreads in zip(
        ("x_m", "y_m", "gain", "resonance"),
        numbers[2:].reshape(4, -1).tolist(),
        deviations[2:].reshape(4, -1).tolist(),
        strict=True,
    ):
        if any(spreads):
            differences[name] = {
                sensor: {"value": value, "deviation": deviation}
                for sensor, value, deviation in zip(sensors, values, spreads, strict=True)
            }
    return differences
