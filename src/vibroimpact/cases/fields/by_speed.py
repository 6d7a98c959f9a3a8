"""A parameter of a contact law as a function of the approach speed, in a case."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from vibroimpact.cases.fields.quantities import quantity_schema, read_quantity
from vibroimpact.cases.fields.size_limits import check_count
from vibroimpact.contact.speed_function import BySpeed, SpeedFunction, SpeedTable
from vibroimpact.errors import InputError, choices
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range

_TABLE = ("speed", "value")
_POLYNOMIAL = ("polynomial", "from", "to")
_MOST_SPEEDS = 1000
_MOST_COEFFICIENTS = 10
_FORMS = "{ speed = [...], value = [...] } or { polynomial = [...], from = ..., to = ... }"


def read_by_speed(given: Mapping[str, Any], unit: str, allowed: Range) -> BySpeed:
    """Return a parameter as a function of the approach speed; `unit` and `allowed`: SI unit and
    range of its values.

    Raises
    ------
    InputError
        If a key is missing or unknown, lists differ in length, speeds do not rise, or a value lies
        outside its range.

    Examples
    --------
    >>> read_by_speed(
    ...     {"speed": ["1 m/s", "3 m/s"], "value": [0.8, 0.7]}, "", Range(above=0, at_most=1)
    ... )
    SpeedTable(speeds=(1.0, 3.0), values=(0.8, 0.7))
    """
    keys = _POLYNOMIAL if "polynomial" in given else _TABLE
    for key in given:
        if key not in keys:
            raise InputError(
                f"unknown key {quoted(key)}; a function of the approach speed is {_FORMS}. "
                f"It takes {choices(keys, str(key))}"
            )
    for key in keys:
        if key not in given:
            raise InputError(f"{key} is missing; a function of the approach speed is {_FORMS}")
    if keys is _POLYNOMIAL:
        return _polynomial(given, unit, allowed)
    return _table(given, unit, allowed)


def _table(given: Mapping[str, Any], unit: str, allowed: Range) -> SpeedTable:
    speeds = _numbers(given["speed"], "speed", "m/s", Range(above=0), _MOST_SPEEDS)
    values = _numbers(given["value"], "value", unit, allowed, _MOST_SPEEDS)
    if len(speeds) != len(values):
        raise InputError(
            f"speed has {len(speeds)} numbers and value {len(values)}; give a value for each speed"
        )
    for slow, fast in pairwise(speeds):
        if not slow < fast:
            raise InputError(
                f"in speed {fast:g} m/s comes after {slow:g} m/s; the speeds must rise"
            )
    return SpeedTable(speeds, values)


def _polynomial(given: Mapping[str, Any], unit: str, allowed: Range) -> SpeedFunction:
    coefficients = _numbers(given["polynomial"], "polynomial", "", Range(), _MOST_COEFFICIENTS)
    ends = [read_quantity(given[name], "m/s", Range(at_least=0)) for name in ("from", "to")]
    if not ends[0] < ends[1]:
        raise InputError(f"it is from {ends[0]:g} to {ends[1]:g} m/s; to must be greater than from")
    function = SpeedFunction(coefficients, *ends)
    for value in function.extremes:
        allowed.check(
            value, unit, f"between {ends[0]:g} and {ends[1]:g} m/s it comes to {value:.4g}, which"
        )
    return function


def _numbers(given: Any, name: str, unit: str, allowed: Range, most: int) -> tuple[float, ...]:
    if not isinstance(given, list) or not given:
        raise InputError(f"{name} is {quoted(given)}; it must be a list of numbers")
    check_count(len(given), most, "numbers")
    return tuple(read_quantity(item, unit, allowed) for item in given)


def by_speed_schema(unit: str, meaning: str) -> list[dict[str, Any]]:
    """Return the JSON schemas of a function of the approach speed: a table, and a polynomial."""
    value = quantity_schema(unit, meaning)
    speed = quantity_schema("m/s", "approach speed")
    lists = {
        "speed": {"type": "array", "items": speed, "minItems": 1},
        "value": {"type": "array", "items": value, "minItems": 1},
    }
    powers = {
        "type": "array",
        "items": {"type": "number"},
        "minItems": 1,
        "maxItems": _MOST_COEFFICIENTS,
    }
    polynomial = {
        "polynomial": {**powers, "description": "coefficients in SI, lowest power first"},
        "from": speed,
        "to": speed,
    }
    return [
        {
            "type": "object",
            "description": phrase,
            "properties": properties,
            "required": list(properties),
            "additionalProperties": False,
        }
        for phrase, properties in (
            ("linear between approach speeds", lists),
            ("a polynomial of the approach speed", polynomial),
        )
    ]
