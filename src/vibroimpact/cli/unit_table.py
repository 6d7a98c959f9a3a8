"""Conversion of a quantity to the unit systems of contact programs."""

from __future__ import annotations

from typing import Any

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.errors import InputError
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.units.reading import convert_units, dimension_of, unit_text

_DIGITS = 10
_SYSTEMS: dict[str, dict[str, str]] = {
    "SI": {"force": "N", "mass": "kg", "length": "m", "time": "s"},
    "mm, kg, N, s (Adams MMKS)": {"force": "N", "mass": "kg", "length": "mm", "time": "s"},
    "mm, tonne, N, s, MPa": {"force": "N", "mass": "tonne", "length": "mm", "time": "s"},
    "mm, g, N, ms, MPa": {"force": "N", "mass": "g", "length": "mm", "time": "ms"},
    "mm, kg, kN, ms, GPa": {"force": "kN", "mass": "kg", "length": "mm", "time": "ms"},
    "cm, g, dyn, s (cgs)": {"force": "dyn", "mass": "g", "length": "cm", "time": "s"},
    "in, lb, lbf, s (Adams IPS)": {"force": "lbf", "mass": "lb", "length": "in", "time": "s"},
}
"""The unit of each dimension in each unit system.

Where force is not mass length / time^2, contact parameters contain the unit of force.
"""


def in_unit_systems(value: float, unit: str) -> list[tuple[str, float, str]]:
    """Return a quantity in each unit system, as (system, number, unit).

    Raises
    ------
    InputError
        If the unit is unknown, dimensionless, or has other dimensions than force, mass, length and
        time.

    Examples
    --------
    >>> in_unit_systems(179.75, "N s/m")[3]
    ('mm, g, N, ms, MPa', 179.75, 'N ms/mm')
    """
    exponents = dimension_of(unit)
    unknown = exponents.keys() - _SYSTEMS["SI"].keys()
    if unknown or not exponents:
        raise InputError(
            f'"{unit}" holds {", ".join(sorted(unknown)) or "no dimension"}; only units of '
            "force, mass, length and time are shown"
        )
    rows = []
    for system, units in _SYSTEMS.items():
        system_unit = unit_text((units[name], exponent) for name, exponent in exponents.items())
        rows.append((system, convert_units(value, unit, system_unit), system_unit))
    return rows


def unit_conversion(value: float, unit: str, to: str) -> RenderableType:
    """Return one conversion as a line of text, with a note on powers of length.

    Raises
    ------
    InputError
        As `convert_units`.
    """
    number = convert_units(value, unit, to)
    exponent = dimension_of(unit).get("length", 0.0)
    # is the factor that of metres to millimetres?
    from_metres = value != 0.0 and abs(number / value * 1000.0**-exponent - 1.0) < 1e-9
    line = Text(f"{number_text(value)} {unit} = {number_text(number)} {to}")
    notes = _power_note(unit) if from_metres else []
    return Group(line, *notes)


def unit_table(value: float, unit: str) -> RenderableType:
    """Return a quantity in the unit systems of contact programs.

    Raises
    ------
    InputError
        As `in_unit_systems`.
    """
    systems, numbers, units = zip(*in_unit_systems(value, unit), strict=True)
    table = TerminalTable(
        [
            TerminalColumn("unit system", systems, text=True),
            TerminalColumn("number", [number_text(number) for number in numbers]),
            TerminalColumn("unit", units, text=True),
        ]
    )
    return Group(Text(f"{number_text(value)} {unit}", style="bold"), table, *_power_note(unit))


def unit_document(value: float, unit: str, to: str | None = None) -> dict[str, Any]:
    """Return a quantity, and what it is in another unit or in each unit system.

    Raises
    ------
    InputError
        As `convert_units` or `in_unit_systems`.

    Examples
    --------
    >>> unit_document(5.0, "N/mm", "N/m")["converted"]
    [{'number': 5000.0, 'unit': 'N/m'}]
    """
    if to is not None:
        converted = [{"number": convert_units(value, unit, to), "unit": to}]
    else:
        converted = [
            {"unit_system": system, "number": number, "unit": system_unit}
            for system, number, system_unit in in_unit_systems(value, unit)
        ]
    return {"number": value, "unit": unit, "converted": converted}


def number_text(number: float) -> str:
    """Return a number in ten significant digits, which hides rounding noise.

    Examples
    --------
    >>> number_text(16175.000000000002), number_text(5.115e8)
    ('16175', '511500000')
    """
    return f"{number:.{_DIGITS}g}"


def _power_note(unit: str) -> list[RenderableType]:
    """Return the note on a common error by hand: a power of length has a power of the factor."""
    exponents = dimension_of(unit)
    exponent = exponents.get("length", 0.0)
    if "force" not in exponents or exponent in (0.0, 1.0):
        return []
    operation = "divided" if exponent < 0.0 else "multiplied"
    power = abs(exponent)
    factor = "1000"
    if power != 1.0:
        factor = f"1000^{power:g} = {number_text(1000.0**power)}, not by 1000"
    sentence = (
        f" From metres to millimetres the number is {operation} by {factor}: length has the "
        f"power {exponent:g} in it."
    )
    return [Text(sentence, style="dim")]
