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
        raise InputError(f"{_long(value)} is too large for a number") from None


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
    parts = _split(text)
    if parts is None or not parts[1]:
        raise InputError(
            f'{quoted(text, 80)} is not a number with a unit, such as "5.115e8 N/m^1.5"'
        )
    return _finite(parts[0], text), parts[1]


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
    have, want = _known_unit(unit), _known_unit(to)
    number = _finite(to_si(value), value)
    if have.dimensionality != want.dimensionality:
        have, want = _by_gravity(unit, to) or (have, want)
    if have.dimensionality != want.dimensionality:
        both = " and ".join(
            f"{quoted(name)} is {_dimension_words(one)}" for name, one in ((unit, have), (to, want))
        )
        raise InputError(f"{both}; one can't be converted to the other")
    try:
        found = float(_registry().Quantity(number, have).to(want).magnitude)
    except OverflowError:
        found = math.inf
    return _finite(found, f"{value:g} {unit} in {to}")


def _by_gravity(unit: str, to: str) -> tuple[pint.Unit, pint.Unit] | None:
    """Return two units of one dimension if "g" is standard gravity in one of them, or None."""
    for one, other in ((by_gravity(spelled(unit)), to), (unit, by_gravity(spelled(to)))):
        have, want = _known_unit(one), _known_unit(other)
        if have.dimensionality == want.dimensionality:
            return have, want
    return None


def dimension_of(unit: str) -> dict[str, float]:
    """Return the exponents of "force", "length" and "time" in a unit; of "mass" instead of "force"
    if the unit has no time.

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


def _dimension(unit: pint.Unit) -> dict[str, float]:
    powers = {
        str(name).strip("[]"): float(str(power)) for name, power in unit.dimensionality.items()
    }
    mass = powers.get("mass", 0.0)
    if mass and powers.get("time", 0.0):
        # a unit with mass and time is expressed by force, since not every program has mass length /
        # time^2 as its unit of force
        del powers["mass"]
        powers |= {
            "force": mass,
            "length": powers.get("length", 0.0) - mass,
            "time": powers["time"] + 2.0 * mass,
        }
    order = ("force", "mass", "length", "time")
    powers = {name: round(power, 9) for name, power in powers.items() if abs(power) > 1e-9}
    return dict(
        sorted(
            powers.items(), key=lambda one: order.index(one[0]) if one[0] in order else len(order)
        )
    )


def unit_text(powers: Iterable[tuple[str, float]]) -> str:
    """Return a product of powers as a unit text.

    Examples
    --------
    >>> unit_text([("N", 1.0), ("mm", -1.5)]), unit_text([("N", 1.0), ("s", 1.0), ("mm", -1.0)])
    ('N/mm^1.5', 'N s/mm')
    """
    given = list(powers)
    above, below = (
        [_power(name, abs(power)) for name, power in given if power * side > 0.0]
        for side in (1, -1)
    )
    return "/".join([" ".join(above) or "1", *below])


def _power(name: str, power: float) -> str:
    return name if power == 1.0 else f"{name}^{power:g}"


def _dimension_words(unit: pint.Unit) -> str:
    """Return the kind of quantity of a unit in words, and its dimension."""
    if not unit.dimensionality:
        return "a plain number"
    kinds = _kinds_of(unit.dimensionality)
    dimension = unit_text(_dimension(unit).items())
    if not kinds:
        return f"of the dimension {dimension}"
    named = _either(kinds)
    return named if kinds == [dimension] else f"{named} ({dimension})"


def _kinds_of(dimension: Mapping[str, Any]) -> list[str]:
    """Return the kinds of quantity that have a dimension: a stiffness and a work of
    adhesion have the same.
    """
    registry = _registry()
    dimensional = (
        (registry.parse_units(name), kind)
        for name, kind in _KIND.items()
        if name not in _WITHOUT_DIMENSION
    )
    return [kind for known, kind in dimensional if known.dimensionality == dimension]


def _either(kinds: Iterable[str]) -> str:
    return " or ".join(f"{_article(kind)} {kind}" for kind in kinds)


def _known_unit(text: str) -> pint.Unit:
    try:
        unit = _parse_unit(text)
        # pint makes it at the first use, and has none for products of decibels
        _ = unit.dimensionality
        return unit
    except Exception as error:  # pint raises many kinds for a unit that it can't read
        raise InputError(
            f'{quoted(text, 80)} is not a unit that is known; write it as "N/mm^1.5", "N '
            's/m" or "kg/s"'
        ) from error


def _parse(text: str, unit: str) -> float:
    parts = _split(text, unit)
    if parts is None:
        raise InputError(f"{quoted(text, 80)} is not {_wanted(unit)}")
    number, given = parts
    if not unit:
        if given:
            digits = f"{_finite(number * _plain_factor(given), text):.15g}"
            raise InputError(
                f"{quoted(text, 80)} has a unit, but a plain number is wanted: write {digits}"
            )
        return number
    if not given:
        digits = f"{_finite(number, text):.15g}"
        raise InputError(
            f"{quoted(text, 80)} has no unit: write {digits} (it is then in {unit}) or "
            f'"{digits} {unit}"'
        )
    return number * _factor(given, unit, text)


def _plain_factor(unit: str) -> float:
    """Return what a unit without a dimension is as a plain number, such as a hundredth
    for %; 1 of another unit, or of an unknown one.
    """
    known = plain_factor(unit)
    if known is not None:
        return known
    try:
        have = _known_unit(unit)
        return (
            1.0 if have.dimensionality else float(_registry().Quantity(1.0, have).to("").magnitude)
        )
    except InputError:
        return 1.0


def _split(text: str, unit: str | None = None) -> tuple[float, str] | None:
    """Return number and unit of a text, "" for no unit; None if it does not begin with a number.

    The wanted unit is for messages: "" if none is wanted, None if any is.
    """
    parts = number_and_unit(text)
    if parts is None and has_comma(text):
        raise InputError(
            f"{quoted(text, 80)} has a comma in its number; {comma_remedy(text, unit)}"
        )
    return parts


def _parse_unit(text: str) -> pint.Unit:
    """Return a unit; raises ValueError, or any error of pint for a unit that it can't read."""
    plain = spelled(text)
    if not is_unit(plain):
        raise ValueError(text)
    return _registry().parse_units(plain)


