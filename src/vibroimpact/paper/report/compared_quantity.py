"""Figures of a quantity over time with printed values: the whole run at the left, the first impact at the right, and a caption."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.response import Response
from vibroimpact.paper.measures import Timeline
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report.drawing import LINE_STYLES
from vibroimpact.paper.runs import TREATMENTS, Runs
from vibroimpact.report.layout import heading, label_vertical, new_figure, row_of_axes
from vibroimpact.report.style import INK
from vibroimpact.runs.figure_data import decimated, history_window
from vibroimpact.units.display import digits, multiple


class ComparedQuantity(NamedTuple):
    """A quantity over time with a value to compare with the paper.

    Parameters
    ----------
    number : int
        Number of the figure in the paper.
    name, short, unit : str
        Name of the quantity, its axis label, and its SI unit.
    timeline : callable
        Function of a response that returns times and values.
    peak : str
        Description of the compared value.
    value : callable
        Function of a response that returns the compared value [SI].
    printed : str
        Name of the printed value, with {} for the type; "" if none is printed.
    signs : tuple of int
        Signs with which the printed value is marked.
    note : callable
        Function of the simulations that returns a further sentence of the caption.
    """

    number: int
    name: str
    short: str
    unit: str
    timeline: Timeline
    peak: str
    value: Callable[[Response], float]
    printed: str = ""
    signs: tuple[int, ...] = (1,)
    note: Callable[[Runs], str] = lambda runs: ""

    @property
    def heading(self) -> str:
        """Name of the quantity, capitalised."""
        return f"{self.name[0].upper()}{self.name[1:]}"


def comparison_sentence(shown: ComparedQuantity, kinds: tuple[int, ...], runs: Runs) -> str:
    """Return the sentence that compares the values of each treatment with the printed ones, and names the nearest treatment.

    Parameters
    ----------
    shown : ComparedQuantity
        The quantity.
    kinds : tuple of int
        The types: 2 and 3, or 3 alone; the nearest treatment is chosen for the last.
    runs : Runs
        The simulations.
    """
    computed = {treatment: [shown.value(runs.treated(kind, treatment)) for kind in kinds] for treatment in TREATMENTS}
    printed_values = [printed(shown.printed.format(kind)) for kind in kinds] if shown.printed else []
    everything = [value for values in computed.values() for value in values]
    scale = multiple(shown.unit, everything if any(everything) else [one.value for one in printed_values])

    def listed(values: list[float]) -> str:
        return " and ".join(digits(value / scale.size) for value in values)

    of = " (Types 2 and 3)" if len(kinds) > 1 else ""
    said = f"{shown.peak}{of}: " + ", ".join(f"{name} {listed(values)}" for name, values in computed.items()) + f" {scale.unit}"
    if not printed_values:
        return f"{said}; the paper prints none."
    paper = f"{listed([one.value for one in printed_values])} {scale.unit}"
    if printed_values[-1].relation == "<":
        below = [name for name, values in computed.items() if np.all(np.array(values) < [one.value for one in printed_values])]
        return f"{said}; the paper says below {paper}, and {_bound_clause(below)}."
    off = {name: values[-1] / printed_values[-1].value - 1.0 for name, values in computed.items()}
    nearest = min(off, key=lambda name: abs(off[name]))
    side = "above" if off[nearest] > 0.0 else "below"
    far = f"{digits(100.0 * abs(off[nearest]), 2)} % {side} it"
    return f"{said}; printed {paper}. Nearest to that{' of Type 3' if of else ''} is the {nearest} treatment, {far}."


def _bound_clause(names: list[str]) -> str:
    """Return the clause on the treatments that keep a printed bound."""
    if len(names) in (0, len(TREATMENTS)):
        return "so are all" if names else "none is"
    return f"so {'is' if len(names) == 1 else 'are'} the {' and the '.join(names)} treatment alone"


_BOTTOM, _BETWEEN, _TOP = 0.85, 0.4, 0.56
"""Margin below all rows, between rows, and above all rows [in]."""
_BEFORE = 0.06
"""Time shown before first touch, as a fraction of that after it."""
_MARK_DISTANCE = 0.35
"""Largest distance of a printed value from the curves at which it is shown, as a fraction of their range."""
_LABEL_DISTANCE = 0.1
"""Distance below which printed values share a label, as a fraction of the panel height."""
_DOTS = (0, (1, 1.5))
_HALO = [withStroke(linewidth=2.0, foreground="white")]


class ResponseLine(NamedTuple):
    """A curve in a row of panels: its label, the index of its line style, and the response that it shows."""

    name: str
    style: int
    response: Response


def draw_rows(
    shown: ComparedQuantity, rows: Mapping[str, Sequence[ResponseLine]], marks: Mapping[str, float], span: float, height: float, head: str
) -> Figure:
    """Draw a quantity in rows of two panels, with a common scale for each column.

    Parameters
    ----------
    shown : ComparedQuantity
        The quantity.
    rows : mapping of str to sequence of ResponseLine
        Curves of each row, by row title.
    marks : mapping of str to float
        Printed values [SI], by label.
    span : float
        Time shown from first touch on in the right column [s].
    height : float
        Height of the panels [in].
    head : str
        Heading of the figure.
    """
    # both columns have their own time and value scales, since the first impact is short beside the whole run
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


def _after_touch(shown: ComparedQuantity, response: Response, span: float) -> tuple[Floats, Floats]:
    """Return times since first touch [s] and values, around the first impact."""
    time, values = shown.timeline(response)
    touch = float(response.impacts["time_s"][0])
    part = history_window({"time_s": time, "value": values}, touch - _BEFORE * span, touch + span)
    return part["time_s"] - touch, part["value"]


def _draw_column(
    column: Sequence[Axes],
    shown: ComparedQuantity,
    rows: Mapping[str, Sequence[ResponseLine]],
    parts: Sequence[Sequence[tuple[Floats, Floats]]],
    clock: float,
    marks: Mapping[str, float],
) -> str:
    """Draw the panels of a column in a common scale, with the printed values close to the curves; return the unit of the scale."""
    everything = np.concatenate([values for row in parts for _, values in row])
    nothing = not np.any(everything)
    scale = multiple(shown.unit, list(marks.values()) if nothing else everything)
    for axes, lines, row in zip(column, rows.values(), parts, strict=True):
        for line, (time, values) in zip(lines, row, strict=True):
            axes.plot(*decimated(time / clock, values / scale.size), **LINE_STYLES[line.style])
        if not any(np.any(values) for _, values in row):
            axes.text(0.5, 0.4, "zero", transform=axes.transAxes, ha="center", fontsize=8.0)
    low, high = (float(pick(everything)) / scale.size for pick in (np.nanmin, np.nanmax))
    reach = np.inf if nothing else _MARK_DISTANCE * (high - low)
    # printed values far from the curves are left out, so that they do not flatten them
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
    """Draw printed values as lines, with a common label for neighbouring ones."""
    labels: list[tuple[float, list[str]]] = []
    for name, level in sorted(levels, key=lambda pair: pair[1]):
        axes.axhline(level, color=INK, linewidth=0.7, linestyle=_DOTS, zorder=1.9)
        up = float(axes.transLimits.transform((0.0, level))[1])
        if labels and up - labels[-1][0] < _LABEL_DISTANCE:
            labels[-1] = (up, [*labels[-1][1], name])
        else:
            labels.append((up, [name]))
    for up, names in labels:
        words, offset = ", ".join(sorted(names)), (-1.5, 1.5)
        axes.annotate(words, (1.0, up), offset, "axes fraction", "offset points", fontsize=6.5, ha="right", va="bottom", path_effects=_HALO)


def _draw_legend(figure: Figure, lines: Sequence[ResponseLine], marked: bool) -> None:
    styles = {line.name: LINE_STYLES[line.style] for line in lines}
    handles = [Line2D([], [], label=name, **style) for name, style in styles.items()]
    if marked:
        handles.append(Line2D([], [], color=INK, linewidth=0.8, linestyle=_DOTS, label="printed"))
    figure.legend(handles=handles, loc="lower center", ncols=len(handles), handlelength=4.0)
