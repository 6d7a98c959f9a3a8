"""Quantities that a calibration takes as given, such as gravity and a height of fall.

Each has a standard deviation, and a reason where that was not given.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from vibroimpact.units.display import STANDARD_GRAVITY, multiple
from vibroimpact.units.written import Written, read_written

EARTH = Written(
    STANDARD_GRAVITY, 0.015, "9.80665 m/s^2", stated=False, why="as it varies over the Earth"
)
"""Gravity where none is given: at sea level it lies anywhere from 9.780 to 9.832 m/s^2, from the
equator to the poles.
"""

BRIEF = Written(0.0, 1e-4, "0 ms", stated=False, why="as of hard balls")
"""Contact time where none is given: that of balls of steel, glass or rock is some tenths of a
millisecond at most.
"""

_DIGITS = "since its last digit leaves open"


class Input(NamedTuple):
    """A quantity that was typed.

    Its name, its value in SI with the standard deviation, its unit, and the reason of the deviation
    if that was not given.
    """

    name: str
    value: Written
    unit: str
    why: str = ""


def as_input(name: str, value: float | str, unit: str) -> Input:
    """Return a quantity with its standard deviation.

    A text has the one that is written in it; a number is exact.

    Examples
    --------
    >>> (
    ...     as_input("height", "0.6 m +- 5 mm", "m").value.deviation,
    ...     as_input("height", 0.6, "m").value.deviation,
    ... )
    (0.005, 0.0)
    """
    if isinstance(value, str):
        value = read_written(value, unit)
    elif not isinstance(value, Written):
        value = Written(value)
    if value.stated:
        return Input(name, value, unit)
    # half a unit of the last digit, of whose uniform distribution the deviation is
    half = _short(value.deviation * 3.0**0.5, unit)
    return Input(name, value, unit, value.why or f"{_DIGITS} \u00b1 {half}")


def inputs_sentence(inputs: Sequence[Input]) -> str:
    """Return a sentence on the values of given quantities, and how well each is known.

    Examples
    --------
    >>> inputs_sentence([as_input("height", "0.6 m +- 5 mm", "m")]).replace("\u00a0", " ")
    'The intervals include the standard deviations of these inputs: height 0.6 m, 5 mm.'
    >>> sentence = inputs_sentence([as_input("height", "0.6 m", "m")]).replace("\u00a0", " ")
    >>> sentence.partition(": ")[2]
    'height 0.6 m, 29 mm (since its last digit leaves open \u00b1 50 mm).'
    """
    if not inputs:
        return ""
    values = "; ".join(_with_deviation(typed) for typed in inputs)
    return f"The intervals include the standard deviations of these inputs: {values}."


def guessed_doubt(typed: Input, of_what: str) -> str:
    """Return a warning that an interval is mostly that of an input of unstated deviation.

    Examples
    --------
    >>> doubt = guessed_doubt(as_input("height", "0.6 m", "m"), "impact 1")
    >>> for clause in doubt.replace("\u00a0", " ").split(", "):
    ...     print(clause)
    the interval of impact 1 is mostly that of height
    0.6 m with a standard deviation of 29 mm
    since its last digit leaves open \u00b1 50 mm; give the standard deviation
    as in "0.6 m +- 10 mm"
    """
    deviation = typed.value.deviation
    value = _value_text(typed)
    # a third of the deviation, in one digit
    example = _short(float(f"{deviation / 3.0:.0e}"), typed.unit)
    written = f"{value} +- {example}".replace("\u00a0", " ")
    return (
        f"the interval of {of_what} is mostly that of {typed.name}, {value} with a standard "
        f"deviation of {_short(deviation, typed.unit)}, {typed.why}; give the standard deviation, "
        f'as in "{written}"'
    )


def inputs_document(inputs: Sequence[Input]) -> list[dict[str, Any]]:
    """Return the given quantities as data."""
    return [
        {
            "name": typed.name,
            "value": float(typed.value),
            "standard_deviation": typed.value.deviation,
            "unit": typed.unit,
            "stated": typed.value.stated,
            "as_typed": typed.value.text,
        }
        for typed in inputs
    ]


def _with_deviation(typed: Input) -> str:
    deviation = typed.value.deviation
    deviation_text = "exact"
    if deviation:
        deviation_text = _short(deviation, typed.unit)
    reason = f" ({typed.why})" if typed.why else ""
    return f"{typed.name} {_value_text(typed)}, {deviation_text}{reason}"


def _value_text(typed: Input) -> str:
    """Return the value with its unit, as it was typed if its deviation is that of its digits."""
    if typed.why.startswith(_DIGITS):
        return typed.value.text
    return f"{typed.value:.6g}\u00a0{multiple(typed.unit, 0.0).unit}".rstrip("\u00a0")


def _short(value: float, unit: str) -> str:
    """Return a value in its best multiple, in two digits at most."""
    best = multiple(unit, value)
    return f"{float(f'{value / best.size:.2g}'):g}\u00a0{best.unit}".rstrip("\u00a0")
