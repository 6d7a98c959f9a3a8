"""Exceptions of the package, and the "did you mean" suggestions of their messages."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from itertools import accumulate, islice

from vibroimpact.quoting import shortened, visible

_LONGEST_WORD = 100
_LARGEST_COUNT = 200  # faults that are formatted; a hundred thousand would take long


LONGEST_MESSAGE = 490
"""Largest length of a message: that of all its lines."""

LONGEST_LINE = 450
"""Largest length of a line of a message; what is left is for the number of further faults."""

MOST_LINES = 10
"""Largest number of faults in a message, one line each; another line gives the number of
further faults.
"""

# characters of the names that a message lists; those of the longest section of a case
_LONGEST_LIST = 220
_LONGEST_NAME = 60
_MOST_NEAR = 3  # names that come first where not all are listed


class VibroimpactError(Exception):
    """Base class of the exceptions of the package.

    Parameters
    ----------
    *faults : str
        One or more descriptions of faults; each becomes one line.

    Attributes
    ----------
    faults : tuple of str
        All faults, but of a great many only the first ones.

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
        self.faults = faults[: _LARGEST_COUNT + 1]
        super().__init__("\n".join(self.lines))

    @property
    def lines(self) -> tuple[str, ...]:
        """The lines of the message, one per fault.

        They are printable, of at most `LONGEST_LINE` characters; at most `MOST_LINES`, and one that
        counts the rest; together they have at most `LONGEST_MESSAGE` characters.
        """
        return lines_of(self.faults)

    def __str__(self) -> str:
        return "\n".join(self.lines)


class ChartWarning(UserWarning):
    """A chart could not be drawn; everything else was written."""


class SlowLawWarning(UserWarning):
    """A contact law could not be compiled; its results are the same, and take longer."""


class InputError(VibroimpactError, ValueError):
    """An invalid case, argument or file; the message states the location, the fault, and what is
    allowed.

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
    ...     vi.units.to_si("2 mm", "kg")
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
        >>> print(
        ...     InputError.of_several(
        ...         ["sphere: this section is missing", "plate: this section is missing"]
        ...     )
        ... )
        sphere: this section is missing
        plate: this section is missing
        """
        error = cls("")
        error.faults = tuple(islice(faults, _LARGEST_COUNT + 1))
        error.args = ("\n".join(error.lines),)
        error.message = "; ".join(error.lines)
        return error


class ComputationError(VibroimpactError, RuntimeError):
    """A failed computation of a valid problem, or one whose energy balance does not close.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> (
    ...     issubclass(vi.ComputationError, vi.VibroimpactError),
    ...     issubclass(vi.ComputationError, vi.InputError),
    ... )
    (True, False)
    """


def lines_of(faults: Iterable[str]) -> tuple[str, ...]:
    r"""Return faults without duplicates, as printable lines of limited number and length.

    Examples
    --------
    >>> lines_of(["no such file", "no such file", "a name\x1b[31m"])
    ('no such file', 'a name\\x1b[31m')
    >>> lines_of(map(str, range(500)))[-1]
    'and at least 190 other faults'
    """
    first = iter(faults)
    found = tuple(
        dict.fromkeys(
            shortened(visible(fault), LONGEST_LINE) for fault in islice(first, _LARGEST_COUNT)
        )
    )
    all_seen = next(first, None) is None
    few = len(found) <= MOST_LINES + 1  # a line that counts one fault would be as long as the fault
    if all_seen and few and len("\n".join(found)) <= LONGEST_MESSAGE:
        return found
    room = LONGEST_MESSAGE - len("and at least 200 other faults")
    fitting = sum(end <= room for end in accumulate(len(line) + 1 for line in found[:MOST_LINES]))
    rest = len(found) - fitting
    if not rest:  # many are alike, and not all were looked at
        return (*found, "and perhaps other faults")
    return (
        *found[:fitting],
        f"and {'' if all_seen else 'at least '}{rest} other fault{'s' if rest > 1 else ''}",
    )


def listed(names: Iterable[str], near: str = "", command: str = "") -> str:
    """Return names for a message, separated by commas: all of them, or if that would be long those
    closest to a word, and more.

    Parameters
    ----------
    names : iterable of str
        The names.
    near : str, optional
        What was given in place of one of them.
    command : str, optional
        The arguments of the command that lists them all, such as "laws".

    Examples
    --------
    >>> listed(["radius", "material"])
    'radius, material'
    >>> text = listed([f"a-long-name-{number}" for number in range(50)], "a-long-name_47", "laws")
    >>> text[:18], text[-53:]
    ('a-long-name-47, a-', 'and 36 others, which "vibroimpact laws" lists in full')
    """
    ordered = [shortened(visible(name), _LONGEST_NAME) for name in names]
    text = ", ".join(ordered)
    if len(text) <= _LONGEST_LIST:
        return text
    first = get_close_matches(near[:_LONGEST_WORD], ordered, n=_MOST_NEAR)
    ordered = [*first, *(name for name in ordered if name not in first)]
    fitting = sum(end <= _LONGEST_LIST for end in accumulate(len(name) + 2 for name in ordered))
    where = f', which "vibroimpact {command}" lists in full' if command else ""
    rest = len(ordered) - fitting
    return f"{', '.join(ordered[:fitting])} and {rest} other{'s' if rest > 1 else ''}{where}"


def choices(names: Iterable[str], given: str, command: str = "") -> str:
    """Return the names that are allowed in place of one that was given, as `listed` does, and which
    of them was probably meant.

    Examples
    --------
    >>> choices(["hertz", "tsuji"], "herz")
    'hertz, tsuji. Did you mean "hertz"?'
    """
    known = list(names)
    return f"{listed(known, given, command)}.{did_you_mean(given, known)}"


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return " Did you mean ...?" for the known word closest to `word`, or "" if there is none, or
    it is the word itself.

    Examples
    --------
    >>> did_you_mean("raduis", ["radius", "material"])
    ' Did you mean "radius"?'
    >>> did_you_mean("xyz", ["radius", "material"])
    ''
    """
    close = get_close_matches(word[:_LONGEST_WORD], list(known), n=1, cutoff=0.6)
    return f' Did you mean "{close[0]}"?' if close and close[0] != word else ""
