"""The multiple of a unit and the origin in which an axis of a chart is shown."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel, values_on
from vibroimpact.charts.marks import Band, Facets, Level, Line, Map, Mark, Points
from vibroimpact.units.display import multiple

_MARGIN = 0.06
"""Margin above and below what a view shows, relative to its range."""

_NEAR = 0.35
"""Largest distance from the lines of a view at which a level is shown, relative to their range.

A farther one would flatten them.
"""


@dataclass(frozen=True)
class Frame:
    """How the values of an axis are shown: less an origin, in a multiple of the unit, with a label.

    Parameters
    ----------
    label, unit : str
        The quantity, and the multiple of its unit.
    size : float
        Size of that multiple in the SI unit.
    origin : float
        Value from which the axis counts [SI].
    """

    label: str
    unit: str
    size: float
    origin: float = 0.0

    @property
    def title(self) -> str:
        """The label with the unit."""
        if self.unit and self.label:
            return f"{self.label} [{self.unit}]"
        return self.label or self.unit

    def shown(self, values: Floats) -> Floats:
        """Return values as shown."""
        return np.asarray((values - self.origin) / self.size)


def frame_of(axis: Axis, panels: tuple[Panel, ...]) -> Frame:
    """Return the frame of an axis for everything that is drawn along it.

    Examples
    --------
    >>> time, force = Axis("Time", "s"), Axis("Force", "N")
    >>> frame_of(
    ...     force, (Panel(time, force, (Line(np.array([0.0, 1.0]), np.array([5.0, 7000.0])),)),)
    ... ).title
    'Force [kN]'
    """
    shown = np.array(axis.range or (np.nan, np.nan))
    if not np.isfinite(shown[1]):
        # a range without an upper end reaches as far as what is drawn
        shown = np.append(shown, values_on(axis, panels))
    best = multiple(axis.unit, shown)
    return Frame(axis.label, best.unit, best.size)


def frames_of(chart: Chart) -> dict[Axis, Frame]:
    """Return the frame of every axis of a chart, those of its maps' scales included."""
    axes: dict[Axis, None] = {}
    for panel in chart.panels:
        axes[panel.x] = None
        axes[panel.y] = None
        for mark in panel.marks:
            if isinstance(mark, Map | Facets) and mark.scale is not None:
                axes[mark.scale] = None
    frames = {axis: frame_of(axis, chart.panels) for axis in axes}
    for panel in chart.panels:
        # lengths that are drawn alike in both directions
        if panel.picture and panel.x.unit == panel.y.unit:
            frames[panel.y] = Frame(panel.y.label, frames[panel.x].unit, frames[panel.x].size)
    return frames


def ends_of_range(axis: Axis, frame: Frame) -> list[float | None]:
    """Return the ends of the given range of an axis as shown; None for one that is left open."""
    assert axis.range is not None  # checked by the caller
    ends: list[float | None] = []
    for end in axis.range:
        shown = frame.shown(np.array(end)).item()
        ends.append(shown if np.isfinite(end) else None)
    return ends


def ends_on(axis: Axis, chart: Chart) -> tuple[float, float]:
    """Return the smallest and the largest finite value along an axis; 0 and 1 if there is none.

    Examples
    --------
    >>> time, force = Axis("Time", "s"), Axis("Force", "N")
    >>> line = Line(np.array([0.0, 1.0]), np.array([np.nan, 7.0]))
    >>> ends_on(force, Chart("force", "Force", ((Panel(time, force, (line,)),),)))
    (7.0, 7.0)
    """
    values = values_on(axis, chart.panels)
    values = values[np.isfinite(values)]
    if not len(values):
        return 0.0, 1.0
    return float(values.min()), float(values.max())


def is_log(scale: Axis, chart: Chart) -> bool:
    """Return whether the scale of maps is drawn as a logarithmic one.

    It is if it shall be, and all values are positive.
    """
    return scale.log and ends_on(scale, chart)[0] > 0.0


def panels_without_label(chart: Chart, frames: dict[Axis, Frame]) -> set[Panel]:
    """Return the panels whose vertical axis needs no label.

    That of the panel to the left has the same; but a view may change it.
    """
    unlabelled = set()
    for row in chart.rows:
        for left, panel in pairwise(row):
            if not panel.x.views and frames[left.y].title == frames[panel.y].title:
                unlabelled.add(panel)
    return unlabelled


