"""The result of a calibration."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.fitting import Fit
from vibroimpact.calibration.fit.overlay import Overlay
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.cases.case import Case
from vibroimpact.cases.reader import case_of
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.ranges import Range
from vibroimpact.report.reported import Reported

DAMPINGS = ("sphere.damping", "plate.damping")
"""Modal dampings that can be calibrated, by their keys in a case."""


@dataclass(frozen=True)
class Calibration(Reported, reported_in="vibroimpact.calibration.report"):
    """The result of a calibration.

    Parameters
    ----------
    problem : Problem
        The drop with its contact law as given.
    parameter, unit : str
        Name and unit of the tuned parameter.
    allowed : Range
        Allowed range of the parameter.
    weights : mapping of str to float
        Weights of the matched quantities, by the names of `MATCHABLE`.
    observations : Observations
        The matched impacts: approach speeds and target values.
    values : array, shape (n,)
        The parameter value that matches each impact; the nearest end of the range where noise puts
        the target out of reach.
    intervals : array, shape (n, 2), optional
        Confidence interval of each value; None for an exact target, or if it cannot be estimated.
    outcomes : mapping of str to array, shape (n,)
        Quantities of the impacts computed with these values.
    given : array, shape (n,)
        The values given by the problem; NaN where it gives none.
    as_given : mapping of str to array, shape (n,)
        Quantities of the impacts computed with the given values; empty where there are none.
    others : mapping of str to float
        Values of other parameters of the law that would each match the first impact, the rest as
        given; empty unless the given values miss the target.
    fit : Fit
        The polynomial of the approach speed.
    curve : tuple of two arrays, optional
        Approach speeds [m/s], and the exact value at each.
    impacts : tuple of two arrays
        Approach speed [m/s] and value of each impact of the drop.
    drops : mapping of str to mapping
        Impact tables of the drop: "target", where that can be simulated; "constant" with the value
        of the first impact, "variable" with the value of each impact, and "function" with the
        fitted polynomial.
    confidence : float
        Confidence level of the intervals.
    bootstrap : int
        Number of bootstrap samples; 0 if the intervals are of first order.
    overlays : tuple of Overlay
        The measured record and its simulation with the values found; empty if no record was given.
    doubts : tuple of str
        Warnings about the validity of the result, as sentences.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> found = vi.calibration.calibrate(
    ...     vi.load_case("paper:type1-constant"), vi.load_case("paper:type1-theory")
    ... )
    >>> found.parameter, found.unit, found.values.round(1).tolist()
    ('damping_max', 'N s/m', [179.8, 172.7, 166.4, 160.9, 156.7])
    """

    problem: Problem = field(repr=False)
    parameter: str
    unit: str
    allowed: Range = field(repr=False)
    weights: Mapping[str, float]
    observations: Observations = field(repr=False)
    values: Floats
    intervals: Floats | None
    outcomes: Mapping[str, Floats] = field(repr=False)
    given: Floats
    as_given: Mapping[str, Floats] = field(repr=False)
    others: Mapping[str, float]
    fit: Fit
    curve: tuple[Floats, Floats] | None = field(repr=False)
    impacts: tuple[Floats, Floats]
    drops: Mapping[str, Mapping[str, Floats]] = field(repr=False)
    confidence: float
    bootstrap: int
    overlays: tuple[Overlay, ...] = field(repr=False)
    doubts: tuple[str, ...]

    @property
    def calibrated_case(self) -> Case:
        """The case with the calibrated values, ready to run.

        There is one value per impact for a parameter of a law, and one for modal damping.

        Raises
        ------
        InputError
            If the drop was stated in Python, and has no case.

        Examples
        --------
        >>> import vibroimpact as vi
        >>> task = vi.calibration.load_calibration("paper:type1-theory")
        >>> problem = vi.calibration.calibrate_case(task).calibrated_case.to_problem()
        >>> len(problem.laws), round(problem.laws[0].damping_max, 3)
        (5, 179.79)
        """
        table = sections_of_case(self.problem)
        values = self.impacts[1].tolist()
        if self.parameter in DAMPINGS:
            body = self.parameter.partition(".")[0]
            return case_of({**table, body: {**table[body], "damping": values[0]}})
        return case_of({**table, "contact": {**table["contact"], self.parameter: values}})


def sections_of_case(problem: Problem) -> dict[str, Any]:
    """Return the sections of the case of a drop but [calibrate].

    Raises
    ------
    InputError
        If the drop was stated in Python, and has no case.
    """
    if not problem.source:
        raise InputError(
            "the drop was stated in Python and has no case; vi.load_case and vi.case_of return "
            "one, which calibrate takes as well"
        )
    return {key: value for key, value in problem.source.items() if key != "calibrate"}


def case_name(problem: Problem) -> str:
    """Return the name of the case of a drop; empty if it has none."""
    if not problem.source:
        return ""
    return problem.source["name"]
