"""Panels of the figures of a study: where they lie, and how results are scaled in them."""

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
_BETWEEN = 0.85  # rows: a title, tick labels and a label [in]
_TURNED = 0.45  # more, where names are turned [in]
_FACTORS = 30.0  # from the 5th to the 95th percentile; beyond, a logarithmic scale shows more


def panels(turned: Sequence[bool], *, legend: bool = False) -> tuple[Figure, list[Axes]]:
    """Return a figure with panels, two in a row, the first one at the top; one alone is as wide as the figure.

    Parameters
    ----------
    turned : sequence of bool
        For each panel, are there names below it that are turned, and need more room?
    legend : bool, default False
        Is there a legend below all?
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
    """Write the legend of one panel below all, its marks larger where they are small in the panel."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=6, handlelength=3.0, columnspacing=1.4, markerscale=enlarged)


def title_of(output: Output) -> str:
    """Return the title of a panel: the result and its unit."""
    return with_unit(lettering(output.title), output.scale.unit)


def is_log(output: Output) -> bool:
    """Does a result spread over so much that its logarithm shows more?"""
    low, high = output.spread.percentiles[0], output.spread.percentiles[-1]
    return low > 0.0 and high > _FACTORS * low


def scale_vertical(axes: Axes, output: Output) -> None:
    """Give the vertical axis its scale, once all is drawn."""
    if is_log(output):
        axes.set_yscale("log")
        plain_log_ticks(axes.yaxis)


def same_heights(some: list[Axes]) -> None:
    """Give panels the vertical limits of all of them together."""
    limits: list[Any] = [axes.get_ylim() for axes in some]
    for axes in some:
        axes.set_ylim(min(low for low, _ in limits), max(high for _, high in limits))