def view_frames(
    panel: Panel, view: View, base: Frame, panels: tuple[Panel, ...]
) -> tuple[Frame, Frame]:
    """Return the frames of the horizontal and the vertical axis of a panel in a view.

    Parameters
    ----------
    panel : Panel
        The panel.
    view : View
        The part of it that is shown.
    base : Frame
        Frame of the vertical axis of the whole panel.
    panels : tuple of Panel
        All panels; those with the same vertical axis have the same frame.
    """
    across = multiple(panel.x.unit, [view.start - view.origin, view.end - view.origin])
    horizontal = Frame(view.label or panel.x.label, across.unit, across.size, view.origin)
    unit = base.unit
    size = base.size
    shown = _shown_values(panel, view, panels) - view.level
    if np.any(shown) and not panel.y.log:
        up = multiple(panel.y.unit, shown)
        unit = up.unit
        size = up.size
    return horizontal, Frame(view.level_label or base.label, unit, size, view.level)


def view_range(panel: Panel, view: View, panels: tuple[Panel, ...]) -> tuple[float, float] | None:
    """Return the range of the vertical axis of a panel in a view.

    It is that of what is drawn there, and of the levels near it.

    Returns
    -------
    tuple of float or None
        None if the range of the axis is given, or nothing in the view has one.

    Examples
    --------
    >>> time, force = Axis("Time", "s", views=(View("contact", 0.0, 1.0),)), Axis("Force", "N")
    >>> panel = Panel(
    ...     time,
    ...     force,
    ...     (Line(np.array([-1.0, 3.0]), np.array([-10.0, 30.0])), Level(12.0), Level(100.0)),
    ... )
    >>> view_range(panel, time.views[0], (panel,))
    (-0.72, 12.72)
    """
    shown = _shown_values(panel, view, panels)
    shown = shown[np.isfinite(shown)]
    if panel.y.range is not None or panel.y.log or not len(shown) or not np.ptp(shown):
        return None
    lowest = float(shown.min())
    highest = float(shown.max())
    reach = _NEAR * (highest - lowest)
    near_levels = [
        level for level in _levels_on(panel.y, panels) if lowest - reach <= level <= highest + reach
    ]
    low = min([lowest, *near_levels])
    high = max([highest, *near_levels])
    margin = _MARGIN * (high - low)
    return low - margin, high + margin


def _levels_on(axis: Axis, panels: tuple[Panel, ...]) -> list[float]:
    """Return the levels across a vertical axis, of all panels that have it."""
    levels = []
    for panel in panels:
        if panel.y is axis:
            for mark in panel.marks:
                if isinstance(mark, Level) and not mark.upright:
                    levels.append(mark.value)
    return levels


def own_view(mark: Mark, panel: Panel, view: View) -> View:
    """Return a view of a panel for a mark.

    It is shifted to the origin of a line that has one of its own.
    """
    if not (isinstance(mark, Line) and mark.origins):
        return view
    origin = mark.origins[panel.x.views.index(view)]
    return replace(
        view,
        start=view.start - view.origin + origin,
        end=view.end - view.origin + origin,
        origin=origin,
    )


def _shown_values(panel: Panel, view: View, panels: tuple[Panel, ...]) -> Floats:
    """Return what a view shows along the vertical axis of a panel, of all panels that have it."""
    number = panel.x.views.index(view)
    parts = []
    for other in panels:
        if other.y is panel.y and number < len(other.x.views):
            for mark in other.marks:
                if isinstance(mark, Line | Points | Band):
                    shown = own_view(mark, other, other.x.views[number])
                    parts.append(values_within(mark, shown))
    if not parts:
        return np.empty(0)
    return np.concatenate(parts)


def values_within(mark: Line | Points | Band, view: View) -> Floats:
    """Return the values of a line, of points or of a band inside a view.

    Of what is connected, they include those interpolated at the ends of the view.
    """
    if isinstance(mark, Points):
        return np.asarray(mark.y[(mark.x >= view.start) & (mark.x <= view.end)])
    first = int(np.searchsorted(mark.x, view.start))
    last = int(np.searchsorted(mark.x, view.end, side="right"))
    ends = [end for end in (view.start, view.end) if len(mark.x) and mark.x[0] < end < mark.x[-1]]
    curves = [mark.low, mark.high] if isinstance(mark, Band) else [mark.y]
    parts = []
    for values in curves:
        parts += [values[first:last], np.interp(ends, mark.x, values)]
    return np.concatenate(parts)
