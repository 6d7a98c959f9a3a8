"""Chart of the energy ledger over time, as stacked bands."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Layer, Level, Spans, Stack
from vibroimpact.dynamics.motion.columns import ALL_HISTORY_COLUMNS
from vibroimpact.results.result import Result
from vibroimpact.runs.chart_data import spans_of_contact, time_axis, views_of_contacts

_MOTIONS = {
    "sphere_motion_J": ("vibration of the sphere", "sphere_vibration_J", "sphere_strain_J"),
    "plate_motion_J": ("motion of the plate", "plate_kinetic_J", "plate_strain_J"),
}
"""Bands that sum two entries of the ledger: label, kinetic and strain energy."""

# at most one of two terms with the same role is large in most runs
_ROLES = {
    "contact_dissipated_J": "contact damping",
    "plastic_work_J": "plastic work",
    "friction_J": "sphere damping",
    "air_J": "plate damping",
    "liquid_J": "plate damping",
    "sphere_damping_J": "sphere damping",
    "plate_damping_J": "plate damping",
    "written_off_at_rest_J": "written off",
    "contact_elastic_J": "contact elastic",
    "rotation_J": "sphere motion",
    "sphere_motion_J": "sphere motion",
    "plate_motion_J": "plate motion",
    "potential_J": "potential",
    "kinetic_J": "kinetic",
}
"""The bands from the bottom of the stack to its top, with their roles."""

_COLUMNS = 110
"""Number of points along the edge of a band over the whole run, besides those at impacts."""


def ledger_chart(result: Result, history: Mapping[str, Floats], caption: str) -> Chart:
    """Return the chart of the entries of the ledger as stacked bands over time.

    Parameters
    ----------
    result : Result
        The result.
    history : dict of str to array
        The history that is drawn.
    caption : str
        The caption.
    """
    bands = bands_of(history)
    put_in = result.energy["input_J"]
    layers = []
    for name, role in _ROLES.items():
        if name in bands and np.any(bands[name] > 1e-6 * put_in):
            label = _MOTIONS[name][0] if name in _MOTIONS else ALL_HISTORY_COLUMNS[name].short
            if name == "contact_dissipated_J" and "plate_motion_J" in bands:
                label = "damping of the contact"  # as opposed to that of the bodies
            layers.append(Layer(label, bands[name], role))
    sinks = np.min(bands["potential_J"]) < -0.01 * put_in
    title = "Energy" + (
        " (bands are stacked on the potential energy where it is negative)" if sinks else ""
    )
    # contacts are shaded where they are enlarged alone, since the bands cover the ground
    stack = Stack(history["time_s"], tuple(layers), _drawn_points(result, history))
    # by a plate that is shaken
    brought = -history["drive_J"] if "drive_J" in history else np.zeros(1)
    marks: tuple[Stack | Level | Spans, ...] = (
        stack,
        Level(put_in, "put in at the start" if brought.any() else "total put in", "total"),
    )
    time = time_axis(result, views_of_contacts(result))
    low = float(min(np.min(bands["potential_J"]), 0.0))
    panel = Panel(
        time,
        Axis("Energy", "J", range=(low, 1.06 * (put_in + max(float(brought.max()), 0.0)))),
        (spans_of_contact(result), *marks),
    )
    return Chart("energy", title, ((panel,),), caption, height=3.9)


def bands_of(history: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return the time and the energies of the bands of a history [SI].

    Kinetic and strain energy of a vibrating body alternate, so they are summed to one band.
    """
    bands = {name: values for name, values in history.items() if name in _ROLES or name == "time_s"}
    if "plate_strain_J" in history:
        bands |= {
            name: history[kinetic] + history[strain]
            for name, (_, kinetic, strain) in _MOTIONS.items()
        }
    return bands


def _drawn_points(result: Result, history: Mapping[str, Floats]) -> Indices:
    """Return the indices of the points of the history to draw: evenly spaced ones, and
    those at touch and release of the first contacts.
    """
    time = history["time_s"]
    touch = result.impacts["time_s"][:45]
    release = touch + result.impacts["duration_s"][:45]
    count = min(max(4 * len(touch), _COLUMNS), 2 * _COLUMNS)
    spread = np.searchsorted(time, np.linspace(time[0], time[-1], count))
    # energies change faster in contact than in flight: a contact long enough to be visible gets
    # more points
    close = np.searchsorted(time, np.linspace(time[0], time[-1], 4 * _COLUMNS))
    close = close[history["indentation_m"][close.clip(max=len(time) - 1)] > 0.0]
    beside = [
        np.searchsorted(time, touch),
        np.searchsorted(time, release, side="right") - 1,
        [len(time) - 1],
    ]
    kept = np.unique(np.concatenate([spread, close, *beside]).clip(0, len(time) - 1))
    # energy stored in a local element at release is lost at once: keep the first point from release
    # on without it
    calm = np.flatnonzero(history["contact_elastic_J"] <= 1e-4 * result.energy["input_J"])
    after = np.searchsorted(calm, np.searchsorted(time, release, side="right") - 1)
    kept = np.union1d(kept, calm[after[after < len(calm)]])
    # a contact too short to be visible would show as a hairline wherever a point happens to lie
    # inside it
    impact = np.searchsorted(result.impacts["time_s"], time[kept], side="right") - 1
    brief = (
        np.append(result.impacts["duration_s"], 0.0)[impact] < 3.0 * (time[-1] - time[0]) / _COLUMNS
    )
    inside = history["contact_elastic_J"][kept] > 1e-4 * result.energy["input_J"]
    return np.asarray(kept[~(brief & inside)])
