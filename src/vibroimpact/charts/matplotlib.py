"""A chart drawn by matplotlib, for print: with its views as further panels, where a page has buttons."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.frame import (
    Frame,
    frames_of,
    own_view,
    panels_without_label,
    view_frames,
    view_range,
)
from vibroimpact.charts.marks import (
    Level,
    Points,
)
from vibroimpact.charts.print_axes import plain_log, set_axis
from vibroimpact.charts.print_marks import PrintedMarks
from vibroimpact.charts.print_style import lettering, print_style

WIDTH = 8.0
"""Width of every figure [in]."""

_ROW, _SMALL_ROW, _ENLARGED_ROW = 2.9, 1.45, 2.2
"""Height of a row: the only one, one of several, and one of enlarged views [in]."""

_TITLE, _SUBTITLE_LINE = 0.27, 0.155
"""Height of the title, and of a line below it [in]."""

_MOST_ENLARGED = 5
"""Views drawn; more panels would be too narrow to read."""

_MOST_BESIDE = 3
"""Views drawn beside each of two rows."""


_LEGEND_LINE = 0.17
"""Height of a line of the legend [in]."""


def matplotlib_figure(chart: Chart) -> Figure:
    """Return a chart as a figure of matplotlib, of a width of 8 inches.

    A chart of one panel has its first five views in a row below; one of several rows has its first view beside each of them,
    one of two rows its first three.

    Examples
    --------
    >>> from vibroimpact.charts.marks import Line
    >>> time, force = Axis("Time", "s"), Axis("Force", "N")
    >>> line = Line(np.array([0.0, 1.0]), np.array([5.0, 7000.0]))
    >>> figure = matplotlib_figure(Chart("force", "Force", ((Panel(time, force, (line,)),),)))
    >>> figure.axes[0].get_ylabel(), figure.axes[0].lines[0].get_ydata().tolist()
    ('Force [kN]', [0.005, 7.0])
    """
    with print_style():
        return _Print(chart).figure()


class _Print:
    """The figure while it is put together."""

    def __init__(self, chart: Chart) -> None:
        self.chart, self.frames = chart, frames_of(chart)
        self.marks = PrintedMarks(chart, self.frames)
        self.drawn: dict[tuple[Axis, str], list[Axes]] = {}
        self.unlabelled = panels_without_label(chart, self.frames)

    def figure(self) -> Figure:
        chart, rows = self.chart, self.chart.rows
        views = [panel.x.views for panel in chart.panels if panel.x.views]
        beside = bool(views) and len(rows) > 1
        below = list(views[0][:_MOST_ENLARGED]) if views and not beside else []
        usual = _ROW if len(rows) == 1 else _SMALL_ROW
        heights = [chart.height or (3.4 if row[0].picture and len(row) < 3 else usual) for row in rows]
        heights = [max(height, 2.1) if len(rows) > 1 and not self._aligned() else height for height in heights]
        lines = [lettering(line, 150) for line in chart.subtitle.splitlines()]
        under_title = _SUBTITLE_LINE * (len(lines) + 0.5) if lines else 0.0
        total = sum(heights) + (_ENLARGED_ROW if below else 0.0) + 0.55 + under_title
        figure = Figure(figsize=(WIDTH, total), layout="constrained")
        figure.suptitle(lettering(chart.title, 110), x=0.01, ha="left", fontsize=10.5, fontweight="bold")
        if lines:
            figure.set_layout_engine("constrained", rect=(0.0, 0.0, 1.0, 1.0 - under_title / total))
            figure.text(0.01, 1.0 - _TITLE / total, "\n".join(lines), fontsize=8.0, va="top", linespacing=1.3)
        parts: Any = figure.subfigures(2, 1, height_ratios=[sum(heights), _ENLARGED_ROW]) if below else [figure]
        shown = _MOST_BESIDE if len(rows) == 2 and self._aligned() else 1
        parted = [[(panel, view) for panel in row for view in panel.x.views[:shown]] if beside else [] for row in rows]
        columns = [len(row) + len(views) for row, views in zip(rows, parted, strict=True)]
        even = len(set(columns)) == 1
        # a common grid, where there is one, aligns the rows, and lets all maps share one colour bar
        grid = parts[0].add_gridspec(len(rows), columns[0] if even else 1, height_ratios=heights)
        for number, (row, panel_views) in enumerate(zip(rows, parted, strict=True)):
            cells, at = (grid, number) if even else (grid[number, 0].subgridspec(1, columns[number]), 0)
            places = [cells[at, column] for column in range(columns[number])]
            last = number == len(rows) - 1 or not self._aligned()
            for column, (place, panel) in enumerate(zip(places, row, strict=False)):
                axes = parts[0].add_subplot(place)
                self._panel(axes, panel, self.frames[panel.x], self.frames[panel.y], None, lowest=last)
                if column and panel.y.names and panel.y is row[column - 1].y:  # names that the panel before has already
                    axes.tick_params(labelleft=False)
            for place, (panel, view) in zip(places[len(row) :], panel_views, strict=True):
                self._view(parts[0].add_subplot(place), panel, view, lowest=last, first=False)
        if below:
            panel, inner = chart.panels[0], parts[1].add_gridspec(1, len(below))
            for number, view in enumerate(below):
                self._view(parts[1].add_subplot(inner[0, number]), panel, view, lowest=True, first=number == 0)
            self._label_once(parts[1])
        self._same_ranges()
        self._colour_bars(parts[0])
        self._legend(figure)
        return figure

    def _same_ranges(self) -> None:
        """Give the panels that have the same axis its range."""
        for (_, side), some in self.drawn.items():
            limits = [getattr(axes, f"get_{side}lim")() for axes in some]
            for axes in some if len(some) > 1 else ():
                getattr(axes, f"set_{side}lim")(min(low for low, _ in limits), max(high for _, high in limits))

    def _label_once(self, part: Any) -> None:
        """Replace equal labels of the x axes of a row by one below all of them."""
        if len({axes.get_xlabel() for axes in part.axes}) == 1:
            part.supxlabel(part.axes[0].get_xlabel(), fontsize=9.0)
            for axes in part.axes:
                axes.set_xlabel("")

    def _aligned(self) -> bool:
        """Return whether all rows have one axis of time, whose numbers the lowest row has."""
        return len({id(panel.x) for panel in self.chart.panels}) == 1

    def _view(self, axes: Axes, panel: Panel, view: View, *, lowest: bool, first: bool) -> None:
        across, up = view_frames(panel, view, self.frames[panel.y], self.chart.panels)
        since = across.label.removeprefix("Time ").partition(" of ")[0]
        short = Frame(since[:1].upper() + since[1:], across.unit, across.size, across.origin)
        self._panel(axes, panel, short, up, view, lowest=lowest, labelled=first)
        # the upper row names the view, with the number that it is about; where it has another unit than the whole, this follows
        number = view.headline.rsplit(" ", 1)[-1] if view.headline else ""
        title = f"{view.name}: {number}" if number else view.name
        unit = f"[{up.unit}]" if not first and up.unit and (up.unit != self.frames[panel.y].unit or not number) else ""
        upper = panel in self.chart.rows[0] or not number
        axes.set_title(lettering(f"{title if upper else ''} {unit}".strip()), fontsize=8.5)

    def _panel(
        self, axes: Axes, panel: Panel, across: Frame, up: Frame, view: View | None, *, lowest: bool = True, labelled: bool = True
    ) -> None:
        """Draw a panel in its frames, the whole of it or a view."""
        span = None if view is None else view_range(panel, view, self.chart.panels)
        for order, mark in enumerate(panel.marks):
            if isinstance(mark, Level) and not mark.upright and span and not span[0] <= mark.value <= span[1]:
                continue
            frames, inside = (across, up), (-np.inf, np.inf)
            if view is not None:
                own = own_view(mark, panel, view)
                frames, inside = (replace(across, origin=own.origin), up), (own.start, own.end)
            before = set(axes.get_children())
            self.marks.draw(axes, mark, panel, frames, inside)
            # in a picture what is drawn later covers what was drawn before, lines too
            for artist in set(axes.get_children()) - before if panel.picture else ():
                artist.set_zorder(2.0 + 0.001 * order)
        if panel.picture:
            axes.set_axis_off()
            axes.set_aspect("equal")
            axes.margins(0.02)
        else:
            has_symbols = any(isinstance(mark, Points) or getattr(mark, "marked", False) for mark in panel.marks)
            axes.margins(x=0.03 if has_symbols else 0.01, y=0.08)
            set_axis(axes, "x", panel.x, across)
            set_axis(axes, "y", panel.y, up)
            if view is not None:
                axes.set_xlim(*across.shown(np.array([view.start, view.end])))
            if span is not None:
                axes.set_ylim(*up.shown(np.array(span)))
            axes.tick_params(labelbottom=lowest)
            axes.set_xlabel(lettering(across.title) if lowest else "")
            labelled = labelled and panel not in self.unlabelled
            axes.set_ylabel((lettering(up.title) if up.label else up.unit) if labelled else "")
        if view is None and panel.marks:
            self.drawn.setdefault((panel.x, "x"), []).append(axes)
            self.drawn.setdefault((panel.y, "y"), []).append(axes)
        title = panel.title if panel.title != self.chart.title else ""
        if title and view is None:
            axes.set_title(lettering(title, 70), fontsize=8.5 if len(self.chart.panels) > 1 else 9.5)

    def _colour_bars(self, figure: Any) -> None:
        for scale, (picture, axes) in self.marks.scales.items():
            frame = self.frames[scale]
            bar = figure.colorbar(
                picture,
                ax=axes,
                location="bottom" if len(axes) > 1 else "right",
                shrink=0.5 if len(axes) > 1 else 1.0,
                aspect=40 if len(axes) > 1 else 25,
            )
            bar.set_label(lettering(frame.title), fontsize=8)
            bar.ax.tick_params(labelsize=7.5)
            if scale.log and isinstance(picture.norm, LogNorm):
                plain_log(bar.ax.yaxis)

    def _legend(self, figure: Figure) -> None:
        if not self.marks.named:
            return
        labels = [lettering(name, 60) for name, _ in self.marks.named]
        columns = max(1, min(len(labels), 6, int(120 // (max(map(len, labels)) + 10))))
        further = math.ceil(len(labels) / columns) - 1
        figure.set_size_inches(WIDTH, figure.get_figheight() + _LEGEND_LINE * further)
        figure.legend(list(self.marks.named.values()), labels, loc="outside lower center", ncols=columns, handlelength=3.2)
