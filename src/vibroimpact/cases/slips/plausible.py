"""What is plausible for one number of a case: where it may lie, and in which units people write it."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from vibroimpact.cases.slips.facts import Facts

Words = str | Callable[[float], str]
"""What is said of a value: as it stands, or made for the value."""


@dataclass(frozen=True, kw_only=True)
class Plausible:
    """Where a number is plausible; NaN bounds nothing.

    Parameters
    ----------
    low, high : float
        Beyond these it is doubted [SI].
    below, above : str or callable
        What is said of one that is too small, and of one that is too large.
    reference : float, optional
        What physics gives for it: of several units the likely one is that which comes close, and is usual. Without it the first
        that leads into the range is.
    within : float, default 100
        By which factor the closest may still be off.
    remedy : str or callable, optional
        What to do where no unit explains it; if that is "", nothing is said then.
    """

    low: float = 0.0
    high: float = math.inf
    below: Words = ""
    above: Words = ""
    reference: float | None = None
    within: float = 100.0
    remedy: Words = ""


Rule = Callable[[Facts, Mapping[str, Any]], Plausible]
"""Gives what is plausible under the facts of a case, for a number that stands in a table."""


@dataclass(frozen=True)
class Place:
    """A key of a case, or keys alike, and what is plausible there.

    Parameters
    ----------
    key : str
        Dotted; "#" stands for each of a list, such as in "sensors.#.rate".
    unit : str
        Its SI unit; "N/m^n" has the exponent of the law.
    units : tuple of str
        Others in which it is usually written, the likeliest first.
    rule : callable
        What is plausible.
    """

    key: str
    unit: str
    units: tuple[str, ...]
    rule: Rule


def between(low: float = 0.0, high: float = math.inf, *, below: str = "", above: str = "") -> Rule:
    """Return the rule of a number that lies in a range whatever else the case says."""
    bounds = Plausible(low=low, high=high, below=below, above=above)
    return lambda facts, table: bounds


def about(what: Callable[[Facts], float], words: str, unit: str, *, factor: float = 300.0, within: float = 30.0) -> Rule:
    """Return the rule of a number that physics gives: by which factor it may be off, and one in another unit."""

    def rule(facts: Facts, table: Mapping[str, Any]) -> Plausible:
        reference = what(facts)

        def said(value: float) -> str:
            return f"is {times(value / reference)} than {words} {number(reference, 4)} {unit}"

        return Plausible(low=reference / factor, high=reference * factor, below=said, above=said, reference=reference, within=within)

    return rule


def times(ratio: float) -> str:
    """Return how many times more or less something is.

    Examples
    --------
    >>> times(64.3), times(1 / 31622.8)
    ('64 times more', '31,623 times less')
    """
    return f"{count(ratio)} times more" if ratio > 1.0 else f"{count(1.0 / ratio)} times less"


def count(value: float) -> str:
    """Return a whole number with commas; a very large one with an exponent.

    Examples
    --------
    >>> count(31622.8), count(6.4e12)
    ('31,623', '6.4e12')
    """
    return f"{value:,.0f}" if value < 1e9 else number(value, 2)


def number(value: float, digits: int = 6) -> str:
    """Return a number as people type it.

    Examples
    --------
    >>> number(16176.0), number(5.115e8), number(7.85e-9), number(2786.0, 2)
    ('16176', '5.115e8', '7.85e-9', '2800')
    """
    rounded = float(f"{value:.{digits}g}")
    return re.sub(r"e([+-])0*", lambda power: "e" + power[1].strip("+"), f"{rounded:.{max(digits, 6)}g}")
