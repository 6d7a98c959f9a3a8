"""Formatting of user input for messages: printable and of limited length."""

from __future__ import annotations

import reprlib
import unicodedata
from datetime import date
from itertools import islice
from typing import Any


def visible(text: str) -> str:
    r"""Return a text with unprintable characters, such as line breaks, as escape sequences.

    Examples
    --------
    >>> print(visible("red\x1b[31m, a\nb"))
    red\x1b[31m, a\nb
    >>> visible("8 mm steel")
    '8 mm steel'
    """
    if text.isprintable():
        return text
    return "".join(map(_visible, text))


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
    kept = most - len(" ... ")
    from_end = kept // 3
    return f"{text[: kept - from_end]} ... {text[len(text) - from_end :]}"


def quoted(value: Any, most: int = 60) -> str:
    r"""Return a value for a message, as a case file has it, of limited length.

    Examples
    --------
    >>> quoted("25 kg"), quoted([1, 2.5]), quoted([0] * 1000)
    ('"25 kg"', '[1, 2.5]', '[0, 0, 0, 0, 0, 0, ...]')
    >>> quoted(True), quoted(["a"]), quoted({"law": "hertz"}), quoted({})
    ('true', '["a"]', '{ law = "hertz" }', '{}')
    >>> print(quoted("a\nb"))
    "a\nb"
    """
    if isinstance(value, str):
        return f'"{shortened(visible(value[: 10 * most]), most)}"'
    return shortened(visible(_short.repr(value)), most)


class _Short(reprlib.Repr):
    """Representation of limited depth and length, as TOML has it."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel = 4
        self.maxstring = 60
        self.maxother = 60

    def repr_int(self, x: int, level: int) -> str:
        bits = x.bit_length()
        if bits < 400:
            return repr(x)
        return f"a whole number of about {int(bits * 0.30103)} digits"

    def repr_bool(self, x: bool, level: int) -> str:
        return str(x).lower()

    def repr_str(self, x: str, level: int) -> str:
        return f'"{shortened(x[: 10 * self.maxstring], self.maxstring)}"'

    def repr_dict(self, x: dict[Any, Any], level: int) -> str:
        if not x:
            return "{}"
        if level <= 0:
            return "{ ... }"
        entries = [
            f"{shortened(str(key), self.maxstring)} = {self.repr1(value, level - 1)}"
            for key, value in islice(x.items(), self.maxdict)
        ]
        if len(x) > self.maxdict:
            entries.append("...")
        return f"{{ {', '.join(entries)} }}"

    def repr_date(self, x: date, level: int) -> str:
        return x.isoformat()

    repr_datetime = repr_date
    repr_time = repr_date


_short = _Short()
