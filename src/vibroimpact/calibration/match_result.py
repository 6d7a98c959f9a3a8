"""What either way of matching finds: the values of the impacts, and the polynomial of the approach speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fitting import Fit, distinct
from vibroimpact.calibration.observations import Observations


class Matched(NamedTuple):
    """Impacts that were matched, the value of each, and what is told of both; as `Calibration` has them."""

    seen: Observations
    values: Floats
    fit: Fit
    intervals: Floats | None = None
    curve: tuple[Floats, Floats] | None = None
    draws: int = 0
    doubts: Sequence[str] = ()


def degree_of(speeds: Floats, degree: int | None) -> int:
    """Return the degree asked for; else 2, or less where there are fewer speeds."""
    return min(2, distinct(speeds) - 1) if degree is None else degree
