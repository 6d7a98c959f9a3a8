"""The elements of a section of the reproduction: compared values with computed verdicts,
tables and paragraphs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from vibroimpact.paper.printed import PrintedValue


class Kind(Enum):
    """What a comparison of a printed with a computed value can show, by what the computed
    value is made of.
    """

    RESULT = "result"
    """Computed from the inputs, and from what was assumed or inferred from other printed
    numbers; the printed value was not used.
    """

    INFERRED = "inferred"
    """A printed value from which the restitution or the full-damping penetration was
    inferred, or that penetration itself.
    """

    FITTED_MODEL = "fitted model"
    """Computed by a model with parameters that were fitted to printed results of Type 2."""

    ARITHMETIC = "arithmetic"
    """Calculated from other printed results: the paper is compared with itself."""

    INPUT = "input"
    """An input of the paper, compared with that of the shipped case."""


class Verdict(Enum):
    """Verdict on the difference between a printed and a computed value."""

    REPRODUCED = "reproduced"
    EXPLAINED = "explained"
    FITTED = "fitted"
    NOT_REPRODUCED = "not reproduced"


@dataclass(frozen=True)
class Explanation:
    """An explanation of a difference: the range in which the printed value must lie.

    Parameters
    ----------
    reason : str
        The cause of the difference.
    low, high : float
        Smallest and largest value that the cause allows, in the printed unit.
    """

    reason: str
    low: float
    high: float

    def contains(self, printed: PrintedValue) -> bool:
        """Whether the printed value itself lies in the range."""
        return self.low <= printed.value <= self.high

    def holds(self, printed: PrintedValue) -> bool:
        """Whether the printed value lies in the range within its rounding error."""
        return self.low - printed.half <= printed.value <= self.high + printed.half


@dataclass(frozen=True)
class ComparedValue:
    """A printed value and the computed one.

    Parameters
    ----------
    printed : PrintedValue
        The printed value.
    computed : float
        The computed value, in the printed unit.
    by : str
        Origin of the computed value: a law, a treatment, or other printed values.
    tolerance : float, optional
        Allowed difference [printed unit]; by default half a unit of the last digit printed.
    explanations : tuple of Explanation
        Possible explanations of a difference; the first that holds is used.
    otherwise : str
        Remark for a difference that no explanation covers.
    fitted : bool
        Whether the model was fitted to the printed value, so that agreement is no evidence.
    digits : int
        Most significant digits shown of the computed value; fewer for values that depend on a mesh.
    made_by : Kind, optional
        `Kind.FITTED_MODEL` or `Kind.ARITHMETIC`, where the computed value is made so; by default
        the role of the printed value decides.

    Examples
    --------
    >>> from vibroimpact.paper.printed import printed
    >>> ComparedValue(printed("type1.rebound_height"), 2.411319, by="a calculation").verdict.value
    'reproduced'
    """

    printed: PrintedValue
    computed: float
    by: str
    tolerance: float | None = None
    explanations: tuple[Explanation, ...] = ()
    otherwise: str = ""
    fitted: bool = False
    digits: int = 13
    made_by: Kind | None = None

    @property
    def kind(self) -> Kind:
        """What the comparison can show."""
        return self.made_by or Kind(self.printed.role)

    @property
    def allowed(self) -> float:
        """Allowed difference [printed unit]."""
        if self.tolerance is None:
            return self.printed.half
        return self.tolerance

    @property
    def difference(self) -> float:
        """Relative difference, computed less printed; NaN if the printed value is zero."""
        if not self.printed.value:
            return math.nan
        return self.computed / self.printed.value - 1.0

    @property
    def explanation(self) -> Explanation | None:
        """The first explanation that holds; None if none does, or the values agree."""
        if self._agrees:
            return None
        return next(
            (explanation for explanation in self.explanations if explanation.holds(self.printed)),
            None,
        )

    @property
    def reason(self) -> str:
        """Reason why the value is not reproduced; empty if it is reproduced or fitted."""
        if self.verdict in (Verdict.REPRODUCED, Verdict.FITTED):
            return ""
        if self.explanation is None:
            return self.otherwise
        return self.explanation.reason

    @property
    def verdict(self) -> Verdict:
        """Verdict on the difference."""
        if self.fitted:
            return Verdict.FITTED
        if self._agrees:
            return Verdict.REPRODUCED
        if self.explanation is None:
            return Verdict.NOT_REPRODUCED
        return Verdict.EXPLAINED

    @property
    def _agrees(self) -> bool:
        if self.printed.relation == "<":
            return self.computed < self.printed.value
        if self.printed.relation == ">":
            return self.computed > self.printed.value
        # the margin of 1e-9 covers the binary rounding of a computed value that lies on the bound
        return abs(self.computed - self.printed.value) <= self.allowed * (1.0 + 1e-9)


@dataclass(frozen=True)
class TextTable:
    """A table of text cells, for results without a printed counterpart.

    Parameters
    ----------
    headers : tuple of str
        Column headings, with units in brackets.
    cells : tuple of tuples of str
        The rows.
    title : str
        Title of the table.
    """

    headers: tuple[str, ...]
    cells: tuple[tuple[str, ...], ...]
    title: str = ""


def holds_text(holds: bool) -> str:
    """Return "holds" or "does not hold", for a statement of the paper."""
    return "holds" if holds else "does not hold"


@dataclass(frozen=True)
class ReportSection:
    """A section of the reproduction.

    Parameters
    ----------
    title : str
        Heading.
    paragraphs : tuple of str
        Paragraphs before the tables.
    rows : tuple of ComparedValue
        Rows of the table of printed and computed values.
    tables : tuple of TextTable
        Further tables.
    conclusion : tuple of str
        Paragraphs after the tables.
    """

    title: str
    paragraphs: tuple[str, ...] = ()
    rows: tuple[ComparedValue, ...] = ()
    tables: tuple[TextTable, ...] = ()
    conclusion: tuple[str, ...] = ()
