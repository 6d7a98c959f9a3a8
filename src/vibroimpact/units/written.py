"""Numbers with a standard deviation, which is written with them or left open by their digits."""

from __future__ import annotations

import re
from typing import Any, TypeGuard

from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted
from vibroimpact.units.quantity_text import number_and_unit
from vibroimpact.units.reading import to_si

_PLUS_MINUS = re.compile(r"\s*(?:\+/?[-\u2212]|±)\s*")
_ROUNDING = 12.0**-0.5
"""Standard deviation of a rounded number, in units of its last digit."""

_DIGITS = re.compile(r"\s*[+-]?([\d.]+)(?:[eE]([+-]?\d+))?")


class Written(float):
    """A number in SI with its standard deviation; otherwise it is a float like any other.

    Parameters
    ----------
    value : float
        The number, in SI.
    deviation : float, default 0
        Its standard deviation, in SI.
    text : str, default ""
        The number as it was written.
    stated : bool, default True
        Whether the standard deviation was given; otherwise it is taken from the digits, or chosen.
    why : str, default ""
        Why it was chosen.

    Examples
    --------
    >>> height = Written(0.6, 0.005, "0.6 m +- 5 mm")
    >>> height + 0.1, height.deviation
    (0.7, 0.005)
    """

    deviation: float
    text: str
    stated: bool
    why: str

    def __new__(
        cls,
        value: float,
        deviation: float = 0.0,
        text: str = "",
        stated: bool = True,
        why: str = "",
    ) -> Written:
        """Return the number."""
        number = super().__new__(cls, value)
        number.deviation = deviation
        number.text = text
        number.stated = stated
        number.why = why
        return number


def has_deviation(value: Any) -> TypeGuard[str]:
    """Return whether a value is a text with a standard deviation, such as "0.6 m +- 5 mm"."""
    return isinstance(value, str) and _PLUS_MINUS.search(value) is not None


def without_deviation(text: str) -> str:
    """Return a text without the standard deviation in it.

    Examples
    --------
    >>> without_deviation("0.6 m +- 5 mm"), without_deviation("0.600 ± 0.005 m")
    ('0.6 m', '0.600 m')
    """
    return _number_and_deviation(text)[0]


def read_written(value: float | str, unit: str = "") -> Written:
    """Return a number in SI with its standard deviation.

    Parameters
    ----------
    value : float or str
        A number in SI, or a text with a unit: "0.6 m +- 5 mm", "0.600 ± 0.005 m", "0.6 m +- 1 %",
        or "0.6 m" alone. Without a standard deviation the number may lie anywhere within half a
        unit of the last digit that is written.
    unit : str, default ""
        The SI unit of the result.

    Raises
    ------
    InputError
        If the value is not a finite number, has a unit of another dimension, or the standard
        deviation is negative.

    Examples
    --------
    >>> height = read_written("0.6 m +- 5 mm", "m")
    >>> height, height.deviation, height.stated
    (0.6, 0.005, True)
    >>> height = read_written("0.60 m", "m")
    >>> round(height.deviation, 6), height.stated  # 5 mm either way
    (0.002887, False)
    >>> read_written("0.6 m +- 5 kg", "m")
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: the standard deviation in "0.6 m +- 5 kg": "5 kg" is a mass;
    expected a length (a number in m, or a \
string such as "25 mm")
    """
    if has_deviation(value):
        number_text, deviation_text = _number_and_deviation(value)
        number = to_si(number_text, unit)
        try:
            deviation = _deviation_in_si(deviation_text, number, unit)
        except InputError as error:
            raise InputError(f"the standard deviation in {quoted(value, 80)}: {error}") from None
        if deviation < 0.0:
            raise InputError(
                f"the standard deviation in {quoted(value, 80)} is negative; it must be at least 0"
            )
        return Written(number, deviation, value.strip())
    number = to_si(value, unit)
    deviation = _ROUNDING * _last_digit(value, number)
    if isinstance(value, str):
        return Written(number, deviation, value.strip(), stated=False)
    return Written(number, deviation, f"{value:.15g} {unit}".rstrip(), stated=False)


def _number_and_deviation(text: str) -> tuple[str, str]:
    """Return number and standard deviation as texts; one without a unit gets that of the other."""
    number_text, deviation_text = _PLUS_MINUS.split(text.strip(), maxsplit=1)
    number = number_and_unit(number_text)
    deviation = number_and_unit(deviation_text)
    if number is None or deviation is None:
        return number_text, deviation_text
    number_unit = number[1]
    deviation_unit = deviation[1]
    if not deviation_unit:
        return number_text, f"{deviation_text} {number_unit}".rstrip()
    if not number_unit and deviation_unit != "%":
        return f"{number_text} {deviation_unit}", deviation_text
    return number_text, deviation_text


def _deviation_in_si(text: str, number: float, unit: str) -> float:
    """Return a standard deviation, which may be a percentage of the number, in SI."""
    quantity = number_and_unit(text)
    if quantity is not None and quantity[1] == "%":
        return 0.01 * quantity[0] * abs(number)
    return to_si(text, unit)


def _last_digit(value: float | str, number: float) -> float:
    """Return one unit of the last digit of a value as it is written, in SI.

    The value is `number` in SI.
    """
    text = value
    if not isinstance(text, str):
        text = repr(float(text)).removesuffix(".0")
    digits = _DIGITS.match(text)
    if digits is None:
        return 0.0
    decimals = len(digits[1].partition(".")[2])
    unit_of_last_digit = 10.0 ** (int(digits[2] or 0) - decimals)
    quantity = None
    if isinstance(value, str):
        quantity = number_and_unit(value)
    if quantity is None or quantity[0] == 0.0:
        return unit_of_last_digit
    return unit_of_last_digit * abs(number / quantity[0])
