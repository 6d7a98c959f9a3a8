"""The charts of a comparison: one drop under several laws, in common axes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Label, Level, Line, Mark, Points
from vibroimpact.charts.palette import series
from vibroimpact.dynamics.motion.columns import HISTORY_COLUMNS
from vibroimpact.law_comparison.comparison import Comparison
from vibroimpact.results.result import Result
from vibroimpact.runs.below import level_below
from vibroimpact.runs.chart_data import (
    MARGIN,
    contact_history,
    contacts_with_duration,
    drawn_history,
    touch_height,
)

_HEIGHT = 3.6
_TOP = 1.05
"""Upper end of the axis of restitution."""

_WITHOUT = " Laws without a force are not shown."
_LABEL = 0.05
"""Height of a label in units of restitution, for the spacing of labels."""


def comparison_charts(comparison: Comparison) -> list[Chart]:
    """Return the charts of a comparison.

    Parameters
    ----------
    comparison : Comparison
        One drop under several laws.

    Returns
    -------
    list of Chart
        `position`, `force`, `force_indentation` and `restitution`; the two of force only if a law
        has one.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> found = vi.laws.compare_laws(vi.load_case("paper:type1-theory"), ["hertz", "newton"])
    >>> [chart.name for chart in comparison_charts(found)]
    ['position', 'force', 'force_indentation', 'restitution']
    """
    roles = {name: series(number) for number, name in enumerate(comparison.results)}
    forceful = {
        name: result
        for name, result in comparison.results.items()
        if len(contacts_with_duration(result))
    }
    makers = {"position": partial(_position_chart, comparison.results, roles)}
    if forceful:
        makers["force"] = partial(_force_chart, forceful, roles)
        makers["force_indentation"] = partial(_loops_chart, forceful, roles)
    makers["restitution"] = partial(_restitution_chart, comparison, roles)
    return made_charts(makers)


def _position_chart(results: Mapping[str, Result], roles: Mapping[str, str]) -> Chart:
    end = max(float(result.history["time_s"][-1]) for result in results.values())
    lines = []
    for name, result in results.items():
        history = drawn_history(result)
        time = history["time_s"]
        height = history["position_m"]
        # it stays there until the longest run ends
        if result.status.startswith("At rest") and time[-1] < end:
            time = np.append(time, end)
            height = np.append(height, height[-1])
        lines.append(Line(time, height, name, roles[name]))
    views = _first_contact(results)
    time_axis = Axis("Time", "s", views=views)
    level = level_below(next(iter(results.values())))
    panel = Panel(
        time_axis, Axis(f"Height above {level}", HISTORY_COLUMNS["position_m"].unit), tuple(lines)
    )
    caption = f"Height of the sphere's centre above {level} with each law."
    if views:
        caption = (
            f"{caption} The first impact, which begins at the same time for all, is shown enlarged."
        )
    return Chart("position", "Height of the sphere's centre", ((panel,),), caption, _HEIGHT)


def _first_contact(results: Mapping[str, Result]) -> tuple[View, ...]:
    """Return the view of the first impact, which begins at the same time under all laws;
    none if no contact lasts.
    """
    lasting = [result for result in results.values() if len(result.impacts["time_s"])]
    longest = max((float(result.impacts["duration_s"][0]) for result in lasting), default=0.0)
    run = max(float(result.history["time_s"][-1]) for result in results.values())
    if not 0.0 < longest < 0.5 * run:
        return ()
    touch = float(lasting[0].impacts["time_s"][0])
    start = touch - MARGIN * longest
    end = touch + (1.0 + MARGIN) * longest
    return (
        View(
            "Impact 1",
            start,
            end,
            touch,
            "Time since first touch",
            "",
            touch_height(lasting[0]),
            "From first touch",
        ),
    )


def _force_chart(results: Mapping[str, Result], roles: Mapping[str, str]) -> Chart:
    marks = []
    for name, result in results.items():
        impact = contacts_with_duration(result)[0]
        part = contact_history(result, impact)
        marks.append(
            Line(
                part["time_s"] - result.impacts["time_s"][impact],
                part["force_N"],
                name,
                roles[name],
            )
        )
    panel = Panel(Axis("Time since first touch", "s"), Axis("Contact force", "N"), tuple(marks))
    return Chart(
        "force",
        "Contact force of the first impact",
        ((panel,),),
        "Time is counted from first touch." + _WITHOUT,
        _HEIGHT,
    )


def _loops_chart(results: Mapping[str, Result], roles: Mapping[str, str]) -> Chart:
    parts = {
        name: contact_history(result, contacts_with_duration(result)[0])
        for name, result in results.items()
    }
    marks = tuple(
        Line(part["indentation_m"], part["force_N"], name, roles[name])
        for name, part in parts.items()
    )
    panel = Panel(Axis("Indentation", "m"), Axis("Contact force", "N"), marks)
    caption = "Between rigid bodies the area that a loop encloses is the energy lost." + _WITHOUT
    return Chart(
        "force_indentation",
        "Contact force over indentation, first impact",
        ((panel,),),
        caption,
        _HEIGHT,
    )


def _restitution_chart(comparison: Comparison, roles: Mapping[str, str]) -> Chart:
    marks: list[Mark] = []
    for name, result in comparison.results.items():
        marks.append(Line(comparison.speeds, comparison.restitutions[name], name, roles[name]))
        impacts = result.impacts
        texts = tuple(
            f"impact {impact + 1} with {name}"
            for impact in range(len(impacts["approach_speed_m_s"]))
        )
        marks.append(
            Points(
                impacts["approach_speed_m_s"],
                impacts["restitution_achieved"],
                role=roles[name],
                texts=texts,
            )
        )
    asked = _asked(comparison.results)
    marks += [Level(value, role="dotted") for value in asked]
    phrase = zip(asked, spread_labels(asked, _LABEL), strict=True)
    marks += [
        Label(1.0, (place + 0.5 * _LABEL) / _TOP, f"asked {value:.4g}", "right", corner=True)
        for value, place in phrase
    ]
    speed = Axis("Approach speed", "m/s", log=True)
    panel = Panel(
        speed, Axis("Separation speed over approach speed", range=(0.0, _TOP)), tuple(marks)
    )
    caption = (
        "Lines: each law with the parameters of its first impact, between rigid bodies with "
        "undeformed surfaces and without gravity. "
        "Symbols: the impacts of the run; with a law that leaves a dent, those after the "
        "first may lie above its line."
    )
    if asked:
        caption = f"{caption} Dotted: the restitution asked of a law."
    return Chart("restitution", "Restitution achieved", ((panel,),), caption, _HEIGHT)


def _asked(results: Mapping[str, Result]) -> list[float]:
    """Return the restitutions asked of the first impact, ascending, to four digits."""
    first = (
        float(result.impacts["restitution_asked"][0])
        for result in results.values()
        if len(result.impacts["restitution_asked"])
    )
    return sorted({float(f"{value:.4g}") for value in first if np.isfinite(value)})


def spread_labels(places: Sequence[float], gap: float) -> list[float]:
    """Return ascending positions moved upwards as little as needed to keep a minimum gap.

    Examples
    --------
    >>> [round(place, 3) for place in spread_labels([0.1, 0.7, 0.716, 0.72], 0.04)]
    [0.1, 0.7, 0.74, 0.78]
    """
    positions: list[float] = []
    lowest = -math.inf
    for place in places:
        positions.append(max(place, lowest))
        lowest = positions[-1] + gap
    return positions
