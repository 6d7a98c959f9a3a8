"""Charts of position, force, velocity and acceleration of the sphere over time, with each
contact as a view.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Mark, Points
from vibroimpact.dynamics.motion.columns import HISTORY_COLUMNS
from vibroimpact.results.result import Result
from vibroimpact.runs.below import level_below
from vibroimpact.runs.chart_data import (
    gravity_of,
    line_over_time,
    spans_of_contact,
    time_axis,
    touch_height,
    views_of_contacts,
)
from vibroimpact.runs.tables import impact_text

Marks = Callable[[Result], tuple[Floats, Floats]]
"""Function returning times [s] and values to mark. They come from the impact table, whose
extremes are located, not sampled.
"""


class PlottedQuantity(NamedTuple):
    """Specification of a chart of one quantity over time.

    Parameters
    ----------
    column : str
        Column of the history.
    title, label : str
        Title of the chart, and label of the vertical axis, without unit.
    marks : tuple of (str, callable)
        Points that are marked, of two kinds at most, by what they are.
    headline : callable
        What the view of a contact tells, from the result and the index of the impact, counted from
        0.
    from_touch : bool
        Whether the views show the difference from the value at first touch.
    """

    column: str
    title: str
    label: str
    marks: tuple[tuple[str, Marks], ...]
    headline: Callable[[Result, int], str]
    from_touch: bool = False


def history_chart(
    result: Result, history: Mapping[str, Floats], quantity: PlottedQuantity, caption: str
) -> Chart:
    """Return the chart of a quantity over time.

    Parameters
    ----------
    result : Result
        The result.
    history : dict of str to array
        The history that is drawn.
    quantity : PlottedQuantity
        The quantity.
    caption : str
        The caption.
    """
    level = 0.0
    label = ""
    if quantity.from_touch:
        level = touch_height(result)
        label = "From first touch"
    views = views_of_contacts(
        result,
        headline=lambda impact: quantity.headline(result, impact),
        level=level,
        level_label=label,
    )
    time = time_axis(result, views)
    marks: list[Mark] = [
        spans_of_contact(result),
        line_over_time(history["time_s"], history[quantity.column], time),
    ]
    if quantity is POSITION and "surface_m" in history and len(result.impacts["time_s"]):
        above = touch_height(result) - _at(result, "surface_m", result.impacts["time_s"][:1])[0]
        marks.append(
            line_over_time(
                history["time_s"],
                history["surface_m"] + above,
                time,
                "where it touches the moving plate",
                "reference",
            )
        )
    for (name, marks_of), role in zip(quantity.marks, ("mark", "other mark"), strict=False):
        times, values = marks_of(result)
        if len(times):
            marks.append(Points(times, values, name, role, _names(result, times)))
    value = Axis(quantity.label, HISTORY_COLUMNS[quantity.column].unit)
    title = quantity.title
    if quantity is POSITION:
        title += f" above {level_below(result)}"
    panel = Panel(time, value, tuple(marks))
    return Chart(quantity.column.split("_")[0], title, ((panel,),), caption)


def _names(result: Result, times: Floats) -> tuple[str, ...]:
    """Return the impact to which each marked time belongs."""
    impact = np.searchsorted(result.impacts["time_s"], times, side="right")
    return tuple(f"impact {number}" for number in impact)


def _at(result: Result, column: str, times: Floats) -> Floats:
    """Return a column of the history of a shaken plate at times [s]; zeros where the
    plate is at rest.
    """
    if column not in result.history:
        return np.zeros_like(times)
    return np.asarray(np.interp(times, result.history["time_s"], result.history[column]))


def tops_of_rebounds(result: Result) -> tuple[Floats, Floats]:
    """Return times [s] and heights of the sphere's centre [m] at the apex of each rebound
    within the run.
    """
    impacts = result.impacts
    down = gravity_of(result)
    if down <= 0.0:
        return np.empty(0), np.empty(0)
    release = impacts["time_s"] + impacts["duration_s"]
    top = (
        release
        + (impacts["separation_speed_m_s"] + _at(result, "surface_velocity_m_s", release)) / down
    )
    # a rebound during which the run ends or comes to rest does not reach its apex in the history
    reached = np.interp(top, result.history["time_s"], result.history["position_m"], right=np.nan)
    height = impacts["rebound_height_m"]
    seen = np.abs(reached - height) < 0.01 * (height - touch_height(result))
    return top[seen], impacts["rebound_height_m"][seen]


def _largest_indentations(result: Result) -> tuple[Floats, Floats]:
    when = result.impacts["time_of_max_indentation_s"]
    if (
        result.vibrates or "surface_m" in result.history
    ):  # the plate moves too: position and indentation do not add up to the height at first touch
        return when, np.interp(when, result.history["time_s"], result.history["position_m"])
    return when, touch_height(result) - result.impacts["max_indentation_m"]


def _force_peaks(result: Result) -> tuple[Floats, Floats]:
    has_force = np.isfinite(result.impacts["max_force_N"])
    return result.impacts["time_of_max_force_s"][has_force], result.impacts["max_force_N"][
        has_force
    ]


def _acceleration_peaks(result: Result) -> tuple[Floats, Floats]:
    # a contact of less than gravitational acceleration has its largest magnitude in flight, not at
    # the largest force
    in_contact = result.impacts["max_acceleration_m_s2"] > gravity_of(result)
    return result.impacts["time_of_max_force_s"][in_contact], result.impacts[
        "max_acceleration_m_s2"
    ][in_contact]


def _touch_and_release(result: Result) -> tuple[Floats, Floats]:
    impacts = result.impacts
    touch = impacts["time_s"]
    release = impacts["time_s"] + impacts["duration_s"]
    before = _at(result, "surface_velocity_m_s", touch) - impacts["approach_speed_m_s"]
    after = _at(result, "surface_velocity_m_s", release) + impacts["separation_speed_m_s"]
    # in the order of time, so that pages keep them in full precision
    return np.stack([touch, release], axis=1).ravel(), np.stack([before, after], axis=1).ravel()


POSITION = PlottedQuantity(
    column="position_m",
    title="Height of the sphere's centre",
    label="Height of centre",
    marks=(("top of a rebound", tops_of_rebounds), ("largest indentation", _largest_indentations)),
    headline=lambda result, impact: (
        f"largest indentation {impact_text(result, impact, 'max_indentation_m', 'm')}"
    ),
    from_touch=True,
)

FORCE = PlottedQuantity(
    column="force_N",
    title="Contact force on the sphere",
    label="Force",
    marks=(("largest force of a contact", _force_peaks),),
    headline=lambda result, impact: (
        f"largest force {impact_text(result, impact, 'max_force_N', 'N')}"
    ),
)

VELOCITY = PlottedQuantity(
    column="velocity_m_s",
    title="Velocity of the sphere, upwards",
    label="Velocity",
    marks=(("first touch and release", _touch_and_release),),
    headline=lambda result, impact: (
        f"restitution {impact_text(result, impact, 'restitution_achieved', '')}"
    ),
)

ACCELERATION = PlottedQuantity(
    column="acceleration_m_s2",
    title="Acceleration of the sphere, upwards",
    label="Acceleration",
    marks=(("largest acceleration of a contact", _acceleration_peaks),),
    headline=lambda result, impact: (
        f"largest acceleration {impact_text(result, impact, 'max_acceleration_m_s2', 'm/s2')}"
    ),
)
