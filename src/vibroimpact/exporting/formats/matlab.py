"""MATLAB: one .mat file with structs of a drop, its response and the units."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import fields
from io import BytesIO
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.contact.law import unit_of
from vibroimpact.contact.parameters import Parameters
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.drop_tables import Table, tables_of
from vibroimpact.exporting.export_format import ExportFormat, file_name
from vibroimpact.files.plain_names import one_line, plain_names

_LONGEST = 63
"""Largest length of a name in MATLAB."""
_KEYWORDS = (
    *(
        "break",
        "case",
        "catch",
        "classdef",
        "continue",
        "else",
        "elseif",
        "end",
        "for",
        "function",
        "global",
        "if",
        "otherwise",
    ),
    *("parfor", "persistent", "return", "spmd", "switch", "try", "while"),
)
_HEADER = 116
"""Length of the text header of a file [bytes]."""


def write(drop: Drop) -> dict[str, bytes]:
    """Return the file.

    Raises
    ------
    InputError
        If the drop has no tables.
    """
    from scipy.io import savemat

    tables = tables_of(drop)
    units: dict[str, Any] = {
        name: {column: table.unit for column, table in tables[name].items()}
        for name in ("impacts", "history")
        if name in tables
    }
    variables: dict[str, Any] = {name: _values(tables[name]) for name in units}
    legal = legal_names(list(drop.signals))
    plain = plain_names(list(drop.signals))
    signals = {
        legal[name]: _signal(drop, name, tables[f"sensors/{plain[name]}"]) for name in drop.signals
    }
    if signals:
        variables["signals"] = signals
    if drop.surface:
        variables["surface"] = {name: np.asarray(values) for name, values in drop.surface.items()}
        units["surface"] = {**dict.fromkeys(drop.surface, "m"), "time": "s"}
    variables["drop"], units["drop"] = _facts(drop)
    file = BytesIO()
    savemat(
        file,
        {**variables, "units": units},
        long_field_names=True,
        oned_as="column",
        do_compression=True,
    )
    # replaces the header with the time of day, so that files are reproducible
    text = f"MATLAB 5.0 MAT-file, written by vibroimpact {__version__}".encode().ljust(_HEADER)
    return {file_name(drop, ".mat"): text + file.getvalue()[_HEADER:]}


def legal_names(names: list[str]) -> dict[str, str]:
    """Return for each name a distinct valid name of a struct field in MATLAB.

    Examples
    --------
    >>> legal_names(["a1", "2nd sensor", "end", "left/upper"])
    {'a1': 'a1', '2nd sensor': 's_2nd_sensor', 'end': 's_end', 'left/upper': 'left_upper'}
    """
    starts = (plain.replace("-", "_") for plain in plain_names(names).values())
    legal = []
    for start in starts:
        is_legal = re.match("[A-Za-z]", start) and start not in _KEYWORDS
        legal.append(start if is_legal else f"s_{start}")
    taken: set[str] = set()
    numbers: dict[str, int] = {}
    for place, name in enumerate(legal):
        tried = start = name[:_LONGEST]
        while tried in taken:
            numbers[start] = numbers.get(start, 1) + 1
            tried = f"{name[: _LONGEST - 1 - len(str(numbers[start]))]}_{numbers[start]}"
        taken.add(tried)
        legal[place] = tried
    return dict(zip(names, legal, strict=True))


def _values(table: Table) -> dict[str, Any]:
    return {name: np.asarray(column.values, dtype=float) for name, column in table.items()}


def _signal(drop: Drop, name: str, table: Table) -> dict[str, Any]:
    sensor = drop.signals[name].sensor
    values = dict(zip(("time_s", "value"), _values(table).values(), strict=True))
    return {
        **values,
        "unit": sensor.unit,
        "quantity": sensor.quantity,
        "rate_Hz": sensor.rate,
        "direction": np.array(sensor.direction),
        "name": one_line(name),
    }


def _facts(drop: Drop) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the data of the drop (bodies, initial state, contact law), and their units."""
    stated: dict[str, tuple[Any, str]] = {
        "name": (one_line(drop.name), ""),
        "radius": (drop.radius, "m"),
        "mass": (drop.mass, "kg"),
        "inertia": (drop.inertia, "kg m2"),
        "height": (drop.height, "m"),
        "speed": (drop.speed, "m/s"),
        "gravity": (drop.gravity, "m/s2"),
        "position": (np.array(drop.position), "m"),
        "plate_size": (np.array(drop.plate_size or ()), "m"),
        "end_time": (drop.end_time, "s"),
        "elastic": (", ".join(drop.elastic), ""),
        "contact_law": (drop.laws[0].name, ""),
    }
    if drop.oblique is not None:
        along = {
            name: np.array(getattr(drop.oblique, name), dtype=float)
            for name in ("velocity", "spin", "gravity")
        }
        stated |= {
            "velocity_along_plate": (along["velocity"], "m/s"),
            "spin": (along["spin"], "rad/s"),
            "gravity_along_plate": (along["gravity"], "m/s2"),
        }
    if drop.motion is not None:
        stated |= {
            "motion_amplitude": (drop.motion.amplitude, "m"),
            "motion_frequency": (drop.motion.frequency, "Hz"),
            "motion_phase": (drop.motion.phase, "rad"),
            "motion_direction": (np.array(drop.motion.direction), "1"),
        }
    facts = {name: value for name, (value, _) in stated.items()}
    units: dict[str, Any] = {name: unit for name, (_, unit) in stated.items() if unit}
    for name in ("sphere", "plate"):
        material = getattr(drop, f"{name}_material")
        for key, unit in (("density", "kg/m3"), ("youngs_modulus", "Pa"), ("poissons_ratio", "1")):
            facts[f"{name}_{key}"], units[f"{name}_{key}"] = getattr(material, key), unit
    facts["law"], units["law"] = _parameters(drop.laws)
    if drop.oblique is not None and drop.oblique.friction is not None:
        facts["friction_law"] = drop.oblique.friction.name
        facts["friction"], units["friction"] = _parameters((drop.oblique.friction,))
    if drop.function is not None:
        name, function = drop.function
        facts["function"] = {
            "parameter": name,
            "coefficients_lowest_power_first": np.array(function.coefficients),
        }
    return facts, units


def _parameters(laws: Sequence[Parameters]) -> tuple[dict[str, Any], dict[str, str]]:
    """Return each parameter of a law as an array over the laws of the impacts, and its unit."""
    values = {}
    units = {}
    for item in fields(laws[0]):
        of_laws = [getattr(law, item.name) for law in laws]
        if of_laws[0] is not None and not item.metadata["memory"]:
            values[item.name], units[item.name] = (
                np.asarray(of_laws),
                unit_of(item, getattr(laws[0], "exponent", 1)),
            )
    return values, units


FORMAT = ExportFormat(
    name="mat",
    program="MATLAB, GNU Octave",
    files="one file (.mat) of structs: impacts, history, signals, surface, drop and units",
    tested="read back with scipy.io.loadmat of SciPy 1.17, values, names and units the same; not "
    "with MATLAB itself",
    write=write,
    notes=lambda drop: [
        f'The sensor "{one_line(name)}" is signals.{legal} in the file, a valid name in MATLAB.'
        for name, legal in legal_names(list(drop.signals)).items()
        if name != legal
    ],
)
