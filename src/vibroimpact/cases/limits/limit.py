"""Limits of the theory.

Each has a dimensionless number of a drop, the threshold above which the drop is doubted, and the
sentence for it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.registry import modules_in

FORCE, DURATION, RESTITUTION, REBOUND, VIBRATION = (
    "largest force",
    "contact time",
    "restitution",
    "rebound",
    "energy of vibration",
)
"""Results of the first impact that the effects of limits name."""

LATER_IMPACTS = "later impacts"

Effects = Mapping[str, float]
"""Relative changes of results, by their names."""


def _no_effects(drop: Conditions, number: float) -> Effects:
    """Return that the effects are not estimated."""
    return {}


def of_slower_impact(loss: float) -> Effects:
    r"""Return the effects of an approach speed that is lower by a part.

    Hertz's largest force goes with :math:`v^{6/5}`, the contact time with :math:`v^{-1/5}`, and
    energies with the square.
    """
    return {FORCE: 1.2 * loss, DURATION: 0.2 * loss, REBOUND: 2.0 * loss, VIBRATION: 2.0 * loss}


def of_force_and_duration(change: float) -> Effects:
    """Return the effects of a stiffness that changes the largest force, and the contact time as
    much in the other direction, since the impulse stays.
    """
    return {FORCE: change, DURATION: change}


@dataclass(frozen=True, kw_only=True)
class Limit:
    """A limit of the theory, which is checked for each drop.

    It is registered by being in `LIMITS` of a module of `vibroimpact.cases.validity`.

    Parameters
    ----------
    name : str
        Name in results: lower case, words joined by "_".
    title : str
        Short title.
    meaning : str
        Definition of the number, which is dimensionless.
    threshold : float
        A drop with a larger number is doubted.
    number : callable
        Returns the number of a drop, or of an array of drops, from its `Conditions`; NaN where the
        limit does not apply.
    sentence : callable
        Returns the message for one drop and its number: what is wrong and by how much, the cause
        and the remedy.
    shown : callable
        Formats a number for display.
    effects : callable
        Returns the relative changes that exceeding the limit makes in results of the drop, by their
        names, from its `Conditions` and its number; without those that are not estimated.
    group : str, default ""
        Limits of one group are about the same thing: a drop is warned of the worst of them alone.
    without_case : bool, default False
        Whether the number depends on the peak values of the drop only, so that it also applies to a
        problem made in Python.
    """

    name: str
    title: str
    meaning: str
    threshold: float
    number: Callable[[Conditions], Array]
    sentence: Callable[[Conditions, float], str]
    shown: Callable[[float], str]
    effects: Callable[[Conditions, float], Effects] = _no_effects
    group: str = ""
    without_case: bool = False


@cache
def limits() -> Mapping[str, Limit]:
    """Return all registered limits by name.

    Examples
    --------
    >>> limits()["air_drag"].threshold
    0.01
    """
    registered = [
        limit for module in modules_in("vibroimpact.cases.validity") for limit in module.LIMITS
    ]
    return {limit.name: limit for limit in sorted(registered, key=lambda limit: limit.name)}


def numbers_of(drops: Conditions) -> dict[str, Array]:
    """Return, by name, the number of each limit that applies to a drop.

    Of an array of drops it applies to any.
    """
    with np.errstate(all="ignore"):  # values that are not known are NaN
        numbers = {
            name: limit.number(drops)
            for name, limit in limits().items()
            if drops.case or limit.without_case
        }
    return {name: number for name, number in numbers.items() if not np.all(np.isnan(number))}


def two_digits(value: float) -> str:
    """Return a number with two significant digits.

    It has no exponent, unless it is very large or very small.

    Examples
    --------
    >>> two_digits(0.996), two_digits(123.0)
    ('1', '120')
    """
    return f"{float(f'{value:.2g}'):g}"


def in_kilohertz(frequency: float) -> str:
    """Return a frequency [Hz] in kHz, in three significant digits, as a case takes it.

    Examples
    --------
    >>> in_kilohertz(16420.0), in_kilohertz(1.2e6)
    ('16.4 kHz', '1200 kHz')
    """
    return f"{float(f'{frequency / 1e3:.3g}'):g} kHz"


def percent_less(part: float) -> str:
    """Return an estimated relative loss in per cent, with two significant digits: 0.135 is -14 %.

    Examples
    --------
    >>> percent_less(0.1352), percent_less(0.0119), percent_less(7.7)
    ('-14 %', '-1.2 %', '-770 %')
    """
    return f"-{two_digits(100.0 * part)} %"


def percent_more(part: float) -> str:
    """Return an estimated relative gain in per cent, as `percent_less` does: 0.135 is +14 %."""
    return percent_less(part).replace("-", "+", 1)
