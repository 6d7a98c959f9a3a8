"""Frequency responses from universal files: functions of type 4 in their datasets 58.

Coherences are those of type 6.
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
_TOLERANCE = 1e-3
"""By how much a coherence exceeds 1 that is rounded."""


class Contents(NamedTuple):
    """Names of the records over time of a file, and the number of its frequency responses."""

    records: tuple[str, ...]
    responses: int


def contents_of(path: str | PathLike[str]) -> Contents:
    """Return what a file has.

    A file that is not universal has records alone, and its own name.

    Raises
    ------
    InputError
        If it is a universal file that can't be read.
    """
    if not Path(path).is_file() or not is_universal(Path(path)):
        return Contents((str(path),), 0)
    file = read_universal_file(Path(path))
    types = [function.function_type for function in file.of_frequency]
    names = tuple(record_name(function) for function in file.functions)
    return Contents(names, types.count(FREQUENCY_RESPONSE))


def load_responses(path: str | PathLike[str]) -> tuple[FrequencyResponse, ...]:
    """Return the frequency responses of a universal file with their coherences.

    They are in datasets 58, of function type 4, and the coherences of type 6.

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
    ...     (response,) = vi.signals.load_responses(f"{folder}/beam.uff")
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
    coherences = [function for function in file.of_frequency if function.function_type == COHERENCE]
    responses: list[FrequencyResponse] = []
    faults: list[str] = []
    for function in file.of_frequency:
        if function.function_type != FREQUENCY_RESPONSE:
            continue
        try:
            responses.append(_response(function, coherences, file.factors, str(path)))
        except InputError as error:
            name = f"function {function.number} {quoted(function.identification)}"
            faults.append(f"{name}: {error.message}")
    if faults and not responses:
        raise InputError.of_several(f"{path}, {fault}" for fault in faults)
    if not responses:
        raise InputError(
            f"{path}: there is no frequency response in it, a complex function of type 4 "
            "of the frequency in a dataset 58"
        )
    if faults:
        if len(faults) == 1:
            left_out = f"1 of its frequency responses is left out: {faults[0]}"
        else:
            left_out = (
                f"{len(faults)} of its frequency responses are left out, such as: {faults[0]}"
            )
        first = responses[0]
        responses[0] = replace(first, doubts=(*first.doubts, left_out))
    return tuple(responses)


