"""Frequency responses from universal files: functions of type 4 in their datasets 58,
with the coherences of type 6.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.measurements.universal_file import (
    COHERENCE,
    FREQUENCY_RESPONSE,
    Freedom,
    FunctionOfFrequency,
    is_universal,
    read_universal_file,
)
from vibroimpact.quoting import quoted
from vibroimpact.signals.frequency_response import (
    RESPONSE_UNITS,
    DegreeOfFreedom,
    FrequencyResponse,
)
from vibroimpact.signals.reading.si_units import in_si
from vibroimpact.signals.reading.universal import record_name
from vibroimpact.units.reading import to_si

_MOTIONS = {8: "m", 11: "m/s", 12: "m/s2"}
_FORCES = (9, 13)
_AXES = "XYZ"
_OVER = 1e-3
"""By how much a coherence exceeds 1 that is rounded."""


class Contents(NamedTuple):
    """What a file of a test has: the names of its records over time, and the number of
    its frequency responses.
    """

    records: tuple[str, ...]
    responses: int


def contents_of(path: str | PathLike[str]) -> Contents:
    """Return what a file has; of a file that is not universal, which has records alone, its own
    name.

    Raises
    ------
    InputError
        If it is a universal file that can't be read.
    """
    if not Path(path).is_file() or not is_universal(Path(path)):
        return Contents((str(path),), 0)
    file = read_universal_file(Path(path))
    responses = sum(one.function_type == FREQUENCY_RESPONSE for one in file.of_frequency)
    return Contents(tuple(record_name(one) for one in file.functions), responses)


def read_responses(path: str | PathLike[str]) -> tuple[FrequencyResponse, ...]:
    """Return the frequency responses of a universal file (dataset 58, function type 4), with their
    coherences (type 6).

    Values are brought to SI by the labels of their units, else by dataset 164; without either they
    are taken as SI, with a doubt.

    Parameters
    ----------
    path : path
        The file: text or binary, at equal steps of frequency or not.

    Raises
    ------
    InputError
        If it can't be read, or has no frequency response of motion, strain or voltage over force.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> lines = ["", "58", "beam", "NONE", "NONE", "NONE", "NONE"]
    >>> lines += [f"{4:5}{0:10}{0:5}{0:10} {'NONE':10}{12:10}{3:4} {'NONE':10}{4:10}{-3:4}"]
    >>> lines += [f"{5:10}{2:10}{1:10}{100.0:13.5e}{10.0:13.5e}{0.0:13.5e}"]
    >>> lines += [
    ...     f"{kind:10}    0    0    0 {'NONE':20} {unit:20}"
    ...     for kind, unit in ((18, "Hz"), (12, "g"), (13, "N"), (0, "NONE"))
    ... ]
    >>> lines += ["  1.00000e+00  0.00000e+00  0.00000e+00 -2.00000e+00", "    -1", ""]
    >>> with TemporaryDirectory() as folder:
    ...     _ = Path(folder, "beam.uff").write_text("    -1" + "\\n".join(lines))
    ...     (response,) = vi.read_responses(f"{folder}/beam.uff")
    >>> (
    ...     response.name,
    ...     response.response.direction,
    ...     response.reference.name,
    ...     response.unit,
    ...     response.value.round(3).tolist(),
    ... )
    ('12', 3, '4', 'm/s2/N', [(9.807+0j), -19.613j])
    """
    file = read_universal_file(Path(path))
    coherences = [one for one in file.of_frequency if one.function_type == COHERENCE]
    found, faults = [], []
    for one in file.of_frequency:
        if one.function_type != FREQUENCY_RESPONSE:
            continue
        try:
            found.append(_response(one, coherences, file.factors, str(path)))
        except InputError as error:
            faults.append(f"function {one.number} {quoted(one.identification)}: {error.message}")
    if faults and not found:
        raise InputError.of_several(f"{path}, {fault}" for fault in faults)
    if not found:
        raise InputError(
            f"{path}: there is no frequency response in it, a complex function of type 4 "
            "of the frequency in a dataset 58"
        )
    if faults:
        number = (
            "1 of its frequency responses is"
            if len(faults) == 1
            else f"{len(faults)} of its frequency responses are"
        )
        left_out = f"{number} left out{'' if len(faults) == 1 else ', such as'}: {faults[0]}"
        found[0] = replace(found[0], doubts=(*found[0].doubts, left_out))
    return tuple(found)


def _response(
    one: FunctionOfFrequency,
    coherences: Iterable[FunctionOfFrequency],
    factors: dict[str, float] | None,
    source: str,
) -> FrequencyResponse:
    """Return one frequency response.

    Raises
    ------
    InputError
        If it is not of motion, strain or voltage over force, its unit is not known, or its
        frequencies do not rise.
    """
    factor, unit, doubt = _unit(one, factors)
    told = (one.frequency > 0.0) & np.isfinite(one.values)
    places = (_place(one.response, one), _place(one.reference, None))
    coherence = _coherence(one, coherences)
    return FrequencyResponse(
        *places,
        one.frequency[told],
        np.asarray(factor * one.values[told], dtype=np.complex128),
        unit,
        None if coherence is None else coherence[told],
        source,
        (doubt,) if doubt else (),
    )


def _unit(one: FunctionOfFrequency, factors: dict[str, float] | None) -> tuple[float, str, str]:
    """Return factor, SI unit, and the doubt about it: by the labels of the units, else by
    the data types and dataset 164.
    """
    above, below = one.units
    motion, force = one.kinds
    if max(abs(one.response.direction), abs(one.reference.direction)) > len(_AXES):
        raise InputError(
            "it is of a rotation or a moment; those of displacements and forces are read, "
            "of the directions 1 to 3"
        )
    if force not in (*_FORCES, 0, 1) or motion in _FORCES:
        raise InputError(
            f"its data types are {motion} over {force}; it must be a motion, strain or "
            "voltage over a force (9 or 13)"
        )
    if above:
        factor, unit = _labelled(above, below)
        if motion in _MOTIONS and unit != f"{_MOTIONS[motion]}/N":
            raise InputError(
                f"its data type {motion} is in {_MOTIONS[motion]}, and its unit is "
                f"{quoted(above)}; correct one of them"
            )
        return factor, unit, ""
    if motion not in _MOTIONS:
        return (
            1.0,
            "",
            "it states neither a unit nor a data type of motion: beside a case, its values "
            "are taken to be in the unit of the sensor there",
        )
    unit = f"{_MOTIONS[motion]}/N"
    if factors is None:
        return (
            1.0,
            unit,
            "it states no unit of its motion, and there is no dataset 164: its values are "
            f"taken to be in {unit}",
        )
    return factors["N"] / factors["m"], unit, ""


def _labelled(above: str, below: str) -> tuple[float, str]:
    """Return factor and SI unit by the labels of numerator and denominator; programs put the whole
    unit into the first as well.

    Raises
    ------
    InputError
        If they are no unit of a frequency response.
    """
    if below:
        try:
            (upper, motion), (lower, force) = in_si(above), in_si(below)
            if force == "N" and f"{motion}/N" in RESPONSE_UNITS:
                return upper / lower, f"{motion}/N"
        except InputError:
            pass  # the first may have the whole
    for name in RESPONSE_UNITS:
        try:
            return to_si(f"1 {above}", name.replace("s2", "s^2")), name
        except InputError:
            continue
    stated = f"{quoted(above)} over {quoted(below)}" if below else quoted(above)
    words = "write motion and force as labels of numerator and denominator, such as g and N"
    raise InputError(
        f"{stated} is no unit of a frequency response, such as {', '.join(RESPONSE_UNITS)}; {words}"
    )


def _place(freedom: Freedom, function: FunctionOfFrequency | None) -> DegreeOfFreedom:
    """Return a place with its names: entity and node, each with the direction, and of a
    function its identification and number.
    """
    node = str(freedom.node) if freedom.node else ""
    whole = [f"{freedom.entity}:{node}" if freedom.entity and node else "", freedom.entity, node]
    names = list(whole)
    axis = abs(freedom.direction)
    if axis:
        sign, letter = "-" if freedom.direction < 0 else "+", _AXES[axis - 1]
        names += [
            f"{name}{text}"
            for name in filter(None, whole)
            for text in (f"{sign}{letter}", f":{sign}{letter}", letter)
        ]
    if function is not None:
        names += [function.identification, f"function {function.number}"]
    return DegreeOfFreedom(
        tuple(dict.fromkeys(filter(None, names))) or ("unnamed",), freedom.direction
    )


def _coherence(
    one: FunctionOfFrequency, coherences: Iterable[FunctionOfFrequency]
) -> Floats | None:
    """Return the coherence of a frequency response: that of the same places, or the only
    one of its name where none are stated.
    """
    fitting = [other for other in coherences if np.array_equal(other.frequency, one.frequency)]
    ends = (_without_sign(one.response), _without_sign(one.reference))
    exact = [
        other
        for other in fitting
        if (_without_sign(other.response), _without_sign(other.reference)) in (ends, ends[::-1])
    ]
    if not any(end.node or end.entity for end in ends):
        exact = [other for other in fitting if other.identification == one.identification]
    if len(exact) != 1:
        return None
    found = np.asarray(exact[0].values.real)
    if not ((found >= -_OVER) & (found <= 1.0 + _OVER) | np.isnan(found)).all():
        raise InputError(f"its coherence, function {exact[0].number}, is not from 0 to 1")
    return np.clip(np.nan_to_num(found, nan=0.0), 0.0, 1.0)


def _without_sign(freedom: Freedom) -> Freedom:
    return freedom._replace(direction=abs(freedom.direction))
