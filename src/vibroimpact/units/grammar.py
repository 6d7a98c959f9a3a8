"""Grammar of unit texts, checked before pint parses them.

pint evaluates any expression, and a tower of powers such as s^9^9^9 would never end.
"""

from __future__ import annotations

import re

_LONGEST = 40  # characters
_LETTER = "A-Za-z%°µμ"
_TOKEN = re.compile(
    rf" *(?:(?P<name>[{_LETTER}][{_LETTER}0-9]*)|(?P<one>1(?![{_LETTER}0-9.]))"
    rf"|(?P<number>\d{{1,3}}(?:\.\d{{1,6}})?(?![{_LETTER}0-9.]))"
    r"|(?P<power>\^|\*\*)|(?P<sign>[+-])|(?P<times>[*·])|(?P<over>/)|(?P<open>\()|(?P<close>\)))"
)
_SYMBOLS = {
    "name": "n",
    "number": "d",
    "one": "1",
    "power": "^",
    "sign": "-",
    "times": "*",
    "over": "/",
    "open": "(",
    "close": ")",
}
"""The symbol of each kind of token; the patterns below match texts of symbols."""

_EXPONENT = re.compile(r"\^(?:-?[1d]|\(-?[1d](?:/[1d])?\))")
_PRODUCT = r"(?:n'?|1)(?:[*/]?(?:n'?|1))*"
_GROUP = re.compile(rf"\({_PRODUCT}\)")
_DEEPEST = 2  # levels of parentheses


def is_unit(text: str) -> bool:
    """Return whether a text is a product of powers of names.

    The names are not checked to be units. Each has at most one exponent, a small number or a ratio
    of two. Parentheses may be nested once.

    Examples
    --------
    >>> [is_unit(text) for text in ("N/mm^1.5", "kg/(m s^2)", "1/mm", "m**(3/2)", "N s / m")]
    [True, True, True, True, True]
    >>> [is_unit(text) for text in ("s^9^9^9", "m**99999999", "(((m)))", "5 m", "m+m", "m/")]
    [False, False, False, False, False, False]
    """
    symbols = _symbols(text)
    if symbols is None:
        return False
    symbols = _EXPONENT.sub("'", symbols)
    for _ in range(_DEEPEST):
        symbols = _GROUP.sub("n", symbols)
    return re.fullmatch(_PRODUCT, symbols) is not None


def _symbols(text: str) -> str | None:
    """Return a text with a symbol for each token; None if it is too long or has anything else."""
    if len(text) > _LONGEST:
        return None
    symbols = ""
    position = 0
    while position < len(text):
        token = _TOKEN.match(text, position)
        if token is None or token.lastgroup is None:
            return None
        symbols += _SYMBOLS[token.lastgroup]
        position = token.end()
    return symbols
