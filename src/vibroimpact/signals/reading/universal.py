"""Records from universal files: the functions of time in their datasets 58."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.measurements.universal_file import Function, read_universal_file
from vibroimpact.quoting import quoted
from vibroimpact.signals.reading.equal_steps import rate_of
from vibroimpact.signals.reading.si_units import in_si
from vibroimpact.signals.record import Record

_KINDS = {8: ("m", "m"), 9: ("N", "N"), 11: ("m/s", "m"), 12: ("m/s2", "m"), 13: ("N", "N")}
"""SI unit of a data type, and which divisor of dataset 164 converts to it."""


def universal_records(path: Path) -> Iterator[Record]:
    """Yield the functions of time of a universal file.

    Raises
    ------
    InputError
        If the file can't be read or has no function of time, or one has an unknown unit or unequal
        steps.
    """
    file = read_universal_file(path)
    if not file.functions:
        number = len(file.of_frequency)
        its = "function of frequency is" if number == 1 else f"{number} functions of frequency are"
        others = f"; its {its} for correlate and modes" if number else ""
        raise InputError(f"{path}: there is no real function of time in it{others}")
    for one in file.functions:
        try:
            factor, unit = _unit(one, file.factors)
            rate = rate_of(one.time)
        except InputError as error:
            raise InputError(
                f"{path}, function {one.number} {quoted(one.identification)}: {error.message}"
            ) from None
        yield Record(record_name(one), factor * one.values, rate, unit, float(one.time[0]))


def record_name(one: Function) -> str:
    """Return the name of a function of time: its first identification line, or its number."""
    return one.identification or f"function {one.number}"


def _unit(one: Function, factors: dict[str, float] | None) -> tuple[float, str]:
    """Return factor and SI unit: by the label of the unit, else by the data type and
    dataset 164.
    """
    if one.unit:
        return in_si(one.unit)
    if one.kind not in _KINDS:
        return 1.0, "1"
    if factors is None:
        raise InputError("it has no unit, and there is no dataset 164 with the units of the file")
    unit, base = _KINDS[one.kind]
    return 1.0 / factors[base], unit
