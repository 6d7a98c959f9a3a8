"""A chart drawn by matplotlib, for print.

Its views are further panels, where a page has buttons.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel, StoredChart
from vibroimpact.charts.frame import (
    Frame,
    ends_on,
    frames_of,
    own_view,
    panels_without_label,
    view_frames,
    view_range,
)
from vibroimpact.charts.marks import (
    Label,
    Level,
    Mark,
    Points,
)
from vibroimpact.charts.print_axes import plain_log, set_axis
from vibroimpact.charts.print_marks import PrintedMarks
from vibroimpact.charts.print_style import lettering, print_style
from vibroimpact.errors import InputError

WIDTH = 8.0
"""Width of every figure [in]."""

_ROW = 2.9
"""Height of the only row [in]."""

_SMALL_ROW = 1.45
"""Height of one of several rows [in]."""

_ENLARGED_ROW = 2.2
"""Height of a row of enlarged views [in]."""

_FEW_PICTURES_ROW = 3.4
"""Height of a row of one or two pictures, if it is not that of their widths [in]."""

_TITLE = 0.27
"""Height of the title [in]."""

_SUBTITLE_LINE = 0.155
"""Height of a line below the title [in]."""

_MOST_ENLARGED = 5
"""Views drawn; more panels would be too narrow to read."""

_MOST_BESIDE = 3
"""Views drawn beside each of two rows."""

_PICTURE_GAP = 0.15
"""Width between pictures [in]."""

_PICTURE_TITLE = 0.3
"""Height of the title of a picture [in]."""

_PICTURE_WORDS = 0.2
"""Height of words below a picture [in]."""

_LEAST_PICTURE = 0.4
"""The least height of a picture [in]."""

_LARGEST_PICTURE_ROW = 4.5
"""The largest height of a row of pictures with their words [in]."""

_LEGEND_LINE = 0.17
"""Height of a line of the legend [in]."""

_COLOUR_BAR = 0.65
"""Height of a colour bar below its maps, with numbers and label [in]."""

_NUMBERS = 0.52
"""Width that a panel leaves to the numbers at its side [in]."""

_LETTER = 0.06
"""Width of a letter of the title of a view [in]."""


def matplotlib_figure(chart: Chart, figure: Figure | None = None) -> Figure:
    """Return a chart as a figure of matplotlib, of a width of 8 inches.

    A chart of one panel has its first five views in a row below; one of several rows has its first
    view beside each of them, one of two rows its first three.

    Parameters
    ----------
    chart : Chart
        The chart.
    figure : matplotlib.figure.Figure, optional
        The empty figure into which it is drawn, and whose size it changes, such as `plt.figure()`,
        which a window shows; by default a new one that pyplot does not know.

    Returns
    -------
    matplotlib.figure.Figure
        The figure.

    Raises
    ------
    InputError
        If the chart was stored without its panels.

    Examples
    --------
    >>> from vibroimpact.charts.marks import Line
    >>> time, force = Axis("Time", "s"), Axis("Force", "N")
    >>> line = Line(np.array([0.0, 1.0]), np.array([5.0, 7000.0]))
    >>> figure = matplotlib_figure(Chart("force", "Force", ((Panel(time, force, (line,)),),)))
    >>> figure.axes[0].get_ylabel(), figure.axes[0].lines[0].get_ydata().tolist()
    ('Force [kN]', [0.005, 7.0])
    """
    if isinstance(chart, StoredChart):
        raise InputError(f"the chart {chart.name} was stored as drawn for a page alone")
    with print_style():
        if figure is None:
            figure = Figure()
        return _Print(chart).figure(figure)


class _Print:
    """The figure while it is put together."""

    def __init__(self, chart: Chart) -> None:
        self.chart = chart
        self.frames = frames_of(chart)
        self.marks = PrintedMarks(chart, self.frames)
        self.drawn: dict[tuple[Axis, str], list[Axes]] = {}
        self.unlabelled = panels_without_label(chart, self.frames)

    def figure(self, figure: Figure) -> Figure:
        """Draw into a figure, and return it."""
        rows = self.chart.rows
        heights = [self._height(row) for row in rows]
        views_below: tuple[View, ...] = ()
        views_height = 0.0
        if len(rows) == 1 and self.chart.views:
            views_below = self.chart.views[:_MOST_ENLARGED]
            views_height = _ENLARGED_ROW
        figure.set_size_inches(WIDTH, sum(heights) + views_height + 0.55)
        figure.set_layout_engine("constrained")
        rows_part: Any = figure
        views_part: Any = None
        if views_below:
            height_ratios = [sum(heights), _ENLARGED_ROW]
            parts: Any = figure.subfigures(2, 1, height_ratios=height_ratios)
            rows_part, views_part = parts
        self._rows(rows_part, heights)
        if views_below:
            self._views_below(views_part, views_below)
        self._same_ranges()
        self._colour_bars(figure, rows_part)
        self._legend(figure)
        self._titles(figure)
        return figure

    def _rows(self, part: Any, heights: list[float]) -> None:
        """Draw the rows of panels, with some of their views beside them."""
        rows = self.chart.rows
        most_beside = self._most_views_beside()
        views = [
            [(panel, view) for panel in row for view in panel.x.views[:most_beside]] for row in rows
        ]
        counts = [len(row) + len(row_views) for row, row_views in zip(rows, views, strict=True)]
        most = max(counts)
        if self._pictures():  # those of a row that is not full are as large as the others
            counts = [most] * len(rows)
        # a common grid, where there is one, aligns the rows, and lets all maps share one colour bar
        has_common_grid = all(most % count == 0 for count in counts)
        columns = most if has_common_grid else 1
        grid = part.add_gridspec(len(rows), columns, height_ratios=heights)
        for number, (row, row_views, count) in enumerate(zip(rows, views, counts, strict=True)):
            if has_common_grid:
                cells = _equal_cells(grid, number, most // count, count)
            else:
                cells = _equal_cells(grid[number, 0].subgridspec(1, count), 0, 1, count)
            lowest = number == len(rows) - 1 or not self._aligned()
            self._row(part, row, cells[: len(row)], lowest=lowest)
            for cell, (panel, view) in zip(cells[len(row) :], row_views, strict=False):
                axes = part.add_subplot(cell)
                self._view(axes, panel, view, count, self.frames[panel.y], lowest=lowest)
        if has_common_grid and len(rows) > 1:
            part.align_ylabels()

    def _most_views_beside(self) -> int:
        """Return how many views of a panel are drawn beside it."""
        rows = len(self.chart.rows)
        if rows == 1:
            return 0
        if rows == 2 and self._aligned():
            return _MOST_BESIDE
        return 1

    def _row(self, part: Any, row: tuple[Panel, ...], cells: list[Any], *, lowest: bool) -> None:
        """Draw the panels of a row into cells of a grid."""
        for column, (cell, panel) in enumerate(zip(cells, row, strict=True)):
            axes = part.add_subplot(cell)
            self._panel(
                axes, panel, self.frames[panel.x], self.frames[panel.y], None, lowest=lowest
            )
            # names that the panel before has already
            if column and panel.y.names and panel.y is row[column - 1].y:
                axes.tick_params(labelleft=False)

    def _height(self, row: tuple[Panel, ...]) -> float:
        """Return the height of a row [in].

        That of pictures follows from their width; a single row of them is no higher than usual.
        """
        is_only_row = len(self.chart.rows) == 1
        if self.chart.height:
            usual = self.chart.height
        elif row[0].picture and len(row) < 3:
            usual = _FEW_PICTURES_ROW
        else:
            usual = _ROW if is_only_row else _SMALL_ROW
        if self._pictures():
            largest = usual if is_only_row else _LARGEST_PICTURE_ROW
            return self._picture_height(row, largest)
        if is_only_row or self._aligned():
            return usual
        return max(usual, 2.1)  # each row has the title of its own horizontal axis

    def _picture_height(self, row: tuple[Panel, ...], largest: float) -> float:
        """Return the height of a row of pictures with their words [in]."""
        width = WIDTH / max(map(len, self.chart.rows)) - _PICTURE_GAP
        heights = []
        for panel in row:
            across = np.ptp(ends_on(panel.x, self.chart))
            up = np.ptp(ends_on(panel.y, self.chart))
            heights.append(width * float(up / (across or up or 1.0)))
        has_words_below = len(self.chart.rows) == 1 or any(
            isinstance(mark, Label) and mark.corner for panel in row for mark in panel.marks
        )
        height_of_words = _PICTURE_TITLE
        if has_words_below:
            height_of_words += _PICTURE_WORDS
        return min(max(*heights, _LEAST_PICTURE) + height_of_words, largest)

    def _pictures(self) -> bool:
        """Return whether all panels are pictures."""
        return all(panel.picture for panel in self.chart.panels)

    def _views_below(self, part: Any, views: tuple[View, ...]) -> None:
        """Draw views of the first panel in a row; the first one has the label of the
        vertical axis.
        """
        panel = self.chart.panels[0]
        grid = part.add_gridspec(1, len(views))
        _, named = view_frames(panel, views[0], self.frames[panel.y], self.chart.panels)
        for number, view in enumerate(views):
            axes = part.add_subplot(grid[0, number])
            beside = named if number else None
            self._view(axes, panel, view, len(views), beside, lowest=True)
        self._label_once(part)

    def _titles(self, figure: Figure) -> None:
        """Write the title and the lines below it, once the height of the figure is known."""
        chart = self.chart
        total = figure.get_figheight()
        figure.suptitle(
            lettering(chart.title, 110), x=0.01, ha="left", fontsize=10.5, fontweight="bold"
        )
        lines = [lettering(line, 150) for line in chart.subtitle.splitlines()]
        if lines:
            height = _SUBTITLE_LINE * (len(lines) + 0.5)
            figure.set_size_inches(WIDTH, total + height)
            figure.set_layout_engine("constrained", rect=(0.0, 0.0, 1.0, total / (total + height)))
            figure.text(
                0.01,
                1.0 - _TITLE / (total + height),
                "\n".join(lines),
                fontsize=8.0,
                va="top",
                linespacing=1.3,
            )

    def _same_ranges(self) -> None:
        """Give the panels that have the same axis its range."""
        for (_, side), some in self.drawn.items():
            if len(some) == 1:
                continue
            limits = [getattr(axes, f"get_{side}lim")() for axes in some]
            lowest = min(low for low, _ in limits)
            highest = max(high for _, high in limits)
            for axes in some:
                getattr(axes, f"set_{side}lim")(lowest, highest)

    def _label_once(self, part: Any) -> None:
        """Replace equal labels of the x axes of a row by one below all of them."""
        if len({axes.get_xlabel() for axes in part.axes}) == 1:
            part.supxlabel(part.axes[0].get_xlabel(), fontsize=9.0)
            for axes in part.axes:
                axes.set_xlabel("")

    def _aligned(self) -> bool:
        """Return whether all rows have one axis of time, whose numbers the lowest row has."""
        return len({id(panel.x) for panel in self.chart.panels}) == 1

    def _view(
        self,
        axes: Axes,
        panel: Panel,
        view: View,
        columns: int,
        beside: Frame | None,
        *,
        lowest: bool,
    ) -> None:
        """Draw a view in one of some columns, beside a panel whose vertical axis has a
        label; None if there is none.
        """
        across, up = view_frames(panel, view, self.frames[panel.y], self.chart.panels)
        # "Time since first touch of impact 1" is too long below a narrow view, whose title has the
        # number of the impact
        since = across.label.removeprefix("Time ").partition(" of ")[0]
        label = since[:1].upper() + since[1:]
        short = replace(across, label=label)
        self._panel(axes, panel, short, up, view, lowest=lowest, labelled=beside is None)
        has_unit = (
            beside is None or up.unit == beside.unit or view.headline.split()[-1:] == [up.unit]
        )
        title = "" if has_unit else f"[{up.unit}]"
        # the upper row names the view and what it is about
        if panel in self.chart.rows[0] or not view.headline:
            most_letters = int((WIDTH / columns - _NUMBERS) / _LETTER)
            title = _title(view, title, most_letters)
        lines = [lettering(line) for line in title.splitlines()]
        size = 8.0 if columns > _MOST_BESIDE else 8.5
        axes.set_title("\n".join(lines), fontsize=size)

    def _panel(
        self,
        axes: Axes,
        panel: Panel,
        across: Frame,
        up: Frame,
        view: View | None,
        *,
        lowest: bool = True,
        labelled: bool = True,
    ) -> None:
        """Draw a panel in its frames, the whole of it or a view."""
        span = None
        if view is not None:
            span = view_range(panel, view, self.chart.panels)
        self._marks(axes, panel, (across, up), view, span)
        if panel.picture:
            axes.set_axis_off()
            axes.set_aspect("equal", anchor="N")  # the titles of a row in a line
            axes.margins(0.02)
        else:
            has_symbols = any(
                isinstance(mark, Points) or getattr(mark, "marked", False) for mark in panel.marks
            )
            # symbols at the ends are wider than lines, and are not to be cut
            axes.margins(x=0.03 if has_symbols else 0.01, y=0.08)
            set_axis(axes, "x", panel.x, across)
            set_axis(axes, "y", panel.y, up)
            if view is not None:
                axes.set_xlim(*across.shown(np.array([view.start, view.end])))
            if span is not None:
                axes.set_ylim(*up.shown(np.array(span)))
            axes.tick_params(labelbottom=lowest)
            if lowest:
                axes.set_xlabel(lettering(across.title))
            if labelled and panel not in self.unlabelled:
                label = lettering(up.title) if up.label else up.unit
                axes.set_ylabel(label)
        if view is not None:
            return
        if panel.marks:
            self.drawn.setdefault((panel.x, "x"), []).append(axes)
            self.drawn.setdefault((panel.y, "y"), []).append(axes)
        if panel.title and panel.title != self.chart.title:
            size = 8.5 if len(self.chart.panels) > 1 else 9.5
            axes.set_title(lettering(panel.title, 70), fontsize=size)

    def _marks(
        self,
        axes: Axes,
        panel: Panel,
        frames: tuple[Frame, Frame],
        view: View | None,
        span: tuple[float, float] | None,
    ) -> None:
        """Draw the marks of a panel, but for levels beyond the vertical span of a view."""
        across, up = frames
        inside = (-np.inf, np.inf)
        for order, mark in enumerate(panel.marks):
            if span is not None and _is_level_beyond(mark, span):
                continue
            if view is not None:
                own = own_view(mark, panel, view)
                across = replace(across, origin=own.origin)
                inside = (own.start, own.end)
            before = set(axes.get_children())
            self.marks.draw(axes, mark, panel, (across, up), inside)
            if panel.picture:
                # what is drawn later covers what was drawn before, lines too
                for artist in set(axes.get_children()) - before:
                    artist.set_zorder(2.0 + 0.001 * order)

    def _colour_bars(self, figure: Figure, part: Any) -> None:
        for scale, (picture, axes) in self.marks.scales.items():
            frame = self.frames[scale]
            look: dict[str, Any] = {"location": "right", "shrink": 1.0, "aspect": 25}
            if len(axes) > 1:
                figure.set_size_inches(WIDTH, figure.get_figheight() + _COLOUR_BAR)
                look = {"location": "bottom", "shrink": 0.5, "aspect": 40}
            # the maps stay where they are in their cells
            bar = part.colorbar(picture, ax=axes, panchor=False, **look)
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
        figure.legend(
            list(self.marks.named.values()),
            labels,
            loc="outside lower center",
            ncols=columns,
            handlelength=3.2,
        )


def _is_level_beyond(mark: Mark, span: tuple[float, float]) -> bool:
    if not isinstance(mark, Level) or mark.upright:
        return False
    return not span[0] <= mark.value <= span[1]


def _equal_cells(grid: Any, row: int, width: int, count: int) -> list[Any]:
    """Return cells side by side in a row of a grid, each of a width in columns."""
    starts = range(0, width * count, width)
    return [grid[row, start : start + width] for start in starts]


def _title(view: View, unit: str, most: int) -> str:
    r"""Return the title of a view with the unit of its axis: its headline beside its name or below
    it, or the number in it alone.

    Parameters
    ----------
    view : View
        The view.
    unit : str
        What stands behind its name.
    most : int
        Number of letters that a line may have.

    Examples
    --------
    >>> view = View("Impact 1", 0.0, 1.0, headline="largest force 9.35\u00a0kN")
    >>> _title(view, "", 32), _title(view, "", 22)
    ('Impact 1: largest force 9.35\xa0kN', 'Impact 1\nlargest force 9.35\xa0kN')
    >>> _title(view, "[N]", 12)
    'Impact 1 [N]\n9.35\xa0kN'
    """
    name = f"{view.name} {unit}".strip()
    if not view.headline:
        return name
    if len(name) + 2 + len(view.headline) <= most:
        return f"{name}: {view.headline}"
    if len(view.headline) <= most:
        return f"{name}\n{view.headline}"
    # the quantity at its end matters most
    return f"{name}\n{view.headline.rsplit(' ', 1)[-1]}"
