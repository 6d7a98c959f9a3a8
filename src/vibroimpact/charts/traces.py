"""Traces of plotly for the marks of a chart, with roles in place of colours."""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Panel
from vibroimpact.charts.frame import Frame, ends_of_range
from vibroimpact.charts.marks import Bars, Line, Points
from vibroimpact.charts.palette import LOOKS, MANY

_LARGEST = 6.0
"""Largest size of a point [px]: of larger ones, plotly would rather tell a point of the
line beneath, be it half a pixel off.
"""


def line_trace(line: Line) -> dict[str, Any]:
    """Return the trace of a line."""
    drawn: dict[str, Any] = {
        "type": "scatter",
        "mode": "lines+markers" if line.marked else "lines",
        "x": line.x,
        "y": line.y,
    }
    drawn["line"] = pen(line.role)
    opacity = LOOKS[line.role].line_opacity
    if opacity < 1.0:
        drawn["opacity"] = opacity
    if line.origins:
        drawn["origins"] = list(line.origins)
    if line.marked:
        drawn["marker"] = _symbol(line.role, 5)
    return drawn | _texts(line.texts)


def silence(mark: Line | Points, panel: Panel) -> dict[str, Any]:
    """Return the setting that hides the hover text of unnamed marks of a picture, where
    coordinates are not quantities.
    """
    if panel.picture and not mark.name:
        return {"hoverinfo": "skip"}
    return {}


def points_trace(points: Points) -> dict[str, Any]:
    """Return the trace of points: small ones without an edge where there are many."""
    size = LOOKS[points.role].size
    drawn: dict[str, Any] = {"type": "scatter", "mode": "markers", "x": points.x, "y": points.y}
    drawn["marker"] = _symbol(points.role, min(_LARGEST, size))
    if len(points.x) > MANY:
        drawn["marker"] = {
            "symbol": LOOKS[points.role].symbol,
            "size": min(LOOKS[points.role].size_of_many, size),
            "color": f"@{points.role}",
            "opacity": 0.6,
            "line": {"width": 0},
        }
    drawn |= _texts(points.texts)
    if points.keys:
        drawn["keys"] = {key: _plain_key(values) for key, values in points.keys.items()}
    if points.low is not None and points.high is not None:
        drawn |= {"low": points.low, "high": points.high}
    return drawn


def _plain_key(values: Any) -> Any:
    """Return the values of a key of points as JSON can hold them: numbers, or texts."""
    if values.dtype.kind in "fiu":
        return values
    return [str(value) for value in values]


def _texts(texts: tuple[str, ...]) -> dict[str, Any]:
    """Return what points are, which takes the place of their coordinates if it has
    several lines.
    """
    if not texts:
        return {}
    settings: dict[str, Any] = {"text": [plain(text) for text in texts]}
    if "\n" in texts[0]:
        settings["hovertemplate"] = "%{text}<extra></extra>"
    return settings


def bars_trace(bars: Bars) -> dict[str, Any]:
    """Return the trace of bars, at places of given widths."""
    places = bars.places
    width = np.full(len(bars.values), bars.width)
    if len(places) == len(bars.values) + 1:
        places, width = 0.5 * (places[1:] + places[:-1]), np.diff(places)
    drawn: dict[str, Any] = {
        "type": "bars",
        "lying": bars.lying,
        "places": places,
        "values": bars.values,
        "widths": width,
    }
    drawn["marker"] = {"color": f"@{bars.role}", "line": {"width": 0.5, "color": "@main"}} | _hatch(
        bars.role, "pattern"
    )
    if bars.base is not None:
        drawn["base"] = bars.base
    if bars.low is not None and bars.high is not None:
        drawn |= {"low": bars.low, "high": bars.high}
    return drawn | _texts(bars.texts)


def pen(role: str) -> dict[str, Any]:
    """Return colour, width and dashes of lines of a role."""
    look = LOOKS[role]
    return {
        "color": f"@{role}",
        "width": look.width,
        "dash": ",".join(f"{part}px" for part in look.dashes) or "solid",
    }


def _symbol(role: str, size: float) -> dict[str, Any]:
    look = LOOKS[role]
    if look.hollow:
        return {
            "symbol": look.symbol,
            "size": size,
            "color": "@ground",
            "line": {"color": f"@{role}", "width": 1.2},
        }
    return {"symbol": look.symbol, "size": size, "color": f"@{role}"}


def area(role: str) -> dict[str, Any]:
    """Return colour, opacity and hatch of areas of a role."""
    look = LOOKS[role]
    return {"fillcolor": f"@{role}", "fillopacity": look.opacity} | _hatch(role, "fillpattern")


def _hatch(role: str, name: str) -> dict[str, Any]:
    look = LOOKS[role]
    if look.hatch:
        return {
            name: {
                "shape": look.hatch,
                "size": 7,
                "solidity": 0.15,
                "fgcolor": "@main",
                "bgcolor": f"@{role}",
            }
        }
    return {}


def colour_between(stops: tuple[tuple[float, str], ...], part: float) -> str:
    """Return the colour at a part of a scale."""
    places = [place for place, _ in stops]
    colours = [[int(colour[index : index + 2], 16) for index in (1, 3, 5)] for _, colour in stops]
    return "#" + "".join(
        f"{round(float(np.interp(part, places, [colour[index] for colour in colours]))):02x}"
        for index in range(3)
    )


def plain(phrase: str) -> str:
    """Return words that plotly shows as they are: it reads a few tags of HTML, and formulas between
    dollar signs.

    Examples
    --------
    >>> plain("a < b & $c$")
    'a &lt; b &amp; &#36;c&#36;'
    """
    return (
        phrase.replace("&", "&amp;")
        .replace("<", "&lt;")
        .replace(">", "&gt;")
        .replace("$", "&#36;")
        .replace("\n", "<br>")
    )


def scale_of(axis: Axis, frame: Frame) -> dict[str, Any]:
    """Return kind, range and ticks of an axis, as a layout of plotly has them."""
    if axis.names:
        places = list(range(len(axis.names)))
        return {
            "tickvals": places,
            "ticktext": [plain(name) for name in axis.names],
            "range": [-0.6, len(places) - 0.4],
            "zeroline": False,
        }
    scale: dict[str, Any] = {}
    if axis.log:
        scale["type"] = "log"
        if axis.range is None:
            # ticks at 1, 2 and 5 of each decade
            scale |= {"dtick": "D2", "tickformat": "~g"}
    if axis.range is not None:
        ends = ends_of_range(axis, frame)
        if axis.log:  # of which plotly takes exponents
            ends = [None if end is None else float(np.log10(end)) for end in ends]
        scale["range"] = ends
    if axis.ticks:
        scale["tickvals"] = frame.shown(np.array(axis.ticks)).tolist()
    if axis.integer:
        scale["tickformat"] = "d"
    return scale
