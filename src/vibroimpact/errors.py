"""Exceptions of the package, and the "did you mean" suggestions of their messages."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
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
"""Largest number of faults in a message, one line each; one more line counts further faults."""

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


class LeftOutWarning(UserWarning):
    """Keys of a case were left out, which do not apply with others that were changed."""


class InputError(VibroimpactError, ValueError):
    """An invalid case, argument or file.

    The message states the location, the fault, and what is allowed.

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
        with_key = message
        if key:
            with_key = f"{shortened(key, 160)}: {message}"
        super().__init__(with_key)
        (self.message,) = lines_of([message])
        self.key = key

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
    remaining = iter(faults)
    formatted = (
        shortened(visible(fault), LONGEST_LINE) for fault in islice(remaining, _LARGEST_COUNT)
    )
    lines = tuple(dict.fromkeys(formatted))
    all_seen = next(remaining, None) is None
    few = len(lines) <= MOST_LINES + 1  # a line that counts one fault would be as long as the fault
    if all_seen and few and len("\n".join(lines)) <= LONGEST_MESSAGE:
        return lines
    room = LONGEST_MESSAGE - len("and at least 200 other faults")
    fitting = _number_fitting(lines[:MOST_LINES], room, separator_length=1)
    further = len(lines) - fitting
    if further == 0:  # many are alike, and not all were looked at
        return (*lines, "and perhaps other faults")
    at_least = "" if all_seen else "at least "
    return (*lines[:fitting], f"and {at_least}{further} other fault{_plural(further)}")


def _number_fitting(texts: Sequence[str], room: int, *, separator_length: int) -> int:
    """Return how many texts, each with a separator, fit into a number of characters."""
    ends = accumulate(len(text) + separator_length for text in texts)
    return sum(end <= room for end in ends)


def _plural(number: int) -> str:
    return "s" if number > 1 else ""


def listed(names: Iterable[str], near: str = "", command: str = "") -> str:
    """Return names for a message, separated by commas.

    If all would be long, those closest to a word come first, and further ones are counted.

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
    printable = [shortened(visible(name), _LONGEST_NAME) for name in names]
    text = ", ".join(printable)
    if len(text) <= _LONGEST_LIST:
        return text
    close = get_close_matches(near[:_LONGEST_WORD], printable, n=_MOST_NEAR)
    ordered = [*close, *(name for name in printable if name not in close)]
    fitting = _number_fitting(ordered, _LONGEST_LIST, separator_length=2)
    further = len(ordered) - fitting
    text = f"{', '.join(ordered[:fitting])} and {further} other{_plural(further)}"
    if command:
        text += f', which "vibroimpact {command}" lists in full'
    return text


def choices(names: Iterable[str], given: str, command: str = "") -> str:
    """Return the names that are allowed in place of one that was given, and the likely one.

    Examples
    --------
    >>> choices(["hertz", "tsuji"], "herz")
    'hertz, tsuji. Did you mean "hertz"?'
    """
    known = list(names)
    return f"{listed(known, given, command)}.{did_you_mean(given, known)}"


def did_you_mean(word: str, known: Iterable[str], cutoff: float = 0.6) -> str:
    """Return " Did you mean ...?" for the known word closest to a word, or "".

    It is "" if no known word is close, or the word itself is known. The cutoff is the least ratio
    of similarity, from 0 to 1.

    Examples
    --------
    >>> did_you_mean("raduis", ["radius", "material"])
    ' Did you mean "radius"?'
    >>> did_you_mean("xyz", ["radius", "material"])
    ''
    """
    close = get_close_matches(word[:_LONGEST_WORD], list(known), n=1, cutoff=cutoff)
    if not close or close[0] == word:
        return ""
    return f' Did you mean "{close[0]}"?'
