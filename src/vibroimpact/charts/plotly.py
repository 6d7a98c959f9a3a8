"""A chart as a figure of plotly, in plain dictionaries.

They are its traces and layout, with arrays in SI units and the frames that show them. Neither
plotly itself nor a browser is needed here. A page completes the figure in the browser, where a view
or a zoom chooses what is drawn of long arrays (`scripts/charts.js`); `vibroimpact.charts.notebook`
completes it in Python. Colours are names of roles after an "@", replaced by those of the light or
the dark ground.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel, StoredChart, values_on
from vibroimpact.charts.contours import Contours, contours_of
from vibroimpact.charts.frame import (
    Frame,
    ends_on,
    frames_of,
    is_log,
    panels_without_label,
    view_frames,
    view_range,
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
)
from vibroimpact.charts.palette import DIVERGING, LOOKS, SEQUENTIAL, SHADES
from vibroimpact.charts.traces import (
    area,
    bars_trace,
    colour_between,
    line_trace,
    pen,
    plain,
    points_trace,
    scale_of,
    silence,
)

ROW = 300
"""Height of the only row [px]."""

SMALL_ROW = 170
"""Height of one of several rows [px]."""

PICTURE_ROW = 340
"""Height of a row of one or two pictures [px]."""

_PICTURE_INCH = 118.0
"""What an inch of a picture in print is on a wide page [px]."""

_GAP = 0.07
"""Gap between panels of a row [parts of the width]."""

_GAP_WITH_COLOUR_BARS = 0.17
"""Gap between panels of a row where colour bars are in it [parts of the width]."""

_GAP_BETWEEN_PICTURES = 0.03
"""Gap between pictures of a row [parts of the width]."""

_GAP_BETWEEN_ROWS = 64
"""Gap between rows [px]."""

_ANCHORS: dict[str, dict[str, Any]] = {
    "left": {"xanchor": "left", "yanchor": "middle", "xshift": 6},
    "right": {"xanchor": "right", "yanchor": "middle", "xshift": -6},
    "center": {"xanchor": "center", "yanchor": "middle"},
    "above": {"xanchor": "center", "yanchor": "bottom", "yshift": 4},
    "below": {"xanchor": "center", "yanchor": "top", "yshift": -4},
}
"""How words lie beside their position."""

_SHADES = 40
"""Number of colours of facets, which are drawn as one trace each."""


def plotly_chart(chart: Chart) -> dict[str, Any]:
    """Return a chart as a figure of plotly whose arrays are in SI units.

    Returns
    -------
    dict
        `name`, `title`, `subtitle`, `caption`; `data`, traces whose arrays are SI values; `layout`;
        `pictures`, whether all panels are; `rows`, suffix and height of the panels of each row;
        `bars`, the colour axis of a panel that has its own; `frames`, by axis, what divides these
        values; `levels` and `spans`, the lines and shaded ranges across panels; `views`, each with
        the frames that it changes.

    Examples
    --------
    >>> time, force = Axis("Time", "s"), Axis("Force", "N")
    >>> line = Line(np.array([0.0, 1.0]), np.array([5.0, 7000.0]))
    >>> figure = plotly_chart(Chart("force", "Force", ((Panel(time, force, (line,)),),)))
    >>> figure["data"][0]["type"], figure["frames"]["y"]["title"]
    ('scatter', 'Force [kN]')
    """
    if isinstance(chart, StoredChart):
        return chart.drawn
    return _Drawing(chart).figure()


class _Drawing:
    """The figure while it is put together: the number of each panel names its axes."""

    def __init__(self, chart: Chart) -> None:
        self.chart = chart
        self.frames = frames_of(chart)
        self.data: list[dict[str, Any]] = []
        self.layout: dict[str, Any] = {"annotations": []}
        self.levels: list[dict[str, Any]] = []
        self.spans: list[dict[str, Any]] = []
        self.named: set[tuple[str, str]] = set()
        self.scales: dict[Axis, str] = {}
        self.bars: dict[str, str] = {}

    def figure(self) -> dict[str, Any]:
        """Return the figure."""
        chart = self.chart
        heights = self._heights()
        total = sum(heights) + _GAP_BETWEEN_ROWS * (len(heights) - 1)
        top = total
        frames: dict[str, Frame] = {}
        panels: dict[str, Panel] = {}  # by the suffix of the names of their axes
        first: dict[Axis, str] = {}  # the name of each axis in the first panel that has it
        rows: list[list[tuple[str, int]]] = []
        for number, (row, height) in enumerate(zip(chart.rows, heights, strict=True)):
            rows.append([])
            axes_below = {panel.x for later in chart.rows[number + 1 :] for panel in later}
            gap = self._gap(row)
            width = (1.0 - gap * (len(row) - 1)) / len(row)
            for column, panel in enumerate(row):
                suffix = str(len(panels) + 1) if panels else ""
                left = column * (width + gap)
                self._place(
                    panel,
                    suffix,
                    (left, left + width),
                    ((top - height) / total, top / total),
                    first,
                    panel.x not in axes_below,
                )
                # names that the panel before has already
                if column and panel.y.names and panel.y is row[column - 1].y:
                    self.layout[f"yaxis{suffix}"]["showticklabels"] = False
                if panel.marks:
                    rows[-1].append((suffix, height))
                frames[f"x{suffix}"] = self.frames[panel.x]
                frames[f"y{suffix}"] = self.frames[panel.y]
                panels[suffix] = panel
                for mark in panel.marks:
                    self._draw(mark, panel, suffix)
            top -= height + _GAP_BETWEEN_ROWS
        unlabelled = panels_without_label(chart, self.frames)
        for suffix, panel in panels.items():
            if panel in unlabelled:
                self.layout[f"yaxis{suffix}"]["title"]["text"] = ""
        self.layout["height"] = total
        self.layout["showlegend"] = bool(self.named)
        return {
            "name": chart.name,
            "title": chart.title,
            "subtitle": chart.subtitle,
            "caption": chart.caption,
            "data": self.data,
            "layout": self.layout,
            "pictures": self._pictures(),
            "rows": rows,
            "bars": self.bars,
            "frames": {name: _as_dict(frame) for name, frame in frames.items()},
            "levels": self.levels,
            "spans": self.spans,
            "views": self._views(panels),
        }

    def _gap(self, row: tuple[Panel, ...]) -> float:
        """Return the gap between the panels of a row [parts of the width]."""
        if self._pictures():
            return _GAP_BETWEEN_PICTURES
        for mark in row[0].marks:
            if isinstance(mark, Map) and self._own_scale(mark.scale):
                return _GAP_WITH_COLOUR_BARS
        return _GAP

    def _heights(self) -> list[int]:
        if self.chart.height is not None:
            pixels = _PICTURE_INCH if self._pictures() else 96.0
            return [round(pixels * self.chart.height)] * len(self.chart.rows)
        usual = ROW if len(self.chart.rows) == 1 else SMALL_ROW
        heights = [usual] * len(self.chart.rows)
        for number, row in enumerate(self.chart.rows):
            if any(panel.picture for panel in row) and len(row) < 3:
                heights[number] = PICTURE_ROW
        return heights

    def _pictures(self) -> bool:
        """Return whether all panels are pictures, whose height follows from the width."""
        return all(panel.picture for panel in self.chart.panels)

    def _place(
        self,
        panel: Panel,
        suffix: str,
        across: tuple[float, float],
        up: tuple[float, float],
        first: dict[Axis, str],
        last: bool,
    ) -> None:
        """Add the axes of a panel; one that is shared follows the first panel that has it."""
        for side, axis, domain, other in (("x", panel.x, across, "y"), ("y", panel.y, up, "x")):
            name = f"{side}{suffix}"
            frame = self.frames[axis]
            line: dict[str, Any] = {"domain": list(domain), "anchor": f"{other}{suffix}"}
            if axis in first:
                line["matches"] = first[axis]
            else:
                first[axis] = name
            shared_below = side == "x" and not last and bool(axis.views)
            is_untitled = shared_below or panel.picture
            title = "" if is_untitled else plain(frame.title)
            line["title"] = {"text": title}
            if shared_below:
                line["showticklabels"] = False
            line |= scale_of(axis, frame)
            if panel.picture:
                line["visible"] = False
                # an axis that follows another one has its scale already
                if side == "y" and "matches" not in line:
                    line["scaleanchor"] = f"x{suffix}"
            self.layout[f"{side}axis{suffix}"] = line
        if panel.title and (len(self.chart.panels) > 1 or panel.title != self.chart.title):
            self._write(
                panel.title,
                f"x{suffix} domain",
                f"y{suffix} domain",
                0.0,
                1.0,
                xanchor="left",
                yanchor="bottom",
                size=13,
            )

    def _write(
        self, phrase: str, xref: str, yref: str, x: float, y: float, size: int = 12, **more: Any
    ) -> None:
        note = {
            "text": plain(phrase),
            "xref": xref,
            "yref": yref,
            "x": x,
            "y": y,
            "showarrow": False,
            "font": {"size": size},
            **more,
        }
        self.layout["annotations"].append(note)

    def _draw(self, mark: Mark, panel: Panel, suffix: str) -> None:
        at = {"xaxis": f"x{suffix}", "yaxis": f"y{suffix}"}
        match mark:
            case Line():
                self._add(mark, at, line_trace(mark) | silence(mark, panel))
            case Points():
                self._add(mark, at, points_trace(mark) | silence(mark, panel))
            case Band():
                self._add(
                    mark,
                    at,
                    {
                        "type": "band",
                        "x": mark.x,
                        "low": mark.low,
                        "high": mark.high,
                        "line": {"width": 0},
                        **area(mark.role),
                    },
                )
            case Stack():
                self._stack(mark, at)
            case Bars():
                self._add(mark, at, bars_trace(mark))
            case Map():
                self._map(mark, panel, at)
            case Facets():
                self._facets(mark, at)
            case Outline():
                look = LOOKS[mark.role]
                closed = {"x": np.append(mark.x, mark.x[0]), "y": np.append(mark.y, mark.y[0])}
                edge = {"color": "@main", "width": look.width}
                self._add(
                    mark,
                    at,
                    {
                        "type": "scatter",
                        "mode": "lines",
                        "fill": "toself",
                        "line": edge,
                        "hoverinfo": "skip",
                        **closed,
                        **area(mark.role),
                    },
                )
            case Level():
                self._level(mark, suffix)
                self._name(mark, at)
            case Spans():
                look = LOOKS[mark.role]
                self.spans.append(
                    {
                        "axis": f"x{suffix}",
                        "across": f"y{suffix}",
                        "starts": mark.starts,
                        "ends": mark.ends,
                        "fillcolor": f"@{mark.role}",
                        "opacity": look.opacity,
                    }
                )
                self._name(mark, at)
            case Rug():
                self._add(
                    mark,
                    at,
                    {
                        "type": "rug",
                        "x": mark.values,
                        "color": f"@{mark.role}",
                        "hover": plain(mark.name),
                    },
                )
            case Label():
                self._label(mark, panel, suffix)
            case Arrow():
                self._arrow(mark, panel, suffix)

    def _stack(self, mark: Stack, at: dict[str, str]) -> None:
        layers = []
        for layer in mark.layers:
            self.named.add((layer.name, layer.role))
            layers.append({"name": plain(layer.name), "y": layer.values, **area(layer.role)})
        stack: dict[str, Any] = {"type": "stack", "x": mark.x, "layers": layers}
        if mark.overview is not None:
            stack["overview"] = mark.overview
        self.data.append({**stack, **at})

    def _level(self, mark: Level, suffix: str) -> None:
        axis, across = ("x", "y") if mark.upright else ("y", "x")
        self.levels.append(
            {
                "axis": f"{axis}{suffix}",
                "across": f"{across}{suffix}",
                "value": mark.value,
                "line": pen(mark.role),
                "label": plain(mark.label),
            }
        )

    def _label(self, mark: Label, panel: Panel, suffix: str) -> None:
        """Write words at a position of a panel, or at a part of its width and height."""
        anchor = _ANCHORS[mark.anchor]
        if mark.corner:
            xref = f"x{suffix} domain"
            yref = f"y{suffix} domain"
            self._write(mark.words, xref, yref, mark.x, mark.y, **anchor)
        else:
            x = self._position(panel.x, mark.x)
            y = self._position(panel.y, mark.y)
            self._write(mark.words, f"x{suffix}", f"y{suffix}", x, y, **anchor)

    def _add(self, mark: Any, at: dict[str, str], trace: dict[str, Any]) -> None:
        self.data.append({**trace, **at, **self._legend(mark)})

    def _legend(self, mark: Any) -> dict[str, Any]:
        """Return the entry of a mark in the legend, which names each look once."""
        if not mark.name:
            return {"showlegend": False}
        new = (mark.name, mark.role) not in self.named
        self.named.add((mark.name, mark.role))
        return {
            "name": plain(mark.name),
            "legendgroup": f"{mark.name} {mark.role}",
            "showlegend": new,
        }

    def _name(self, mark: Level | Spans, at: dict[str, str]) -> None:
        """Add the legend's entry of what is not a trace."""
        if mark.name and (mark.name, mark.role) not in self.named:
            look = {"mode": "lines", "line": pen(mark.role)}
            if isinstance(mark, Spans):
                look = {
                    "mode": "markers",
                    "marker": {
                        "symbol": "square",
                        "size": 12,
                        "color": f"@{mark.role}",
                        "opacity": LOOKS[mark.role].opacity,
                    },
                }
            self._add(
                mark, at, {"type": "scatter", "x": [None], "y": [None], "hoverinfo": "skip", **look}
            )

    def _map(self, mark: Map, panel: Panel, at: dict[str, str]) -> None:
        frame = self.frames[mark.scale]
        if mark.scale not in self.scales:
            self._add_scale(mark, frame)
        x = mark.x
        y = mark.y
        if mark.cells:
            # plotly would put the edges of a logarithmic axis midway, or below zero
            x = cell_edges(mark.x, log=panel.x.log)
            y = cell_edges(mark.y, log=panel.y.log)
        shown = frame.shown(mark.values)
        unit = plain(frame.unit)
        trace = {
            "type": "heatmap",
            "x": x,
            "y": y,
            "z": shown,
            "coloraxis": self.scales[mark.scale],
            "hoverongaps": False,
        }
        trace["hovertemplate"] = f"%{{z:.5~g}} {unit}<extra></extra>"
        if is_log(mark.scale, self.chart):
            trace |= {
                "z": np.log10(shown),
                "customdata": shown,
                "hovertemplate": f"%{{customdata:.5~g}} {unit}<extra></extra>",
            }
        if mark.texts:
            trace |= {
                "text": [plain(text) for text in mark.texts],
                "hovertemplate": "%{text}<extra></extra>",
            }
        if not mark.cells:
            trace["zsmooth"] = "best"
        self.data.append({**trace, **at, "showlegend": False})
        if mark.contours:
            for contours in contours_of(shown):
                self.data.append({**_contour_trace(mark, contours), **at})

    def _add_scale(self, mark: Map | Facets, frame: Frame) -> None:
        """Add the colour scale that maps or facets share."""
        assert mark.scale is not None  # checked by the caller
        # plotly counts them coloraxis, coloraxis2, and so on
        name = "coloraxis"
        if self.scales:
            name += str(len(self.scales) + 1)
        self.scales[mark.scale] = name
        log = is_log(mark.scale, self.chart)
        low, high = frame.shown(np.array(ends_on(mark.scale, self.chart))).tolist()
        if log:
            low = math.log10(low)
            high = math.log10(high)
        stops = SEQUENTIAL
        ends = (low, high)
        if mark.diverging:
            # the middle colour of a diverging scale stands for zero
            stops = DIVERGING
            largest = max(abs(low), abs(high)) or 1.0
            ends = (-largest, largest)
        bar: dict[str, Any] = {
            "title": {"text": plain(frame.title), "side": "right"},
            "thickness": 12,
            "outlinewidth": 0,
            "len": 1.0,
        }
        if log:
            ticks = np.arange(np.ceil(low), np.floor(high) + 1.0)
            if len(ticks) < 2:  # less than a decade
                ticks = np.linspace(low, high, 3)
            bar |= {
                "tickvals": ticks.tolist(),
                "ticktext": [f"{10.0**value:.3g}" for value in ticks],
            }
        panels_with_maps = [
            panel
            for panel in self.chart.panels
            if any(isinstance(other, Map) for other in panel.marks)
        ]
        if len(panels_with_maps) > 1 and self._own_scale(mark.scale):
            bar |= self._beside(mark.scale)
        self.layout[name] = {
            "cmin": ends[0],
            "cmax": ends[1],
            "colorscale": [list(stop) for stop in stops],
            "colorbar": bar,
        }

    def _own_scale(self, scale: Axis) -> bool:
        """Return whether a scale is that of a single panel among several."""
        return sum(_has_scale(panel, scale) for panel in self.chart.panels) == 1

    def _beside(self, scale: Axis) -> dict[str, Any]:
        """Return the position of a colour bar beside its only panel."""
        number = next(
            index for index, panel in enumerate(self.chart.panels) if _has_scale(panel, scale)
        )
        suffix = "" if number == 0 else str(number + 1)
        self.bars[suffix] = self.scales[scale]
        _, right = self.layout[f"xaxis{suffix}"]["domain"]
        bottom, top = self.layout[f"yaxis{suffix}"]["domain"]
        return {
            "x": right,
            "xanchor": "left",
            "y": 0.5 * (bottom + top),
            "yanchor": "middle",
            "len": top - bottom,
            "title": {"text": self.frames[scale].unit, "side": "top"},
        }

    def _facets(self, mark: Facets, at: dict[str, str]) -> None:
        """Draw facets in a few colours: one filled trace of each.

        Its outlines are interrupted by NaN.
        """
        values = mark.values
        if mark.scale is not None:
            values = values_on(mark.scale, self.chart.panels)
        low = float(values.min())
        high = float(values.max())
        if mark.diverging:
            high = max(abs(low), abs(high)) or 1.0
            low = -high
        part = (mark.values - low) / ((high - low) or 1.0)
        shade = np.clip((part * _SHADES).astype(int), 0, _SHADES - 1)
        stops = DIVERGING if mark.diverging else SHADES
        for number in np.unique(shade):
            is_of_shade = shade == number
            corners = mark.corners[is_of_shade]
            first_corner = corners[:, :1]
            gap = np.full_like(first_corner, np.nan)
            closed = np.concatenate([corners, first_corner, gap], axis=1).reshape(-1, 2)
            colour = colour_between(stops, (number + 0.5) / _SHADES)
            trace: dict[str, Any] = {
                "type": "scatter",
                "mode": "lines",
                "fill": "toself",
                "fillcolor": colour,
                "line": {"color": colour, "width": 0.5},
            }
            trace |= {"hoverinfo": "skip", "showlegend": False}
            if mark.scale is not None:
                frame = self.frames[mark.scale]
                mean = float(frame.shown(mark.values[is_of_shade].mean()))
                trace |= {
                    "hoveron": "fills",
                    "hoverinfo": "text",
                    "text": f"{mean:.2g} {frame.unit}".rstrip(),
                }
            self.data.append({**trace, "x": closed[:, 0], "y": closed[:, 1], **at})
        if mark.scale is not None and mark.scale not in self.scales:
            self._add_scale(mark, self.frames[mark.scale])
            # the bar belongs to a trace of markers, of which there is none
            bar = {"color": [0.0], "coloraxis": self.scales[mark.scale]}
            nothing = {
                "type": "scatter",
                "mode": "markers",
                "x": [None],
                "y": [None],
                "hoverinfo": "skip",
                "showlegend": False,
            }
            self.data.append({**nothing, "marker": bar, **at})

    def _position(self, axis: Axis, value: float) -> float:
        """Return the position of an annotation along an axis.

        On a logarithmic one plotly takes the logarithm, other than of a trace.
        """
        shown = float(self.frames[axis].shown(np.array(value)))
        return math.log10(shown) if axis.log else shown

    def _arrow(self, mark: Arrow, panel: Panel, suffix: str) -> None:
        start_x, start_y = mark.start
        end_x, end_y = mark.end
        arrow = {
            "text": "",
            "showarrow": True,
            "x": self._position(panel.x, end_x),
            "y": self._position(panel.y, end_y),
            "ax": self._position(panel.x, start_x),
            "ay": self._position(panel.y, start_y),
            "xref": f"x{suffix}",
            "yref": f"y{suffix}",
            "axref": f"x{suffix}",
            "ayref": f"y{suffix}",
            "arrowhead": 2,
            "arrowside": "end+start" if mark.both else "end",
            "arrowwidth": LOOKS[mark.role].width,
            "arrowcolor": f"@{mark.role}",
        }
        self.layout["annotations"].append(arrow)

    def _views(self, panels: dict[str, Panel]) -> list[dict[str, Any]]:
        """Return the views with the frames and ranges that each of them changes."""
        views = []
        for number, view in enumerate(self.chart.views):
            frames: dict[str, Any] = {}
            for suffix, panel in panels.items():
                if number < len(panel.x.views):
                    across, up = self._view_frames(panel, panel.x.views[number])
                    frames[f"x{suffix}"] = across
                    frames[f"y{suffix}"] = up
            views.append({"name": view.name, "headline": view.headline, "frames": frames})
        return views

    def _view_frames(self, panel: Panel, view: View) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return the frames of both axes of a panel in a view, with the ranges shown."""
        panels = self.chart.panels
        across, up = view_frames(panel, view, self.frames[panel.y], panels)
        horizontal = _as_dict(across)
        horizontal["range"] = across.shown(np.array([view.start, view.end])).tolist()
        vertical = _as_dict(up)
        span = view_range(panel, view, panels)
        if span is not None:
            vertical["range"] = up.shown(np.array(span)).tolist()
        return horizontal, vertical


def _has_scale(panel: Panel, scale: Axis) -> bool:
    """Return whether a panel has a map or facets of a scale."""
    return any(getattr(mark, "scale", None) is scale for mark in panel.marks)


def _contour_trace(mark: Map, contours: Contours) -> dict[str, Any]:
    """Return the trace of contours of a map that look alike."""
    step = 1.0
    if len(contours.levels) > 1:
        step = contours.levels[1] - contours.levels[0]
    levels = {
        "coloring": "none",
        "start": contours.levels[0],
        # it lies beyond the last level, which rounding would leave out
        "end": contours.levels[-1] + 0.01 * step,
        "size": step,
    }
    dash = "4px,3px" if contours.dashed else "solid"
    return {
        "type": "contour",
        "x": mark.x,
        "y": mark.y,
        "z": contours.values,
        "showscale": False,
        "hoverinfo": "skip",
        "contours": levels,
        "line": {"color": "@contour", "width": 1.2 * contours.width, "dash": dash},
        "showlegend": False,
    }


def _as_dict(frame: Frame) -> dict[str, Any]:
    return {
        "title": plain(frame.title),
        "unit": frame.unit,
        "size": frame.size,
        "origin": frame.origin,
    }
