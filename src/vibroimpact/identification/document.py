"""An identification as data and as text: its summary, what `identify --json` prints, and the table that the terminal and the page show."""

from __future__ import annotations

from typing import Any

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
        "estimates": {name: {"value": one.value, "low": one.interval[0], "high": one.interval[1]} for name, one in found.estimates.items()},
        "other_places_m": [list(one.place) for one in found.search.candidates[1:]],
        "records": {
            sensor.name: {
                "noise": float(noise),
                "left": float((part**2).mean() ** 0.5),
                "rms": float((value**2).mean() ** 0.5),
                "offset": removed.offset,
                "drift": removed.drift,
            }
            for sensor, noise, part, value, removed in zip(
                measured.sensors, measured.noise, left, measured.value, measured.removed, strict=True
            )
        },
        "doubts": list(found.doubts),
    }
