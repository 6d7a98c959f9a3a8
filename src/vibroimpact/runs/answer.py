"""What the run of a drop answers: its main results, with the digits that their errors leave."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from vibroimpact.cases.limits.limit import DURATION, FORCE
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.report.report import Quantity
from vibroimpact.results.result import Result
from vibroimpact.runs.tables import ERRORS_OF_COLUMNS
from vibroimpact.units.display import STANDARD_GRAVITY

_MOST_SENSORS = 4
"""Sensors whose largest reading the answer states; the table below has all."""

_OF_FIRST_IMPACT = (
    ("duration_s", "Contact time", "s"),
    ("restitution_achieved", "Restitution", ""),
    ("rebound_height_m", "Rebound height", "m"),
    ("energy_to_vibration_J", "Energy into vibration", "J"),
)
"""Columns of the table of impacts with their names here, and units."""


def answer_of(result: Result) -> list[Quantity]:
    """Return the main results of a run: of its first impact, and the peaks of its sensors.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> result = vi.result_of(vi.simulate(vi.load_case("paper:type1-theory")))
    >>> [(quantity.name, quantity.error_text) for quantity in answer_of(result)][:2]
    [('Largest force', '± 9.7 %'), ('Contact time', '± 8.5 %')]
    """
    return [*answer_of_impacts(result), *_of_sensors(result)]


def answer_of_impacts(result: Result) -> Iterator[Quantity]:
    """Yield the largest force of the run, and results of the first impact."""
    impacts = result.impacts
    if not len(impacts["impact"]):
        return
    errors = result.relative_errors
    several = len(impacts["impact"]) > 1
    largest_force = float(impacts["max_force_N"].max())
    if math.isfinite(largest_force):
        note = ""
        if several:
            note = f"in impact {int(impacts['max_force_N'].argmax()) + 1}"
        yield Quantity("Largest force", largest_force, "N", errors.get(FORCE, math.nan), note)
    # what modes left out change of the rebound is more than of the force, and not estimated
    least_error = max(result.truncation.values(), default=0.0)
    for column, name, unit in _OF_FIRST_IMPACT:
        value = float(impacts[column][0]) if column in impacts else math.nan
        if not math.isfinite(value):
            continue
        error_name = ERRORS_OF_COLUMNS[column]
        error = errors.get(error_name, math.nan)
        is_least = least_error > 0.0 and error_name != DURATION
        if is_least:
            error = float(np.fmax(error, least_error))
        note = "of the first impact" if several else ""
        yield Quantity(name, value, unit, error, note, is_least)


def _of_sensors(result: Result) -> Iterator[Quantity]:
    """Yield the largest readings of the first sensors, accelerations also in g."""
    if not len(result.impacts["impact"]):
        return
    for name, signal in list(result.signals.items())[:_MOST_SENSORS]:
        reading = largest_reading(name, signal)
        yield replace(reading, note=_in_g(reading))


def largest_reading(name: str, signal: Signal) -> Quantity:
    """Return the largest reading of a sensor, by its name."""
    return Quantity(name, signal.largest, signal.sensor.unit, signal.uncertainty)


def _in_g(reading: Quantity) -> str:
    """Return an acceleration as a multiple of standard gravity; "" for other readings."""
    if reading.unit != "m/s2":
        return ""
    return replace(reading, value=reading.value / STANDARD_GRAVITY, unit="").text + " g"
