"""Figures of vibrating bodies over time: energies of the sphere, motion and energies of the plate, one row per quantity."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from vibroimpact.arrays import Floats
from vibroimpact.report.layout import heading, new_figure, row_of_axes
from vibroimpact.report.style import ACCENT, CONTACT, INK
from vibroimpact.results.fine_history import resolved_span
from vibroimpact.results.result import Result
from vibroimpact.runs.figure_data import decimated, history_window
from vibroimpact.units.display import Multiple, multiple

_ROW, _BOTTOM, _TOP = 1.35, 0.5, 0.12
"""Height of a row, and margins below and above all rows [in]."""

_BEFORE = 0.06
"""Time shown before first touch, relative to that shown after it."""


class Panel(NamedTuple):
    """Row of a figure: the columns of the history whose sum is drawn, their SI unit and the title."""

    columns: tuple[str, ...]
    unit: str
    title: str


def draw_panels(result: Result, title: str, panels: Sequence[Panel], span: float) -> Figure:
    """Draw quantities over time, one row each: the whole run at the left, the first visit at the right.

    Parameters
    ----------
    result : Result
        Result with at least one impact.
    title : str
        Title of the figure.
    panels : sequence of Panel
        The rows, from the top.
    span : float
        Time shown after first touch at the right [s].
    """
    touch = float(result.impacts["time_s"][0])
    whole = result.history
    close = history_window(whole, touch - _BEFORE * span, touch + span)
    clocks = multiple("s", whole["time_s"]), multiple("s", span)
    figure = new_figure(_BOTTOM + len(panels) * _ROW + _TOP)
    for number, panel in enumerate(panels):
        last = number == len(panels) - 1
        left, right = row_of_axes(figure, 2, _BOTTOM + (len(panels) - 1 - number) * _ROW, _ROW - 0.42)
        values, enlarged = (np.sum([part[name] for name in panel.columns], axis=0) for part in (whole, close))
        scale, own = multiple(panel.unit, values), multiple(panel.unit, enlarged)
        _draw(left, whole["time_s"], values, INK, clocks[0], scale)
        _shade_contacts(right, result, touch, clocks[1])
        _draw(right, close["time_s"] - touch, enlarged, ACCENT, clocks[1], own)
        if own != scale:  # the title at the left names the unit of the row
            right.set_title(f"[{own.unit}]")
        right.set_xlim(-_BEFORE * span / clocks[1].size, span / clocks[1].size)
        left.set_title(f"{panel.title} [{scale.unit}]")
        for axes, words in ((left, f"Time [{clocks[0].unit}]"), (right, f"Time since first touch [{clocks[1].unit}]")):
            axes.tick_params(labelbottom=last)
            if last:
                axes.set_xlabel(words)
    heading(figure, f"{title}: whole run at the left, first visit at the right (grey: in contact)", figure.get_figheight() - 0.22)
    return figure


def _draw(axes: Axes, time: Floats, values: Floats, colour: str, clock: Multiple, scale: Multiple) -> None:
    axes.plot(*decimated(time / clock.size, values / scale.size), color=colour, linewidth=1.0)
    axes.margins(x=0.01, y=0.1)
    axes.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
    axes.yaxis.set_major_locator(MaxNLocator(4, min_n_ticks=3, steps=[1, 2, 2.5, 5, 10]))


def _shade_contacts(axes: Axes, result: Result, touch: float, clock: Multiple) -> None:
    """Shade the time spans in contact during the first visit, which may consist of several contacts."""
    first = history_window(result.history, touch, touch + float(result.impacts["duration_s"][0]))
    inside = np.flatnonzero((first["indentation_m"] > 0.0) | (first["force_N"] != 0.0))
    for run in np.split(inside, np.flatnonzero(np.diff(inside) > 1) + 1) if len(inside) else ():
        ends = (first["time_s"][[run[0], run[-1]]] - touch) / clock.size
        axes.axvspan(*ends, color=CONTACT, linewidth=0, zorder=0)


_SPHERE = (
    Panel(("kinetic_J",), "J", "Kinetic energy of the centre"),
    Panel(("potential_J",), "J", "Potential energy, zero at first touch"),
)
_SPHERE_MODES = (
    Panel(("sphere_strain_J",), "J", "Strain energy of its modes"),
    Panel(("sphere_strain_J", "sphere_vibration_J"), "J", "Energy of its vibration: strain and kinetic"),
    Panel(("sphere_rotational_J",), "J", "Energy of rotation"),
)
_PLATE_MOTION = (
    Panel(("plate_displacement_m",), "m", "Displacement of the centre of mass"),
    Panel(("plate_velocity_m_s",), "m/s", "Velocity of the centre of mass"),
    Panel(("plate_acceleration_m_s2",), "m/s2", "Acceleration of the centre of mass"),
    Panel(("plate_deflection_m",), "m", "Displacement at the contact point"),
)
_PLATE_ENERGY = (
    Panel(("plate_kinetic_J",), "J", "Kinetic energy"),
    Panel(("plate_strain_J",), "J", "Strain energy, from where it rests"),
    Panel(("plate_kinetic_J", "plate_strain_J"), "J", "Energy of its vibration: strain and kinetic"),
    Panel(("plate_potential_J",), "J", "Change of the potential energy"),
)
_VISIT = 1.6
"""Time shown after first touch in the figure of the sphere, relative to the duration of the first visit."""


def draw_sphere_energy(result: Result) -> Figure:
    """Draw the energies of the sphere: kinetic and potential, and those of its modes and rotation that are not negligible."""
    modes = _SPHERE_MODES if "sphere" in result.peaks else ()
    rows = _SPHERE + tuple(panel for panel in modes if exceeds_rounding(result, panel.columns[0]))
    return draw_panels(result, "Energy of the sphere", rows, _VISIT * float(result.impacts["duration_s"][0]))


def draw_plate_motion(result: Result) -> Figure:
    """Draw the motion of the plate: that of its centre of mass, and the displacement at the contact point."""
    return draw_panels(result, "Motion of the plate, upwards", _PLATE_MOTION, plate_span(result))


def draw_plate_energy(result: Result) -> Figure:
    """Draw the energies of the plate: kinetic, strain, their sum, and the change of its potential energy."""
    return draw_panels(result, "Energy of the plate", _PLATE_ENERGY, plate_span(result))


def plate_span(result: Result) -> float:
    """Return the time after first touch for which the plate is shown [s].

    It is 1.5 periods of the lowest mode, but ends at the next impact or the end of the run, and is at least 1.2 contact durations.
    """
    touches, duration = result.impacts["time_s"], float(result.impacts["duration_s"][0])
    until = float(touches[1]) if len(touches) > 1 else float(result.history["time_s"][-1])
    return max(min(resolved_span(1.0 / result.frequencies("plate")[0]), until - float(touches[0])), 1.2 * duration)


def exceeds_rounding(result: Result, column: str) -> bool:
    """Return whether an energy exceeds rounding error, 1e-12 of the energy put in."""
    return bool(result.history[column].max() > 1e-12 * result.energy["input_J"])
