"""What a limit of the theory is: a quantity of a drop, the threshold beyond which it is doubted, and the sentence that says so."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.conditions import Conditions
from vibroimpact.registry import modules_in


@dataclass(frozen=True, kw_only=True)
class Limit:
    """A limit of what a drop is computed with, to which each drop is held.

    Being in `LIMITS` of a file of its own under `vibroimpact.cases.limits` is all the registration that it needs.

    Parameters
    ----------
    name : str
        As results call it: lower case, words joined by "_".
    title : str
        As people call it, in a few words.
    meaning : str
        What the number is, in a few words; it has no unit.
    threshold : float
        A drop whose number is greater is doubted.
    number : callable
        Returns the number of a drop, or of an array of drops, under `Conditions`; NaN where the limit has no bearing.
    sentence : callable
        Returns what is said of one drop and its number: what is off and how far, the cause and the remedy.
    shown : callable
        Returns a number as it is read.
    without_case : bool, default False
        Does the number follow from what came of a drop alone? Then a problem made in Python, which has no case, is held to it too.
    """

    name: str
    title: str
    meaning: str
    threshold: float
    number: Callable[[Conditions], Array]
    sentence: Callable[[Conditions, float], str]
    shown: Callable[[float], str]
    without_case: bool = False


@cache
def limits() -> Mapping[str, Limit]:
    """Return every limit by its name.

    Examples
    --------
    >>> limits()["air_drag"].threshold
    0.01
    """
    found = [one for module in modules_in("vibroimpact.cases.limits") for one in module.LIMITS]
    return {one.name: one for one in sorted(found, key=lambda one: one.name)}


def numbers_of(drops: Conditions) -> dict[str, Array]:
    """Return the number of each limit that has a bearing on a drop, or on any of an array of drops."""
    with np.errstate(all="ignore"):  # what can't be told of a drop is not a number
        found = {name: limit.number(drops) for name, limit in limits().items() if drops.case or limit.without_case}
    return {name: number for name, number in found.items() if not np.all(np.isnan(number))}


def percent_less(part: float) -> str:
    """Return a part that is lost, in per cent: 0.135 is -13.5 %.

    Examples
    --------
    >>> percent_less(0.1352), percent_less(0.0119)
    ('-13.5 %', '-1.2 %')
    """
    percent = 100.0 * part
    return f"-{percent:.1f} %" if percent >= 1.0 else f"-{percent:.2g} %"


def percent_more(part: float) -> str:
    """Return a part that is added, in per cent: 0.135 is +13.5 %."""
    return percent_less(part).replace("-", "+", 1)
