"""Pieces of what was read, as messages and figures show them: in one line, without control characters, and not too long."""

from __future__ import annotations

ELLIPSIS = "..."


def visible(text: str, most: int = 60) -> str:
    r"""Return a text of at most `most` characters, in which those that can't be seen stand as their escapes, such as \n or \x1b.

    Examples
    --------
    >>> visible("a name of 300 letters" * 15, 20)
    'a name of 300 let...'
    >>> print(visible("left\nupper"))
    left\nupper
    """
    # a text of any length is cut before it is worked on
    plain = "".join(letter if letter.isprintable() else _escape(letter) for letter in text[: most + 1])
    return plain if len(plain) <= most else plain[: most - len(ELLIPSIS)] + ELLIPSIS


def shown(text: str, most: int = 40) -> str:
    """Return the beginning of a text in quotes, fit for a message.

    Examples
    --------
    >>> shown("1.0.0")
    '"1.0.0"'
    >>> shown("0123456789", 4)
    '"0123..."'
    """
    return f'"{visible(text[:most], 10 * most)}{ELLIPSIS if len(text) > most else ""}"'


def _escape(letter: str) -> str:
    return letter.encode("unicode_escape").decode("ascii")
