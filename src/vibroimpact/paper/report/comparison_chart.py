"""A quantity over time, beside printed values: a row of curves for each treatment, and
each impact as a view.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Panel
from vibroimpact.charts.marks import Label, Level, Mark
from vibroimpact.dynamics.response import Response
from vibroimpact.paper.report.compared_quantity import ComparedQuantity
from vibroimpact.paper.report.impact_views import impact_views, response_line

_MARK_DISTANCE = 0.35
"""Largest distance of a printed value from the curves at which it is shown, relative to
their range.
"""
_LABEL_DISTANCE = 0.1
"""Distance below which printed values share a label, relative to the range shown."""


class ResponseLine(NamedTuple):
    """A curve in a row: its label, its role, and the response that it shows."""

    name: str
    role: str
    response: Response


def comparison_rows(
    shown: ComparedQuantity,
    rows: Mapping[str, Sequence[ResponseLine]],
    marks: Mapping[str, float],
    window: Callable[[int], tuple[float, float]],
) -> tuple[tuple[Panel, ...], ...]:
    """Return the rows of the chart of a quantity, with a common scale.

    Parameters
    ----------
    shown : ComparedQuantity
        The quantity.
    rows : mapping of str to sequence of ResponseLine
        Curves of each row, by row title.
    marks : mapping of str to float
        Printed values [SI], by what has them: a type, or "".
    window : callable
        Function of an impact, counted from 0, that returns the times shown before and after its
        first touch [s].
    """
    all_lines = [line for lines in rows.values() for line in lines]
    views = impact_views([line.response for line in all_lines], window)
    time = Axis("Time", "s", views=views)
    value = Axis(shown.short, shown.unit)
    # a response that is in every row is read once
    curves = {
        line: response_line(shown.timeline, line.response, views, line.name, line.role)
        for line in dict.fromkeys(all_lines)
    }
    levels = _levels(shown, marks, np.concatenate([curve.y for curve in curves.values()]))
    panels = []
    for title, lines in rows.items():
        drawn: list[Mark] = [*(curves[line] for line in lines), *levels]
        if not any(np.any(curves[line].y) for line in lines):
            drawn.append(Label(0.5, 0.4, "zero", corner=True))
        panels.append((Panel(time, value, tuple(drawn), title),))
    return tuple(panels)


def _levels(shown: ComparedQuantity, marks: Mapping[str, float], values: Floats) -> list[Level]:
    """Return the printed values that do not lie far from the curves, which they would
    flatten; neighbouring ones share a label.
    """
    low = float(np.nanmin(values))
    high = float(np.nanmax(values))
    reach = np.inf  # a level curve can't be flattened
    if high > low:
        reach = _MARK_DISTANCE * (high - low)
    signed = [(sign * value, kind) for kind, value in marks.items() for sign in shown.signs]
    near = sorted(mark for mark in signed if low - reach <= mark[0] <= high + reach)
    shown_values = [low, high, *(level for level, _ in near)]
    span = max(shown_values) - min(shown_values)
    groups: list[list[tuple[float, str]]] = []
    for level, kind in near:
        if groups and level - groups[-1][-1][0] < _LABEL_DISTANCE * span:
            groups[-1].append((level, kind))
        else:
            groups.append([(level, kind)])
    levels = []
    for group in groups:
        # the highest of the neighbours has the label, which stands above it
        highest = group[-1][0]
        label = _label([kind for _, kind in group])
        for level, _ in group:
            shown_label = label if level == highest else ""
            levels.append(Level(level, "printed", "dotted", label=shown_label))
    return levels


def _label(kinds: Sequence[str]) -> str:
    names = sorted(kind for kind in kinds if kind)
    if not names:
        return ""
    noun = "Types" if len(names) > 1 else "Type"
    return f"{noun} {' and '.join(names)}"
