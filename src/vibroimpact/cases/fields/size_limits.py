"""Limits on the size of a case file, checked before validation, so that oversized or
hostile input is rejected quickly.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator

from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted

MOST_BYTES = 1_000_000
"""Maximum size of a case file [bytes]."""

DEEPEST = 20
"""Maximum nesting depth of tables and lists; a case needs seven levels."""

MOST_VALUES = 200_000
"""Maximum number of keys and list items in total; a study may list its points."""

LONGEST_TEXT = 4096
"""Maximum number of characters of a string: that of a path on most systems."""

LONGEST_KEY = 200
"""Maximum number of characters of a key."""

LARGEST_WHOLE = 2**63 - 1
"""Largest integer, as TOML defines it."""

LONGEST_NAME = 200
"""Maximum number of characters of a name."""

MOST_ITEMS = 1000
"""Maximum number of sensors, and of supports, of a plate."""

MOST_OF_A_LIST = 10_000
"""Maximum number of values, one per impact, of a parameter of a contact law."""

_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
_DOTTED = re.compile(rf"(?<![\w-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{DEEPEST}}}", re.ASCII)


def check_text(text: str) -> None:
    """Check that no dotted key has more parts than the maximum nesting depth; the TOML parser takes
    quadratic time in that number.

    Raises
    ------
    InputError
        If there is one; the message gives its line.

    Examples
    --------
    >>> check_text("plate.size = [1, 2, 3]")
    """
    if max(map(_dots, text.split("\n"))) < DEEPEST:
        return
    dotted = _DOTTED.search(text)
    if dotted is not None and not text[
        text.rfind("\n", 0, dotted.start()) + 1 : dotted.start()
    ].lstrip().startswith("#"):
        line = text.count("\n", 0, dotted.start()) + 1
        raise InputError(
            f"line {line}: {quoted(dotted[0])} has more than {DEEPEST} parts joined by dots; "
            "a key may have so many at most, and a text or a comment too"
        )


def _dots(line: str) -> int:
    return line.count(".")


def check_bounds(table: Mapping[str, Any]) -> None:
    """Check the size of a parsed case: number of values, nesting depth, lengths of keys and
    strings, magnitude of integers.

    Raises
    ------
    InputError
        If a limit is exceeded; with the key.

    Examples
    --------
    >>> check_bounds({"name": "x" * 5000})
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: name: the text has 5000 characters; 4096 are the most
    """
    _check_table(table, (), 0)


def _check_table(table: Any, where: tuple[Any, ...], number: int) -> int:
    """Check a table or a list recursively; return `number`, the count of values so far,
    plus its own.
    """
    number += len(table)
    if number > MOST_VALUES:
        message = "a case is a page of text, and many points of a study go into a CSV file"
        raise InputError(f"it holds more than {MOST_VALUES} values; {message}")
    if len(where) > DEEPEST:
        raise _too_large(where[:4], f"tables and lists lie more than {DEEPEST} deep in one another")
    items: Iterable[tuple[Any, Any]] = enumerate(table)
    if isinstance(table, Mapping):
        items = table.items()
    for key, value in items:
        if type(key) is str and len(key) > LONGEST_KEY:
            raise _too_large(where, f"a key has {len(key)} characters; {LONGEST_KEY} are the most")
        kind = type(value)
        if kind is float:
            continue
        if kind is str:
            if len(value) > LONGEST_TEXT:
                raise _too_large(
                    (*where, key),
                    f"the text has {len(value)} characters; {LONGEST_TEXT} are the most",
                )
        elif kind is int:
            if not -LARGEST_WHOLE <= value <= LARGEST_WHOLE:
                message = (
                    f"the number is too large for a whole number; beyond {LARGEST_WHOLE} write "
                    "it as 1e20"
                )
                raise _too_large((*where, key), message)
        elif isinstance(value, (dict, list, tuple)):
            number = _check_table(value, (*where, key), number)
    return number


def check_name(name: str) -> str:
    """Return a name after checking that it is one line of printable text.

    Raises
    ------
    InputError
        If it is too long, or contains non-printable characters, such as the escape sequences of
        terminals.
    """
    if len(name) > LONGEST_NAME:
        raise InputError(f"the name has {len(name)} characters; {LONGEST_NAME} are the most")
    if not name.replace("\u00a0", " ").isprintable():
        raise InputError(
            f"{quoted(name)} has characters that can't be shown; a name is one line of text"
        )
    return name


Name = Annotated[str, AfterValidator(check_name)]
"""Type of a name that is shown in tables, pages and figures."""


def _check_file_name(name: str) -> str:
    if not name.strip():
        raise InputError("the name of the file is empty")
    return name


FileName = Annotated[str, AfterValidator(_check_file_name)]
"""Type of the name of a file."""


def at_most(number: int, what: str) -> BeforeValidator:
    """Return a validator that rejects a list of more than `number` items before the items
    themselves are validated.
    """

    def check(value: Any) -> Any:
        if isinstance(value, (list, tuple)):
            check_count(len(value), number, what)
        return value

    return BeforeValidator(check)


def check_count(count: int, most: int, what: str) -> None:
    """Check that a count does not exceed its maximum.

    Raises
    ------
    InputError
        If it does; the message gives both numbers.
    """
    if count > most:
        raise InputError(f"there are {count} {what}; {most} are the most")


def _too_large(where: tuple[Any, ...], message: str) -> InputError:
    return InputError(message, ".".join(str(part) for part in where))
