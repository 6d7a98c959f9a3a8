"""A quantity in rows of panels: the whole run at the left, the first impact at the right, with what the paper prints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.response import Response
from vibroimpact.paper.report.compared import Compared
from vibroimpact.paper.report.line_styles import LOOKS
from vibroimpact.report.layout import heading, label_vertical, new_figure, row_of_axes
from vibroimpact.report.style import INK
from vibroimpact.runs.figure_data import decimated, history_window
from vibroimpact.units.display import multiple

_BOTTOM, _BETWEEN, _TOP = 0.85, 0.4, 0.56
"""Room below all rows, between them, and above all [in]."""
_BEFORE = 0.06
"""What is shown before first touch, as a part of what is shown after it."""
_NEAR = 0.35
"""How far beyond the lines a printed value is still shown, as a part of their range."""
_TOGETHER = 0.1
"""Printed values that lie closer than this, as a part of the height of a panel, share a label."""
_DOTS = (0, (1, 1.5))
_HALO = [withStroke(linewidth=2.0, foreground="white")]


class Line(NamedTuple):
    """A line of a row: its name, its place among the `LOOKS`, and the response that it shows."""

    name: str
    place: int
    response: Response


def draw_rows(
    shown: Compared, rows: Mapping[str, Sequence[Line]], marks: Mapping[str, float], span: float, height: float, head: str
) -> Figure:
    """Draw a quantity in rows of two panels, all panels of a column in one scale.

    Parameters
    ----------
    shown : Compared
        The quantity.
    rows : mapping of str to sequence of Line
        The lines of each row, by its title.
    marks : mapping of str to float
        Printed values [SI], by what they are labelled with.
    span : float
        How much is shown from the first touch on, at the right [s].
    height : float
        Height of the panels [in].
    head : str
        What is said over the figure.
    """
    step = height + _BETWEEN
    figure = new_figure(_BOTTOM + len(rows) * step - _BETWEEN + _TOP)
    places = [row_of_axes(figure, 2, _BOTTOM + index * step, height) for index in reversed(range(len(rows)))]
    clock = multiple("s", span)
    left, right = ([axes[side] for axes in places] for side in (0, 1))
    whole = [[shown.timeline(line.response) for line in lines] for lines in rows.values()]
    close = [[_after_touch(shown, line.response, span) for line in lines] for lines in rows.values()]
    unit = _draw_column(left, shown, rows, whole, 1.0, marks)
    own = _draw_column(right, shown, rows, close, clock.size, marks)
    for title, axes in zip(rows, left, strict=True):
        axes.set_title(title)
        label_vertical(axes, f"{shown.short} [{unit}]")
    if own != unit:
        right[0].set_title(f"[{own}]")
    left[-1].set_xlabel("Time [s]")
    right[-1].set_xlabel(f"Time since first touch [{clock.unit}]")
    heading(figure, head, figure.get_figheight() - 0.24)
    _draw_legend(figure, [line for lines in rows.values() for line in lines], bool(marks))
    return figure


def _after_touch(shown: Compared, response: Response, span: float) -> tuple[Floats, Floats]:
    """Return times since first touch [s] and values, around the first impact."""
    time, values = shown.timeline(response)
    touch = float(response.impacts["time_s"][0])
    part = history_window({"time_s": time, "value": values}, touch - _BEFORE * span, touch + span)
    return part["time_s"] - touch, part["value"]


def _draw_column(
    column: Sequence[Axes],
    shown: Compared,
    rows: Mapping[str, Sequence[Line]],
    parts: Sequence[Sequence[tuple[Floats, Floats]]],
    clock: float,
    marks: Mapping[str, float],
) -> str:
    """Draw the panels of a column in one scale, with the printed values that lie near the lines; return the unit."""
    everything = np.concatenate([values for row in parts for _, values in row])
    nothing = not np.any(everything)
    scale = multiple(shown.unit, list(marks.values()) if nothing else everything)
    for axes, lines, row in zip(column, rows.values(), parts, strict=True):
        for line, (time, values) in zip(lines, row, strict=True):
            axes.plot(*decimated(time / clock, values / scale.size), **LOOKS[line.place])
        if not any(np.any(values) for _, values in row):
            axes.text(0.5, 0.4, "zero", transform=axes.transAxes, ha="center", fontsize=8.0)
    low, high = (float(pick(everything)) / scale.size for pick in (np.nanmin, np.nanmax))
    reach = np.inf if nothing else _NEAR * (high - low)
    levels = [(name, sign * value / scale.size) for name, value in marks.items() for sign in shown.signs]
    levels = [(name, level) for name, level in levels if low - reach <= level <= high + reach]
    low, high = min([low, *(level for _, level in levels)]), max([high, *(level for _, level in levels)])
    first, last = (pick(float(time[end]) for row in parts for time, _ in row) / clock for pick, end in ((min, 0), (max, -1)))
    for axes in column:
        axes.set_xlim(first - 0.01 * (last - first), last + 0.01 * (last - first))
        axes.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
        axes.tick_params(labelbottom=axes is column[-1])
        axes.tick_params(axis="y", labelsize=7.0, pad=2.0)
        axes.yaxis.set_major_locator(MaxNLocator(5, min_n_ticks=3, steps=[1, 2, 2.5, 5, 10]))
        axes.set_ylim(low - 0.06 * (high - low), high + 0.06 * (high - low))
        _draw_marks(axes, levels)
    return scale.unit


def _draw_marks(axes: Axes, levels: Sequence[tuple[str, float]]) -> None:
    """Draw printed values as lines, and label those that lie close to one another as one."""
    labels: list[tuple[float, list[str]]] = []
    for name, level in sorted(levels, key=lambda pair: pair[1]):
        axes.axhline(level, color=INK, linewidth=0.7, linestyle=_DOTS, zorder=1.9)
        up = float(axes.transLimits.transform((0.0, level))[1])
        if labels and up - labels[-1][0] < _TOGETHER:
            labels[-1] = (up, [*labels[-1][1], name])
        else:
            labels.append((up, [name]))
    for up, names in labels:
        words, place = ", ".join(sorted(names)), (-1.5, 1.5)
        axes.annotate(words, (1.0, up), place, "axes fraction", "offset points", fontsize=6.5, ha="right", va="bottom", path_effects=_HALO)


def _draw_legend(figure: Figure, lines: Sequence[Line], marked: bool) -> None:
    looks = {line.name: LOOKS[line.place] for line in lines}
    handles = [Line2D([], [], label=name, **look) for name, look in looks.items()]
    if marked:
        handles.append(Line2D([], [], color=INK, linewidth=0.8, linestyle=_DOTS, label="printed"))
    figure.legend(handles=handles, loc="lower center", ncols=len(handles), handlelength=4.0)
