"""Ranges of allowed numbers, with their description in words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from vibroimpact.errors import InputError


@dataclass(frozen=True)
class Range:
    """An interval, unbounded where no bound is given. NaN and infinities are never inside.

    Examples
    --------
    >>> Range(above=0, at_most=1).words
    'greater than 0 and at most 1'
    """

    above: float = -math.inf
    at_least: float = -math.inf
    below: float = math.inf
    at_most: float = math.inf

    @property
    def words(self) -> str:
        """The range in words; "" if every finite number is inside."""
        bounds = {
            "greater than": self.above,
            "at least": self.at_least,
            "less than": self.below,
            "at most": self.at_most,
        }
        return " and ".join(
            f"{relation} {bound:g}" for relation, bound in bounds.items() if math.isfinite(bound)
        )

    def clip(self, values: Any) -> Any:
        """Return values clipped to the range, just inside an open end.

        Examples
        --------
        >>> Range(at_least=0).clip(np.array([-1.0, 2.0])).tolist()
        [0.0, 2.0]
        """
        lowest = self.at_least
        if math.isfinite(self.above):
            lowest = self.above + 1e-12 * abs(self.above) + 1e-300
        highest = self.at_most
        if math.isfinite(self.below):
            highest = self.below - 1e-12 * abs(self.below)
        return np.clip(values, lowest, highest)

    def bounded(self, values: Any) -> Any:
        """Return values clipped to the closed interval, including its open ends.

        Examples
        --------
        >>> Range(above=0, at_most=1).bounded(np.array([-0.2, 0.5, 1.3])).tolist()
        [0.0, 0.5, 1.0]
        """
        return np.clip(values, max(self.above, self.at_least), min(self.below, self.at_most))

    def check(self, values: Any, unit: str = "", shown: str = "") -> None:
        """Raise unless all `values` are finite and inside the range.

        Raises
        ------
        InputError
            With the first invalid value (as `shown`, if given), and the allowed range.
        """
        if (
            isinstance(values, float)
            and self.above < values < self.below
            and self.at_least <= values <= self.at_most
        ):
            return  # fast path: an array of one element takes ten times as long
        try:
            array = np.asarray(values, dtype=float)
        except (TypeError, ValueError):
            number = f"number in {unit}" if unit else "number"
            raise InputError(
                f"{values!r} is not allowed; it must be a {number}, or an array of them"
            ) from None
        inside = (
            np.isfinite(array)
            & (array > self.above)
            & (array >= self.at_least)
            & (array < self.below)
            & (array <= self.at_most)
        )
        if not inside.all():
            invalid = shown or f"{array[~inside].flat[0]:g}"
            allowed = "finite"
            if self.words:
                allowed = f"{self.words} {unit}".rstrip()
            raise InputError(f"{invalid} is not allowed; it must be {allowed}")
