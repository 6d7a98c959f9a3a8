"""The looks of points of classes, which differ without colours too."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from vibroimpact.charts.marks import Points
from vibroimpact.charts.palette import LOOKS, MANY, of_class
from vibroimpact.charts.traces import points_trace


def luminance(colour: str) -> float:
    """Return the relative luminance of a colour (WCAG 2.2)."""
    channels = [int(colour[place : place + 2], 16) / 255.0 for place in (1, 3, 5)]
    linear = [
        channel / 12.92 if channel <= 0.04045 else ((channel + 0.055) / 1.055) ** 2.4
        for channel in channels
    ]
    return float(np.dot(linear, (0.2126, 0.7152, 0.0722)))


def test_classes_differ_in_symbols_and_the_first_two_in_luminance() -> None:
    looks = [LOOKS[of_class(number)] for number in range(7)]
    for first, second in combinations(looks, 2):
        assert first.symbol != second.symbol
    # as on paper; the contrast of WCAG
    shades = [luminance(look.light) + 0.05 for look in looks[:2]]
    assert max(shades) / min(shades) > 3.0


def test_symbols_of_classes_are_seen_where_there_are_many_points() -> None:
    many = np.arange(MANY + 1.0)
    sizes = {role: points_trace(Points(many, many, role, role)) for role in ("mark", of_class(1))}
    assert sizes["mark"]["marker"]["size"] == 4.0
    assert sizes[of_class(1)]["marker"]["size"] > 5.0
    assert sizes[of_class(1)]["marker"]["symbol"] == "triangle-up"
