"""Charts of vibrating bodies over time: energies of the sphere, motion and energies of
the plate, one row per quantity.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.results.fine_history import resolved_span
from vibroimpact.results.result import Result
from vibroimpact.runs.chart_data import (
    line_over_time,
    spans_of_contact,
    time_axis,
    views_of_contacts,
)


class Row(NamedTuple):
    """Row of a chart: the columns of the history whose sum is drawn, their SI unit and
    the title.
    """

    columns: tuple[str, ...]
    unit: str
    title: str


_SPHERE = (
    Row(("kinetic_J",), "J", "Kinetic energy of the centre"),
    Row(("potential_J",), "J", "Potential energy, zero at first touch"),
)
_SPHERE_MODES = (
    Row(("sphere_strain_J",), "J", "Strain energy of its modes"),
    Row(
        ("sphere_strain_J", "sphere_vibration_J"),
        "J",
        "Energy of its vibration: strain and kinetic",
    ),
    Row(("sphere_rotational_J",), "J", "Energy of rotation"),
)
_PLATE_MOTION = (
    Row(("plate_displacement_m",), "m", "Displacement of the centre of mass"),
    Row(("plate_velocity_m_s",), "m/s", "Velocity of the centre of mass"),
    Row(("plate_acceleration_m_s2",), "m/s2", "Acceleration of the centre of mass"),
    Row(("plate_deflection_m",), "m", "Displacement at the contact point"),
)
_PLATE_ENERGY = (
    Row(("plate_kinetic_J",), "J", "Kinetic energy"),
    Row(("plate_strain_J",), "J", "Strain energy, from where it rests"),
    Row(("plate_kinetic_J", "plate_strain_J"), "J", "Energy of its vibration: strain and kinetic"),
    Row(("plate_potential_J",), "J", "Change of the potential energy"),
)
_VISIT = 1.6
"""Time shown after first touch in the chart of the sphere, relative to the duration of
the visit.
"""


def sphere_energy_chart(result: Result, history: Mapping[str, Floats], caption: str) -> Chart:
    """Return the chart of the sphere's energies: kinetic and potential, and those of its
    modes and rotation that are not negligible.
    """
    rows: tuple[Row, ...] = _SPHERE
    if "sphere" in result.peaks:
        rows += tuple(row for row in _SPHERE_MODES if exceeds_rounding(result, row.columns[0]))
    views = views_of_contacts(
        result, lambda impact: _VISIT * float(result.impacts["duration_s"][impact])
    )
    time = time_axis(result, views)
    return _chart(result, history, ("sphere_energy", "Energy of the sphere", caption), rows, time)


def plate_motion_chart(result: Result, history: Mapping[str, Floats], caption: str) -> Chart:
    """Return the chart of the plate's motion: that of its centre of mass, and the
    displacement at the contact point.
    """
    return _chart(
        result,
        history,
        ("plate_motion", "Motion of the plate, upwards", caption),
        _PLATE_MOTION,
        plate_time(result),
    )


def plate_energy_chart(result: Result, history: Mapping[str, Floats], caption: str) -> Chart:
    """Return the chart of the plate's energies: kinetic, strain, their sum, and the
    change of its potential energy.
    """
    return _chart(
        result,
        history,
        ("plate_energy", "Energy of the plate", caption),
        _PLATE_ENERGY,
        plate_time(result),
    )


def plate_time(result: Result) -> Axis:
    """Return the axis of time of what the plate does, with the vibration after each
    impact as a view.
    """
    return time_axis(result, views_of_contacts(result, lambda impact: plate_span(result, impact)))


def _chart(
    result: Result,
    history: Mapping[str, Floats],
    phrase: tuple[str, str, str],
    rows: Sequence[Row],
    time: Axis,
) -> Chart:
    name, title, caption = phrase
    panels = []
    for row in rows:
        if len(row.columns) == 1:
            values = history[row.columns[0]]
        else:
            values = np.sum([history[column] for column in row.columns], axis=0)
        panels.append(
            (
                Panel(
                    time,
                    Axis("", row.unit),
                    (spans_of_contact(result), line_over_time(history["time_s"], values, time)),
                    row.title,
                ),
            )
        )
    return Chart(name, title, tuple(panels), caption)


def plate_span(result: Result, impact: int = 0) -> float:
    """Return the time after the first touch of an impact for which the plate is shown [s].

    It is 1.5 periods of the lowest mode, where the plate has one, but ends at the next impact or
    the end of the run, and is at least 1.2 contact durations.
    """
    touches = result.impacts["time_s"]
    duration = float(result.impacts["duration_s"][impact])
    if len(touches) > impact + 1:
        until = float(touches[impact + 1])
    else:
        until = float(result.history["time_s"][-1])
    spans = [resolved_span(1.0 / lowest) for lowest in result.frequencies("plate")[:1]]
    return max(min([*spans, until - float(touches[impact])]), 1.2 * duration)


def exceeds_rounding(result: Result, column: str) -> bool:
    """Return whether an energy exceeds rounding error, 1e-12 of the energy put in."""
    return bool(result.history[column].max() > 1e-12 * result.energy["input_J"])
