"""What is plausible for one number of a case: where it may lie, and in which units people write it."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from vibroimpact.cases.slips.hertz_estimate import HertzEstimate

Words = str | Callable[[float], str]
"""What is said of a value: as it stands, or made for the value."""


@dataclass(frozen=True, kw_only=True)
class PlausibleRange:
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


Rule = Callable[[HertzEstimate, Mapping[str, Any]], PlausibleRange]
"""Gives what is plausible under the estimate of a case, for a number that stands in a table."""


@dataclass(frozen=True)
class CheckedKey:
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
    bounds = PlausibleRange(low=low, high=high, below=below, above=above)
    return lambda estimate, table: bounds


def near(what: Callable[[HertzEstimate], float], words: str, unit: str, *, factor: float = 300.0, within: float = 30.0) -> Rule:
    """Return the rule of a number that physics gives: by which factor it may be off, and one in another unit."""

    def rule(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
        reference = what(estimate)

        def said(value: float) -> str:
            return f"is {ratio_text(value / reference)} than {words} {number_text(reference, 4)} {unit}"

        return PlausibleRange(low=reference / factor, high=reference * factor, below=said, above=said, reference=reference, within=within)

    return rule


def ratio_text(ratio: float) -> str:
    """Return how many times more or less something is.

    Examples
    --------
    >>> ratio_text(64.3), ratio_text(1 / 31622.8)
    ('64 times more', '31,623 times less')
    """
    return f"{count_text(ratio)} times more" if ratio > 1.0 else f"{count_text(1.0 / ratio)} times less"


def count_text(value: float) -> str:
    """Return a whole number with commas; a very large one with an exponent.

    Examples
    --------
    >>> count_text(31622.8), count_text(6.4e12)
    ('31,623', '6.4e12')
    """
    return f"{value:,.0f}" if value < 1e9 else number_text(value, 2)


def number_text(value: float, digits: int = 6) -> str:
    """Return a number as people type it.

    Examples
    --------
    >>> number_text(16176.0), number_text(5.115e8), number_text(7.85e-9), number_text(2786.0, 2)
    ('16176', '5.115e8', '7.85e-9', '2800')
    """
    rounded = float(f"{value:.{digits}g}")
    return re.sub(r"e([+-])0*", lambda power: "e" + power[1].strip("+"), f"{rounded:.{max(digits, 6)}g}")
