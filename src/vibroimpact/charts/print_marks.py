"""The marks of a chart drawn by matplotlib."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, LogNorm, Normalize
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.contours import contours_of
from vibroimpact.charts.decimation import decimated
from vibroimpact.charts.frame import (
    Frame,
    ends_on,
    is_log,
)
from vibroimpact.charts.marks import (
    Arrow,
    Band,
    Bars,
    Facets,
    Label,
    Level,
    Line,
    Map,
    Mark,
    Outline,
    Points,
    Rug,
    Spans,
    Stack,
    cell_edges,
    stack_edges,
)
from vibroimpact.charts.palette import DIVERGING, LOOKS, MANY, SEQUENTIAL, SHADES, Look
from vibroimpact.charts.print_style import lettering

_SYMBOLS = {
    "circle": "o",
    "square": "s",
    "triangle-up": "^",
    "triangle-down": "v",
    "diamond": "D",
    "x": "x",
    "cross": "P",
}
_HATCHES = {
    "": "",
    "/": "////",
    "\\": "\\\\\\\\",
    "|": "||||",
    "-": "----",
    "x": "xxxx",
    ".": "....",
}
_HALO = [withStroke(linewidth=1.8, foreground="white", alpha=0.8)]
_STACK_POINTS = 220

_THINNEST = 1e-3
"""Width of the narrowest span drawn, relative to the axis.

