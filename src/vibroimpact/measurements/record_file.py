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
_OWN = {words for words, *_ in SPHERE_FUNCTIONS.values()}
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
    functions = [one for one in file.functions if one.kind in _KINDS]
    if which is not None:
        one = _requested(path, file.functions, which)
    else:
        order: tuple[Quantity, ...] = ("position", "force") if by_rebound else ("force", "position")
        groups = (
            [one for one in functions if _KINDS[one.kind][0] == quantity]
            for quantity in (*order, "acceleration")
        )
        group = next((group for group in groups if group), [])
        if not group:
            raise InputError(
                f"{path}: there is no force, displacement or acceleration over time in it; "
                f"{_there(file.functions)}",
                "target",
            )
        own = [one for one in group if one.identification in _OWN]
        group = own if len(own) == 1 else group
        if len(group) > 1:
            raise InputError(
                f"{path}: name the function to use: {_there(group)}", "target.function"
            )
        one = group[0]
    quantity, unit = _KINDS[one.kind]
    steps = np.diff(one.time)
    if np.any(steps <= 0.0):
        raise InputError(
            f'{path}: "{one.identification}": time does not rise at sample '
            f"{int(np.argmin(steps > 0.0)) + 2}",
            "target",
        )
    return UniversalRecord(
        one.identification, quantity, one.time, one.values * _in_si(path, one, unit, file)
    )


def _requested(path: str | Path, functions: list[Function], which: str) -> Function:
    found = [one for one in functions if which in (one.identification, str(one.number))]
    if len(found) != 1:
        several = "there are several functions" if found else "there is no function"
        hint = "" if found else did_you_mean(which, [one.identification for one in functions])
        raise InputError(
            f'{path}: {several} "{which}"; {_there(functions)}.{hint}', "target.function"
        )
    if found[0].kind not in _KINDS:
        raise InputError(
            f'{path}: "{which}" is no force, displacement or acceleration; {_there(functions)}',
            "target.function",
        )
    return found[0]


def _there(functions: list[Function]) -> str:
    named = [f'{one.number} "{one.identification[:40]}"' for one in functions[:_MOST_NAMED]]
    more = f" and {len(functions) - _MOST_NAMED} more" if len(functions) > _MOST_NAMED else ""
    return (
        f"there are {', '.join(named)}{more}" if functions else "there is no real function of time"
    )


def _in_si(path: str | Path, one: Function, unit: str, file: UniversalFile) -> float:
    """Return the conversion factor to SI, from the unit label or from dataset 164; if
    both are given, they must agree.
    """
    by_label, by_file = (
        _by_label(one.unit, unit),
        None if file.factors is None else 1.0 / file.factors[_DIMENSIONS[unit]],
    )
    if by_label is None and by_file is None:
        label = (
            f'the label "{one.unit}" is no known unit of this quantity, such as {unit}'
            if one.unit
            else "it has no unit"
        )
        raise InputError(
            f'{path}: "{one.identification}": {label}, and there is no dataset 164 with '
            "the units of the file",
            "target",
        )
    if by_label is not None and by_file is not None and abs(by_label / by_file - 1.0) > _SAME:
        words = (
            f'its unit is "{one.unit}", and by dataset 164 the values are in units of '
            f"{by_file:g} {unit}"
        )
        raise InputError(f'{path}: "{one.identification}": {words}; correct one of them', "target")
    return by_label if by_label is not None else float(by_file or 1.0)


def _by_label(label: str, unit: str) -> float | None:
    if not label:
        return None
    try:
        return to_si(f"1 {label}", unit)
    except InputError:
        return None
