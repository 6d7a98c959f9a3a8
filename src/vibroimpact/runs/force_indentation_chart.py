"""Chart of contact force over indentation: one hysteresis loop per contact."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Line, Points
from vibroimpact.charts.palette import SERIES, series
from vibroimpact.results.result import Result
from vibroimpact.runs.chart_data import contact_history, contacts_with_duration
from vibroimpact.units.display import text

_NAMED = 5
"""Number of loops with a name, where there are more than looks of lines."""

_MOST_OTHERS = 60
"""Largest number of unnamed loops; more would only fill the corner near the origin."""


def loops_chart(result: Result, caption: str) -> Chart:
    """Return the chart of contact force over indentation, with the first contacts named
    by impact and approach speed.
    """
    contacts = contacts_with_duration(result)
    named = contacts
    if len(contacts) > SERIES:
        named = contacts[:_NAMED]
    marks: list[Line | Points] = _other_loops(result, contacts[len(named) :])
    for number, impact in enumerate(named):
        name = f"impact {impact + 1}, {text(result.impacts['approach_speed_m_s'][impact], 'm/s')}"
        marks.append(Line(*_loop(result, impact), name, series(number)))
    when = result.impacts["time_of_max_force_s"][named]
    texts = tuple(f"impact {impact + 1}" for impact in named)
    marks.append(
        Points(
            _indentation_at(result, named, when),
            result.impacts["max_force_N"][named],
            "largest force",
            texts=texts,
        )
    )
    panel = Panel(Axis("Indentation", "m"), Axis("Contact force", "N"), tuple(marks))
    return Chart("force_indentation", "Contact force over indentation", ((panel,),), caption)


def _loop(result: Result, impact: int) -> tuple[Floats, Floats]:
    part = contact_history(result, impact)
    return part["indentation_m"], part["force_N"]


def _other_loops(result: Result, others: Indices) -> list[Line | Points]:
    """Return the unnamed loops as one thin line with gaps."""
    if not len(others):
        return []
    drawn = others[np.unique(np.linspace(0, len(others) - 1, _MOST_OTHERS).round().astype(int))]
    gap = np.full((1, 2), np.nan)
    x, y = np.concatenate(
        [part for impact in drawn for part in (np.column_stack(_loop(result, impact)), gap)]
    ).T
    which = f"impacts {others[0] + 1} to {others[-1] + 1}"
    if len(drawn) < len(others):
        which += f" ({len(drawn)} of them)"
    return [Line(np.ascontiguousarray(x), np.ascontiguousarray(y), which, "muted")]


def _indentation_at(result: Result, shown: Indices, when: Floats) -> Floats:
    """Return the indentation of each contact at a given time during it [m], interpolated
    linearly.
    """
    parts = [contact_history(result, impact) for impact in shown]
    return np.array(
        [
            np.interp(time, part["time_s"], part["indentation_m"])
            for time, part in zip(when, parts, strict=True)
        ]
    )
