"""Figures of position, force, velocity and acceleration over time: the whole run, and below it the first contacts enlarged."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.columns import HISTORY_COLUMNS
from vibroimpact.report.layout import heading, label_vertical, new_figure, row_of_axes, wide_axes
from vibroimpact.report.style import ACCENT, CONTACT, INK, MARK
from vibroimpact.results.result import Result
from vibroimpact.runs.figure_data import (
    MARGIN,
    contacts_with_duration,
    decimated,
    enlarged_contacts,
    gravity_of,
    history_around,
    touch_height,
)
from vibroimpact.runs.tables import impact_text
from vibroimpact.units.display import Multiple, multiple

_RUN_HEIGHT, _ROW_HEIGHT = 2.7, 2.5
"""Heights of the parts of a figure that show the whole run and the enlarged contacts [in]."""

Marks = Callable[[Result], tuple[Floats, Floats]]
"""Function returning times [s] and values to mark. They come from the impact table, whose extremes are located, not sampled."""


class PlottedQuantity(NamedTuple):
    """Specification of a figure of one quantity over time.

    Parameters
    ----------
    column : str
        Column of the history.
    title, label, enlarged_label : str
        Title of the figure, and labels of the vertical axes of the whole run and of the enlarged contacts, without unit.
    run_marks, contact_marks : callable
        Points marked in the whole run and in the enlarged contacts.
    run_meaning, contact_meaning : str
        Meaning of the marks.
    headline : callable
        Value in the title of an enlarged contact, from the result and the index of the impact, counted from 0.
    from_touch : bool
        Whether the enlarged contacts show the difference from the value at first touch.
    """

    column: str
    title: str
    label: str
    enlarged_label: str
    run_marks: Marks
    run_meaning: str
    contact_marks: Marks
    contact_meaning: str
    headline: Callable[[Result, int], str]
    from_touch: bool = False

    @property
    def unit(self) -> str:
        """Its SI unit."""
        return HISTORY_COLUMNS[self.column].unit


def draw_history(result: Result, quantity: PlottedQuantity) -> Figure:
    """Draw a quantity over the whole run and over the first contacts enlarged, if there are any."""
    shown = enlarged_contacts(result)
    figure = new_figure(_RUN_HEIGHT + (_ROW_HEIGHT if len(shown) else 0.0))
    _draw_run(wide_axes(figure, figure.get_figheight() - _RUN_HEIGHT + 0.5, _RUN_HEIGHT - 0.8), result, quantity)
    if len(shown):
        _draw_contacts(figure, result, quantity, shown)
    return figure


def _draw_run(axes: Axes, result: Result, quantity: PlottedQuantity) -> None:
    time, values = result.history["time_s"], result.history[quantity.column]
    clock, scale = multiple("s", time), multiple(quantity.unit, values)
    axes.plot(*decimated(time / clock.size, values / scale.size), color=INK, linewidth=1.0)
    marked = _mark(axes, *quantity.run_marks(result), clock, scale)
    axes.set_title(f"{quantity.title}, whole run" + (f" ({quantity.run_meaning})" if marked else ""))
    axes.set_xlabel(f"Time [{clock.unit}]")
    label_vertical(axes, f"{quantity.label} [{scale.unit}]")
    axes.margins(x=0.01, y=0.08)


def _draw_contacts(figure: Figure, result: Result, quantity: PlottedQuantity, shown: Indices) -> None:
    impacts = result.impacts
    parts = [history_around(result, impact) for impact in shown]
    base = touch_height(result) if quantity.from_touch else 0.0
    clock = multiple("s", impacts["duration_s"][shown])
    scale = multiple(quantity.unit, np.concatenate([part[quantity.column] - base for part in parts]))
    times, values = quantity.contact_marks(result)
    row = row_of_axes(figure, len(shown), 0.52, _ROW_HEIGHT - 1.12)
    for axes, impact, part in zip(row, shown, parts, strict=True):
        touch, span = impacts["time_s"][impact], impacts["duration_s"][impact] / clock.size
        axes.axvspan(0.0, span, color=CONTACT, linewidth=0, zorder=0)
        axes.plot(part["time_s"] / clock.size, (part[quantity.column] - base) / scale.size, color=ACCENT, linewidth=1.4)
        # marks of this contact: those within its duration, with a margin for rounding
        here = np.abs(times - touch - 0.5 * impacts["duration_s"][impact]) <= 0.5001 * impacts["duration_s"][impact]
        _mark(axes, times[here] - touch, values[here] - base, clock, scale)
        axes.set_xlim(-MARGIN * span, (1.0 + MARGIN) * span)
        axes.margins(y=0.1)
        axes.grid(visible=False)
        axes.xaxis.set_major_locator(MaxNLocator(max(3, 10 // len(row)), steps=[1, 2, 5, 10]))
        axes.yaxis.set_major_locator(MaxNLocator(4, min_n_ticks=3, steps=[1, 2, 2.5, 5, 10]))
        axes.set_title(f"Impact {impact + 1}: {quantity.headline(result, impact)}", fontsize=7.8)
    label_vertical(row[0], f"{quantity.enlarged_label} [{scale.unit}]")
    figure.text(0.5, 0.08 / figure.get_figheight(), f"Time since first touch of each contact [{clock.unit}]", ha="center", va="bottom")
    total = len(contacts_with_duration(result))
    each = "The contact enlarged" if total == 1 else "Each contact enlarged"
    what = f"The first {len(shown)} of {total} contacts enlarged" if len(shown) < total else each
    heading(figure, f"{what} (grey: in contact; {quantity.contact_meaning})", _ROW_HEIGHT - 0.32)


def _mark(axes: Axes, times: Floats, values: Floats, clock: Multiple, scale: Multiple) -> bool:
    """Mark points, with smaller symbols where there are many; return whether there are any."""
    x, y = decimated(times / clock.size, values / scale.size)
    size = 4.5 if len(x) <= 30 else 2.5
    axes.plot(x, y, "o", markersize=size, markerfacecolor="white", markeredgecolor=MARK, markeredgewidth=1.0, clip_on=False, zorder=3)
    return bool(len(x))


Points = tuple[Floats, Floats]


def _no_marks(result: Result) -> Points:
    return np.empty(0), np.empty(0)


def tops_of_rebounds(result: Result) -> Points:
    """Return times [s] and heights of the sphere's centre [m] at the apex of each rebound within the run."""
    impacts, down = result.impacts, gravity_of(result)
    if down <= 0.0:
        return _no_marks(result)
    top = impacts["time_s"] + impacts["duration_s"] + impacts["separation_speed_m_s"] / down
    # a rebound during which the run ends or comes to rest does not reach its apex in the history
    reached = np.interp(top, result.history["time_s"], result.history["position_m"], right=np.nan)
    height = impacts["rebound_height_m"]
    seen = np.abs(reached - height) < 0.01 * (height - touch_height(result))
    return top[seen], impacts["rebound_height_m"][seen]


