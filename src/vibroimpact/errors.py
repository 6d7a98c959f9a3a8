"""Exceptions of the package, and the "did you mean" suggestions of their messages."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from itertools import islice

from vibroimpact.shown import shortened, visible

_LONGEST_WORD = 100
_LARGEST_COUNT = 200  # faults that are formatted; a hundred thousand would take long


LONGEST_LINE = 480
"""Largest length of a line of a message."""

MOST_LINES = 10
"""Largest number of faults in a message, one line each; another line gives the number of further faults."""


class VibroimpactError(Exception):
    """Base class of the exceptions of the package.

    Parameters
    ----------
    *faults : str
        One or more descriptions of faults; each becomes one line.

    Attributes
    ----------
    lines : tuple of str
        One line per fault: printable, of at most `LONGEST_LINE` characters; at most `MOST_LINES` lines, and one that counts the rest.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> try:
    ...     vi.load_case("no-such-case.toml")
    ... except vi.VibroimpactError as error:
    ...     len(error.lines)
    1
    """

    def __init__(self, *faults: str) -> None:
        self.lines = lines_of(faults)
        super().__init__("\n".join(self.lines))

    def __str__(self) -> str:
        return "\n".join(self.lines)


class ChartWarning(UserWarning):
    """A chart could not be drawn; everything else was written."""


class InputError(VibroimpactError, ValueError):
    """An invalid case, argument or file; the message states the location, the fault, and what is allowed.

    Parameters
    ----------
    message : str
        The fault, and what is allowed.
    key : str, optional
        The dotted key of the invalid value.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> try:
    ...     vi.to_si("2 mm", "kg")
    ... except vi.InputError as error:
    ...     print(error)
    "2 mm" is a length; expected a mass (a number in kg, or a string such as "90 g")
    """

    def __init__(self, message: str, key: str = "") -> None:
        super().__init__(f"{shortened(key, 160)}: {message}" if key else message)
        (self.message,), self.key = lines_of((message,)), key

    @classmethod
    def of_several(cls, faults: Iterable[str]) -> InputError:
        """Return one error for several faults, one line each.

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
    """A failed computation of a valid problem, or one whose energy balance does not close.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> issubclass(vi.ComputationError, vi.VibroimpactError), issubclass(vi.ComputationError, vi.InputError)
    (True, False)
    """


def lines_of(faults: Iterable[str]) -> tuple[str, ...]:
    r"""Return faults without duplicates, as printable lines of limited number and length.

    Examples
    --------
    >>> lines_of(["no such file", "no such file", "a name\x1b[31m"])
    ('no such file', 'a name\\x1b[31m')
    >>> lines_of(map(str, range(500)))[-1]
    'and more than 190 other faults'
    """
    first = iter(faults)
    found = list(dict.fromkeys(shortened(visible(fault), LONGEST_LINE) for fault in islice(first, _LARGEST_COUNT)))
    rest, all_seen = len(found) - MOST_LINES, next(first, None) is None
    if all_seen and rest <= 1:  # a line that counts one fault would be as long as the fault
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