def _response(
    function: FunctionOfFrequency,
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
    factor, unit, doubt = _unit(function, factors)
    # many files have no number at 0 Hz
    known = (function.frequency > 0.0) & np.isfinite(function.values)
    response = _degree_of_freedom(function.response, function)
    reference = _degree_of_freedom(function.reference, None)
    coherence = _coherence(function, coherences)
    if coherence is not None:
        coherence = coherence[known]
    return FrequencyResponse(
        response,
        reference,
        frequency=function.frequency[known],
        value=np.asarray(factor * function.values[known], dtype=np.complex128),
        unit=unit,
        coherence=coherence,
        source=source,
        doubts=(doubt,) if doubt else (),
    )


def _unit(
    function: FunctionOfFrequency, factors: dict[str, float] | None
) -> tuple[float, str, str]:
    """Return factor, SI unit, and the doubt about it.

    They are by the labels of the units, else by the data types and dataset 164.
    """
    numerator, denominator = function.units
    motion, force = function.kinds
    directions = (function.response.direction, function.reference.direction)
    if max(abs(direction) for direction in directions) > len(_AXES):
        raise InputError(
            "it is of a rotation or a moment; those of displacements and forces are read, "
            "of the directions 1 to 3"
        )
    if force not in (*_FORCES, 0, 1) or motion in _FORCES:
        raise InputError(
            f"its data types are {motion} over {force}; it must be a motion, strain or "
            "voltage over a force (9 or 13)"
        )
    if numerator:
        factor, unit = _of_labels(numerator, denominator)
        if motion in _MOTIONS and unit != f"{_MOTIONS[motion]}/N":
            raise InputError(
                f"its data type {motion} is in {_MOTIONS[motion]}, and its unit is "
                f"{quoted(numerator)}; correct one of them"
            )
        return factor, unit, ""
    if motion not in _MOTIONS:
        doubt = (
            "it states neither a unit nor a data type of motion: beside a case, its values "
            "are taken to be in the unit of the sensor there"
        )
        return 1.0, "", doubt
    unit = f"{_MOTIONS[motion]}/N"
    if factors is None:
        doubt = (
            "it states no unit of its motion, and there is no dataset 164: its values are "
            f"taken to be in {unit}"
        )
        return 1.0, unit, doubt
    return factors["N"] / factors["m"], unit, ""


def _of_labels(numerator: str, denominator: str) -> tuple[float, str]:
    """Return factor and SI unit by the labels of numerator and denominator.

    Programs put the whole unit into the first as well.

    Raises
    ------
    InputError
        If they are no unit of a frequency response.
    """
    if denominator:
        try:
            motion_factor, motion = in_si(numerator)
            force_factor, force = in_si(denominator)
            if force == "N" and f"{motion}/N" in RESPONSE_UNITS:
                return motion_factor / force_factor, f"{motion}/N"
        except InputError:
            pass  # the first may have the whole
    for unit in RESPONSE_UNITS:
        try:
            return to_si(f"1 {numerator}", unit.replace("s2", "s^2")), unit
        except InputError:
            continue
    stated = quoted(numerator)
    if denominator:
        stated = f"{stated} over {quoted(denominator)}"
    raise InputError(
        f"{stated} is no unit of a frequency response, such as {', '.join(RESPONSE_UNITS)}; write "
        "motion and force as labels of numerator and denominator, such as g and N"
    )


def _degree_of_freedom(freedom: Freedom, function: FunctionOfFrequency | None) -> DegreeOfFreedom:
    """Return a degree of freedom with its names.

    They are its entity and node, each with the direction, and of a function its identification and
    number.
    """
    node = str(freedom.node) if freedom.node else ""
    entity_and_node = ""
    if freedom.entity and node:
        entity_and_node = f"{freedom.entity}:{node}"
    places = [name for name in (entity_and_node, freedom.entity, node) if name]
    names = list(places)
    if freedom.direction:
        sign = "-" if freedom.direction < 0 else "+"
        letter = _AXES[abs(freedom.direction) - 1]
        for place in places:
            names += [f"{place}{sign}{letter}", f"{place}:{sign}{letter}", f"{place}{letter}"]
    if function is not None:
        names += [function.identification, f"function {function.number}"]
    distinct = dict.fromkeys(name for name in names if name)
    return DegreeOfFreedom(tuple(distinct) or ("unnamed",), freedom.direction)


def _coherence(
    function: FunctionOfFrequency, coherences: Iterable[FunctionOfFrequency]
) -> Floats | None:
    """Return the coherence of a frequency response; None if there is none, or several.

    It is that of the same degrees of freedom, or the only one of its name where none are stated.
    """
    ends = _ends(function)
    are_stated = any(end.node or end.entity for end in ends)
    matching = []
    for other in coherences:
        if not np.array_equal(other.frequency, function.frequency):
            continue
        if are_stated:
            matches = _ends(other) in (ends, ends[::-1])
        else:
            matches = other.identification == function.identification
        if matches:
            matching.append(other)
    if len(matching) != 1:
        return None
    coherence = np.asarray(matching[0].values.real)
    in_range = (coherence >= -_TOLERANCE) & (coherence <= 1.0 + _TOLERANCE)
    if not (in_range | np.isnan(coherence)).all():
        raise InputError(f"its coherence, function {matching[0].number}, is not from 0 to 1")
    return np.clip(np.nan_to_num(coherence, nan=0.0), 0.0, 1.0)


def _ends(function: FunctionOfFrequency) -> tuple[Freedom, Freedom]:
    """Return response and reference of a function, without the signs of their directions."""
    return _without_sign(function.response), _without_sign(function.reference)


def _without_sign(freedom: Freedom) -> Freedom:
    return freedom._replace(direction=abs(freedom.direction))
