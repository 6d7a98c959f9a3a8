"""A chart as a figure of plotly's Python library, for notebooks and scripts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.decimation import COLUMNS, decimated
from vibroimpact.charts.marks import Layer, Stack, stack_edges
from vibroimpact.charts.palette import GRID, GROUND, INK, LOOKS
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.charts.traces import plain

if TYPE_CHECKING:
    import plotly.graph_objects as go

_MOST_SPANS = 60
"""Shaded ranges of a panel that are drawn."""
_FINE = 10_000
"""Columns into which a long line is divided: more than are seen, as a zoom shows no other
points.
"""

_COLOURS = {
    "ground": GROUND.light,
    "ink": INK.light,
    "grid": GRID.light,
    **{role: look.light for role, look in LOOKS.items()},
}


def plotly_figure(chart: Chart) -> go.Figure:
    """Return a chart as a figure of plotly, with the whole of its axes shown.

    Parameters
    ----------
    chart : Chart
        The chart.

    Returns
    -------
    plotly.graph_objects.Figure
        The figure; values are in the multiples of units that its axes name.

    Examples
    --------
    >>> from vibroimpact.charts.axis import Axis
    >>> from vibroimpact.charts.chart import Panel
    >>> from vibroimpact.charts.marks import Line
    >>> time, force = Axis("Time", "s"), Axis("Force", "N")
    >>> line = Line(np.array([0.0, 1.0]), np.array([5.0, 7000.0]))
    >>> figure = plotly_figure(Chart("force", "Force", ((Panel(time, force, (line,)),),)))
    >>> figure.data[0].y.tolist(), figure.layout.yaxis.title.text
    ([0.005, 7.0], 'Force [kN]')
    """
    import plotly.graph_objects as go

    drawn = plotly_chart(chart)
    title = {"text": plain(drawn["title"]), "subtitle": {"text": plain(drawn["subtitle"])}}
    layout = drawn["layout"] | {"title": title, "template": "plotly_white", "hovermode": "closest"}
    above = 70
    if chart.subtitle:
        above += 16 * len(chart.subtitle.splitlines()) + 14
    layout |= {
        "shapes": [*_levels(drawn), *_spans(drawn), *_rugs(drawn)],
        "margin": {"t": above, "b": 60},
        "font": {"color": INK.light},
    }
    # 60 px below the axes, where their labels end, in parts of the height that the axes have
    layout["legend"] = {"orientation": "h", "y": -60 / layout["height"], "yanchor": "top"}
    layout["height"] += above + 80
    traces = [
        trace for drawn_trace in drawn["data"] for trace in _traces(drawn_trace, drawn["frames"])
    ]
    return go.Figure(_coloured({"data": traces, "layout": layout}))


def _traces(trace: dict[str, Any], frames: dict[str, dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the traces of plotly that a trace of a chart becomes."""
    x = frames[trace["xaxis"]]
    y = frames[trace["yaxis"]]
    common: dict[str, Any] = {
        key: trace[key]
        for key in ("xaxis", "yaxis", "name", "showlegend", "legendgroup")
        if key in trace
    }
    match trace["type"]:
        case "rug":
            return []
        case "band":
            edges = [_shown(trace[side], y) for side in ("low", "high")]
            look = {key: trace[key] for key in ("fillcolor", "fillopacity", "line")} | {
                "type": "scatter",
                "mode": "lines",
                "x": _shown(trace["x"], x),
            }
            return [
                {**look, **common, "y": edges[0], "showlegend": False, "hoverinfo": "skip"},
                {**look, **common, "y": edges[1], "fill": "tonexty", "hoverinfo": "skip"},
            ]
        case "stack":
            return _stack(trace, x, y, common)
        case "bars":
            return [_bars(trace, x, y, common)]
        case "heatmap" | "contour":
            shown = {**trace, "x": _shown(trace["x"], x), "y": _shown(trace["y"], y)}
            if "text" in trace:
                shown["text"] = np.reshape(trace["text"], trace["z"].shape)
            return [shown]
    kept = {
        key: value
        for key, value in trace.items()
        if key not in ("x", "y", "low", "high", "keys", "origins")
    }
    across = trace["x"]
    up = trace["y"]
    if trace["mode"] == "lines" and "fill" not in trace:
        across, up = decimated(across, up, _FINE)
    if "low" in trace:
        above = (trace["high"] - trace["y"]) / y["size"]
        below = (trace["y"] - trace["low"]) / y["size"]
        kept["error_y"] = {
            "array": above,
            "arrayminus": below,
            "thickness": 1.0,
            "width": 3,
            "color": "@main",
        }
    if trace.get("hoverinfo") != "skip" and "hovertemplate" not in trace:
        kept["hovertemplate"] = hover(x["unit"], y["unit"], "text" in trace) + _name_of(trace)
    return [{**kept, "x": _shown(across, x), "y": _shown(up, y)}]


def hover(across: str, up: str, texts: bool) -> str:
    """Return what plotly writes at the pointer, by the units of both axes.

    Examples
    --------
    >>> hover("ms", "kN", False)
    '%{x:.7~g} ms<br>%{y:.5~g} kN'
    """
    coordinates = f"%{{x:.7~g}} {across}<br>%{{y:.5~g}} {up}"
    if not texts:
        return coordinates
    return f"%{{text}}<br>{coordinates}"


def _name_of(trace: dict[str, Any]) -> str:
    """Return what takes the name of a trace away at the pointer where it has none: plotly
    would call it by its number.
    """
    return "" if trace.get("name") else "<extra></extra>"


