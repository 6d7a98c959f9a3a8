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
        raise InputError(
            f"{path}: there is no real function of time in it{_others(len(file.of_frequency))}"
        )
    for function in file.functions:
        try:
            factor, unit = _unit(function, file.factors)
            rate = rate_of(function.time)
        except InputError as error:
            name = f"function {function.number} {quoted(function.identification)}"
            raise InputError(f"{path}, {name}: {error.message}") from None
        value = factor * function.values
        yield Record(record_name(function), value, rate, unit, float(function.time[0]))


def _others(functions: int) -> str:
    """Return which commands read the functions of frequency of a file, if it has some."""
    if not functions:
        return ""
    if functions == 1:
        return "; its function of frequency is for correlate and modes"
    return f"; its {functions} functions of frequency are for correlate and modes"


def record_name(function: Function) -> str:
    """Return the name of a function of time: its first identification line, or its number."""
    return function.identification or f"function {function.number}"


def _unit(function: Function, factors: dict[str, float] | None) -> tuple[float, str]:
    """Return factor and SI unit, by the label of the unit, else by data type and dataset 164."""
    if function.unit:
        return in_si(function.unit)
    if function.kind not in _KINDS:
        return 1.0, "1"
    if factors is None:
        raise InputError("it has no unit, and there is no dataset 164 with the units of the file")
    unit, base = _KINDS[function.kind]
    return 1.0 / factors[base], unit
