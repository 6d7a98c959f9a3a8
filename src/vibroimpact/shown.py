"""What people and files give, as it is shown to people: printable, and no longer than can be read."""

from __future__ import annotations

import reprlib
import unicodedata
from typing import Any


def visible(text: str) -> str:
    r"""Return a text in which nothing steers a terminal: control characters, line breaks and their like stand as escapes.

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
    if unicodedata.category(character) == "Zs":  # a blank that does not break, and the other widths
        return " "
    return character.encode("unicode_escape").decode()


def shortened(text: str, most: int) -> str:
    """Return a text of at most so many characters, without its middle if it is longer.

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
    r"""Return a value of a case as a message shows it: a text in quotes, other things as they are, no more than can be read.

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
    """Looks into no more of a value than is shown: one from Python may be without end."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel, self.maxstring, self.maxother = 4, 60, 60

    def repr_int(self, x: int, level: int) -> str:
        return repr(x) if x.bit_length() < 400 else f"a whole number of {int(x.bit_length() * 0.30103)} digits"


_short = _Short()
