"""The errors of the package, and the "did you mean" of their messages."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from itertools import islice

from vibroimpact.shown import shortened, visible

_LONGEST_WORD = 100
_LOOKED_AT = 200  # faults; to put each of a hundred thousand into words takes long


LONGEST_LINE = 480
"""Characters of a line of a message."""

MOST_LINES = 10
"""Faults that are told, a line each; how many more there are is told in one line more."""


class VibroimpactError(Exception):
    """Base of every error the package raises on purpose.

    Parameters
    ----------
    *faults : str
        What is wrong, one or more; each becomes one line, whatever it holds.

    Attributes
    ----------
    lines : tuple of str
        A line a fault: printable, of at most `LONGEST_LINE` characters, and at most `MOST_LINES` of them with one that counts the rest.
    """

    def __init__(self, *faults: str) -> None:
        self.lines = lines_of(faults)
        super().__init__("\n".join(self.lines))

    def __str__(self) -> str:
        return "\n".join(self.lines)


class InputError(VibroimpactError, ValueError):
    """A wrong case, argument or file: the message says where, what, and what is allowed.

    Parameters
    ----------
    message : str
        What is wrong, and what is allowed.
    key : str, optional
        The dotted key of the value it is about.
    """

    def __init__(self, message: str, key: str = "") -> None:
        super().__init__(f"{shortened(key, 160)}: {message}" if key else message)
        (self.message,), self.key = lines_of((message,)), key

    @classmethod
    def of_several(cls, faults: Iterable[str]) -> InputError:
        """Return one error of several faults, a line each.

        Examples
        --------
        >>> print(InputError.of_several(["sphere: this section is missing", "plate: this section is missing"]))
        sphere: this section is missing
        plate: this section is missing
        """
        error = cls("")
        error.lines = lines_of(faults)
        error.args = ("\n".join(error.lines),)
        error.message = "; ".join(error.lines)
        return error


class ComputationError(VibroimpactError, RuntimeError):
    """A valid problem whose computation failed or did not close its energy ledger."""


def lines_of(faults: Iterable[str]) -> tuple[str, ...]:
    r"""Return faults as a terminal can show them: different ones, a printable line each, few and not long.

    Examples
    --------
    >>> lines_of(["no such file", "no such file", "a name\x1b[31m"])
    ('no such file', 'a name\\x1b[31m')
    >>> lines_of(map(str, range(500)))[-1]
    'and more than 190 other faults'
    """
    first = iter(faults)
    found = list(dict.fromkeys(shortened(visible(fault), LONGEST_LINE) for fault in islice(first, _LOOKED_AT)))
    rest, all_seen = len(found) - MOST_LINES, next(first, None) is None
    if all_seen and rest <= 1:  # a line that counts one takes as much room as the one
        return tuple(found)
    return (*found[:MOST_LINES], f"and {'' if all_seen else 'more than '}{rest} other faults")


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return " Did you mean ...?" for the known word closest to `word`, or "".

    Examples
    --------
    >>> did_you_mean("raduis", ["radius", "material"])
    ' Did you mean "radius"?'
    >>> did_you_mean("xyz", ["radius", "material"])
    ''
    """
    close = get_close_matches(word[:_LONGEST_WORD], list(known), n=1, cutoff=0.6)
    return f' Did you mean "{close[0]}"?' if close else ""
