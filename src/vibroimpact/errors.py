"""The errors of the package, and the "did you mean" of their messages."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


class VibroimpactError(Exception):
    """Base of every error the package raises on purpose."""


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
        super().__init__(f"{key}: {message}" if key else message)
        self.message, self.key = message, key


class ComputationError(VibroimpactError, RuntimeError):
    """A valid problem whose computation failed or did not close its energy ledger."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return " Did you mean ...?" for the known word closest to `word`, or "".

    Examples
    --------
    >>> did_you_mean("raduis", ["radius", "material"])
    ' Did you mean "radius"?'
    >>> did_you_mean("xyz", ["radius", "material"])
    ''
    """
    close = get_close_matches(word, list(known), n=1, cutoff=0.6)
    return f' Did you mean "{close[0]}"?' if close else ""
