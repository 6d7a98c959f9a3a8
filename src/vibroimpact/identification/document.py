"""An identification as data and as text: its summary, what `identify --json` prints, and
the table that the terminal and the page show.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.identification.identify import Identification
from vibroimpact.signals.estimate import Estimate
from vibroimpact.units.display import digits, multiple

HEADERS = ("Quantity", "Value", "95 % from", "to", "Unit")
"""Headers of the table."""

_MEANINGS = {
    "place_x_m": ("place, x", "m"),
    "place_y_m": ("place, y", "m"),
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


def identification_rows(found: Identification) -> list[list[str]]:
    """Return the cells of the table, a row for each quantity."""
    return [_row(*_MEANINGS[name], one) for name, one in found.estimates.items()]


def _row(meaning: str, unit: str, one: Estimate) -> list[str]:
    low, high = one.interval
    chosen = multiple(unit, [low, one.value, high])
    given = one.deviation == 0.0
    cells = [digits(value / chosen.size, _FIGURES) for value in (one.value, low, high)]
    return [meaning, cells[0], *(["given", ""] if given else cells[1:]), chosen.unit]


def summary_of_identification(found: Identification) -> dict[str, Any]:
    """Return the content of `summary.json`, and of what `identify --json` prints."""
    measured, left = found.measured, found.sphere.residual
    return {
        "name": found.plate.case.name,
        "version": __version__,
        "estimates": {
            name: {"value": one.value, "low": one.interval[0], "high": one.interval[1]}
            for name, one in found.estimates.items()
        },
        "other_places_m": [list(one.place) for one in found.search.candidates[1:]],
        "records": {
            sensor.name: {
                "noise": float(noise),
                "left": float((part**2).mean() ** 0.5),
                "rms": float((value**2).mean() ** 0.5),
                "offset": removed.offset,
                "drift": removed.drift,
                "clipped_samples": int(np.count_nonzero(~heard)),
                "inverted": bool(polarity < 0.0),
            }
            for sensor, noise, part, value, removed, heard, polarity in zip(
                measured.sensors,
                measured.noise,
                left,
                measured.value,
                measured.removed,
                measured.heard,
                measured.polarity,
                strict=True,
            )
        },
        "differences": _differences(found),
        "taken_as_certain": list(found.certain),
        "doubts": list(found.doubts),
    }


def _differences(found: Identification) -> dict[str, Any]:
    """Return how the plate and its sensors differ from the case, of what is not taken as
    certain: values and standard deviations.
    """
    sensors = [sensor.name for sensor in found.measured.sensors]
    numbers, deviations = found.sphere.setting.numbers, found.sphere.setting.deviations
    of_plate = zip(
        ("thickness", "modulus"), numbers[:2].tolist(), deviations[:2].tolist(), strict=True
    )
    of_sensors = zip(
        ("x_m", "y_m", "gain", "resonance"),
        numbers[2:].reshape(4, -1).tolist(),
        deviations[2:].reshape(4, -1).tolist(),
        strict=True,
    )
    return {
        name: {"value": value, "deviation": deviation}
        for name, value, deviation in of_plate
        if deviation
    } | {
        name: {
            sensor: {"value": one, "deviation": its}
            for sensor, one, its in zip(sensors, values, spreads, strict=True)
        }
        for name, values, spreads in of_sensors
        if any(spreads)
    }