def _stack(
    trace: dict[str, Any], x: dict[str, Any], y: dict[str, Any], common: dict[str, Any]
) -> list[dict[str, Any]]:
    kept = trace.get("overview", slice(None, None, max(1, len(trace["x"]) // COLUMNS)))
    layers = tuple(Layer(layer["name"], layer["y"][kept], "") for layer in trace["layers"])
    edges = stack_edges(Stack(trace["x"][kept], layers))
    line = {"type": "scatter", "mode": "lines", "x": _shown(trace["x"][kept], x), **common}
    traces = [
        {
            **line,
            "y": _shown(edges[0], y),
            "line": {"width": 0},
            "hoverinfo": "skip",
            "showlegend": False,
        }
    ]
    for layer, values, edge in zip(trace["layers"], layers, edges[1:], strict=True):
        look = {key: layer[key] for key in ("fillcolor", "fillpattern") if key in layer} | {
            "line": {"width": 0.4, "color": "@main"}
        }
        phrase = (
            f"{layer['name']}: %{{customdata:.5~g}} {y['unit']}<br>%{{x:.7~g}} "
            f"{x['unit']}<extra></extra>"
        )
        own = {
            "name": layer["name"],
            "customdata": _shown(values.values, y),
            "hovertemplate": phrase,
            "fill": "tonexty",
            "showlegend": True,
        }
        traces.append({**line, **look, **own, "y": _shown(edge, y)})
    return traces


def _bars(
    trace: dict[str, Any], x: dict[str, Any], y: dict[str, Any], common: dict[str, Any]
) -> dict[str, Any]:
    place, value = ("y", "x") if trace["lying"] else ("x", "y")
    along, across = (y, x) if trace["lying"] else (x, y)
    places = _shown(trace["places"], along)
    values = trace["values"] / across["size"]
    bars = {
        "type": "bar",
        "orientation": "h" if trace["lying"] else "v",
        "marker": trace["marker"],
        "width": trace["widths"] / along["size"],
    }
    if "base" in trace:
        bars["base"] = _shown(trace["base"], across)
    if "low" in trace:
        error = {
            "array": (trace["high"] - trace["values"]) / across["size"],
            "arrayminus": (trace["values"] - trace["low"]) / across["size"],
        }
        bars[f"error_{value}"] = {
            **error,
            "thickness": 1.0,
            "width": 3,
            "color": "@main",
        }
    what = f"%{{{place}:.5~g}} {along['unit']}"
    if "text" in trace:
        bars["hovertext"] = trace["text"]  # as "text" it would be written on the bars
        what = "%{hovertext}"
    bars["hovertemplate"] = f"{what}<br>%{{{value}:.5~g}} {across['unit']}" + _name_of(trace)
    if trace["lying"]:
        return {**bars, **common, "x": values, "y": places}
    return {**bars, **common, "x": places, "y": values}


def _levels(drawn: dict[str, Any]) -> list[dict[str, Any]]:
    shapes = []
    for level in drawn["levels"]:
        frame = drawn["frames"][level["axis"]]
        place = float(_shown(np.array(level["value"]), frame))
        along = level["axis"][0]
        across = level["across"][0]
        # the line crosses the whole panel along the other axis
        ends = {
            f"{along}ref": level["axis"],
            f"{along}0": place,
            f"{along}1": place,
            f"{across}ref": f"{level['across']} domain",
            f"{across}0": 0,
            f"{across}1": 1,
        }
        shapes.append(
            {
                "type": "line",
                "line": level["line"],
                "label": {"text": level["label"], "textposition": "end", "font": {"size": 10}},
                **ends,
            }
        )
    return shapes


def _spans(drawn: dict[str, Any]) -> list[dict[str, Any]]:
    shapes = []
    for span in drawn["spans"]:
        frame = drawn["frames"][span["axis"]]
        # more would be too narrow to see, and slow
        starts, ends = (
            _shown(span[side][:_MOST_SPANS], frame).tolist() for side in ("starts", "ends")
        )
        for start, end in zip(starts, ends, strict=True):
            look = {
                "fillcolor": span["fillcolor"],
                "opacity": span["opacity"],
                "line": {"width": 0},
                "layer": "below",
            }
            across = {"yref": f"{span['across']} domain", "y0": 0, "y1": 1}
            shapes.append(
                {"type": "rect", "xref": span["axis"], "x0": start, "x1": end, **across, **look}
            )
    return shapes


def _rugs(drawn: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the ticks of rugs, as one path each."""
    shapes = []
    for trace in drawn["data"]:
        if trace["type"] == "rug" and len(trace["x"]):
            path = "".join(
                f"M{place},0L{place},0.03"
                for place in _shown(trace["x"], drawn["frames"][trace["xaxis"]]).tolist()
            )
            across = {"xref": trace["xaxis"], "yref": f"{trace['yaxis']} domain"}
            shapes.append(
                {
                    "type": "path",
                    "path": path,
                    **across,
                    "line": {"color": trace["color"], "width": 1},
                }
            )
    return shapes


def _shown(values: Floats, frame: dict[str, Any]) -> Floats:
    return np.asarray((np.asarray(values, dtype=float) - frame["origin"]) / frame["size"])


def _coloured(part: Any) -> Any:
    """Return a part of a figure with the roles replaced by their colours on light ground,
    and the opacity of areas in their colour.
    """
    if isinstance(part, dict):
        coloured = {key: _coloured(value) for key, value in part.items() if key != "fillopacity"}
        opacity = part.get("fillopacity", 1.0)
        if opacity < 1.0:
            red, green, blue = (
                int(coloured["fillcolor"][index : index + 2], 16) for index in (1, 3, 5)
            )
            coloured["fillcolor"] = f"rgba({red},{green},{blue},{opacity})"
        return coloured
    if isinstance(part, list):
        return [_coloured(item) for item in part]
    if isinstance(part, str) and part.startswith("@") and part[1:] in _COLOURS:
        return _COLOURS[part[1:]]
    return part
