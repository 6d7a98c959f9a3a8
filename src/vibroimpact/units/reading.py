"""Parsing of quantities and conversion of units: a bare number is in SI, a string has a unit.

Inside the package every quantity is a float in SI; units are converted where input is read, and by
the command `units`. pint takes half a second to start, and is imported with the first unit that is
not an SI unit with or without a prefix, such as "mm" or "GPa".
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any

from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted, shortened
from vibroimpact.units.grammar import is_unit
from vibroimpact.units.quantity_text import comma_remedy, has_comma, number_and_unit
from vibroimpact.units.spelling import by_gravity, plain_factor, spelled

if TYPE_CHECKING:
    import pint

_KIND = {
    "m": "length",
    "kg": "mass",
    "kg m^2": "moment of inertia",
    "s": "time",
    "m/s": "speed",
    "m/s^2": "acceleration",
    "Pa": "pressure",
    "kg/m^3": "density",
    "Hz": "frequency",
    "N": "force",
    "N/m": "stiffness",
    "N/m^1.5": "contact stiffness",
    "N s/m": "damping",
    "s/m": "reciprocal speed",
    "J/m^2": "work of adhesion",
    "1/m": "reciprocal length",
    "V": "voltage",
    "V/N": "voltage over force",
    "V/Pa": "voltage over pressure",
    "V s/m": "voltage over velocity",
    "V s^2/m": "voltage over acceleration",
    "byte": "memory size",
    "rad": "angle",
    "rad/s": "angular velocity",
    "Pa*s": "viscosity",
    "": "plain number",
}
_EXAMPLE = {
    "m": "25 mm",
    "kg": "90 g",
    "kg m^2": "7.2 g cm^2",
    "s": "5 ms",
    "m/s": "8.8 m/s",
    "m/s^2": "9.8 m/s^2",
    "Pa": "2.26 GPa",
    "kg/m^3": "1.38 g/cm^3",
    "Hz": "60 kHz",
    "N": "3.5 kN",
    "N/m": "1.2 MN/m",
    "N/m^1.5": "1.6e4 N/mm^1.5",
    "N s/m": "179.75 N s/m",
    "s/m": "0.3 s/m",
    "J/m^2": "50 mJ/m^2",
    "1/m": "0.5 1/mm",
    "V": "10 mV",
    "V/N": "10 mV/N",
    "V/Pa": "50 mV/Pa",
    "V s/m": "27.6 V s/m",
    "V s^2/m": "100 mV/g",
    "byte": "500 MB",
    "rad": "30 deg",
    "rad/s": "100 rad/s",
    "Pa*s": "1 mPa*s",
}
_WITHOUT_DIMENSION = ("rad", "byte", "")
"""Units that have no dimension by which they are told from each other."""

_PREFIXES = {"G": 1e9, "M": 1e6, "k": 1e3, "c": 1e-2, "m": 1e-3, "u": 1e-6, "n": 1e-9}
_PREFIXED = ("m", "s", "m/s", "m/s^2", "Pa", "Hz", "N", "N/m", "V")
"""SI units whose multiples are read without pint, with the same factors."""


@cache
def _registry() -> pint.UnitRegistry[float]:
    import pint

    return pint.UnitRegistry()


def to_si(value: float | str, unit: str = "") -> float:
    """Convert a number or a "number unit" string to a float in the SI `unit`.

    Parameters
    ----------
    value : float or str
        A bare number is in `unit` already; a string must have a unit of the same dimension, in any
        spelling: m/s2, m/s², m·s⁻², µm.
    unit : str, default ""
        The SI unit of the result; "" for a plain number.

    Returns
    -------
    float
        The finite value in `unit`.

    Raises
    ------
    InputError
        If the value is not a finite number, or has no unit or one of another dimension.

    Examples
    --------
    >>> to_si("25 mm", "m")
    0.025
    >>> to_si("2.26 GPa", "Pa")
    2260000000.0
    >>> to_si(0.025, "m")
    0.025
    >>> to_si("250 mm/s²", "m/s^2")
    0.25
    >>> to_si(
    ...     "500 g", "m/s^2"
    ... )  # as data sheets have it: standard gravity; of a mass "g" is the gram
    4903.325
    >>> to_si("25 kg", "m")
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: "25 kg" is a mass; expected a length (a number in m, or a string
    such as "25 mm")
    """
    unit = spelled(unit)
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise InputError(f"{quoted(value)} is not {_wanted(unit)}")
    if isinstance(value, str):
        return _finite(_parse(value, unit), value)
    try:
        return _finite(float(value), value)
    except OverflowError:
        raise InputError(f"{_first_digits(value)} is too large for a number") from None


def parse_quantity(text: str) -> tuple[float, str]:
    """Return the number and the unit of a text such as "5.115e8 N/m^1.5".

    Raises
    ------
    InputError
        If it is not a finite number with a unit.

    Examples
    --------
    >>> parse_quantity("179.75 N s/m")
    (179.75, 'N s/m')
    """
    number, unit = _number_and_unit(text) or (0.0, "")
    if not unit:
        raise InputError(
            f'{quoted(text, 80)} is not a number with a unit, such as "5.115e8 N/m^1.5"'
        )
    return _finite(number, text), unit


def convert_units(value: float, unit: str, to: str) -> float:
    """Convert a number from one unit to another.

    Parameters
    ----------
    value : float
        The number, in `unit`.
    unit, to : str
        Units, in any spelling: "N/m^1.5", "N·s/mm", "kN/mm¹·⁵", "kg/s". "g" is the gram, or
        standard gravity if only that is of the dimension of the other unit.

    Returns
    -------
    float
        The number in `to`.

    Raises
    ------
    InputError
        If the number is not finite, a unit is not known, or the two are of different dimensions.

    Examples
    --------
    >>> round(convert_units(5.115e8, "N/m^1.5", "N/mm^1.5"), 3)
    16175.05
    >>> round(convert_units(179.75, "N s/m", "N s/mm"), 5)
    0.17975
    """
    source = _known_unit(unit)
    target = _known_unit(to)
    number = _finite(to_si(value), value)
    if source.dimensionality != target.dimensionality:
        source, target = _by_gravity(unit, to) or (source, target)
    if source.dimensionality != target.dimensionality:
        raise InputError(
            f"{quoted(unit)} is {_dimension_words(source)} and {quoted(to)} is "
            f"{_dimension_words(target)}; one can't be converted to the other"
        )
    try:
        converted = float(_registry().Quantity(number, source).to(target).magnitude)
    except OverflowError:
        converted = math.inf
    return _finite(converted, f"{value:g} {unit} in {to}")


def _by_gravity(unit: str, to: str) -> tuple[pint.Unit, pint.Unit] | None:
    """Return two units of one dimension if "g" is standard gravity in one of them, or None."""
    spellings = [(by_gravity(spelled(unit)), to), (unit, by_gravity(spelled(to)))]
    for source_text, target_text in spellings:
        source = _known_unit(source_text)
        target = _known_unit(target_text)
        if source.dimensionality == target.dimensionality:
            return source, target
    return None


def dimension_of(unit: str) -> dict[str, float]:
    """Return the exponents of "force", "length" and "time" in a unit.

    A unit without time has "mass" in place of "force".

    Raises
    ------
    InputError
        If the unit is not known.

    Examples
    --------
    >>> dimension_of("N/m^1.5")
    {'force': 1.0, 'length': -1.5}
    >>> dimension_of("kg/s")  # which is N s/m
    {'force': 1.0, 'length': -1.0, 'time': 1.0}
    """
    return _dimension(_known_unit(unit))


_MECHANICAL = ("force", "mass", "length", "time")
"""The dimensions that come first, in this order."""


def _dimension(unit: pint.Unit) -> dict[str, float]:
    exponents = {
        str(name).strip("[]"): float(str(exponent))
        for name, exponent in unit.dimensionality.items()
    }
    if exponents.get("mass") and exponents.get("time"):
        exponents = _with_force(exponents)
    exponents = {
        name: round(exponent, 9) for name, exponent in exponents.items() if abs(exponent) > 1e-9
    }
    mechanical = [name for name in _MECHANICAL if name in exponents]
    non_mechanical = [name for name in exponents if name not in _MECHANICAL]
    return {name: exponents[name] for name in (*mechanical, *non_mechanical)}


def _with_force(exponents: Mapping[str, float]) -> dict[str, float]:
    """Return a dimension with force in place of mass.

    Not every program has mass length / time^2 as its unit of force.
    """
    mass = exponents["mass"]
    without_mass = {name: exponent for name, exponent in exponents.items() if name != "mass"}
    return without_mass | {
        "force": mass,
        "length": exponents.get("length", 0.0) - mass,
        "time": exponents["time"] + 2.0 * mass,
    }


def unit_text(powers: Iterable[tuple[str, float]]) -> str:
    """Return a product of powers as a unit text.

    Examples
    --------
    >>> unit_text([("N", 1.0), ("mm", -1.5)]), unit_text([("N", 1.0), ("s", 1.0), ("mm", -1.0)])
    ('N/mm^1.5', 'N s/mm')
    """
    factors = list(powers)
    numerator = [_power(name, exponent) for name, exponent in factors if exponent > 0.0]
    denominator = [_power(name, -exponent) for name, exponent in factors if exponent < 0.0]
    return "/".join([" ".join(numerator) or "1", *denominator])


def _power(name: str, exponent: float) -> str:
    if exponent == 1.0:
        return name
    return f"{name}^{exponent:g}"


def _dimension_words(unit: pint.Unit) -> str:
    """Return the kind of quantity of a unit in words, and its dimension."""
    if not unit.dimensionality:
        return "a plain number"
    kinds = _kinds_of(unit.dimensionality)
    dimension = unit_text(_dimension(unit).items())
    if not kinds:
        return f"of the dimension {dimension}"
    if kinds == [dimension]:
        return _either(kinds)
    return f"{_either(kinds)} ({dimension})"


def _kinds_of(dimension: Mapping[str, Any]) -> list[str]:
    """Return the kinds of quantity of a dimension: stiffness and work of adhesion have the same."""
    registry = _registry()
    kinds = []
    for unit, kind in _KIND.items():
        if unit in _WITHOUT_DIMENSION:
            continue
        if registry.parse_units(unit).dimensionality == dimension:
            kinds.append(kind)
    return kinds


def _either(kinds: Iterable[str]) -> str:
    return " or ".join(f"{_article(kind)} {kind}" for kind in kinds)


def _known_unit(text: str) -> pint.Unit:
    try:
        unit = _parse_unit(text)
        # pint computes it at the first use, and fails for products of decibels
        _ = unit.dimensionality
        return unit
    except Exception as error:  # pint raises many kinds for a unit that it can't read
        raise InputError(
            f'{quoted(text, 80)} is not a unit that is known; write it as "N/mm^1.5", "N '
            's/m" or "kg/s"'
        ) from error


def _parse(text: str, unit: str) -> float:
    quantity = _number_and_unit(text, unit)
    if quantity is None:
        raise InputError(f"{quoted(text, 80)} is not {_wanted(unit)}")
    number, given_unit = quantity
    if not unit:
        return _plain_number(number, given_unit, text)
    if not given_unit:
        digits = f"{_finite(number, text):.15g}"
        raise InputError(
            f"{quoted(text, 80)} has no unit: write {digits} (it is then in {unit}) or "
            f'"{digits} {unit}"'
        )
    return number * _factor(given_unit, unit, text)


def _plain_number(number: float, unit: str, text: str) -> float:
    """Return a number that has no unit, or is in per cent.

    Of one with another unit the message says what to write.
    """
    if unit == "%":
        return number * _plain_factor(unit)
    if unit:
        digits = f"{_finite(number * _plain_factor(unit), text):.15g}"
        raise InputError(
            f"{quoted(text, 80)} has a unit, but a plain number is wanted: write {digits}"
        )
    return number


def _plain_factor(unit: str) -> float:
    """Return what a unit without a dimension is as a plain number, such as a hundredth for %.

    It is 1 of another unit, and of an unknown one.
    """
    factor = plain_factor(unit)
    if factor is not None:
        return factor
    try:
        known_unit = _known_unit(unit)
        if known_unit.dimensionality:
            return 1.0
        return float(_registry().Quantity(1.0, known_unit).to("").magnitude)
    except InputError:
        return 1.0


def _number_and_unit(text: str, wanted_unit: str | None = None) -> tuple[float, str] | None:
    """Return what `number_and_unit` does; a comma in the number is an error.

    The wanted unit is for the message: "" if none is wanted, None if any is.
    """
    quantity = number_and_unit(text)
    if quantity is None and has_comma(text):
        raise InputError(
            f"{quoted(text, 80)} has a comma in its number; {comma_remedy(text, wanted_unit)}"
        )
    return quantity


def _parse_unit(text: str) -> pint.Unit:
    """Return a unit; raises ValueError, or any error of pint for a unit that it can't read."""
    unit = spelled(text)
    if not is_unit(unit):
        raise ValueError(text)
    return _registry().parse_units(unit)


