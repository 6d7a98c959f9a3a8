"""What a user states about the columns of a table: `time=s,force=N`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from vibroimpact.errors import InputError
from vibroimpact.measurements.header_cells import is_time, name_and_unit
from vibroimpact.quoting import quoted, shortened
from vibroimpact.units.quantity_text import number_and_unit
from vibroimpact.units.reading import to_si

STATED = "--columns"
"""The option, by which messages name where the columns were stated.

In a case it is the key `columns`.
"""

_LEFT_OUT = "-"
_RATE = "rate"
_MOST_IN_REMEDY = 5
_LONG_NAME = 20


class StatedColumns(NamedTuple):
    """Columns of a table as a user states them.

    Parameters
    ----------
    cells : tuple of str
        A header's cell for each column, in order; "" for one that is left out.
    rate : float or None
        Rate of the rows [Hz], of a table without times.
    """

    cells: tuple[str, ...]
    rate: float | None


def stated_columns(text: str) -> StatedColumns:
    """Return the columns that a text states.

    It has NAME=UNIT for each, - for one that is left out, and rate=VALUE without times.

    Raises
    ------
    InputError
        If it states none, or something else.

    Examples
    --------
    >>> stated_columns("time=s,-,force=kN")
    StatedColumns(cells=('time [s]', '', 'force [kN]'), rate=None)
    >>> stated_columns("rate=44.1 kHz, sound=1")
    StatedColumns(cells=('sound [1]',), rate=44100.0)
    """
    where = f"{STATED} {quoted(text)}"
    cells: list[str] = []
    rate = None
    for entry in text.split(","):
        name, sign, unit = (part.strip() for part in entry.partition("="))
        if name == _RATE and sign:
            rate = _rate(unit)
        elif name == _LEFT_OUT and not sign:
            cells.append("")
        elif not name or (sign and not unit):
            raise InputError(
                f"{where}: {quoted(entry.strip())} is no column; state NAME=UNIT for each, and - "
                'for one that is left out: "time=s,-,force=N"'
            )
        else:
            cells.append(f"{name} [{unit}]" if sign else name)
    if not any(cells):
        raise InputError(
            f'{where}: it names no column; state NAME=UNIT for each, such as "time=s,force=N"'
        )
    if rate is not None and any(is_time(*name_and_unit(cell)) for cell in cells if cell):
        raise InputError(
            f"{where}: the rate follows from the column of times; leave "
            "rate out, or - for that column"
        )
    return StatedColumns(tuple(cells), rate)


def remedy_for(header: Sequence[str]) -> str:
    """Return the option that states the columns of a header, with UNIT where it is to be filled in.

    Examples
    --------
    >>> remedy_for(["t", "x", "force [N]"]).partition(", with")[0]
    'or give --columns "time=s,x=UNIT,force=N"'
    >>> remedy_for(["sound"])
    'or give --columns "rate=10 kHz,sound=UNIT" (in a case the key columns)'
    """
    if len(header) > _MOST_IN_REMEDY or any("," in cell or "=" in cell for cell in header):
        return (
            f"or give --columns with NAME=UNIT for each of the {len(header)} columns, - for "
            "one to leave out (in a case the key columns)"
        )
    if len(header) == 1 and not is_time(*name_and_unit(header[0])):
        return (
            f'or give --columns "{_RATE}=10 kHz,{_stated(header[0])}" (in a case the key columns)'
        )
    cells = ",".join(map(_stated, header or ("time [s]", "force [N]")))
    return (
        f'or give --columns "{cells}", with - for a column to leave out (in a case the key columns)'
    )


def _stated(cell: str) -> str:
    """Return a column as a user states it."""
    if not cell.strip():
        return _LEFT_OUT
    name, unit = name_and_unit(cell)
    if not unit:
        unit = "s" if name == "time" else "UNIT"
    return f"{shortened(name, _LONG_NAME)}={unit}"


def _rate(text: str) -> float:
    """Return a rate [Hz] that is stated, in Hz if it has no unit."""
    try:
        parts = number_and_unit(text)
        if parts is not None and not parts[1]:
            number, _ = parts
            rate = to_si(number, "Hz")
        else:
            rate = to_si(text, "Hz")
    except InputError as error:
        raise InputError(f"{STATED}: rate: {error.message}") from None
    if not rate > 0.0:
        raise InputError(f"{STATED}: rate: {text} is not allowed; it must be greater than 0")
    return rate
