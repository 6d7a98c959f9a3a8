"""How large a case may be, looked at before it is worked on: what lies beyond is no case, and would take for ever to refuse."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator

from vibroimpact.errors import InputError
from vibroimpact.shown import shown

MOST_BYTES = 1_000_000
"""Of a file; a case is a page of text."""

DEEPEST = 20
"""Tables and lists in one another; a case has seven."""

MOST_VALUES = 200_000
"""Keys and items of lists in all; a study may list its points."""

LONGEST_TEXT = 4096
"""Characters of a text: what a path may have on most computers."""

LONGEST_KEY = 200
"""Characters of a key."""

LARGEST_WHOLE = 2**63 - 1
"""As TOML has it."""

LONGEST_NAME = 200
"""Characters of a name."""

MOST_ITEMS = 1000
"""Sensors or supports of a plate."""

MOST_OF_A_LIST = 10_000
"""Values of a parameter of a contact law, one an impact."""

_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
_DOTTED = re.compile(rf"(?<![\w-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{DEEPEST}}}", re.ASCII)


def check_text(text: str) -> None:
    """Raise if a text holds a dotted key of more parts than tables may lie in one another; to read it takes their number squared.

    Raises
    ------
    InputError
        With where it begins.

    Examples
    --------
    >>> check_text("plate.size = [1, 2, 3]")
    """
    if max(map(_points, text.split("\n"))) < DEEPEST:
        return
    found = _DOTTED.search(text)
    if found is not None and not text[text.rfind("\n", 0, found.start()) + 1 : found.start()].lstrip().startswith("#"):
        line = text.count("\n", 0, found.start()) + 1
        raise InputError(f"line {line}: {shown(found[0])} has too many parts; tables lie at most {DEEPEST} deep in one another")


def _points(line: str) -> int:
    return line.count(".")


def check_bounds(table: Mapping[str, Any]) -> None:
    """Raise unless a case, as a TOML file holds it, is of a size that can be worked on.

    Raises
    ------
    InputError
        With the key of what is too large.

    Examples
    --------
    >>> check_bounds({"name": "x" * 5000})
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: name: the text has 5000 characters; 4096 are the most
    """
    _look(table, (), 0)


def _look(table: Any, where: tuple[Any, ...], number: int) -> int:
    """Look into a table or a list; return how many values there are up to its end."""
    number += len(table)
    if number > MOST_VALUES:
        words = "a case is a page of text, and many points of a study go into a CSV file"
        raise InputError(f"it holds more than {MOST_VALUES} values; {words}")
    if len(where) > DEEPEST:
        raise _too_large(where[:4], f"tables and lists lie more than {DEEPEST} deep in one another")
    for key, value in table.items() if isinstance(table, Mapping) else enumerate(table):
        if type(key) is str and len(key) > LONGEST_KEY:
            raise _too_large(where, f"a key has {len(key)} characters; {LONGEST_KEY} are the most")
        kind = type(value)
        if kind is float:
            continue
        if kind is str:
            if len(value) > LONGEST_TEXT:
                raise _too_large((*where, key), f"the text has {len(value)} characters; {LONGEST_TEXT} are the most")
        elif kind is int:
            if not -LARGEST_WHOLE <= value <= LARGEST_WHOLE:
                words = f"the number is too large for a whole number; beyond {LARGEST_WHOLE} write it as 1e20"
                raise _too_large((*where, key), words)
        elif isinstance(value, (dict, list, tuple)):
            number = _look(value, (*where, key), number)
    return number


def check_name(name: str) -> str:
    """Return a name, which is one line of text that can be shown.

    Raises
    ------
    InputError
        If it is too long, or has characters that steer a terminal.
    """
    if len(name) > LONGEST_NAME:
        raise InputError(f"the name has {len(name)} characters; {LONGEST_NAME} are the most")
    if not name.replace("\u00a0", " ").isprintable():
        raise InputError(f"{shown(name)} has characters that can't be shown; a name is one line of text")
    return name


Name = Annotated[str, AfterValidator(check_name)]
"""What something is called in tables, pages and figures."""


def at_most(number: int, what: str) -> BeforeValidator:
    """Return a validator of a list that may have so many items, which refuses a longer one before it looks at them."""

    def check(value: Any) -> Any:
        if isinstance(value, (list, tuple)):
            check_count(len(value), number, what)
        return value

    return BeforeValidator(check)


def check_count(count: int, most: int, what: str) -> None:
    """Raise if there are more of something than may be.

    Raises
    ------
    InputError
        With both numbers.
    """
    if count > most:
        raise InputError(f"there are {count} {what}; {most} are the most")


def _too_large(where: tuple[Any, ...], words: str) -> InputError:
    return InputError(words, ".".join(str(part) for part in where))
