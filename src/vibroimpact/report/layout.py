"""Where axes go on a figure, in inches: all figures share one grid, and none is searched for when it is drawn."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import blended_transform_factory

WIDTH = 8.0
"""Width of every figure [in]."""

_LEFT, _RIGHT, _BETWEEN = 0.8, 7.8, 0.46
"""Edges of the axes, and the room between two side by side, where tick labels go [in]."""

_LABEL = 0.18
"""Where the vertical axes have their labels, from the left edge [in]."""


def new_figure(height: float) -> Figure:
    """Return a figure of common width and a height [in]."""
    return Figure(figsize=(WIDTH, height))


def wide_axes(figure: Figure, bottom: float, height: float) -> Axes:
    """Return axes across the figure, `bottom` above its lower edge [in]."""
    return row_of_axes(figure, 1, bottom, height)[0]


def row_of_axes(figure: Figure, count: int, bottom: float, height: float) -> list[Axes]:
    """Return axes side by side, `bottom` above the figure's lower edge [in]."""
    total = figure.get_figheight()
    width = (_RIGHT - _LEFT - (count - 1) * _BETWEEN) / count
    lefts = [_LEFT + number * (width + _BETWEEN) for number in range(count)]
    return [figure.add_axes((left / WIDTH, bottom / total, width / WIDTH, height / total)) for left in lefts]


def label_vertical(axes: Axes, label: str) -> None:
    """Label the vertical axis at the place that all figures have for it."""
    axes.set_ylabel(label)
    figure = axes.get_figure(root=True)
    assert figure is not None
    axes.yaxis.set_label_coords(_LABEL / WIDTH, 0.5, transform=blended_transform_factory(figure.transFigure, axes.transAxes))


def heading(figure: Figure, text: str, bottom: float) -> None:
    """Write a heading, flush with the axes, over a row of axes."""
    figure.text(_LEFT / WIDTH, bottom / figure.get_figheight(), text, fontsize=9.5, va="bottom")
