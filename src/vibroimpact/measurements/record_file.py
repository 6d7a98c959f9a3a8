"""Selection of a measured record from the functions of a universal file, converted to SI units."""

from __future__ import annotations

from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.measurements.universal_file import (
    SPHERE_FUNCTIONS,
    Function,
    UniversalFile,
    is_universal,
    read_universal_file,
)
from vibroimpact.units.reading import to_si

__all__ = ["SPHERE_ACCELERATION", "UniversalRecord", "is_universal", "read_universal_record"]

Quantity = Literal["position", "force", "acceleration"]

_KINDS: dict[int, tuple[Quantity, str]] = {
    8: ("position", "m"),
    9: ("force", "N"),
    13: ("force", "N"),
    12: ("acceleration", "m/s^2"),
}
_DIMENSIONS = {"m": "m", "N": "N", "m/s^2": "m"}
_OWN_IDENTIFICATIONS = {identification for identification, *_ in SPHERE_FUNCTIONS.values()}
SPHERE_ACCELERATION = SPHERE_FUNCTIONS["acceleration_m_s2"][0]
"""Identification line of the sphere's acceleration in files written by this program."""

_SAME = 1e-6
_MOST_NAMED = 8


class UniversalRecord(NamedTuple):
    """A record: identification, quantity, times [s], and values in SI units."""

    identification: str
    quantity: Quantity
    time: Floats
    values: Floats


def read_universal_record(path: str | Path, which: str | None, by_rebound: bool) -> UniversalRecord:
    """Read a record of force or position from a universal file.

    Parameters
    ----------
    path : path
        The file.
    which : str, optional
        First identification line of the function, or its number in the file. By default the only
        function of its kind, or the one that this program writes for its sphere.
    by_rebound : bool
        Whether a position is preferred to a force.

    Raises
    ------
    InputError
        If the file can't be read, has no such function, or more than one.
    """
    file = read_universal_file(path)
    if which is not None:
        function = _requested(path, file.functions, which)
    else:
        function = _only_function(path, file.functions, by_rebound)
    quantity, unit = _KINDS[function.kind]
    steps = np.diff(function.time)
    if np.any(steps <= 0.0):
        raise InputError(
            f'{path}: "{function.identification}": time does not rise at sample '
            f"{int(np.argmin(steps > 0.0)) + 2}",
            "target",
        )
    values = function.values * _factor_to_si(path, function, unit, file)
    return UniversalRecord(function.identification, quantity, function.time, values)


def _only_function(path: str | Path, functions: list[Function], by_rebound: bool) -> Function:
    """Return the only function of the first quantity that there is, or that of this program.

    Raises
    ------
    InputError
        If there is none, or several.
    """
    order: tuple[Quantity, ...] = ("force", "position", "acceleration")
    if by_rebound:
        order = ("position", "force", "acceleration")
    candidates: list[Function] = []
    for quantity in order:
        candidates = [
            function
            for function in functions
            if function.kind in _KINDS and _KINDS[function.kind][0] == quantity
        ]
        if candidates:
            break
    if not candidates:
        raise InputError(
            f"{path}: there is no force, displacement or acceleration over time in it; "
            f"{_listed(functions)}",
            "target",
        )
    own = [function for function in candidates if function.identification in _OWN_IDENTIFICATIONS]
    if len(own) == 1:
        return own[0]
    if len(candidates) > 1:
        raise InputError(
            f"{path}: name the function to use: {_listed(candidates)}", "target.function"
        )
    return candidates[0]


def _requested(path: str | Path, functions: list[Function], which: str) -> Function:
    """Return the function with an identification or a number.

    Raises
    ------
    InputError
        If there is none, there are several, or it is of another quantity.
    """
    requested = [
        function
        for function in functions
        if which in (function.identification, str(function.number))
    ]
    if not requested:
        hint = did_you_mean(which, [function.identification for function in functions])
        raise InputError(
            f'{path}: there is no function "{which}"; {_listed(functions)}.{hint}',
            "target.function",
        )
    if len(requested) > 1:
        raise InputError(
            f'{path}: there are several functions "{which}"; {_listed(functions)}.',
            "target.function",
        )
    function = requested[0]
    if function.kind not in _KINDS:
        raise InputError(
            f'{path}: "{which}" is no force, displacement or acceleration; {_listed(functions)}',
            "target.function",
        )
    return function


def _listed(functions: list[Function]) -> str:
    """Return which functions there are, for messages."""
    if not functions:
        return "there is no real function of time"
    listed = ", ".join(
        f'{function.number} "{function.identification[:40]}"'
        for function in functions[:_MOST_NAMED]
    )
    if len(functions) > _MOST_NAMED:
        listed += f" and {len(functions) - _MOST_NAMED} more"
    return f"there are {listed}"


def _factor_to_si(path: str | Path, function: Function, unit: str, file: UniversalFile) -> float:
    """Return the conversion factor to SI, from the unit label or from dataset 164.

    If both are given, they must agree.
    """
    named = f'{path}: "{function.identification}"'
    by_label = _factor_of_label(function.unit, unit)
    by_file = None
    if file.factors is not None:  # from SI
        by_file = 1.0 / file.factors[_DIMENSIONS[unit]]
    if by_label is None and by_file is None:
        label = "it has no unit"
        if function.unit:
            label = f'the label "{function.unit}" is no known unit of this quantity, such as {unit}'
        raise InputError(
            f"{named}: {label}, and there is no dataset 164 with the units of the file", "target"
        )
    if by_label is None:
        return float(by_file or 1.0)
    if by_file is not None and abs(by_label / by_file - 1.0) > _SAME:
        raise InputError(
            f'{named}: its unit is "{function.unit}", and by dataset 164 the values are in units '
            f"of {by_file:g} {unit}; correct one of them",
            "target",
        )
    return by_label


def _factor_of_label(label: str, unit: str) -> float | None:
    """Return the factor of a unit label; None if there is none, or it is of another quantity."""
    if not label:
        return None
    try:
        return to_si(f"1 {label}", unit)
    except InputError:
        return None
