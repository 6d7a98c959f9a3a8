"""What a calibration takes as given, such as gravity and a height of fall, with its
standard deviation and where that is from.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from vibroimpact.dynamics.problem import STANDARD_GRAVITY
from vibroimpact.units.display import multiple
from vibroimpact.units.written import Written, read_written

EARTH = Written(
    STANDARD_GRAVITY, 0.015, "9.80665 m/s^2", stated=False, why="as it varies over the Earth"
)
"""Gravity where none is given: at sea level it lies anywhere from 9.780 to 9.832 m/s^2,
from the equator to the poles.
"""

BRIEF = Written(0.0, 1e-4, "0 ms", stated=False, why="as of hard balls")
"""Contact time where none is given: that of balls of steel, glass or rock is some tenths
of a millisecond at most.
"""

_DIGITS = "since its last digit leaves open"


class Input(NamedTuple):
    """A quantity that was typed: its name, its value in SI with the standard deviation,
    its unit, and where that is from if not given.
    """

    name: str
    value: Written
    unit: str
    why: str = ""


def as_input(name: str, value: float | str, unit: str) -> Input:
    """Return a quantity with its standard deviation: a text has what is written in it, a number
    without one is exact.

    Examples
    --------
    >>> (
    ...     as_input("height", "0.6 m +- 5 mm", "m").value.deviation,
    ...     as_input("height", 0.6, "m").value.deviation,
    ... )
    (0.005, 0.0)
    """
    if not isinstance(value, Written):
        value = read_written(value, unit) if isinstance(value, str) else Written(value)
    if value.stated:
        return Input(name, value, unit)
    half = _short(value.deviation * 3.0**0.5, unit)
    return Input(name, value, unit, value.why or f"{_DIGITS} \u00b1 {half}")


def inputs_sentence(inputs: Sequence[Input]) -> str:
    """Return what was taken for given quantities and how well each is known.

    Examples
    --------
    >>> inputs_sentence([as_input("height", "0.6 m +- 5 mm", "m")]).replace("\u00a0", " ")
    'The intervals include the standard deviations of these inputs: height 0.6 m, 5 mm.'
    >>> inputs_sentence([as_input("height", "0.6 m", "m")]).replace("\u00a0", " ")
    'The intervals include the standard deviations of these inputs: height 0.6 m, 29 mm (since its
    last digit leaves open \u00b1 50 mm).'
    """
    words = "The intervals include the standard deviations of these inputs"
    return f"{words}: {'; '.join(_words(one) for one in inputs)}." if inputs else ""


def guessed_doubt(one: Input, of_what: str) -> str:
    """Return a warning that an interval is mostly that of an input whose standard deviation was not
    given.

    Examples
    --------
    >>> guessed_doubt(as_input("height", "0.6 m", "m"), "impact 1").replace("\u00a0", " ")
    'the interval of impact 1 is mostly that of height, 0.6 m with a standard deviation of 29 mm,
    since its last digit leaves open \u00b1 \
50 mm; give the standard deviation, as in "0.6 m +- 10 mm"'
    """
    spread, example = (
        _short(one.value.deviation, one.unit),
        _short(float(f"{one.value.deviation / 3.0:.0e}"), one.unit),
    )
    known = f"{one.name}, {_value(one)} with a standard deviation of {spread}, {one.why}"
    written = f"{_value(one)} +- {example}".replace("\u00a0", " ")
    return (
        f"the interval of {of_what} is mostly that of {known}; give the standard deviation, as "
        f'in "{written}"'
    )


def inputs_document(inputs: Sequence[Input]) -> list[dict[str, Any]]:
    """Return the given quantities as data."""
    return [
        {
            "name": one.name,
            "value": float(one.value),
            "standard_deviation": one.value.deviation,
            "unit": one.unit,
            "stated": one.value.stated,
            "as_typed": one.value.text,
        }
        for one in inputs
    ]


def _words(one: Input) -> str:
    spread = _short(one.value.deviation, one.unit) if one.value.deviation else "exact"
    return f"{one.name} {_value(one)}, {spread}{f' ({one.why})' if one.why else ''}"


def _value(one: Input) -> str:
    by_digits = one.why.startswith(_DIGITS)
    return (
        one.value.text
        if by_digits
        else f"{one.value:.6g}\u00a0{multiple(one.unit, 0.0).unit}".rstrip("\u00a0")
    )


def _short(value: float, unit: str) -> str:
    """Return a value in its best multiple, in two digits at most."""
    best = multiple(unit, value)
    return f"{float(f'{value / best.size:.2g}'):g}\u00a0{best.unit}".rstrip("\u00a0")
