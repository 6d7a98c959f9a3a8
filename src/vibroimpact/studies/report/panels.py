"""Layout and scales of the panels in the figures of a study."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibroimpact.report.layout import new_figure, row_of_axes, wide_axes
from vibroimpact.report.style import lettering
from vibroimpact.studies.report.labels import with_unit
from vibroimpact.studies.report.outputs import Output
from vibroimpact.studies.report.ticks import plain_log_ticks

_HEIGHT, _WIDE_HEIGHT = 1.9, 3.0
_BETWEEN = 0.85  # distance of rows, for a title, tick labels and an axis label [in]
_TURNED = 0.45  # additional distance for rotated names [in]
_FACTORS = 30.0  # ratio of the 95th to the 5th percentile above which the scale is logarithmic


def panels(turned: Sequence[bool], *, legend: bool = False) -> tuple[Figure, list[Axes]]:
    """Return a figure with panels, two per row from the top; a single panel has the full width.

    Parameters
    ----------
    turned : sequence of bool
        For each panel, whether the names below it are rotated and need more space.
    legend : bool, default False
        Whether to leave space for a legend below all panels.
    """
    height = _HEIGHT if len(turned) > 1 else _WIDE_HEIGHT
    rooms = [_TURNED * any(turned[first : first + 2]) for first in range(0, len(turned), 2)]
    foot = 0.5 + 0.35 * legend
    bottoms = [foot + sum(rooms[row:]) + (len(rooms) - 1 - row) * (height + _BETWEEN) for row in range(len(rooms))]
    figure = new_figure(bottoms[0] + height + 0.35)
    if len(turned) == 1:
        return figure, [wide_axes(figure, bottoms[0], height)]
    found = [axes for bottom in bottoms for axes in row_of_axes(figure, 2, bottom, height)]
    for axes in found[len(turned) :]:
        axes.remove()
    return figure, found[: len(turned)]


def add_legend(figure: Figure, axes: Axes, enlarged: float = 1.0) -> None:
    """Add the legend of one panel below all panels, with marks scaled by a factor."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=6, handlelength=3.0, columnspacing=1.4, markerscale=enlarged)


def title_of(output: Output) -> str:
    """Return the title of a panel: the result with its unit."""
    return with_unit(lettering(output.title), output.scale.unit)


def is_log(output: Output) -> bool:
    """Return whether a result is shown on a logarithmic scale, as it spans a large ratio."""
    low, high = output.spread.percentiles[0], output.spread.percentiles[-1]
    return low > 0.0 and high > _FACTORS * low


def scale_vertical(axes: Axes, output: Output) -> None:
    """Set the scale of the vertical axis after drawing."""
    if is_log(output):
        axes.set_yscale("log")
        plain_log_ticks(axes.yaxis)


def same_heights(some: list[Axes]) -> None:
    """Give all panels common vertical limits."""
    limits: list[Any] = [axes.get_ylim() for axes in some]
    for axes in some:
        axes.set_ylim(min(low for low, _ in limits), max(high for _, high in limits))
