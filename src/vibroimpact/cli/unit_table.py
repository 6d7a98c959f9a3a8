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
"""Unit systems with the unit of each dimension; where force is not mass length / time^2,
contact parameters contain the unit of force.
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
    dimension = dimension_of(unit)
    others = dimension.keys() - _SYSTEMS["SI"].keys()
    if others or not dimension:
        raise InputError(
            f'"{unit}" holds {", ".join(sorted(others)) or "no dimension"}; only units of '
            "force, mass, length and time are shown"
        )
    found = []
    for name, units in _SYSTEMS.items():
        there = unit_text([(units[one], power) for one, power in dimension.items()])
        found.append((name, convert_units(value, unit, there), there))
    return found


def converted(value: float, unit: str, to: str) -> RenderableType:
    """Return one conversion as a line of text, with a note on powers of length.

    Raises
    ------
    InputError
        As `convert_units`.
    """
    there = convert_units(value, unit, to)
    power = dimension_of(unit).get("length", 0.0)
    from_metres = value != 0.0 and abs(there / value * 1000.0**-power - 1.0) < 1e-9
    return Group(
        Text(f"{number_text(value)} {unit} = {number_text(there)} {to}"),
        *(_power_note(unit) if from_metres else []),
    )


def unit_table(value: float, unit: str) -> RenderableType:
    """Return a quantity in the unit systems of contact programs.

    Raises
    ------
    InputError
        As `in_unit_systems`.
    """
    names, values, there = zip(*in_unit_systems(value, unit), strict=True)
    shown = [number_text(one) for one in values]
    table = TerminalTable(
        [
            TerminalColumn("unit system", names, text=True),
            TerminalColumn("number", shown),
            TerminalColumn("unit", there, text=True),
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
        found = [{"number": convert_units(value, unit, to), "unit": to}]
    else:
        found = [
            {"unit_system": name, "number": number, "unit": there}
            for name, number, there in in_unit_systems(value, unit)
        ]
    return {"number": value, "unit": unit, "converted": found}


def number_text(number: float) -> str:
    """Return a number in ten significant digits, which hides rounding noise.

    Examples
    --------
    >>> number_text(16175.000000000002), number_text(5.115e8)
    ('16175', '511500000')
    """
    return f"{number:.{_DIGITS}g}"


def _power_note(unit: str) -> list[RenderableType]:
    """Return the note on a common error by hand: a length to the power p converts with
    the factor to the power p.
    """
    dimension = dimension_of(unit)
    power = dimension.get("length", 0.0)
    if "force" not in dimension or power in (0.0, 1.0):
        return []
    does, size = ("divided" if power < 0.0 else "multiplied"), abs(power)
    factor = f"1000^{size:g} = {number_text(1000.0**size)}, not by 1000" if size != 1.0 else "1000"
    return [
        Text(
            f" From metres to millimetres the number is {does} by {factor}: length has the "
            f"power {power:g} in it.",
            style="dim",
        )
    ]
