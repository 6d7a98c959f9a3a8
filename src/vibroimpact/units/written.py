"""Numbers as they were written: with the standard deviation that is given with them, or
that their digits leave open.
"""

from __future__ import annotations

import re
from typing import Any

from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted
from vibroimpact.units.quantity_text import number_and_unit
from vibroimpact.units.reading import to_si

_PLUS_MINUS = re.compile(r"\s*(?:\+/?[-\u2212]|±)\s*")
_HALF_STEP = 12.0**-0.5
"""Standard deviation of a number that is anywhere within half a step of what is written,
in steps.
"""


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
        made = super().__new__(cls, value)
        made.deviation, made.text, made.stated, made.why = deviation, text, stated, why
        return made


def has_deviation(value: Any) -> bool:
    """Return whether a value is a text with a standard deviation, such as "0.6 m +- 5 mm"."""
    return isinstance(value, str) and _PLUS_MINUS.search(value) is not None


def without_deviation(text: str) -> str:
    """Return a text without the standard deviation in it.

    Examples
    --------
    >>> without_deviation("0.6 m +- 5 mm"), without_deviation("0.600 ± 0.005 m")
    ('0.6 m', '0.600 m')
    """
    return _parts(text)[0]


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
    if not has_deviation(value):
        number = to_si(value, unit)
        text = value.strip() if isinstance(value, str) else f"{value:.15g} {unit}".rstrip()
        return Written(number, _HALF_STEP * _last_place(value, number), text, stated=False)
    assert isinstance(value, str)
    number, deviation = to_si(without_deviation(value), unit), _parts(value)[1]
    part = number_and_unit(deviation)
    try:
        spread = (
            0.01 * part[0] * abs(number)
            if part is not None and part[1] == "%"
            else to_si(deviation, unit)
        )
    except InputError as error:
        raise InputError(f"the standard deviation in {quoted(value, 80)}: {error}") from None
    if spread < 0.0:
        raise InputError(
            f"the standard deviation in {quoted(value, 80)} is negative; it must be at least 0"
        )
    return Written(number, spread, value.strip())


def _parts(text: str) -> tuple[str, str]:
    """Return number and standard deviation as texts with their units; one that has none
    has that of the other.
    """
    first, deviation = _PLUS_MINUS.split(text.strip(), maxsplit=1)
    of_first, of_deviation = number_and_unit(first), number_and_unit(deviation)
    if of_first is None or of_deviation is None:
        return first, deviation
    if not of_deviation[1]:
        return first, f"{deviation} {of_first[1]}".rstrip()
    return (
        (first, deviation)
        if of_first[1] or of_deviation[1] == "%"
        else (f"{first} {of_deviation[1]}", deviation)
    )


def _last_place(value: float | str, number: float) -> float:
    """Return one unit of the last digit of a number as it is written, in SI."""
    parts = number_and_unit(value) if isinstance(value, str) else None
    written = re.match(
        r"\s*[+-]?([\d.]+)(?:[eE]([+-]?\d+))?",
        value if isinstance(value, str) else f"{float(value)!r}".removesuffix(".0"),
    )
    if written is None:
        return 0.0
    step = 10.0 ** (int(written[2] or 0) - len(written[1].partition(".")[2]))
    return step if parts is None or not parts[0] else step * abs(number / parts[0])
