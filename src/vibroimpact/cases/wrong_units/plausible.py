"""Plausible ranges of the values of a case, and the units in which they are usually written."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from vibroimpact.cases.wrong_units.hertz_estimate import HertzEstimate

Words = str | Callable[[float], str]
"""A part of a message: fixed, or a function of the value."""


@dataclass(frozen=True, kw_only=True)
class PlausibleRange:
    """The plausible range of a value; a bound of NaN is no bound.

    Parameters
    ----------
    low, high : float
        Bounds of the magnitude [SI].
    below, above : str or callable
        Message for a value below or above the range.
    reference : float, optional
        Physical estimate of the value: of several units, the one that brings the value close to it
        and is common is taken. Without it, the first unit that brings the value into the range.
    within : float, default 100
        Largest ratio between the corrected value and the reference.
    remedy : str or callable, optional
        Advice if no unit explains the value; if it is "", the value is then not reported.
    """

    low: float = 0.0
    high: float = math.inf
    below: Words = ""
    above: Words = ""
    reference: float | None = None
    within: float = 100.0
    remedy: Words = ""


Rule = Callable[[HertzEstimate, Mapping[str, Any]], PlausibleRange]
"""Returns the plausible range of a value, from the estimate of the case and the table
that holds the value.
"""


@dataclass(frozen=True)
class CheckedKey:
    """A key of a case whose value is checked for plausibility.

    Parameters
    ----------
    key : str
        Dotted key; "#" stands for each item of a list, such as in "sensors.#.rate".
    unit : str
        Its SI unit; the n of "N/m^n" is the exponent of the law.
    units : tuple of str
        Other common units, the likeliest first.
    rule : callable
        Returns the plausible range.
    """

    key: str
    unit: str
    units: tuple[str, ...]
    rule: Rule


def between(low: float = 0.0, high: float = math.inf, *, below: str = "", above: str = "") -> Rule:
    """Return the rule of a fixed range."""
    bounds = PlausibleRange(low=low, high=high, below=below, above=above)
    return lambda estimate, table: bounds


def near(
    what: Callable[[HertzEstimate], float],
    phrase: str,
    unit: str,
    *,
    factor: float = 300.0,
    within: float = 30.0,
) -> Rule:
    """Return the rule of a value with a physical estimate.

    Parameters
    ----------
    what : callable
        Returns the estimate [SI].
    phrase : str
        Name of the estimate in messages.
    unit : str
        Its SI unit.
    factor : float
        Largest ratio of a plausible value to the estimate, or its inverse.
    within : float
        Largest ratio, or its inverse, of a value that is corrected for its unit.
    """

    def rule(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
        reference = what(estimate)

        def said(value: float) -> str:
            return (
                f"is {ratio_text(value / reference)} than {phrase} {number_text(reference, 4)} "
                f"{unit}"
            )

        return PlausibleRange(
            low=reference / factor,
            high=reference * factor,
            below=said,
            above=said,
            reference=reference,
            within=within,
        )

    return rule


def ratio_text(ratio: float) -> str:
    """Return a ratio in words.

    Examples
    --------
    >>> ratio_text(64.3), ratio_text(1 / 31622.8)
    ('64 times more', '31,623 times less')
    """
    if ratio > 1.0:
        return f"{count_text(ratio)} times more"
    return f"{count_text(1.0 / ratio)} times less"


def count_text(value: float) -> str:
    """Return an integer with thousands separators; a very large one with an exponent.

    Examples
    --------
    >>> count_text(31622.8), count_text(6.4e12)
    ('31,623', '6.4e12')
    """
    if value < 1e9:
        return f"{value:,.0f}"
    return number_text(value, 2)


def number_text(value: float, digits: int = 6) -> str:
    """Return a number in its shortest usual notation.

    Examples
    --------
    >>> number_text(16176.0), number_text(5.115e8), number_text(7.85e-9), number_text(2786.0, 2)
    ('16176', '5.115e8', '7.85e-9', '2800')
    """
    rounded = float(f"{value:.{digits}g}")
    return re.sub(
        r"e([+-])0*", lambda power: "e" + power[1].strip("+"), f"{rounded:.{max(digits, 6)}g}"
    )
