"""Figures of a study with many axes: one result over each axis, as a percentile band (grid) or as points (sampling designs)."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibroimpact.arrays import Floats
from vibroimpact.report.style import ACCENT, INK, MARK
from vibroimpact.studies.percentiles import PERCENTILES
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.labels import BAND
from vibroimpact.studies.report.outputs import Output, on_grid, sampled_output, sampled_places
from vibroimpact.studies.report.panels import add_legend, panels, same_heights, scale_vertical, title_of
from vibroimpact.studies.report.ticks import Ticks, ascending_order
from vibroimpact.studies.study import Study

MOST_AXES = 8
"""Maximum number of axes drawn."""

MOST_POINTS = 1500
"""Maximum number of drops drawn as points; more would overlap."""

_BANDED = 100_000  # maximum number of drops for the medians
_BINS, _FULL = 12, 15  # bins of the medians, and the minimum number of drops in one
_LEVELS = 200  # maximum number of levels drawn of an axis of a grid
_MANY = 200  # drops above which marks are small
_PARTS = np.array([PERCENTILES[0], 50, PERCENTILES[-1]]) / 100.0


def draw_bands(study: Study, axes: list[StudyAxis], output: Output) -> Figure:
    """Draw a result on a grid over each axis: median and 5 to 95 % band over all other axes."""
    axes = axes[:MOST_AXES]
    ticks = [Ticks(axis) for axis in axes]
    values = on_grid(study, output.name)
    figure, panel = panels([one.turned for one in ticks], legend=True)
    for number, (one, axis) in enumerate(zip(ticks, axes, strict=True)):
        order = ascending_order(axis, _LEVELS)
        bands = np.array([_quantiles(values[(slice(None),) * number + (level,)]) for level in order])
        _draw_band(panel[number], one, one.places(axis.values[order]), bands / output.scale.size)
    _finish(figure, panel, ticks, output)
    return figure


def draw_points(study: Study, axes: list[StudyAxis], output: Output) -> Figure:
    """Draw a result of sampled points over each axis: points of a subset of drops, and median and band of a larger one."""
    axes = [axis for axis in axes if axis.varies][:MOST_AXES]
    ticks = [Ticks(axis) for axis in axes]
    values = sampled_output(study, output.name, _BANDED) / output.scale.size
    figure, panel = panels([one.turned for one in ticks], legend=True)
    for one, axis, here in zip(ticks, axes, panel, strict=True):
        places = one.places(axis.values[sampled_places(study, _BANDED)])
        finite = np.isfinite(values)
        if finite.sum() > 20 * _FULL:
            _draw_band(here, one, *_in_bins(places[finite], values[finite], one))
        few = slice(None, None, math.ceil(len(values) / MOST_POINTS)) if study.design == "zip" else slice(0, MOST_POINTS)
        spread = _offsets(len(places[few])) if one.names else 0.0
        here.plot(
            places[few] + spread,
            values[few],
            ".",
            color=MARK,
            alpha=0.5 if len(values) > _MANY else 1.0,
            markersize=2.5 if len(values) > _MANY else 8.0,
            markeredgewidth=0.0,
            label="a drop",
            rasterized=True,
            zorder=1.5,
        )
    _finish(figure, panel, ticks, output, enlarged=3.0 if len(values) > _MANY else 1.0)
    return figure


def _draw_band(axes: Axes, ticks: Ticks, places: Floats, bands: Floats) -> None:
    low, middle, high = bands.T
    if ticks.names or len(places) == 1:
        axes.vlines(places, low, high, color=ACCENT, alpha=0.4, linewidth=4.0, label=BAND)
        axes.plot(places, middle, "o", color=INK, markersize=4.0, label="median")
        return
    axes.fill_between(places, low, high, color=ACCENT, alpha=0.22, linewidth=0.0, label=BAND)
    axes.plot(places, middle, color=INK, marker="o" if len(places) <= 40 else "", markersize=3.0, label="median", zorder=2.5)


def _finish(figure: Figure, panel: list[Axes], ticks: list[Ticks], output: Output, enlarged: float = 1.0) -> None:
    for number, (one, axes) in enumerate(zip(ticks, panel, strict=True)):
        if number == 0:
            axes.set_title(title_of(output))
        scale_vertical(axes, output)
        one.set_on(axes)
        axes.set_xlabel(one.label)
    same_heights(panel)
    add_legend(figure, panel[0], enlarged)


def _quantiles(values: Floats) -> Floats:
    finite = values[np.isfinite(values)]
    return np.quantile(finite, _PARTS) if len(finite) else np.full(len(_PARTS), np.nan)


def _in_bins(places: Floats, values: Floats, ticks: Ticks) -> tuple[Floats, Floats]:
    """Return bin centres along an axis, with equal numbers of drops per bin, or its names, and the band in each bin."""
    found = np.unique(places)
    if ticks.names or len(found) <= _BINS:  # a list of values: a bin would mix them
        return found, np.array([_quantiles(values[places == place]) for place in found])
    order = np.argsort(places, kind="stable")
    groups = [group for group in np.array_split(order, min(_BINS, len(order) // _FULL)) if len(group)]
    middles = np.array([float(np.median(places[group])) for group in groups])
    return middles, np.array([_quantiles(values[group]) for group in groups])


def _offsets(number: int) -> Floats:
    """Return offsets that separate points of the same name: a deterministic sequence by the golden ratio."""
    return np.asarray(0.5 * ((np.arange(number) * 0.6180339887498949) % 1.0 - 0.5), dtype=np.float64)
