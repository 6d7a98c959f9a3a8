"""Spellings of units, which instruments, languages and tables write in many ways."""

from __future__ import annotations

import re
from functools import lru_cache

_SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻"
_RAISED = re.compile(rf"[{_SUPERSCRIPTS}]+(?:[·⋅.][{_SUPERSCRIPTS}]+)?")
_LOWERED = str.maketrans(f"{_SUPERSCRIPTS}·⋅", "0123456789+-..")
_SIGNS = str.maketrans(
    {
        **dict.fromkeys("\u2212\u2010\u2011\u2013", "-"),  # minus, hyphens, en dash
        # dot operator, bullets, multiplication sign
        **dict.fromkeys("\u22c5\u2219\u2022\u00d7", "·"),
        **dict.fromkeys("\u2215\u2044\u00f7", "/"),  # division slash, fraction slash, division sign
        **dict.fromkeys("\u00b5\u03bc", "u"),  # micro sign and Greek mu
    }
)
_POINT = re.compile(r"(?<=[A-Za-z0-9)])\.(?=[A-Za-z(])")
"""A full stop between two units multiplies them; between digits it is a decimal point."""

_STANDARD_GRAVITY = re.compile(r"(?<![A-Za-z])([mu]?)g_?n(?![A-Za-z0-9])")
_JOINED = re.compile(r"(?<![A-Za-z])([GMkmu]?(?:N|Pa|V))s(?![A-Za-z])")
"""A newton, pascal or volt with the second after it, as in Ns/m."""

_POWER = re.compile(r"(?<=[A-Za-z])\+?(-?[1-9]\d*(?:\.\d+)?)(?![A-Za-z0-9])")
"""A power without a sign of it, as in m/s2; no unit has a name that ends in a digit from 1 to 9."""

_GRAVITY = re.compile(r"(?<![A-Za-z])([mu]?)[gG](?![A-Za-z0-9])")

_WORDS = {
    **dict.fromkeys(("volt", "volts"), "V"),
    **dict.fromkeys(("second", "seconds", "secs"), "s"),
    **dict.fromkeys(("newton", "newtons"), "N"),
    **dict.fromkeys(("amp", "amps", "ampere", "amperes"), "A"),
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("pascal", "pascals"), "Pa"),
}
"""Symbols of units by their names, as oscilloscopes and LabVIEW write them, in lower case."""

_PLAIN = {
    **dict.fromkeys(("", "1", "-", "none"), 1.0),
    **dict.fromkeys(
        (
            "a.u.",
            "a.u",
            "arb. u.",
            "arb. unit",
            "arb. units",
            "arb.units",
            "arbitrary units",
            "count",
            "counts",
        ),
        1.0,
    ),
    **dict.fromkeys(("strain", "m/m", "mm/mm"), 1.0),
    **dict.fromkeys(("um/m", "microstrain", "ustrain", "uε"), 1e-6),
    "mm/m": 1e-3,
    "%": 1e-2,
}


@lru_cache(maxsize=1000)
def spelled(text: str) -> str:
    """Return a unit in the spelling that pint reads.

    Powers follow "^", micro is "u", and "·" stands between factors. Unknown words are kept.

    Examples
    --------
    >>> [
    ...     spelled(text)
    ...     for text in ("m/s2", "m·s⁻²", "m.s-2", "kg/m³", "N/m¹·⁵", "µm", "mV/gn", "Ns/m")
    ... ]
    ['m/s^2', 'm·s^-2', 'm·s^-2', 'kg/m^3', 'N/m^1.5', 'um', 'mV/g0', 'N s/m']
    >>> spelled("Volts")
    'V'
    """
    text = text.strip()
    symbol = _WORDS.get(text.lower())
    if symbol is not None:
        return symbol
    text = _RAISED.sub(lambda power: "^" + power[0].translate(_LOWERED).removeprefix("+"), text)
    text = " ".join(text.translate(_SIGNS).split())
    text = _JOINED.sub(r"\1 s", text)
    text = _STANDARD_GRAVITY.sub(r"\1g0", text)
    text = _POINT.sub("·", text)
    return _POWER.sub(r"^\1", text)


def by_gravity(text: str) -> str:
    """Return a unit in which g, mg, ug and G are standard gravity, 9.80665 m/s^2.

    Elsewhere they are the gram, its parts and the gauss.

    Examples
    --------
    >>> by_gravity("mV/g"), by_gravity("mg"), by_gravity("kg")
    ('mV/g0', 'mg0', 'kg')
    """
    return _GRAVITY.sub(r"\1g0", text)


def plain_factor(text: str) -> float | None:
    """Return the factor of a unit of plain numbers, such as strain; None of any other unit.

    Examples
    --------
    >>> plain_factor("a.u."), plain_factor("µm/m"), plain_factor("%"), plain_factor("m")
    (1.0, 1e-06, 0.01, None)
    """
    unit = " ".join(text.translate(_SIGNS).split())
    return _PLAIN.get(unit, _PLAIN.get(unit.lower()))
