"""Figure of a grid with two or more axes: maps of the results over two of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.report.layout import WIDTH, label_vertical
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.outputs import Output, on_grid
from vibroimpact.studies.report.panels import is_log, panels, title_of
from vibroimpact.studies.report.ticks import Ticks, ascending_order, plain_log_ticks
from vibroimpact.studies.study import Study

_MOST = 400  # maximum number of levels drawn along an axis, close to the resolution of a figure
_LETTERS = 29  # letters of a label that fit beside a panel
_BAR, _GAP, _LABELS = 0.1, 0.08, 0.5  # width and distance of the colour bar, and space for its numbers [in]


def draw_maps(study: Study, axes: list[StudyAxis], outputs: list[Output], shown: tuple[int, int]) -> Figure:
    """Draw maps of results over two axes.

    Parameters
    ----------
    study : Study
        A study on a grid.
    axes : list of StudyAxis
        Its axes with several levels.
    outputs : list of Output
        The results to draw.
    shown : tuple of int
        Indices of the two axes of the maps; the median is taken over the others.
    """
    across, up = shown
    if not axes[up].numeric and axes[across].numeric:  # names fit better below
        across, up = up, across
    below, beside = Ticks(axes[across]), Ticks(axes[up])
    levels = ascending_order(axes[across], _MOST), ascending_order(axes[up], _MOST)
    edges = _edges(below, axes[across].values[levels[0]]), _edges(beside, axes[up].values[levels[1]])
    figure, some = panels([below.turned] * len(outputs))
    for number, (panel, output) in enumerate(zip(some, outputs, strict=True)):
        values = _medians(on_grid(study, output.name), across, up)[np.ix_(*levels)] / output.scale.size
        _draw(figure, panel, edges, values, is_log(output))
        panel.set_title(title_of(output))
        below.set_on(panel, "x")
        beside.set_on(panel, "y")
        panel.grid(False)
        if number + 2 >= len(outputs):
            panel.set_xlabel(below.label)
        if number % 2:
            panel.tick_params(labelleft=False)
        else:
            label_vertical(panel, beside.label)
            panel.yaxis.label.set_fontsize(min(9.0, 9.0 * _LETTERS / len(beside.label)))
    return figure


def _draw(figure: Figure, panel: Axes, edges: tuple[Floats, Floats], values: Floats, log: bool) -> None:
    """Draw one map and its colour bar; cells without a value are hatched."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    norm = LogNorm(low, high) if log and low > 0.0 else Normalize(low, high)
    panel.patch.set(facecolor="#f2f2f2", edgecolor="#9a9a9a", hatch="xxxx")
    mesh = panel.pcolormesh(*edges, np.ma.masked_invalid(values.T), cmap="cividis", norm=norm, rasterized=True)
    place, width = panel.get_position(), figure.get_figwidth()
    panel.set_position((place.x0, place.y0, place.width - (_BAR + _GAP + _LABELS) / width, place.height))
    bar = figure.add_axes((place.x1 - (_BAR + _LABELS) / WIDTH, place.y0, _BAR / WIDTH, place.height))
    figure.colorbar(mesh, cax=bar)
    bar.grid(False)
    if isinstance(norm, LogNorm):
        plain_log_ticks(bar.yaxis)


def _medians(values: Floats, across: int, up: int) -> Floats:
    """Return the median of a result over all axes of the grid but two."""
    if values.ndim == 2:
        return values if across < up else values.T
    moved = np.moveaxis(values, (across, up), (0, 1))
    flat = moved.reshape(*moved.shape[:2], -1)
    found = np.full(flat.shape[:2], np.nan)
    for place in np.ndindex(*found.shape):
        here = flat[place]
        here = here[np.isfinite(here)]
        if len(here):
            found[place] = np.median(here)
    return found


def _edges(ticks: Ticks, levels: NDArray[Any]) -> Floats:
    """Return the edges of the cells: midpoints between levels, geometric ones on a logarithmic scale."""
    places = ticks.places(levels)
    return np.exp(_halves(np.log(places))) if ticks.is_log else _halves(places)


def _halves(places: Floats) -> Floats:
    middles = 0.5 * (places[1:] + places[:-1])
    return np.concatenate([[2.0 * places[0] - middles[0]], middles, [2.0 * places[-1] - middles[-1]]])
