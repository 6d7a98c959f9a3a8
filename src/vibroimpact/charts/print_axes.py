"""Scale, range and ticks of the axes of a figure for print."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from vibroimpact.charts.axis import Axis
from vibroimpact.charts.frame import Frame, ends_of_range
from vibroimpact.charts.print_style import lettering


def set_axis(axes: Axes, side: str, axis: Axis, frame: Frame) -> None:
    """Set scale, range and ticks of an axis."""
    line = getattr(axes, f"{side}axis")
    set_limits = getattr(axes, f"set_{side}lim")
    if axis.log:
        getattr(axes, f"set_{side}scale")("log")
    if axis.names:
        line.set_ticks(range(len(axis.names)), [lettering(name, 30) for name in axis.names])
        set_limits(-0.6, len(axis.names) - 0.4)
        if side == "x" and sum(map(len, axis.names)) > 36:
            for text in line.get_ticklabels():
                text.set(rotation=20, ha="right", rotation_mode="anchor")
    if axis.range is not None:
        set_limits(*ends_of_range(axis, frame))
    if axis.log:
        plain_log(line)
    elif axis.ticks:
        line.set_ticks(frame.shown(np.array(axis.ticks)).tolist())
    elif not axis.names:
        line.set_major_locator(
            MaxNLocator(_numbers(axes, side), steps=[1, 2, 2.5, 5, 10], integer=axis.integer)
        )


def _numbers(axes: Axes, side: str) -> int:
    """Return how many numbers fit along an axis."""
    if side == "y":
        return 5
    place = axes.get_subplotspec()
    assert place is not None
    columns = place.get_gridspec().ncols // len(place.colspan)
    return {1: 7, 2: 6}.get(columns, 3)


def plain_log(line: Any) -> None:
    """Label a logarithmic axis at 1, 2 and 5 of each decade in plain notation, or only at
    the decades if there are many.
    """
    low, high = sorted(line.get_view_interval())
    decades = math.log10(high / low) if low > 0.0 else math.inf
    steps = (1.0, 2.0, 5.0) if decades < 2.2 else (1.0,)
    line.set_major_locator(LogLocator(10.0, subs=steps))
    if decades < 5.0:
        line.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.6g}"))
    line.set_minor_formatter(NullFormatter())
