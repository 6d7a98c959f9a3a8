"""Universal file, dataset 58: signals, motion and force of the sphere as functions of
time, for vibration-testing programs.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.columns import OBLIQUE_HISTORY_COLUMNS
from vibroimpact.errors import InputError
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, file_name
from vibroimpact.exporting.resample import motion_at
from vibroimpact.files.plain_names import one_line, plain_words
from vibroimpact.measurements.universal_file import SPHERE_FUNCTIONS

_IN_CONTACT = 20
"""Least number of history samples in the shortest contact: the peak of a half-sine is
then accurate to 0.3 %.
"""
_MOST_SAMPLES = 2_000_000
"""Largest number of samples of the history."""
_SPHERE = 1
_FIRST_SENSOR = 2
_UP = 3  # direction +z
_TURNING = 3  # what the number of a rotation about an axis is beyond that of the direction along it
_LINE = 80
"""Characters of a line of text."""
_MOST_NAMED = 10
"""Largest number of sensors that a note names."""
_QUANTITIES = {
    "displacement": 8,
    "velocity": 11,
    "acceleration": 12,
    "voltage": 1,
    "strain": 3,
    "pressure": 15,
    "force": 9,
}
"""Data types of dataset 58; 1 is "general", as voltage has none of its own."""
_ALONG_PLATE = {"position": 8, "velocity": 11, "spin": 11, "friction": 13}


@dataclass(frozen=True)
class _Function:
    identification: str
    node: int
    direction: int
    kind: int  # data type of the ordinate in dataset 58
    unit: str
    rate: float
    values: Floats


def write(drop: Drop) -> dict[str, bytes]:
    """Return the file.

    Raises
    ------
    InputError
        If there is neither a sensor nor a history that can be sampled evenly, or pyuff is not
        installed.
    """
    functions = [*_of_signals(drop), *_of_history(drop)]
    if not functions:
        raise InputError(
            f'"{one_line(drop.name)}" has no sensor with two samples or more, and '
            f"{_why_no_history(drop)}; there is nothing to write as functions of time"
        )
    try:
        import pyuff
    except ImportError:
        raise InputError(
            'universal files need pyuff, which is not installed: pip install "vibroimpact[uff]"'
        ) from None
    with TemporaryDirectory() as folder, warnings.catch_warnings():  # pyuff writes only to files
        # pyuff does not close a file after binary data
        warnings.simplefilter("ignore", ResourceWarning)
        path = Path(folder, "drop.uff")
        pyuff.UFF(str(path)).write_sets(
            [_header(drop), _si(), *(_dataset(function, drop) for function in functions)],
            "overwrite",
        )
        return {file_name(drop, ".uff"): path.read_bytes()}


def history_rate(drop: Drop) -> float | None:
    """Return the sampling rate of the history [Hz], which resolves the shortest contact.

    An integer multiple of the rate of the fastest sensor; without sensors 1, 2 or 5 times a power
    of ten, so that the step is exact in the few digits of the format. None if no contact has a
    positive duration, or there would be too many samples.
    """
    if not drop.impacts or not len(drop.history.get("time_s", ())):
        return None
    durations = drop.impacts["duration_s"]
    durations = durations[durations > 0.0]
    if not len(durations):
        return None
    needed = _IN_CONTACT / float(durations.min())
    if drop.signals:
        fastest = max(signal.sensor.rate for signal in drop.signals.values())
        rate = fastest * max(1, math.ceil(needed / fastest))
    else:
        power = 10.0 ** math.floor(math.log10(needed))
        rate = next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= needed)
    if drop.end_time * rate < _MOST_SAMPLES:
        return rate
    return None


def _of_signals(drop: Drop) -> Iterator[_Function]:
    for node, (name, signal) in enumerate(drop.signals.items(), _FIRST_SENSOR):
        sensor = signal.sensor
        if len(signal.value) > 1:
            phrase = f"{sensor.quantity} of {plain_words(name)}"
            yield _Function(
                phrase,
                node,
                _direction(sensor.direction),
                _QUANTITIES[sensor.quantity],
                sensor.unit,
                sensor.rate,
                signal.value,
            )


def _of_history(drop: Drop) -> Iterator[_Function]:
    rate = history_rate(drop)
    if rate is None:
        return
    # the last sample is not to be lost to rounding
    last = int(drop.history["time_s"][-1] * rate * (1.0 + 1e-12))
    motion = motion_at(drop.history, np.arange(last + 1) / rate)
    for name, (phrase, kind, unit) in SPHERE_FUNCTIONS.items():
        yield _Function(phrase, _SPHERE, _UP, kind, unit, rate, motion[name])
    for name, column in OBLIQUE_HISTORY_COLUMNS.items():
        if name in motion:
            what, axis, _ = name.split("_", 2)
            direction = "xyz".index(axis) + 1
            if what == "spin":
                direction += _TURNING
            yield _Function(
                column.meaning,
                _SPHERE,
                direction,
                _ALONG_PLATE[what],
                column.unit,
                rate,
                motion[name],
            )


def _direction(along: tuple[float, float, float]) -> int:
    """Return the number of the axis along a direction, negative for the opposite
    direction; 0 if it is not along an axis.
    """
    for axis, part in enumerate(along, 1):
        if abs(part) > 1.0 - 1e-9:
            return axis if part > 0.0 else -axis
    return 0


def _header(drop: Drop) -> dict[str, Any]:
    date = {
        f"{what}_{when}": ""
        for what in ("date", "time")
        for when in ("db_created", "db_saved", "file_written")
    }
    phrase = {
        "model_name": plain_words(drop.name),
        "description": "a sphere that falls on a plate",
        "db_app": "vibroimpact",
    }
    return {"type": 151, **phrase, "program": f"vibroimpact {__version__}", **date}


def _si() -> dict[str, Any]:
    scales = {"length": 1.0, "force": 1.0, "temp": 1.0, "temp_offset": 273.15}
    return {"type": 164, "units_code": 1, "units_description": "SI", "temp_mode": 1, **scales}


def _dataset(function: _Function, drop: Drop) -> dict[str, Any]:
    labels = {
        "abscissa_axis_lab": "time",
        "abscissa_axis_units_lab": "s",
        "ordinate_axis_units_lab": function.unit,
    }
    return {
        "type": 58,
        "binary": 1,
        "id1": function.identification[:_LINE],
        "id2": plain_words(drop.name),
        "func_type": 1,
        "rsp_ent_name": "NONE",
        "rsp_node": function.node,
        "rsp_dir": function.direction,
        "ref_ent_name": "NONE",
        "ref_node": 0,
        "ref_dir": 0,
        "abscissa_spacing": 1,
        "abscissa_spec_data_type": 17,
        "ordinate_spec_data_type": function.kind,
        "orddenom_spec_data_type": 0,
        "z_axis_spec_data_type": 0,
        **labels,
        "x": np.array([0.0, 1.0 / function.rate]),  # only the start and the step are written
        "data": function.values,
    }


def _why_no_history(drop: Drop) -> str:
    if not len(drop.history.get("time_s", ())):
        return "it has no history"
    if not drop.impacts or not np.any(drop.impacts["duration_s"] > 0.0):
        return "no contact in it has a duration that a rate could be chosen for"
    return (
        f"its history would take more than {_MOST_SAMPLES} samples, {_IN_CONTACT} in the "
        "shortest contact"
    )


def _notes(drop: Drop) -> list[str]:
    rate = history_rate(drop)
    nodes = [
        f"{number} is the sensor {one_line(name)}"
        for number, name in enumerate(drop.signals, _FIRST_SENSOR)
    ]
    if len(nodes) > _MOST_NAMED:
        nodes = [*nodes[: _MOST_NAMED - 1], "and so on"]
    notes = [
        f"Node {_SPHERE} is the sphere"
        + "".join(f", {phrase}" for phrase in nodes)
        + "; directions are the plate's, +z upwards."
    ]
    if rate is None:
        notes.append(f"The history is left out: {_why_no_history(drop)}.")
    else:
        phrase = f"The history is sampled at {rate:g} Hz, without a filter against aliasing"
        notes.append(f"{phrase}: at least {_IN_CONTACT} times in the shortest contact.")
    slanting = [
        one_line(name)
        for name, signal in drop.signals.items()
        if not _direction(signal.sensor.direction)
    ]
    if slanting:
        notes.append(
            f"The direction of {', '.join(slanting)} lies along no axis; it is written as a scalar."
        )
    rates = {signal.sensor.rate for signal in drop.signals.values()}
    if rate:
        rates.add(rate)
    rough = sorted(
        sampling_rate
        for sampling_rate in rates
        if float(f"{1.0 / sampling_rate:.5e}") != 1.0 / sampling_rate
    )
    if rough:
        rates_text = ", ".join(f"{sampling_rate:g} Hz" for sampling_rate in rough)
        notes.append(
            f"The time step of {rates_text} is rounded to the six digits that the format has."
        )
    return notes


FORMAT = ExportFormat(
    name="uff58",
    program="programs of vibration testing (Simcenter Testlab, ME'scope, pyuff, ...)",
    files="one universal file (.uff), datasets 151, 164 and binary 58",
    tested="read back with pyuff 2.5, which also writes it, and by a reader in the tests; not with "
    "Simcenter Testlab or ME'scope",
    write=write,
    notes=_notes,
)
