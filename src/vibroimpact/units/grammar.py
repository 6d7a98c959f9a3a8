"""Grammar of unit texts, checked before pint parses them.

pint evaluates any expression, and a tower of powers such as s^9^9^9 would never end.
"""

from __future__ import annotations

import re

_LONGEST = 40  # characters
_LETTER = "A-Za-z%°µμ"
_TOKEN = re.compile(
    rf" *(?:(?P<n>[{_LETTER}][{_LETTER}0-9]*)|(?P<one>1(?![{_LETTER}0-9.]))"
    rf"|(?P<d>\d{{1,3}}(?:\.\d{{1,6}})?(?![{_LETTER}0-9.]))"
    r"|(?P<power>\^|\*\*)|(?P<sign>[+-])|(?P<times>[*·])|(?P<over>/)|(?P<open>\()|(?P<close>\)))"
)
_SIGNS = {
    "one": "1",
    "power": "^",
    "sign": "-",
    "times": "*",
    "over": "/",
    "open": "(",
    "close": ")",
}
_EXPONENT = re.compile(r"\^(?:-?[1d]|\(-?[1d](?:/[1d])?\))")
_PRODUCT = r"(?:n'?|1)(?:[*/]?(?:n'?|1))*"
_GROUP = re.compile(rf"\({_PRODUCT}\)")
_MOST_GROUPS = 2


def is_unit(text: str) -> bool:
    """Return whether a text is a product of names, each with at most one exponent, a small number
    or a ratio of two.

    The names are not checked to be units. Parentheses may be nested once.

    Examples
    --------
    >>> [is_unit(text) for text in ("N/mm^1.5", "kg/(m s^2)", "1/mm", "m**(3/2)", "N s / m")]
    [True, True, True, True, True]
    >>> [is_unit(text) for text in ("s^9^9^9", "m**99999999", "(((m)))", "5 m", "m+m", "m/")]
    [False, False, False, False, False, False]
    """
    kinds, at = "", 0
    while at < len(text) <= _LONGEST:
        token = _TOKEN.match(text, at)
        if token is None or token.lastgroup is None:
            return False
        kinds += _SIGNS.get(token.lastgroup, token.lastgroup)
        at = token.end()
    kinds = _EXPONENT.sub("'", kinds)
    for _ in range(_MOST_GROUPS):
        kinds = _GROUP.sub("n", kinds)
    return re.fullmatch(_PRODUCT, kinds) is not None
