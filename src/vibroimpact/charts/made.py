"""Making of charts: one that can't be made or drawn is replaced by one that says why.

What was computed is thus written all the same.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any

from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.errors import ChartWarning
from vibroimpact.quoting import shortened, visible

_LONGEST_REASON = 200
_HEIGHT = 0.6

SCENE = "plate_in_motion"
"""Name of the chart that stands for a plate in motion that can't be drawn."""


def made_charts(makers: Mapping[str, Callable[[], Chart | None]]) -> list[Chart]:
    """Return charts, each as its function makes it.

    One that raises is replaced by one that says why, with a `ChartWarning`.

    Parameters
    ----------
    makers : mapping of str to callable
        What makes each chart, by its name; None where it has nothing to show.

    Examples
    --------
    >>> import warnings
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore")
    ...     (lost,) = made_charts({"force": lambda: [][0], "energy": lambda: None})
    >>> lost.name, lost.subtitle
    ('force', 'This chart could not be drawn: IndexError: list index out of range')
    """
    charts = []
    for name, make in makers.items():
        try:
            chart = make()
        except Exception as error:
            chart = _lost(name, name.replace("_", " ").capitalize(), error)
        if chart is not None:
            charts.append(chart)
    return charts


def drawn(chart: Chart, draw: Callable[[Chart], dict[str, Any]]) -> dict[str, Any]:
    """Return a chart as drawn, or where that fails the chart that says why."""
    try:
        return draw(chart)
    except Exception as error:
        return draw(_lost(chart.name, chart.title, error))


def made_scene(
    make: Callable[[], dict[str, Any] | None],
) -> tuple[dict[str, Any] | None, list[Chart]]:
    """Return the plate in motion and no chart.

    Where it can't be made, return None and the chart that says why.
    """
    try:
        return make(), []
    except Exception as error:
        return None, [_lost(SCENE, "Plate in motion", error)]


def warn_of_lost(name: str, error: Exception) -> str:
    """Warn that a chart could not be drawn, and return the reason."""
    reason = type(error).__name__
    if str(error):
        reason += f": {error}"
    reason = shortened(visible(reason), _LONGEST_REASON)
    warnings.warn(ChartWarning(f"the chart {name} could not be drawn: {reason}"), stacklevel=2)
    return reason


def _lost(name: str, title: str, error: Exception) -> Chart:
    reason = warn_of_lost(name, error)
    blank = Panel(Axis(), Axis(), (), picture=True)
    subtitle = f"This chart could not be drawn: {reason}"
    return Chart(name, title, ((blank,),), height=_HEIGHT, subtitle=subtitle)
