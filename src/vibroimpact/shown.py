"""Formatting of user input for messages: printable and of limited length."""

from __future__ import annotations

import reprlib
import unicodedata
from typing import Any


def visible(text: str) -> str:
    r"""Return a text with control characters, line breaks and other unprintable characters as escape sequences.

    Examples
    --------
    >>> print(visible("red\x1b[31m, a\nb"))
    red\x1b[31m, a\nb
    >>> visible("8 mm steel")
    '8 mm steel'
    """
    return text if text.isprintable() else "".join(map(_visible, text))


def _visible(character: str) -> str:
    if character.isprintable():
        return character
    if unicodedata.category(character) == "Zs":  # no-break space and spaces of other widths
        return " "
    return character.encode("unicode_escape").decode()


def shortened(text: str, most: int) -> str:
    """Return a text of at most `most` characters, with its middle omitted if it is longer.

    Examples
    --------
    >>> shortened("a name that never comes to an end", 20)
    'a name tha ... n end'
    """
    if len(text) <= most:
        return text
    end = (most - 5) // 3
    return f"{text[: most - 5 - end]} ... {text[len(text) - end :]}"


def shown(value: Any, most: int = 60) -> str:
    r"""Return a value for a message: a text in quotes, other values as their representation, of limited length.

    Examples
    --------
    >>> shown("25 kg"), shown([1, 2.5]), shown([0] * 1000)
    ('"25 kg"', '[1, 2.5]', '[0, 0, 0, 0, 0, 0, ...]')
    >>> print(shown("a\nb"))
    "a\nb"
    """
    if isinstance(value, str):
        return f'"{shortened(visible(value[: 10 * most]), most)}"'
    return shortened(visible(_short.repr(value)), most)


class _Short(reprlib.Repr):
    """Representation of limited depth and length: a value from Python may be arbitrarily large."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel, self.maxstring, self.maxother = 4, 60, 60

    def repr_int(self, x: int, level: int) -> str:
        return repr(x) if x.bit_length() < 400 else f"a whole number of {int(x.bit_length() * 0.30103)} digits"


_short = _Short()
