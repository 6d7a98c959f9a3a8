"""A printed value beside the computed one, and what the difference means: a verdict that is computed, never typed in."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from vibroimpact.paper.printed import Printed


class Verdict(Enum):
    """What a difference means."""

    REPRODUCED = "reproduced"
    EXPLAINED = "explained"
    FITTED = "fitted"
    NOT_REPRODUCED = "not reproduced"


@dataclass(frozen=True)
class Account:
    """A reason for a difference, put so that it can fail: the range in which the printed value must lie if it holds.

    Parameters
    ----------
    reason : str
        What was done otherwise, in words.
    low, high : float
        The least and the largest value that follows from it, in the printed unit.
    """

    reason: str
    low: float
    high: float

    def contains(self, printed: Printed) -> bool:
        """Does the printed value lie in the range, as it stands?"""
        return self.low <= printed.value <= self.high

    def holds(self, printed: Printed) -> bool:
        """Does the printed value, as far as its digits tell, lie in the range?"""
        return self.low - printed.half <= printed.value <= self.high + printed.half


@dataclass(frozen=True)
class Row:
    """A printed value beside the computed one.

    Parameters
    ----------
    printed : Printed
        What the paper prints.
    computed : float
        What is computed now, in the printed unit.
    by : str
        What computed it: a law, a treatment, or other printed values.
    tolerance : float, optional
        How far the computed value may be off [printed unit]; by default half a unit of the last digit printed.
    accounts : tuple of Account
        Reasons for a difference; the first that holds counts.
    otherwise : str
        What is to be said if none holds.
    fitted : bool
        Was the model fitted to the printed value, so that it proves nothing?
    digits : int
        How many digits of the computed value are shown at most: fewer of what depends on a mesh.

    Examples
    --------
    >>> from vibroimpact.paper.printed import printed
    >>> Row(printed("type1.rebound_height"), 2.411319, by="a calculation").verdict.value
    'reproduced'
    """

    printed: Printed
    computed: float
    by: str
    tolerance: float | None = None
    accounts: tuple[Account, ...] = ()
    otherwise: str = ""
    fitted: bool = False
    digits: int = 13

    @property
    def allowed(self) -> float:
        """How far the computed value may be off [printed unit]."""
        return self.printed.half if self.tolerance is None else self.tolerance

    @property
    def difference(self) -> float:
        """Computed less printed, as a part of the printed value."""
        return self.computed / self.printed.value - 1.0 if self.printed.value else math.nan

    @property
    def account(self) -> Account | None:
        """The reason that holds, if one is needed."""
        return next((account for account in self.accounts if account.holds(self.printed)), None) if not self._agrees else None

    @property
    def reason(self) -> str:
        """Why it is not reproduced; empty if it is, or was fitted."""
        if self.verdict in (Verdict.REPRODUCED, Verdict.FITTED):
            return ""
        return self.account.reason if self.account else self.otherwise

    @property
    def verdict(self) -> Verdict:
        """What the difference means."""
        if self.fitted:
            return Verdict.FITTED
        if self._agrees:
            return Verdict.REPRODUCED
        return Verdict.EXPLAINED if self.account else Verdict.NOT_REPRODUCED

    @property
    def _agrees(self) -> bool:
        if self.printed.relation == "<":
            return self.computed < self.printed.value
        if self.printed.relation == ">":
            return self.computed > self.printed.value
        # a part in 1e9 of the allowance for the rounding of binary numbers
        return abs(self.computed - self.printed.value) <= self.allowed * (1.0 + 1e-9)
