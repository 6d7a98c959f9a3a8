"""A chart described as data: panels with axes, what is drawn in them, and a caption. Nothing here
draws.

All values are in SI units; what draws a chart chooses the multiples shown. What looks alike in all
charts has a *role*, whose colour, dashes and symbol stand in `vibroimpact.charts.palette`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.marks import Facets, Map, Mark, across, upwards


@dataclass(frozen=True, eq=False)
class Panel:
    """Axes with what is drawn in them.

    Parameters
    ----------
    x, y : Axis
        The axes.
    marks : tuple of marks
        What is drawn, the lowest first.
    title : str
        Title of the panel.
    picture : bool
        Whether it is a picture to scale: no axes, equal scales.
    """

    x: Axis
    y: Axis
    marks: tuple[Mark, ...]
    title: str = ""
    picture: bool = False


@dataclass(frozen=True, eq=False)
class Chart:
    """A chart: rows of panels with a title and a caption.

    Parameters
    ----------
    name : str
        Plain name, as of a file.
    title : str
        Title.
    rows : tuple of tuples of Panel
        The panels.
    caption : str
        What is seen, in sentences; also what is read to those who do not see it.
    height : float
        Height of a row [in] in print; by default that of its kind.
    subtitle : str
        What stands in small letters below the title, in print too, such as parameters; in several
        lines if it is long.
    """

    name: str
    title: str
    rows: tuple[tuple[Panel, ...], ...]
    caption: str = ""
    height: float | None = None
    subtitle: str = ""

    @property
    def panels(self) -> tuple[Panel, ...]:
        """All panels, row by row."""
        return tuple(panel for row in self.rows for panel in row)

    @property
    def views(self) -> tuple[View, ...]:
        """The parts shown enlarged of the first axis that has some."""
        return next((panel.x.views for panel in self.panels if panel.x.views), ())


@dataclass(frozen=True, eq=False)
class StoredChart(Chart):
    """A chart that was stored as it was drawn for a page, without its panels.

    Parameters
    ----------
    drawn : dict
        The chart as `plotly_chart` returned it.
    """

    drawn: dict[str, Any] = field(default_factory=dict)


def stored_chart(drawn: dict[str, Any]) -> StoredChart:
    """Return the chart that was drawn for a page and stored.

    Parameters
    ----------
    drawn : dict
        The chart as `plotly_chart` returned it.
    """
    return StoredChart(
        drawn["name"],
        drawn["title"],
        rows=(),
        caption=drawn["caption"],
        subtitle=drawn["subtitle"],
        drawn=drawn,
    )


def values_on(axis: Axis, panels: tuple[Panel, ...]) -> Floats:
    """Return all values drawn along an axis, of all panels that have it, for the choice of its unit
    and range.

    Examples
    --------
    >>> from vibroimpact.charts.marks import Line
    >>> time, force = Axis("Time", "s"), Axis("Force", "N")
    >>> panel = Panel(time, force, (Line(np.array([0.0, 1.0]), np.array([5.0, 7.0])),))
    >>> values_on(force, (panel,)).tolist()
    [5.0, 7.0]
    """
    parts = [np.atleast_1d(np.asarray(part, dtype=float)).ravel() for part in _on(axis, panels)]
    return np.concatenate([np.empty(0), *parts])


def _on(axis: Axis, panels: tuple[Panel, ...]) -> Iterator[Any]:
    for panel in panels:
        for mark in panel.marks:
            if panel.x is axis:
                yield from across(mark)
            if panel.y is axis:
                yield from upwards(mark)
            if isinstance(mark, Map | Facets) and mark.scale is axis:
                yield mark.values
