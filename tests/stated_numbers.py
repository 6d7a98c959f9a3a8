"""Numbers that pages state, held against what is computed again.

A test in tests/claims computes what a page says and calls `says` with the sentence;
tests/project/test_numbers.py reads those calls to find numbers that nothing holds.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]

NUMBER = r"[-+]?\d+(?:,\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?"

_FIELD = re.compile(r"\{(\d*)\}")
_SLACK = 0.05
"""Of a unit of the last digit, beyond half of it: machines differ in rounding."""


def page_text(page: str) -> str:
    """Return the text of a page, by its name from the root of the project, in one line."""
    return _text(ROOT / page)


@cache
def _text(path: Path) -> str:
    return " ".join(path.read_text(encoding="utf-8").split())


def pattern(sentence: str) -> re.Pattern[str]:
    """Return the pattern of a sentence: {} stands for a number.

    Examples
    --------
    >>> pattern("takes {} s").search("it takes 0.5 s, today").groups()
    ('0.5',)
    """
    words = _FIELD.split(" ".join(sentence.split()))[::2]
    return re.compile(f"({NUMBER})".join(re.escape(part) for part in words))


def says(page: str, sentence: str, *values: float) -> None:
    """Assert that a page has a sentence, in which {} stands for numbers that are the values as they
    are rounded there.

    Parameters
    ----------
    page : str
        Name of the page from the root of the project, such as "docs/guides/choosing.md".
    sentence : str
        Words of the page, at least a few about each number; {} for a number, {2} for one with two
        significant digits, as 17,000.
    *values : float
        What was computed, in the units of the sentence.
    """
    digits = [int(given) if given else 0 for given in _FIELD.findall(sentence)]
    assert len(digits) == len(values), (
        f"{len(digits)} numbers in {sentence!r}, {len(values)} computed"
    )
    matches = list(pattern(sentence).finditer(page_text(page)))
    assert matches, f"{page} does not say {sentence!r}"
    for match in matches:
        if all(
            _agrees(text, value, most)
            for text, value, most in zip(match.groups(), values, digits, strict=True)
        ):
            return
    stated = " or ".join(", ".join(match.groups()) for match in matches)
    raise AssertionError(
        f"{page} says {sentence!r} with {stated}; computed: "
        f"{', '.join(f'{value:.8g}' for value in values)}"
    )


def _agrees(text: str, value: float, digits: int) -> bool:
    """Return whether a number is a value rounded to the digits printed.

    Examples
    --------
    >>> (
    ...     _agrees("0.82", 0.8151, 0),
    ...     _agrees("0.82", 0.8149, 0),
    ...     _agrees("17,000", 16_700, 2),
    ...     _agrees("1.3e-5", 1.26e-5, 0),
    ... )
    (True, True, True, True)
    >>> _agrees("0.82", 0.814, 0), _agrees("17,000", 16_700, 0)
    (False, False)
    """
    plain = text.replace(",", "")
    mantissa, _, exponent = plain.partition("e")
    decimals = len(mantissa.partition(".")[2])
    unit = 10.0 ** (int(exponent or 0) - decimals)
    if digits:
        unit *= 10.0 ** max(0, len(mantissa.partition(".")[0].lstrip("+-")) - digits)
    return abs(float(plain) - value) <= (0.5 + _SLACK) * unit
