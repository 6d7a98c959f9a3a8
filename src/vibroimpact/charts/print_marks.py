"""The marks of a chart drawn by matplotlib."""

from __future__ import annotations

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
"""Width of the narrowest span drawn, relative to the axis: a narrower one is less than a
dot, seen or not as the dots fall.
"""


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
        self.chart, self.frames = chart, frames
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
        """Draw a mark of a panel in the frames of its axes, as far as it lies inside a
        range of the horizontal one.
        """
        x, y = frames
        match mark:
            case Line():
                across, up = within(mark.x, mark.y, inside)
                if not mark.marked:
                    across, up = decimated(across, up)
                style = print_pen(LOOKS[mark.role]) | {
                    "alpha": LOOKS[mark.role].opacity if mark.role == "under" else 1.0
                }
                style |= (
                    {"marker": _SYMBOLS[LOOKS[mark.role].symbol], "markersize": 3.5}
                    if mark.marked
                    else {}
                )
                self._name(mark, axes.plot(x.shown(across), y.shown(up), **style)[0])
            case Points():
                self._points(axes, mark, x, y, inside)
            case Band():
                look = LOOKS[mark.role]
                low, high = y.shown(mark.low), y.shown(mark.high)
                area = axes.fill_between(
                    x.shown(mark.x), low, high, color=look.light, alpha=look.opacity, linewidth=0.0
                )
                self._name(mark, area)
            case Stack():
                self._stack(axes, mark, x, y, inside)
            case Bars():
                self._bars(axes, mark, x, y)
            case Map():
                self._map(axes, mark, panel, x, y)
            case Facets():
                self._facets(axes, mark, x, y)
            case Outline():
                look = LOOKS[mark.role]
                patch = axes.fill(
                    x.shown(mark.x),
                    y.shown(mark.y),
                    facecolor=look.light,
                    alpha=look.opacity,
                    edgecolor="#1b1b1b",
                    linewidth=look.width,
                    hatch=_HATCHES[look.hatch],
                )
                self._name(mark, patch[0])
            case Level():
                draw, along = (axes.axvline, x) if mark.upright else (axes.axhline, y)
                self._name(
                    mark,
                    draw(float(along.shown(np.array(mark.value))), **print_pen(LOOKS[mark.role])),
                )
                if mark.label and not mark.upright:
                    at = (1.0, float(y.shown(np.array(mark.value))))
                    axes.annotate(
                        lettering(mark.label),
                        at,
                        (-2, 1.5),
                        ("axes fraction", "data"),
                        "offset points",
                        ha="right",
                        va="bottom",
                        fontsize=7,
                        path_effects=_HALO,
                    )
            case Spans():
                self._spans(
                    axes,
                    mark,
                    x,
                    inside if np.isfinite(inside[0]) else ends_on(panel.x, self.chart),
                )
            case Rug():
                places = x.shown(mark.values)
                line = axes.plot(
                    places,
                    np.full(len(places), 0.02),
                    "|",
                    markersize=5,
                    color=LOOKS[mark.role].light,
                    markeredgewidth=0.6,
                    transform=axes.get_xaxis_transform(),
                )
                self._name(mark, line[0])
            case Label():
                place = (
                    (mark.x, mark.y)
                    if mark.corner
                    else (float(x.shown(np.array(mark.x))), float(y.shown(np.array(mark.y))))
                )
                sides = {
                    "left": ("left", "center", (5, 0)),
                    "right": ("right", "center", (-5, 0)),
                    "above": ("center", "bottom", (0, 4)),
                    "below": ("center", "top", (0, -4)),
                    "center": ("center", "center", (0, 0)),
                }
                ha, va, off = sides[mark.anchor]
                if not mark.corner:
                    # which matplotlib does not do for words and arrows
                    axes.update_datalim([place])
                axes.annotate(
                    lettering(mark.words, 120),
                    place,
                    off,
                    "axes fraction" if mark.corner else "data",
                    "offset points",
                    ha=ha,
                    va=va,
                    fontsize=8,
                    path_effects=_HALO,
                )
            case Arrow():
                ends = [
                    (float(x.shown(np.array(end[0]))), float(y.shown(np.array(end[1]))))
                    for end in (mark.start, mark.end)
                ]
                heads = {
                    "arrowstyle": "<|-|>" if mark.both else "-|>",
                    "color": LOOKS[mark.role].light,
                    "linewidth": LOOKS[mark.role].width,
                    "shrinkA": 0.0,
                    "shrinkB": 0.0,
                }
                axes.update_datalim(ends)
                axes.annotate("", ends[1], ends[0], arrowprops=heads)

    def _name(self, mark: Any, artist: Any) -> None:
        if mark.name:
            self.named.setdefault((mark.name, mark.role), artist)

    def _points(
        self, axes: Axes, mark: Points, x: Frame, y: Frame, inside: tuple[float, float]
    ) -> None:
        seen = (mark.x >= inside[0]) & (mark.x <= inside[1])
        across, up = mark.x[seen], mark.y[seen]
        look, many = LOOKS[mark.role], len(mark.x) > MANY
        face = "white" if look.hollow and not many else look.light
        style: dict[str, Any] = {
            "marker": _SYMBOLS[look.symbol],
            "linestyle": "",
            "markersize": min(2.5, 0.64 * look.size) if many else 0.64 * look.size,
            "markerfacecolor": face,
            "markeredgecolor": look.light,
        }
        style |= {
            "markeredgewidth": 0.0 if many else 1.0,
            "alpha": 0.5 if many else 1.0,
            "rasterized": len(mark.x) > 300,
            "zorder": 3,
        }
        self._name(mark, axes.plot(x.shown(across), y.shown(up), **style)[0])
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
        edges = stack_edges(mark)
        if not np.isfinite(inside[0]) and mark.overview is not None:
            time, shown = mark.x[mark.overview], [edge[mark.overview] for edge in edges]
        else:
            time, shown = (
                within(mark.x, edges[0], inside)[0],
                [within(mark.x, edge, inside)[1] for edge in edges],
            )
            if len(time) > _STACK_POINTS:
                even = np.linspace(time[0], time[-1], _STACK_POINTS)
                time, shown = even, [np.interp(even, time, edge) for edge in shown]
        for layer, lower, upper in zip(mark.layers, shown, shown[1:], strict=False):
            look = LOOKS[layer.role]
            area = axes.fill_between(
                x.shown(time),
                y.shown(lower),
                y.shown(upper),
                facecolor=look.light,
                hatch=_HATCHES[look.hatch],
                edgecolor="#3d3d3d",
                linewidth=0.3,
            )
            self.named.setdefault((layer.name, layer.role), area)

    def _bars(self, axes: Axes, mark: Bars, x: Frame, y: Frame) -> None:
        look, (along, across) = LOOKS[mark.role], ((y, x) if mark.lying else (x, y))
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
            places, lengths, width = (
                along.shown(mark.places),
                mark.values / across.size,
                mark.width / along.size,
            )
            artist = (
                axes.barh(places, lengths, width, left=base, **style)
                if mark.lying
                else axes.bar(places, lengths, width, bottom=base, **style)
            )
        if mark.low is not None and mark.high is not None:
            reach = np.maximum([mark.values - mark.low, mark.high - mark.values], 0.0) / across.size
            ends, places = across.shown(mark.values), along.shown(mark.places)
            at: dict[str, Any] = (
                {"x": ends, "y": places, "xerr": reach}
                if mark.lying
                else {"x": places, "y": ends, "yerr": reach}
            )
            axes.errorbar(**at, fmt="none", ecolor="#1b1b1b", elinewidth=0.8, capsize=1.5)
        self._name(mark, artist)

    def _spans(self, axes: Axes, mark: Spans, x: Frame, inside: tuple[float, float]) -> None:
        look, (low, high) = LOOKS[mark.role], inside
        seen = (
            (mark.ends >= low)
            & (mark.starts <= high)
            & (mark.ends - mark.starts >= _THINNEST * (high - low))
        )
        for start, end in zip(
            x.shown(mark.starts[seen][:60]), x.shown(mark.ends[seen][:60]), strict=True
        ):
            self._name(
                mark,
                axes.axvspan(
                    float(start),
                    float(end),
                    color=look.light,
                    alpha=look.opacity,
                    linewidth=0,
                    zorder=0,
                ),
            )

    def _map(self, axes: Axes, mark: Map, panel: Panel, x: Frame, y: Frame) -> None:
        frame = self.frames[mark.scale]
        values = frame.shown(mark.values)
        low, high = frame.shown(np.array(ends_on(mark.scale, self.chart))).tolist()
        most = max(abs(low), abs(high)) or 1.0
        stops = DIVERGING if mark.diverging else SEQUENTIAL
        log_scale = is_log(mark.scale, self.chart)
        norm = (
            Normalize(-most, most)
            if mark.diverging
            else LogNorm(low, high)
            if log_scale
            else Normalize(low, high)
        )
        colours = LinearSegmentedColormap.from_list("scale", list(stops))
        axes.patch.set(
            facecolor="#f2f2f2",
            edgecolor="#9a9a9a",
            hatch="" if np.isfinite(values).all() or not mark.cells else "xxxx",
        )
        across, up = x.shown(mark.x), y.shown(mark.y)
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
            half = 0.5 * (across[1] - across[0]), 0.5 * (up[1] - up[0])
            edges = (across[0] - half[0], across[-1] + half[0], up[0] - half[1], up[-1] + half[1])
            picture = axes.imshow(
                values,
                extent=edges,
                origin="lower",
                cmap=colours,
                norm=norm,
                interpolation="bicubic",
                aspect="auto",
            )
            # a pixel lies around its point, and half of it beyond the edge
            inner = (across[0], up[0]), across[-1] - across[0], up[-1] - up[0]
            picture.set_clip_path(Rectangle(*inner, transform=axes.transData))
        for found in contours_of(values) if mark.contours else ():
            style: dict[str, Any] = {
                "linewidths": found.width,
                "linestyles": "--" if found.dashed else "-",
            }
            axes.contour(
                across,
                up,
                np.ma.masked_invalid(found.values),
                levels=found.levels,
                colors="#1b1b1b",
                **style,
            )
        self.scales.setdefault(mark.scale, (picture, []))[1].append(axes)

    def _facets(self, axes: Axes, mark: Facets, x: Frame, y: Frame) -> None:
        values, low, high = mark.values, float(mark.values.min()), float(mark.values.max())
        if mark.scale is not None:
            frame = self.frames[mark.scale]
            values, (low, high) = (
                frame.shown(values),
                frame.shown(np.array(ends_on(mark.scale, self.chart))).tolist(),
            )
        most = max(abs(low), abs(high)) or 1.0
        norm = Normalize(-most, most) if mark.diverging else Normalize(low, high)
        colours = LinearSegmentedColormap.from_list(
            "facets", list(DIVERGING if mark.diverging else SHADES)
        )
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


def within(x: Floats, y: Floats, inside: tuple[float, float]) -> tuple[Floats, Floats]:
    """Return the points of a line inside a range of x, and those interpolated at its
    ends; a line that does not ascend as it is.
    """
    if not np.isfinite(inside[0]) or not bool(np.all(np.diff(x) >= 0.0)):
        return x, y
    first, last = np.searchsorted(x, inside[0]), np.searchsorted(x, inside[1], side="right")
    ends = [end for end in inside if len(x) and x[0] < end < x[-1]]
    before, after = (
        [end for end in ends if end == inside[0]],
        [end for end in ends if end == inside[1]],
    )
    return (
        np.concatenate([before, x[first:last], after]),
        np.concatenate([np.interp(before, x, y), y[first:last], np.interp(after, x, y)]),
    )


def print_pen(look: Look) -> dict[str, Any]:
    """Return colour, width and dashes of a line of matplotlib."""
    return {
        "color": look.light,
        "linewidth": look.width,
        "linestyle": (0, look.dashes) if look.dashes else "-",
    }
