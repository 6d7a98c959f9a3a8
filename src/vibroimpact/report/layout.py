"""Figure layout on a common grid in inches; fixed positions avoid the cost of automatic layout."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import blended_transform_factory

WIDTH = 8.0
"""Width of every figure [in]."""

_LEFT, _RIGHT, _BETWEEN = 0.8, 7.8, 0.46
"""Left and right edges of the axes, and the gap between neighbouring axes for tick labels [in]."""

_LABEL = 0.18
"""Distance of vertical axis labels from the left edge [in]."""


def new_figure(height: float) -> Figure:
    """Return a figure of common width and given height [in]."""
    return Figure(figsize=(WIDTH, height))


def wide_axes(figure: Figure, bottom: float, height: float) -> Axes:
    """Return axes over the full width, `bottom` above the lower edge of the figure [in]."""
    return row_of_axes(figure, 1, bottom, height)[0]


def row_of_axes(figure: Figure, count: int, bottom: float, height: float) -> list[Axes]:
    """Return axes in a row, `bottom` above the lower edge of the figure [in]."""
    total = figure.get_figheight()
    width = (_RIGHT - _LEFT - (count - 1) * _BETWEEN) / count
    lefts = [_LEFT + number * (width + _BETWEEN) for number in range(count)]
    return [figure.add_axes((left / WIDTH, bottom / total, width / WIDTH, height / total)) for left in lefts]


def label_vertical(axes: Axes, label: str) -> None:
    """Label the vertical axis, at the position common to all figures."""
    axes.set_ylabel(label)
    figure = axes.get_figure(root=True)
    assert figure is not None
    axes.yaxis.set_label_coords(_LABEL / WIDTH, 0.5, transform=blended_transform_factory(figure.transFigure, axes.transAxes))


def heading(figure: Figure, text: str, bottom: float) -> None:
    """Write a heading over a row of axes, aligned with their left edge."""
    figure.text(_LEFT / WIDTH, bottom / figure.get_figheight(), text, fontsize=9.5, va="bottom")