def _factor(given: str, unit: str, text: str) -> float:
    """Return the conversion factor from `given` to `unit`."""
    plain = spelled(given)
    if plain == unit:
        return 1.0
    if unit in _PREFIXED and plain[1:] == unit and plain[0] in _PREFIXES:
        return _PREFIXES[plain[0]]
    return _converted(given, unit, text)


@lru_cache(maxsize=1000)
def _converted(given: str, unit: str, text: str) -> float:
    """Return the conversion factor from `given` to `unit` by pint."""
    import pint

    registry = _registry()
    try:
        have, want = registry.Quantity(1.0, _parse_unit(given)), registry.parse_units(unit)
        # of an acceleration, g is standard gravity, and not the gram
        if have.dimensionality != want.dimensionality:
            other = registry.Quantity(1.0, _parse_unit(by_gravity(spelled(given))))
            have = other if other.dimensionality == want.dimensionality else have
        return float(have.to(want).magnitude)
    except pint.DimensionalityError:
        kinds = (
            _kinds_of(have.dimensionality)
            if have.dimensionality
            else ["number without a dimension"]
        )
        raise InputError(
            f"{quoted(text, 80)} is {_either(kinds) or 'another kind of quantity'}; "
            f"expected {_wanted(unit)}"
        ) from None
    except Exception as error:  # pint raises many kinds for a unit that it can't read
        raise InputError(
            f"{quoted(given, 80)} in {quoted(text, 80)} is not a unit that is known; "
            f"expected {_wanted(unit)}"
        ) from error


def _long(number: float) -> str:
    """Return the first digits of an integer, which may have more digits than Python
    converts to text.
    """
    try:
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
