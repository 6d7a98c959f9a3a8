"""Cells of a header: names of columns and their units, as people and programs write them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

from vibroimpact.errors import InputError
from vibroimpact.units.reading import to_si
from vibroimpact.units.spelling import plain_factor

_ENDINGS = {
    "_m_s2": "m/s^2",
    "_m_s_2": "m/s^2",
    "_m_s": "m/s",
    "_mm_s": "mm/s",
    "_cm_s": "cm/s",
    "_rad_s": "rad/s",
    "_deg": "deg",
    "_s": "s",
    "_ms": "ms",
    "_us": "us",
    "_m": "m",
    "_cm": "cm",
    "_mm": "mm",
    "_um": "um",
    "_nm": "nm",
    "_N": "N",
    "_kN": "kN",
    "_V": "V",
    "_mV": "mV",
    "_uV": "uV",
    "_Pa": "Pa",
    "_kPa": "kPa",
    "_MPa": "MPa",
}
"""Units at the end of a name.

MATLAB makes names of variables of a header, in which brackets and signs become underscores.
"""

_LONGEST_FIRST = sorted(_ENDINGS.items(), key=lambda item: -len(item[0]))

_LANGUAGES = {
    "time": "t zeit temps tiempo tempo tijd tid aika czas čas idő zaman время 时间 時間",
    "force": "kraft fuerza forza força kracht voima siła síla erő kuvvet сила 力",
}
"""Names of a column in other languages: instruments write that which they are set to."""

_ENGLISH = {word: name for name, words in _LANGUAGES.items() for word in words.split()}

_QUANTITIES = ("s", "V", "m/s^2", "m/s", "m", "N", "Pa", "A", "Hz", "rad", "rad/s", "kg")
"""Quantities of columns whose units may stand in a row of their own."""


def name_and_unit(cell: str) -> tuple[str, str | None]:
    """Return name and unit of a header cell; None if it has no unit.

    The words of other languages for time and force are translated.

    Examples
    --------
    >>> (
    ...     name_and_unit("Rebound height [mm]"),
    ...     name_and_unit("time_s"),
    ...     name_and_unit("count"),
    ...     name_and_unit("Zeit [ms]"),
    ... )
    (('rebound_height', 'mm'), ('time', 's'), ('count', None), ('time', 'ms'))
    >>> name_and_unit("position_cm")
    ('position', 'cm')
    >>> name_and_unit("acceleration_m_s_2_")  # by MATLAB from "acceleration [m/s^2]"
    ('acceleration', 'm/s^2')
    """
    whole = cell.strip()
    if whole.endswith(("]", ")")):
        # the unit is between the last two brackets; a regular expression for that takes minutes on
        # a long line of brackets
        inside = whole[:-1]
        start = max(inside.rfind("]"), inside.rfind(")")) + 1
        openings = [inside.find(bracket, start) for bracket in "[("]
        opening = min((position for position in openings if position >= 0), default=None)
        if opening is not None:
            return _plain(inside[:opening]), inside[opening + 1 :].strip()
    for ending, unit in _LONGEST_FIRST:
        if whole.endswith((ending, f"{ending}_")):
            return _plain(whole.removesuffix("_").removesuffix(ending)), unit
    return _plain(whole), None


def is_time(name: str, unit: str | None) -> bool:
    """Return whether a column has times, by its name or its unit.

    A unit of time is that of no signal.

    Examples
    --------
    >>> is_time("time", None), is_time("x_axis", "second"), is_time("force", "N")
    (True, True, False)
    """
    return name == "time" or (unit is not None and _measures(unit, "s"))


def are_units(cells: Sequence[str]) -> bool:
    """Return whether the cells of a line are units, in brackets or all without; some may be empty.

    Examples
    --------
    >>> (
    ...     are_units(["(ms)", "(V)", ""]),
    ...     are_units(["second", "Volt"]),
    ...     are_units(["time", "force"]),
    ...     are_units(["1", "2"]),
    ... )
    (True, True, False, False)
    """
    texts = [cell.strip() for cell in cells if cell.strip()]
    if not texts:
        return False
    in_brackets = all(text[0] + text[-1] in ("[]", "()") for text in texts)
    return in_brackets or all(_is_unit(text) for text in texts)


def with_unit(cell: str, unit: str) -> str:
    """Return a cell of a header with the unit that stands elsewhere; as it is, if there is none.

    Examples
    --------
    >>> with_unit("Channel A", "(mV)"), with_unit("CH1", "Volt"), with_unit("count", "")
    ('Channel A (mV)', 'CH1 [Volt]', 'count')
    """
    name = cell.strip()
    unit = unit.strip()
    if not unit:
        return name
    if unit[0] in "[(":
        return f"{name} {unit}"
    return f"{name} [{unit}]"


def _plain(name: str) -> str:
    plain = re.sub(r"[\s-]+", "_", name.strip().lower())
    return _ENGLISH.get(plain, plain)


@lru_cache(maxsize=1000)
def _is_unit(text: str) -> bool:
    """Return whether a text is a unit that a column may have."""
    if not any(character.isalpha() or character in "%-" for character in text):
        return False
    if plain_factor(text) is not None:
        return True
    return any(_measures(text, quantity) for quantity in _QUANTITIES)


def _measures(unit: str, quantity: str) -> bool:
    """Return whether a unit is one of a quantity, which is given by its SI unit."""
    try:
        to_si(f"1 {unit}", quantity)
    except InputError:
        return False
    return True
