"""Bounces of a sphere in air or a liquid, compared with their integration by SciPy."""

from __future__ import annotations

from collections.abc import Mapping

from agreement import Against, Agrees
from oracles.bouncing_in_air import Bounces
from vibroimpact.arrays import Floats


def agrees_on_bounces(
    agrees: Agrees,
    case: str,
    impacts: Mapping[str, Floats],
    heights: Floats,
    seen: Bounces,
    against: Against,
) -> None:
    """Compare times and approach speeds of impacts, and heights of rebound, to 1e-8."""
    count = len(impacts["time_s"])
    for quantity, ours, theirs, unit in (
        ("time of impact", impacts["time_s"], seen.touches, "s"),
        ("approach speed", impacts["approach_speed_m_s"], seen.before, "m/s"),
        ("rebound height", heights, seen.tops, "m"),
    ):
        agrees(case, quantity, ours, theirs[:count], unit=unit, against=against, relative=1e-8)
