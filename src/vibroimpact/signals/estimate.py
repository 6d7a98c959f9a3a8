"""A number with its interval."""

from __future__ import annotations

import math
from dataclasses import dataclass

_NORMAL = 1.959964
"""Standard deviations to either side that hold 95 % of a normal distribution."""


@dataclass(frozen=True)
class Estimate:
    """A number that was found, with its standard deviation.

    Parameters
    ----------
    value : float
        The number.
    deviation : float
        Its standard deviation; that of its logarithm, if `logarithmic`.
    logarithmic : bool, default False
        Whether its logarithm is normal.

    Examples
    --------
    >>> Estimate(10.0, 1.0).interval
    (8.040036, 11.959964)
    """

    value: float
    deviation: float
    logarithmic: bool = False

    @property
    def interval(self) -> tuple[float, float]:
        """The interval that holds 95 %."""
        if self.logarithmic:
            factor = math.exp(min(_NORMAL * self.deviation, 700.0))
            return self.value / factor, self.value * factor
        return self.value - _NORMAL * self.deviation, self.value + _NORMAL * self.deviation
