"""Figure of the plate's deflection: maps at six times."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patheffects import withStroke
from scipy.ndimage import maximum_filter

from vibroimpact.report.layout import WIDTH, new_figure
from vibroimpact.report.style import INK, lettering
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.result import Result
from vibroimpact.units.display import Multiple, digits, multiple, text

_COLUMNS, _ROWS = 3, 2
_LEFT, _BETWEEN, _TITLE, _HEAD, _FOOT = 0.2, 0.14, 0.26, 0.38, 0.62
"""Space at the side, between maps, and for their titles, the heading and the colour bar [in]."""

_AT_REST = 0.015
"""Relative to the largest deflection of a map: where all neighbouring points are below, no contour lines are drawn."""

_ROUNDING = 1e-9
"""Relative to the largest deflection of all maps: smaller values are drawn as zero."""

_HALO = [withStroke(linewidth=1.8, foreground="white", alpha=0.8)]
"""Outline of sensor names, which makes them legible on dark colours."""


def draw_deflection(result: Result) -> Figure:
    """Draw the plate's deflection from above at six times after first touch, all on one colour scale."""
    deflection = result.deflection
    assert deflection is not None  # checked by the caller
    touch, frames = float(result.impacts["time_s"][0]), chosen_frames(result, deflection)
    shape = np.ptp(deflection.y) / np.ptp(deflection.x)
    across = (WIDTH - 2.0 * _LEFT - (_COLUMNS - 1) * _BETWEEN) / _COLUMNS
    high = across * float(np.clip(shape, 0.2, 1.6))
    figure = new_figure(_HEAD + _ROWS * (high + _TITLE) + _FOOT)
    total = figure.get_figheight()
    most = float(np.nanmax(np.abs(deflection.height[frames])))
    scale = multiple("m", most)
    for number, frame in enumerate(frames):
        row, column = divmod(number, _COLUMNS)
        bottom = total - _HEAD - (row + 1) * (high + _TITLE)
        axes = figure.add_axes(((_LEFT + column * (across + _BETWEEN)) / WIDTH, bottom / total, across / WIDTH, high / total))
        picture = _draw(axes, result, deflection, frame, scale, most)
        axes.set_title(f"{text(float(deflection.time[frame]) - touch, 's', 3)} after first touch", fontsize=8.5)
    bar = figure.colorbar(picture, cax=figure.add_axes((0.3, 0.36 / total, 0.4, 0.09 / total)), orientation="horizontal")
    bar.ax.tick_params(labelsize=7.5, length=2)
    bar.ax.set_xlabel(f"upwards [{scale.unit}]", fontsize=8, labelpad=1)
    words = "Deflection of the plate from above (lines: dashed down, full up, thick at rest; circle: contact point)"
    figure.text(_LEFT / WIDTH, (total - 0.22) / total, words, fontsize=9.5, va="bottom")
    return figure


def chosen_frames(result: Result, deflection: Deflection) -> list[int]:
    """Return the indices of the frames drawn: in mid-contact, at release, and up to the last at geometrically growing times."""
    touch, duration = (float(result.impacts[name][0]) for name in ("time_s", "duration_s"))
    after = float(deflection.time[-1]) - touch
    wanted = touch + np.append(0.5 * duration, np.geomspace(min(duration, 0.3 * after), after, _COLUMNS * _ROWS - 1))
    return sorted({int(np.abs(deflection.time - time).argmin()) for time in wanted})


def _draw(axes: Axes, result: Result, deflection: Deflection, frame: int, scale: Multiple, most: float) -> AxesImage:
    still = np.abs(deflection.height) <= _ROUNDING * most
    height = np.where(still[frame], 0.0, deflection.height[frame]) / scale.size
    half = 0.5 * np.array([deflection.x[1] - deflection.x[0], deflection.y[1] - deflection.y[0]])
    edges = (deflection.x[0] - half[0], deflection.x[-1] + half[0], deflection.y[0] - half[1], deflection.y[-1] + half[1])
    picture = axes.imshow(
        height,
        extent=edges,
        origin="lower",
        cmap="RdBu_r",
        vmin=-most / scale.size,
        vmax=most / scale.size,
        interpolation="bilinear",
        aspect="auto",
    )
    own = float(np.nanmax(np.abs(height))) or 1.0
    levels = own * np.linspace(-0.9, 0.9, 7)
    levels[3] = 0.0
    styles = ["--"] * 3 + ["-"] * 4
    # where the plate is held or hardly moves, the zero contour would follow rounding errors
    hidden = (maximum_filter(np.nan_to_num(np.abs(height)), 3) < _AT_REST * own) | np.all(still, axis=0)
    lined = np.ma.masked_where(hidden, height)
    axes.contour(deflection.x, deflection.y, lined, levels=levels, colors=INK, linewidths=[0.5] * 3 + [0.9] + [0.5] * 3, linestyles=styles)
    axes.plot(*deflection.contact, "o", markersize=6, markerfacecolor="white", markeredgecolor=INK, markeredgewidth=1.2)
    for name, x, y in sensor_places(result):
        axes.plot(x, y, "^", markersize=5, markerfacecolor="#ffd54a", markeredgecolor=INK, markeredgewidth=0.8)
        axes.annotate(lettering(name, 14), (x, y), (4, 3), textcoords="offset points", fontsize=7, path_effects=_HALO)
    axes.text(
        0.985,
        0.02,
        f"{digits(float(np.nanmin(height)), 2)} to {digits(float(np.nanmax(height)), 2)}",
        fontsize=7,
        ha="right",
        va="bottom",
        transform=axes.transAxes,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.8},
    )
    axes.set_xticks([])
    axes.set_yticks([])
    axes.grid(visible=False)
    return picture


def sensor_places(result: Result) -> list[tuple[str, float, float]]:
    """Return name, x and y [m] of the sensors whose positions the case gives as coordinates."""
    sensors = result.case.get("sensors", [])
    placed = [(one["name"], one["position"]) for one in sensors]
    return [(name, float(place[0]), float(place[1])) for name, place in placed if not isinstance(place, str)]
