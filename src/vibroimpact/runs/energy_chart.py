"""Chart of the energy ledger over time, as stacked bands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Layer, Level, Stack
from vibroimpact.dynamics.motion.columns import ALL_HISTORY_COLUMNS
from vibroimpact.results.result import Result
from vibroimpact.runs.chart_data import spans_of_contact, time_axis, views_of_contacts, windows_of

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

_MOST_IN_WINDOW = 500
"""Points along the edge of a band in a view: as many as a page draws."""

_COLUMNS = 110
"""Number of points along the edge of a band over the whole run, besides those at impacts."""
_MOST_CONTACTS = 45
"""Largest number of contacts whose touch and release get a point each."""


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
            if name == "contact_dissipated_J" and "plate_motion_J" in bands:
                label = "damping of the contact"  # as opposed to that of the bodies
            elif name in _MOTIONS:
                label = _MOTIONS[name][0]
            else:
                label = ALL_HISTORY_COLUMNS[name].short
            layers.append(Layer(label, bands[name], role))
    sinks = np.min(bands["potential_J"]) < -0.01 * put_in
    title = "Energy"
    if sinks:
        title += " (bands are stacked on the potential energy where it is negative)"
    # contacts are shaded where they are enlarged alone, since the bands cover the ground
    time = time_axis(result, views_of_contacts(result))
    overview = _drawn_points(result, history)
    kept = np.union1d(overview, _points_of_windows(history["time_s"], time))
    stack = Stack(
        history["time_s"][kept],
        tuple(replace(layer, values=layer.values[kept]) for layer in layers),
        np.searchsorted(kept, overview),
    )
    drive_work = -history.get("drive_J", np.zeros(1))  # of a plate that is shaken
    name_of_total = "put in at the start" if drive_work.any() else "total put in"
    total = Level(put_in, name_of_total, "total")
    low = float(min(np.min(bands["potential_J"]), 0.0))
    high = 1.06 * (put_in + max(float(drive_work.max()), 0.0))
    energy = Axis("Energy", "J", range=(low, high))
    panel = Panel(time, energy, (spans_of_contact(result), stack, total))
    return Chart("energy", title, ((panel,),), caption, height=3.9)


def _points_of_windows(time: Floats, axis: Axis) -> Indices:
    """Return the indices of points of the history that are drawn in each view, and between views.

    They are evenly spaced, as those that a page draws.
    """
    if len(time) <= _MOST_IN_WINDOW:
        return np.arange(len(time))
    chosen = []
    for start, end in windows_of(axis, time):
        first = np.searchsorted(time, start)
        last = np.searchsorted(time, end, side="right")
        if last - first <= _MOST_IN_WINDOW:
            chosen.append(np.arange(first, last))
        else:
            chosen.append(np.searchsorted(time, np.linspace(start, end, _MOST_IN_WINDOW)))
        chosen.append(np.array([first - 1, last]))  # those beyond, so that bands reach the ends
    return np.unique(np.concatenate(chosen)).clip(0, len(time) - 1)


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
    last = len(time) - 1
    touch = result.impacts["time_s"][:_MOST_CONTACTS]
    release = touch + result.impacts["duration_s"][:_MOST_CONTACTS]
    count = min(max(4 * len(touch), _COLUMNS), 2 * _COLUMNS)
    spread = np.searchsorted(time, np.linspace(time[0], time[-1], count))
    # energies change faster in contact than in flight: a contact long enough to be visible gets
    # more points
    close = np.searchsorted(time, np.linspace(time[0], time[-1], 4 * _COLUMNS))
    close = close[history["indentation_m"][close.clip(max=last)] > 0.0]
    at_touch = np.searchsorted(time, touch)
    at_release = np.searchsorted(time, release, side="right") - 1
    kept = np.concatenate([spread, close, at_touch, at_release, [last]])
    kept = np.unique(kept.clip(0, last))
    # energy stored in a local element at release is lost at once: keep the first point from release
    # on without it
    is_stored = history["contact_elastic_J"] > 1e-4 * result.energy["input_J"]
    calm = np.flatnonzero(~is_stored)
    after = np.searchsorted(calm, at_release)
    kept = np.union1d(kept, calm[after[after < len(calm)]])
    # a contact too short to be visible would show as a hairline wherever a point happens to lie
    # inside it
    impact = np.searchsorted(result.impacts["time_s"], time[kept], side="right") - 1
    # before the first touch the impact is -1, which is of no duration
    duration = np.append(result.impacts["duration_s"], 0.0)[impact]
    is_brief = duration < 3.0 * (time[-1] - time[0]) / _COLUMNS
    return np.asarray(kept[~(is_brief & is_stored[kept])])