def _factor(given: str, unit: str, text: str) -> float:
    """Return the conversion factor from `given` to `unit`."""
    given_unit = spelled(given)
    if given_unit == unit:
        return 1.0
    if unit in _PREFIXED and given_unit[1:] == unit and given_unit[0] in _PREFIXES:
        return _PREFIXES[given_unit[0]]
    return _pint_factor(given, unit, text)


@lru_cache(maxsize=1000)
def _pint_factor(given: str, unit: str, text: str) -> float:
    """Return the conversion factor from `given` to `unit` by pint."""
    import pint

    registry = _registry()
    try:
        source = registry.Quantity(1.0, _parse_unit(given))
        target = registry.parse_units(unit)
        # of an acceleration, g is standard gravity, and not the gram
        if source.dimensionality != target.dimensionality:
            with_gravity = registry.Quantity(1.0, _parse_unit(by_gravity(spelled(given))))
            if with_gravity.dimensionality == target.dimensionality:
                source = with_gravity
        return float(source.to(target).magnitude)
    except pint.DimensionalityError:
        raise InputError(
            f"{quoted(text, 80)} is {_kinds_in_words(source.dimensionality)}; "
            f"expected {_wanted(unit)}"
        ) from None
    except Exception as error:  # pint raises many kinds for a unit that it can't read
        raise InputError(
            f"{quoted(given, 80)} in {quoted(text, 80)} is not a unit that is known; "
            f"expected {_wanted(unit)}"
        ) from error


def _kinds_in_words(dimension: Mapping[str, Any]) -> str:
    if not dimension:
        return "a number without a dimension"
    return _either(_kinds_of(dimension)) or "another kind of quantity"


def _first_digits(number: float) -> str:
    """Return the first digits of an integer that is too large for a float."""
    try:  # Python converts no more than some thousand digits to text
        return f"{str(number)[:20]}..."
    except ValueError:
        return "a number of thousands of digits"


def _article(noun: str) -> str:
    return "an" if noun[0] in "aeiou" else "a"


def _wanted(unit: str) -> str:
    if not unit:
        return "a plain number"
    kind = _either([_KIND.get(unit, "quantity")])
    return f'{kind} (a number in {unit}, or a string such as "{_EXAMPLE.get(unit, f"1 {unit}")}")'


def _finite(number: float, value: float | str) -> float:
    if not math.isfinite(number):
        raise InputError(f"{shortened(str(value), 60)} is not finite")
    return number
