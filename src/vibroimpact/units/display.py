"""Formatting of numbers for reports: unit prefixes chosen from the data, and significant digits."""

from __future__ import annotations

import math
import re
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vibroimpact.arrays import Floats, Indices


class Multiple(NamedTuple):
    """A multiple of an SI unit: name, and size in the SI unit."""

    unit: str
    size: float


STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity [m/s^2], CGPM 1901.

Accelerations are also shown as multiples of it.
"""

MISSING = "\u2013"
"""Text of a missing value: an en dash."""

_MINUS = "\u2212"

_MULTIPLES: dict[str, tuple[Multiple, ...]] = {
    "m": (Multiple("m", 1.0), Multiple("mm", 1e-3), Multiple("µm", 1e-6), Multiple("nm", 1e-9)),
    "s": (Multiple("s", 1.0), Multiple("ms", 1e-3), Multiple("µs", 1e-6), Multiple("ns", 1e-9)),
    "m/s": (Multiple("m/s", 1.0), Multiple("mm/s", 1e-3), Multiple("µm/s", 1e-6)),
    "m/s2": (Multiple("m/s²", 1.0), Multiple("mm/s²", 1e-3)),  # nobody reads km/s²
    "m/s2/N": (Multiple("m/s²/N", 1.0),),
    "N": (
        Multiple("MN", 1e6),
        Multiple("kN", 1e3),
        Multiple("N", 1.0),
        Multiple("mN", 1e-3),
        Multiple("µN", 1e-6),
        Multiple("nN", 1e-9),
    ),
    "J": (
        Multiple("MJ", 1e6),
        Multiple("kJ", 1e3),
        Multiple("J", 1.0),
        Multiple("mJ", 1e-3),
        Multiple("µJ", 1e-6),
        Multiple("nJ", 1e-9),
        Multiple("pJ", 1e-12),
        Multiple("fJ", 1e-15),
    ),
    "Pa": (
        Multiple("GPa", 1e9),
        Multiple("MPa", 1e6),
        Multiple("kPa", 1e3),
        Multiple("Pa", 1.0),
        Multiple("mPa", 1e-3),
        Multiple("µPa", 1e-6),
    ),
    "Hz": (Multiple("GHz", 1e9), Multiple("MHz", 1e6), Multiple("kHz", 1e3), Multiple("Hz", 1.0)),
    "N/m": (
        Multiple("GN/m", 1e9),
        Multiple("MN/m", 1e6),
        Multiple("kN/m", 1e3),
        Multiple("N/m", 1.0),
    ),
    "N s/m": (
        Multiple("GN s/m", 1e9),
        Multiple("MN s/m", 1e6),
        Multiple("kN s/m", 1e3),
        Multiple("N s/m", 1.0),
    ),
    "kg": (Multiple("kg", 1.0), Multiple("g", 1e-3)),
    "V": (Multiple("V", 1.0), Multiple("mV", 1e-3), Multiple("µV", 1e-6), Multiple("nV", 1e-9)),
    "m/m": (
        Multiple("m/m", 1.0),
        Multiple("mm/m", 1e-3),
        Multiple("µm/m", 1e-6),
        Multiple("nm/m", 1e-9),
    ),
    "1": (Multiple("", 1.0),),
    "": (Multiple("", 1.0),),
}
"""The usual multiples of each SI unit, largest first; other units have none."""


def largest(values: ArrayLike) -> float:
    """Return the largest magnitude among the finite values; 0 if there is none."""
    if isinstance(values, float):  # the text of a single number, of which a study has many
        return abs(values) if math.isfinite(values) else 0.0
    values = np.abs(np.asarray(values, dtype=float))
    return float(np.max(values, where=np.isfinite(values), initial=0.0))


def multiple(unit: str, values: ArrayLike, figures: int = 17) -> Multiple:
    """Return the largest multiple of an SI unit in which the largest of the values is at least 1.

    Where that has more digits before its decimal point than are certain, it is the next larger one,
    if there is any.

    Parameters
    ----------
    unit : str
        SI unit as in `dynamics.columns`, or as in a case, with "^" before powers. A unit without
        multiples is returned unchanged.
    values : array_like
        Values in that unit; NaN is ignored.
    figures : int
        How many figures of the largest value are certain.

    Examples
    --------
    >>> multiple("N", [120.0, 9709.0]).unit
    'kN'
    >>> multiple("m", [0.0]).unit
    'm'
    >>> multiple("s", [114e-6]).unit, multiple("s", [114e-6], figures=2).unit
    ('µs', 'ms')
    >>> [multiple(unit, [7850.0]).unit for unit in ("m/s^2", "m/s2", "kg/m^3", "N/m^1.5")]
    ['m/s²', 'm/s²', 'kg/m³', 'N/m¹·⁵']
    """
    multiples = _MULTIPLES.get(unit.replace("^", ""))
    if multiples is None:
        raised = re.sub(r"\^([\d.]+)", lambda power: _superscript(power[1]), unit)
        return Multiple(raised, 1.0)
    magnitude = largest(values)
    if magnitude == 0.0:
        return next(candidate for candidate in multiples if candidate.size == 1.0)
    larger = multiples[0]
    for candidate in multiples:
        # 0.9995 is printed as 1.000 with four digits
        if magnitude >= 0.9995 * candidate.size:
            has_certain_digits = magnitude < 10.0**figures * candidate.size
            return candidate if has_certain_digits else larger
        larger = candidate
    return multiples[-1]


def digits(value: float, significant: int = 4) -> str:
    """Return a number in significant digits, with an en dash for NaN and a true minus sign.

    Examples
    --------
    >>> [digits(value) for value in (9.70894, 0.65, 12345.6, 0.0)]
    ['9.709', '0.6500', '12346', '0']
    >>> digits(1.25e-7, 3)
    '1.25·10⁻⁷'
    """
    if not math.isfinite(value):
        return MISSING
    if value == 0.0:
        return "0"
    exponent = _exponent(value, significant)
    if exponent not in _PLAIN_EXPONENTS:
        return _with_power_of_ten(value, significant)
    return fixed(value, max(0, significant - 1 - exponent))


def certain(shown: str, value: float, figures: int) -> str:
    """Return the text of a number with its certain figures only, or a question mark if it has none.

    Parameters
    ----------
    shown : str
        The number in all digits that would be printed.
    value : float
        The number.
    figures : int
        How many of its significant figures are certain.

    Examples
    --------
    >>> [certain("9708.9", 9708.9456, figures) for figures in (9, 5, 4, 2, 0)]
    ['9708.9', '9708.9', '9709', '9.7·10³', '?']
    >>> certain("0.01", 0.0123, 1)
    '0.01'
    """
    significant = len(re.sub(r"[^0-9]", "", shown.split("·")[0]).lstrip("0"))
    if figures >= significant or not math.isfinite(value):
        return shown
    if figures < 1:
        return "?"
    exponent = _exponent(value, figures)
    # 9709 in two figures is not 9700, whose zeros look certain
    if not -4 <= exponent < figures:
        return _with_power_of_ten(value, figures)
    return fixed(value, figures - 1 - exponent)


ALL_FIGURES = 17
"""Significant figures of a number without uncertainty."""


def certain_figures(change: ArrayLike) -> Indices:
    """Return how many significant figures of each number are certain; the last may be off by three.

    Parameters
    ----------
    change : array_like
        Relative change of each number [-] under an unavoidable perturbation of the drop; NaN if it
        is unbounded.

    Examples
    --------
    >>> certain_figures([0.0, 1e-9, 0.003, 0.12, 0.5]).tolist()
    [17, 9, 3, 1, 0]
    """
    relative = np.nan_to_num(np.asarray(change, dtype=float), nan=np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        figures = np.floor(0.5 - np.log10(relative))
    return np.asarray(np.clip(figures, 0, ALL_FIGURES), dtype=np.intp)


_LEAST_DIGITS = 3
"""Significant digits that the smallest number of a column has at least."""

_ADDED_DECIMALS = 2
"""Decimals that a column gets for its smallest number at most."""


def column_texts(values: ArrayLike, significant: int = 5) -> list[str]:
    """Return the numbers of a column as texts with the same number of decimals.

    The largest number has `significant` digits, or up to two more if the smallest would have fewer
    than three. If that is not enough, because the numbers differ by orders of magnitude, each
    number has its own significant digits.

    Parameters
    ----------
    values : array_like
        Numbers in one unit; NaN becomes a dash.
    significant : int
        Significant digits of the largest number.

    Examples
    --------
    >>> column_texts([9.70894, 0.65, 0.0])
    ['9.7089', '0.6500', '0.0000']
    >>> column_texts([1200.0, 0.0123], 4)
    ['1200', '0.01230']
    """
    numbers = np.asarray(values, dtype=float)
    decimals = _column_decimals(numbers, significant)
    if decimals is None:
        return [digits(float(number), significant) for number in numbers]
    return [fixed(float(number), decimals) for number in numbers]


def _column_decimals(numbers: Floats, significant: int) -> int | None:
    """Return the decimals of all numbers of a column; None if each needs digits of its own."""
    magnitudes = np.abs(numbers[np.isfinite(numbers) & (numbers != 0.0)])
    if not magnitudes.size:
        return None
    highest = _exponent(magnitudes.max(), significant)
    lowest = _exponent(magnitudes.min(), significant)
    usual = max(0, significant - 1 - highest)
    decimals = max(usual, min(_LEAST_DIGITS, significant) - 1 - lowest)
    if highest not in _PLAIN_EXPONENTS or decimals > usual + _ADDED_DECIMALS:
        return None
    return decimals


def known_text(value: float, spread: float, most: int = 6) -> str:
    """Return a number in the digits that its uncertainty leaves: down to the second digit of that.

    Parameters
    ----------
    value, spread : float
        The number, and its standard deviation or half an interval; 0 or NaN if it is exact or not
        known.
    most : int, default 6
        Significant digits of the number at most.

    Examples
    --------
    >>> [known_text(0.81986, spread) for spread in (0.0196, 3.1e-6, 0.0)]
    ['0.820', '0.819860', '0.819860']
    >>> [known_text(value, 44.0) for value in (1234.5, 12.0, 0.3)]
    ['1234', '12', '0']
    """
    if not (math.isfinite(value) and math.isfinite(spread) and spread > 0.0):
        return digits(value, most)
    decimals = 1 - _exponent(spread, 2)
    figures = decimals + 1 + _exponent(value, 2)
    if figures >= most:
        return digits(value, most)
    if figures < 1:  # the uncertainty is larger than the number
        return fixed(value, decimals) if decimals >= 0 else fixed(0.0, 0)
    rounded = round(value, decimals)
    if decimals > 0 or abs(value) >= 1e7:
        return digits(rounded, figures)
    return fixed(rounded, 0)


def known_texts(values: ArrayLike, spreads: ArrayLike, most: int = 6) -> list[str]:
    """Return numbers each in the digits that its uncertainty leaves, as `known_text` does.

    Examples
    --------
    >>> known_texts([0.81986, 0.81987], [0.02, 1e-4])
    ['0.820', '0.81987']
    """
    pairs = zip(np.asarray(values, dtype=float), np.asarray(spreads, dtype=float), strict=True)
    return [known_text(float(value), float(spread), most) for value, spread in pairs]


def fixed(value: float, decimals: int) -> str:
    """Return a number with a given number of decimals, an en dash for NaN and a true minus sign."""
    if not math.isfinite(value):
        return MISSING
    # + 0.0 turns a minus zero from rounding into a plain zero
    return f"{round(value, decimals) + 0.0:.{decimals}f}".replace("-", _MINUS)


def text(value: float, unit: str, significant: int = 4) -> str:
    """Return a value [SI] in its best multiple, with the unit after a no-break space.

    Examples
    --------
    >>> text(9708.94, "N").replace("\u00a0", " ")
    '9.709 kN'
    """
    best = multiple(unit, value)
    return f"{digits(value / best.size, significant)}\u00a0{best.unit}".rstrip("\u00a0")


def brief(value: float, unit: str) -> str:
    """Return a value [SI] in its best multiple with up to four digits, without zeros at the end.

    Examples
    --------
    >>> [brief(value, "m").replace("\u00a0", " ") for value in (0.52, 0.0125, 1.0)]
    ['520 mm', '12.5 mm', '1 m']
    """
    best = multiple(unit, value)
    shown = f"{value / best.size:.4g}"
    number = shown.replace("-", _MINUS)
    if "e" in shown:
        number = digits(value / best.size)
    return f"{number}\u00a0{best.unit}".rstrip("\u00a0")


_PLAIN_EXPONENTS = range(-4, 8)
"""Powers of ten of the numbers that are written without one."""


def _exponent(value: float, significant: int) -> int:
    """Return the power of ten of a number that is rounded to significant digits; 0 of zero."""
    return int(f"{value:.{significant - 1}e}".partition("e")[2])


def _with_power_of_ten(value: float, significant: int) -> str:
    mantissa, exponent = f"{value:.{significant - 1}e}".split("e")
    return f"{mantissa}·10{_superscript(str(int(exponent)))}".replace("-", _MINUS)


def _superscript(power: str) -> str:
    return power.translate(str.maketrans("-.0123456789", "⁻·⁰¹²³⁴⁵⁶⁷⁸⁹"))
