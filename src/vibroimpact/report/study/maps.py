"""The figure of a study with two axes or more: maps of the results over two of them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from vibroimpact.report.excerpt import Floats
from vibroimpact.report.layout import WIDTH, label_vertical
from vibroimpact.report.study.axes import StudyAxis, Ticks, plain_log_ticks
from vibroimpact.report.study.outputs import Output, on_grid
from vibroimpact.report.study.panels import is_log, panels, scale_of, title_of
from vibroimpact.storage.study import Study

_MOST = 400  # levels of an axis that are drawn; a figure has few more pixels
_LETTERS = 29  # of a label that has room beside a panel
_BAR, _GAP, _LABELS = 0.1, 0.08, 0.5  # of the colour bar: width, distance, room for its numbers [in]


def draw_maps(study: Study, axes: list[StudyAxis], outputs: list[Output], shown: tuple[int, int]) -> Figure:
    """Draw maps of results.

    Parameters
    ----------
    study : Study
        On a grid.
    axes : list of StudyAxis
        Those with several levels.
    outputs : list of Output
        What is drawn.
    shown : tuple of int
        The two axes of the maps; over the others, the median is drawn.
    """
    across, up = shown
    if not axes[up].numeric and axes[across].numeric:  # names have more room below
        across, up = up, across
    ticks = [Ticks(axes[place]) for place in (across, up)]
    orders = [_order(one, axes[place]) for one, place in zip(ticks, (across, up), strict=True)]
    figure, some = panels([ticks[0].turned] * len(outputs))
    for number, (panel, output) in enumerate(zip(some, outputs, strict=True)):
        values = _medians(on_grid(study, output.name), across, up)[np.ix_(*orders)] / scale_of(output).size
        edges = [_edges(one.places(axes[p].values)[o], one) for one, p, o in zip(ticks, (across, up), orders, strict=True)]
        _draw(figure, panel, edges, values, is_log(output))
        panel.set_title(title_of(output))
        ticks[0].set_on(panel, "x")
        ticks[1].set_on(panel, "y")
        panel.grid(False)
        if number + 2 >= len(outputs):
            panel.set_xlabel(ticks[0].label)
        if number % 2:
            panel.tick_params(labelleft=False)
        else:
            label_vertical(panel, ticks[1].label)
            panel.yaxis.label.set_fontsize(min(9.0, 9.0 * _LETTERS / len(ticks[1].label)))
    return figure


def _draw(figure: Figure, panel: Axes, edges: list[Floats], values: Floats, log: bool) -> None:
    """Draw one map and its colour bar; what failed is hatched."""
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
    """Return a result over two axes of the grid: its median over the others."""
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


def _order(ticks: Ticks, axis: StudyAxis) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    order = np.argsort(ticks.places(axis.values), kind="stable")
    return order[:: -(-len(order) // _MOST)]


def _edges(places: Floats, ticks: Ticks) -> Floats:
    """Return the edges of cells: half way between levels, on a logarithmic scale by factors."""
    if ticks.is_log:
        return np.asarray(np.exp(_halves(np.log(places))))
    return _halves(places)


def _halves(places: Floats) -> Floats:
    middles = 0.5 * (places[1:] + places[:-1])
    return np.concatenate([[2.0 * places[0] - middles[0]], middles, [2.0 * places[-1] - middles[-1]]])