def _largest_indentations(result: Result) -> Points:
    when = result.impacts["time_of_max_indentation_s"]
    if result.vibrates:  # the plate moves too: position and indentation do not add up to the height at first touch
        return when, np.interp(when, result.history["time_s"], result.history["position_m"])
    return when, touch_height(result) - result.impacts["max_indentation_m"]


def _force_peaks(result: Result) -> Points:
    found = np.isfinite(result.impacts["max_force_N"])
    return result.impacts["time_of_max_force_s"][found], result.impacts["max_force_N"][found]


def _acceleration_peaks(result: Result) -> Points:
    # a contact of less than gravitational acceleration has its largest magnitude in flight, not at the largest force
    found = result.impacts["max_acceleration_m_s2"] > gravity_of(result)
    return result.impacts["time_of_max_force_s"][found], result.impacts["max_acceleration_m_s2"][found]


def _touch_and_release(result: Result) -> Points:
    impacts = result.impacts
    times = np.concatenate([impacts["time_s"], impacts["time_s"] + impacts["duration_s"]])
    return times, np.concatenate([-impacts["approach_speed_m_s"], impacts["separation_speed_m_s"]])


def _indentation(result: Result, impact: int) -> str:
    return impact_text(result, impact, "max_indentation_m", "m")


def _force(result: Result, impact: int) -> str:
    return impact_text(result, impact, "max_force_N", "N")


def _restitution(result: Result, impact: int) -> str:
    return f"e = {impact_text(result, impact, 'restitution_achieved', '')}"


def _acceleration(result: Result, impact: int) -> str:
    return impact_text(result, impact, "max_acceleration_m_s2", "m/s2")


POSITION = PlottedQuantity(
    column="position_m",
    title="Height of the sphere's centre above the plate",
    label="Height of centre",
    enlarged_label="From first touch",
    run_marks=tops_of_rebounds,
    run_meaning="circle: top of a rebound",
    contact_marks=_largest_indentations,
    contact_meaning="circle: largest indentation",
    headline=_indentation,
    from_touch=True,
)

FORCE = PlottedQuantity(
    column="force_N",
    title="Contact force on the sphere",
    label="Force",
    enlarged_label="Force",
    run_marks=_force_peaks,
    run_meaning="circle: largest force of a contact",
    contact_marks=_force_peaks,
    contact_meaning="circle: largest force",
    headline=_force,
)

VELOCITY = PlottedQuantity(
    column="velocity_m_s",
    title="Velocity of the sphere, upwards",
    label="Velocity",
    enlarged_label="Velocity",
    run_marks=_no_marks,
    run_meaning="",
    contact_marks=_touch_and_release,
    contact_meaning="circles: first touch and release",
    headline=_restitution,
)

ACCELERATION = PlottedQuantity(
    column="acceleration_m_s2",
    title="Acceleration of the sphere, upwards",
    label="Acceleration",
    enlarged_label="Acceleration",
    run_marks=_acceleration_peaks,
    run_meaning="circle: largest of a contact",
    contact_marks=_acceleration_peaks,
    contact_meaning="circle: largest acceleration",
    headline=_acceleration,
)
