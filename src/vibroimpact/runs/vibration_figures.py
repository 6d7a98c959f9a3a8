"""A figure of several quantities over time: a row each, the whole run at the left and the first visit at the right."""

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
"""Height of a row, and room below all and above all [in]."""

_BEFORE = 0.06
"""What is shown before first touch, as a part of what is shown after it."""


class Panel(NamedTuple):
    """A row: the columns of the history whose sum it exceeds_rounding, their SI unit and its title."""

    columns: tuple[str, ...]
    unit: str
    title: str


def draw_panels(result: Result, title: str, panels: Sequence[Panel], span: float) -> Figure:
    """Draw quantities over time.

    Parameters
    ----------
    result : Result
        A run with an impact.
    title : str
        What they are.
    panels : sequence of Panel
        The rows.
    span : float
        How much is shown from the first touch on, at the right [s].
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
        if own != scale:
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
    """Shade where the surfaces overlap: a visit may be of several contacts."""
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
"""How much of the first visit is shown, in its durations."""


def draw_sphere_energy(result: Result) -> Figure:
    """Draw where the energy of the sphere is."""
    modes = _SPHERE_MODES if "sphere" in result.peaks else ()
    rows = _SPHERE + tuple(panel for panel in modes if exceeds_rounding(result, panel.columns[0]))
    return draw_panels(result, "Energy of the sphere", rows, _VISIT * float(result.impacts["duration_s"][0]))


def draw_plate_motion(result: Result) -> Figure:
    """Draw how the plate moves, as a whole and where it is hit."""
    return draw_panels(result, "Motion of the plate, upwards", _PLATE_MOTION, plate_span(result))


def draw_plate_energy(result: Result) -> Figure:
    """Draw where the energy of the plate is."""
    return draw_panels(result, "Energy of the plate", _PLATE_ENERGY, plate_span(result))


def plate_span(result: Result) -> float:
    """Return how long after first touch the plate is shown [s]: until it has moved up and down, or is hit again."""
    touches, duration = result.impacts["time_s"], float(result.impacts["duration_s"][0])
    until = float(touches[1]) if len(touches) > 1 else float(result.history["time_s"][-1])
    return max(min(resolved_span(1.0 / result.frequencies("plate")[0]), until - float(touches[0])), 1.2 * duration)


def exceeds_rounding(result: Result, column: str) -> bool:
    """Is an energy more than rounding of what was put in?"""
    return bool(result.history[column].max() > 1e-12 * result.energy["input_J"])