A narrower one is less than a dot, seen or not as the dots fall.
"""

_MOST_SPANS = 60
"""Number of spans drawn."""

_LABEL_SIDES: dict[str, tuple[str, str, tuple[int, int]]] = {
    "left": ("left", "center", (5, 0)),
    "right": ("right", "center", (-5, 0)),
    "above": ("center", "bottom", (0, 4)),
    "below": ("center", "top", (0, -4)),
    "center": ("center", "center", (0, 0)),
}
"""Horizontal and vertical alignment of words, and their offset [pt], by their anchor."""


class PrintedMarks:
    """Draws the marks of a chart into axes, and keeps what the legend and the colour bars need.

    Parameters
    ----------
    chart : Chart
        The chart.
    frames : dict of Axis to Frame
        The frame of each of its axes.
    """

    def __init__(self, chart: Chart, frames: dict[Axis, Frame]) -> None:
        self.chart = chart
        self.frames = frames
        self.named: dict[tuple[str, str], Any] = {}
        self.scales: dict[Axis, tuple[Any, list[Axes]]] = {}

    def draw(
        self,
        axes: Axes,
        mark: Mark,
        panel: Panel,
        frames: tuple[Frame, Frame],
        inside: tuple[float, float],
    ) -> None:
        """Draw a mark of a panel in the frames of its axes.

        It is drawn as far as it lies inside a range of the horizontal one.
        """
        x, y = frames
        match mark:
            case Line():
                self._line(axes, mark, x, y, inside)
            case Points():
                self._points(axes, mark, x, y, inside)
            case Band():
                self._band(axes, mark, x, y)
            case Stack():
                self._stack(axes, mark, x, y, inside)
            case Bars():
                self._bars(axes, mark, x, y)
            case Map():
                self._map(axes, mark, panel, x, y)
            case Facets():
                self._facets(axes, mark, x, y)
            case Outline():
                self._outline(axes, mark, x, y)
            case Level():
                self._level(axes, mark, x, y)
            case Spans():
                if not np.isfinite(inside[0]):  # the whole of the axis, not a view
                    inside = ends_on(panel.x, self.chart)
                self._spans(axes, mark, x, inside)
            case Rug():
                self._rug(axes, mark, x)
            case Label():
                self._label(axes, mark, x, y)
            case Arrow():
                self._arrow(axes, mark, x, y)

    def _name(self, mark: Any, artist: Any) -> None:
        """Keep an artist for the legend, which names each look once."""
        if mark.name:
            self.named.setdefault((mark.name, mark.role), artist)

    def _line(
        self, axes: Axes, mark: Line, x: Frame, y: Frame, inside: tuple[float, float]
    ) -> None:
        look = LOOKS[mark.role]
        across, up = within(mark.x, mark.y, inside)
        if not mark.marked:
            across, up = decimated(across, up)
        style = print_pen(look)
        style["alpha"] = look.line_opacity
        if mark.marked:
            style["marker"] = _SYMBOLS[look.symbol]
            style["markersize"] = 3.5
        (artist,) = axes.plot(x.shown(across), y.shown(up), **style)
        self._name(mark, artist)

    def _band(self, axes: Axes, mark: Band, x: Frame, y: Frame) -> None:
        look = LOOKS[mark.role]
        artist = axes.fill_between(
            x.shown(mark.x),
            y.shown(mark.low),
            y.shown(mark.high),
            color=look.light,
            alpha=look.opacity,
            linewidth=0.0,
        )
        self._name(mark, artist)

    def _outline(self, axes: Axes, mark: Outline, x: Frame, y: Frame) -> None:
        look = LOOKS[mark.role]
        (artist,) = axes.fill(
            x.shown(mark.x),
            y.shown(mark.y),
            facecolor=look.light,
            alpha=look.opacity,
            edgecolor="#1b1b1b",
            linewidth=look.width,
            hatch=_HATCHES[look.hatch],
        )
        self._name(mark, artist)

    def _level(self, axes: Axes, mark: Level, x: Frame, y: Frame) -> None:
        style = print_pen(LOOKS[mark.role])
        if mark.upright:
            artist = axes.axvline(_position(x, mark.value), **style)
        else:
            artist = axes.axhline(_position(y, mark.value), **style)
        self._name(mark, artist)
        if mark.label and not mark.upright:
            axes.annotate(
                lettering(mark.label),
                (1.0, _position(y, mark.value)),
                (-2, 1.5),
                ("axes fraction", "data"),
                "offset points",
                ha="right",
                va="bottom",
                fontsize=7,
                path_effects=_HALO,
            )

    def _rug(self, axes: Axes, mark: Rug, x: Frame) -> None:
        positions = x.shown(mark.values)
        (artist,) = axes.plot(
            positions,
            np.full(len(positions), 0.02),
            "|",
            markersize=5,
            color=LOOKS[mark.role].light,
            markeredgewidth=0.6,
            transform=axes.get_xaxis_transform(),
        )
        self._name(mark, artist)

    def _label(self, axes: Axes, mark: Label, x: Frame, y: Frame) -> None:
        if mark.corner:
            coordinates = "axes fraction"
            position = (mark.x, mark.y)
        else:
            coordinates = "data"
            position = (_position(x, mark.x), _position(y, mark.y))
            # which matplotlib does not do for words and arrows
            axes.update_datalim([position])
        horizontal, vertical, offset = _LABEL_SIDES[mark.anchor]
        axes.annotate(
            lettering(mark.words, 120),
            position,
            offset,
            coordinates,
            "offset points",
            ha=horizontal,
            va=vertical,
            fontsize=8,
            path_effects=_HALO,
        )

    def _arrow(self, axes: Axes, mark: Arrow, x: Frame, y: Frame) -> None:
        look = LOOKS[mark.role]
        start = (_position(x, mark.start[0]), _position(y, mark.start[1]))
        end = (_position(x, mark.end[0]), _position(y, mark.end[1]))
        heads = {
            "arrowstyle": "<|-|>" if mark.both else "-|>",
            "color": look.light,
            "linewidth": look.width,
            "shrinkA": 0.0,
            "shrinkB": 0.0,
        }
        axes.update_datalim([start, end])
        axes.annotate("", end, start, arrowprops=heads)

    def _points(
        self, axes: Axes, mark: Points, x: Frame, y: Frame, inside: tuple[float, float]
    ) -> None:
        look = LOOKS[mark.role]
        shown = (mark.x >= inside[0]) & (mark.x <= inside[1])
        style: dict[str, Any] = {
            "marker": _SYMBOLS[look.symbol],
            "linestyle": "",
            "markersize": 0.64 * look.size,
            "markerfacecolor": "white" if look.hollow else look.light,
            "markeredgecolor": look.light,
            "markeredgewidth": 1.0,
            "alpha": 1.0,
            "rasterized": len(mark.x) > 300,
            "zorder": 3,
        }
        if len(mark.x) > MANY:
            # small and without edges, so that they can be told apart
            style["markersize"] = min(0.625 * look.size_of_many, 0.64 * look.size)
            style["markerfacecolor"] = look.light
            style["markeredgewidth"] = 0.0
            style["alpha"] = 0.5
        (artist,) = axes.plot(x.shown(mark.x[shown]), y.shown(mark.y[shown]), **style)
        self._name(mark, artist)
        if mark.low is not None and mark.high is not None:
            reach = np.maximum([mark.y - mark.low, mark.high - mark.y], 0.0) / y.size
            axes.errorbar(
                x.shown(mark.x),
                y.shown(mark.y),
                yerr=reach,
                fmt="none",
                ecolor=look.light,
                elinewidth=0.9,
                capsize=2.5,
            )

    def _stack(
        self, axes: Axes, mark: Stack, x: Frame, y: Frame, inside: tuple[float, float]
    ) -> None:
        all_edges = stack_edges(mark)
        if not np.isfinite(inside[0]) and mark.overview is not None:
            across = mark.x[mark.overview]
            edges = [edge[mark.overview] for edge in all_edges]
        else:
            across, _ = within(mark.x, all_edges[0], inside)
            edges = [within(mark.x, edge, inside)[1] for edge in all_edges]
            if len(across) > _STACK_POINTS:
                even = np.linspace(across[0], across[-1], _STACK_POINTS)
                edges = [np.interp(even, across, edge) for edge in edges]
                across = even
        for layer, (lower, upper) in zip(mark.layers, pairwise(edges), strict=True):
            look = LOOKS[layer.role]
            area = axes.fill_between(
                x.shown(across),
                y.shown(lower),
                y.shown(upper),
                facecolor=look.light,
                hatch=_HATCHES[look.hatch],
                edgecolor="#3d3d3d",
                linewidth=0.3,
            )
            self.named.setdefault((layer.name, layer.role), area)

    def _bars(self, axes: Axes, mark: Bars, x: Frame, y: Frame) -> None:
        look = LOOKS[mark.role]
        # frames of the positions of bars, and of their values
        along, across = (y, x) if mark.lying else (x, y)
        style: dict[str, Any] = {
            "facecolor": look.light,
            "hatch": _HATCHES[look.hatch],
            "edgecolor": "#1b1b1b",
            "linewidth": 0.4,
        }
        if len(mark.places) == len(mark.values) + 1:
            artist: Any = axes.stairs(
                across.shown(mark.values),
                along.shown(mark.places),
                fill=True,
                facecolor=look.light,
                alpha=0.6,
            )
        else:
            base = 0.0 if mark.base is None else across.shown(mark.base)
            positions = along.shown(mark.places)
            lengths = mark.values / across.size
            width = mark.width / along.size
            if mark.lying:
                artist = axes.barh(positions, lengths, width, left=base, **style)
            else:
                artist = axes.bar(positions, lengths, width, bottom=base, **style)
        if mark.low is not None and mark.high is not None:
            reach = np.maximum([mark.values - mark.low, mark.high - mark.values], 0.0) / across.size
            ends = across.shown(mark.values)
            positions = along.shown(mark.places)
            look_of_error: dict[str, Any] = {
                "fmt": "none",
                "ecolor": "#1b1b1b",
                "elinewidth": 0.8,
                "capsize": 1.5,
            }
            if mark.lying:
                axes.errorbar(ends, positions, xerr=reach, **look_of_error)
            else:
                axes.errorbar(positions, ends, yerr=reach, **look_of_error)
        self._name(mark, artist)

    def _spans(self, axes: Axes, mark: Spans, x: Frame, inside: tuple[float, float]) -> None:
        look = LOOKS[mark.role]
        low, high = inside
        is_shown = (mark.ends >= low) & (mark.starts <= high)
        is_wide = mark.ends - mark.starts >= _THINNEST * (high - low)
        drawn = np.flatnonzero(is_shown & is_wide)[:_MOST_SPANS]
        starts = x.shown(mark.starts[drawn]).tolist()
        ends = x.shown(mark.ends[drawn]).tolist()
        for start, end in zip(starts, ends, strict=True):
            artist = axes.axvspan(
                start, end, color=look.light, alpha=look.opacity, linewidth=0, zorder=0
            )
            self._name(mark, artist)

    def _map(self, axes: Axes, mark: Map, panel: Panel, x: Frame, y: Frame) -> None:
        frame = self.frames[mark.scale]
        values = frame.shown(mark.values)
        low, high = frame.shown(np.array(ends_on(mark.scale, self.chart))).tolist()
        norm: Normalize
        if mark.diverging:
            norm = _symmetric_norm(low, high)
        elif is_log(mark.scale, self.chart):
            norm = LogNorm(low, high)
        else:
            norm = Normalize(low, high)
        stops = DIVERGING if mark.diverging else SEQUENTIAL
        colours = LinearSegmentedColormap.from_list("scale", list(stops))
        axes.patch.set(facecolor="#f2f2f2", edgecolor="#9a9a9a")
        if mark.cells and not np.isfinite(values).all():
            axes.patch.set_hatch("xxxx")  # seen through cells without a value
        across = x.shown(mark.x)
        up = y.shown(mark.y)
        if mark.cells:
            picture: Any = axes.pcolormesh(
                cell_edges(across, log=panel.x.log),
                cell_edges(up, log=panel.y.log),
                np.ma.masked_invalid(values),
                cmap=colours,
                norm=norm,
                rasterized=True,
            )
            axes.grid(visible=False)
        else:
            # a pixel lies around its point, and half of it beyond the edge
            half_x = 0.5 * (across[1] - across[0])
            half_y = 0.5 * (up[1] - up[0])
            picture = axes.imshow(
                values,
                extent=(across[0] - half_x, across[-1] + half_x, up[0] - half_y, up[-1] + half_y),
                origin="lower",
                cmap=colours,
                norm=norm,
                interpolation="bicubic",
                aspect="auto",
            )
            map_area = Rectangle(
                (across[0], up[0]),
                across[-1] - across[0],
                up[-1] - up[0],
                transform=axes.transData,
            )
            picture.set_clip_path(map_area)
        if mark.contours:
            for contours in contours_of(values):
                style = "--" if contours.dashed else "-"
                axes.contour(
                    across,
                    up,
                    np.ma.masked_invalid(contours.values),
                    levels=contours.levels,
                    colors="#1b1b1b",
                    linewidths=contours.width,
                    linestyles=style,
                )
        self.scales.setdefault(mark.scale, (picture, []))[1].append(axes)

    def _facets(self, axes: Axes, mark: Facets, x: Frame, y: Frame) -> None:
        if mark.scale is None:
            values = mark.values
            low = float(values.min())
            high = float(values.max())
        else:
            frame = self.frames[mark.scale]
            values = frame.shown(mark.values)
            low, high = frame.shown(np.array(ends_on(mark.scale, self.chart))).tolist()
        norm = _symmetric_norm(low, high) if mark.diverging else Normalize(low, high)
        stops = DIVERGING if mark.diverging else SHADES
        colours = LinearSegmentedColormap.from_list("facets", list(stops))
        corners = np.stack([x.shown(mark.corners[..., 0]), y.shown(mark.corners[..., 1])], axis=-1)
        facets = PolyCollection(
            list(corners),
            array=values,
            cmap=colours,
            norm=norm,
            edgecolors="face",
            linewidths=0.3,
            rasterized=True,
        )
        axes.add_collection(facets)
        axes.autoscale_view()
        if mark.scale is not None:
            self.scales.setdefault(mark.scale, (facets, []))[1].append(axes)


def _position(frame: Frame, value: float) -> float:
    """Return a value as shown in a frame."""
    return float(frame.shown(np.array(value)))


def _symmetric_norm(low: float, high: float) -> Normalize:
    """Return a norm of colours that is symmetric about zero."""
    largest = max(abs(low), abs(high)) or 1.0
    return Normalize(-largest, largest)


def within(x: Floats, y: Floats, inside: tuple[float, float]) -> tuple[Floats, Floats]:
    """Return the points of a line inside a range of x, and those interpolated at its ends.

    A line that does not ascend is returned as it is.
    """
    start, end = inside
    if not np.isfinite(start) or not bool(np.all(np.diff(x) >= 0.0)):
        return x, y

    def is_inside(position: float) -> bool:
        return len(x) > 0 and bool(x[0] < position < x[-1])

    first = np.searchsorted(x, start)
    last = np.searchsorted(x, end, side="right")
    # at the ends of the range, unless the line begins or ends inside it
    begin_x = [start] if is_inside(start) else []
    end_x = [end] if is_inside(end) else []
    across = np.concatenate([begin_x, x[first:last], end_x])
    up = np.concatenate([np.interp(begin_x, x, y), y[first:last], np.interp(end_x, x, y)])
    return across, up


def print_pen(look: Look) -> dict[str, Any]:
    """Return colour, width and dashes of a line of matplotlib."""
    return {
        "color": look.light,
        "linewidth": look.width,
        "linestyle": (0, look.dashes) if look.dashes else "-",
    }
