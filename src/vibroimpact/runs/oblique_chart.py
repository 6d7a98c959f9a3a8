"""Chart of the motion along the plate over time: velocity, friction force and spin."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Line
from vibroimpact.results.result import Result
from vibroimpact.runs.chart_data import spans_of_contact, time_axis, views_of_contacts

_QUANTITIES = (
    (
        "Velocity of the centre along the plate",
        "m/s",
        {"along x": "velocity_x_m_s", "along y": "velocity_y_m_s"},
    ),
    ("Friction force on the sphere", "N", {"along x": "friction_x_N", "along y": "friction_y_N"}),
    (
        "Angular velocity",
        "rad/s",
        {"about x": "spin_x_rad_s", "about y": "spin_y_rad_s", "about the normal": "spin_z_rad_s"},
    ),
)
"""The panels: title, unit, and columns of the history by name."""


def moves_along(history: Mapping[str, Floats]) -> bool:
    """Return whether the sphere moves along the plate or turns at any time of a history."""
    return any(
        np.any(history.get(column, 0.0))
        for _, _, columns in _QUANTITIES
        for column in columns.values()
    )


def oblique_chart(result: Result, history: Mapping[str, Floats], caption: str) -> Chart:
    """Return the chart of the motion along the plate, with components that are zero throughout left
    out.

    Parameters
    ----------
    result : Result
        The result.
    history : dict of str to array
        The history that is drawn.
    caption : str
        The caption.
    """

    def headline(impact: int) -> str:
        return (
            f"rebound at {float(result.impacts['rebound_angle_deg'][impact]):.1f}° from the normal"
        )

    time = time_axis(result, views_of_contacts(result, headline=headline))
    rows = []
    for title, unit, columns in _QUANTITIES:
        moving = {
            name: history[column] for name, column in columns.items() if np.any(history[column])
        }
        if moving:
            lines = [
                Line(history["time_s"], values, name, f"series {number}")
                for number, (name, values) in enumerate(moving.items())
            ]
            rows.append((Panel(time, Axis("", unit), (spans_of_contact(result), *lines), title),))
    return Chart("along_plate", "Motion along the plate", tuple(rows), caption)
