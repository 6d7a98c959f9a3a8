"""What a calibration found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fitting import Fit
from vibroimpact.calibration.observations import Observations
from vibroimpact.calibration.overlay import Overlay
from vibroimpact.dynamics.problem import Problem
from vibroimpact.ranges import Range


@dataclass(frozen=True)
class Calibration:
    """What a calibration found.

    Parameters
    ----------
    problem : Problem
        The drop with its contact law as it was given.
    parameter, unit : str
        What was tuned.
    allowed : Range
        Of what was tuned.
    weights : mapping of str to float
        What was matched, by the names of `MATCHABLE`.
    observations : Observations
        The impacts that were matched: approach speeds and what was wanted.
    values : array, shape (n,)
        The value with which each comes out as wanted; the end of the range where noise puts it out of reach.
    intervals : array, shape (n, 2), optional
        Between which each value lies; None where nothing tells.
    outcomes : mapping of str to array, shape (n,)
        What the impacts are like with these values.
    given : array, shape (n,)
        The values as the problem gives them.
    as_given : mapping of str to array, shape (n,)
        What the impacts are like with those.
    others : mapping of str to float
        Values of other parameters of the law that would meet the first impact instead, the rest as given; none if it is met so.
    fit : Fit
        The value as a function of the approach speed.
    curve : tuple of two arrays, optional
        Approach speeds [m/s] and the exact value at each.
    impacts : tuple of two arrays
        Approach speed [m/s] and value of each impact of the drop.
    drops : mapping of str to mapping
        Impact tables of the drop: "target", where that can be simulated, and with the value "constant", "variable" from
        impact to impact, and by the fitted "function".
    confidence : float
        Of the intervals.
    bootstrap : int
        How many measurements were drawn again for them; 0 if they are of first order.
    overlays : tuple of Overlay
        What was recorded beside what is simulated with the values found; none where no record was given.
    doubts : tuple of str
        What to doubt of it.
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
