"""Figure of the energy ledger over time, as stacked bands."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.columns import ALL_HISTORY_COLUMNS
from vibroimpact.report.layout import label_vertical, new_figure, wide_axes
from vibroimpact.report.style import BANDS, INK
from vibroimpact.results.result import Result
from vibroimpact.runs.figure_data import MARGIN, enlarged_contacts, history_around
from vibroimpact.units.display import Multiple, multiple

_MOTIONS = {
    "sphere_motion_J": ("vibration of the sphere", "sphere_vibration_J", "sphere_strain_J"),
    "plate_motion_J": ("motion of the plate", "plate_kinetic_J", "plate_strain_J"),
}
"""Bands that sum two entries of the ledger: label, kinetic and strain energy."""

_COLUMNS = 110
"""Number of points along the edge of a band, besides those at impacts: filled areas with many points make large files."""


def draw_ledger(result: Result) -> Figure:
    """Draw the entries of the ledger as stacked bands, over the whole run and over the first enlarged contact, if there is one."""
    scale, shown = multiple("J", result.energy["input_J"]), enlarged_contacts(result)
    figure = new_figure(3.3 + (2.8 if len(shown) else 0.0))
    whole = wide_axes(figure, figure.get_figheight() - 2.3, 2.0)
    _draw_run(whole, result, scale)
    if len(shown):
        _draw_contact(wide_axes(figure, 1.1, 2.0), result, shown[0], scale)
    handles, labels = whole.get_legend_handles_labels()
    columns = len(labels) if len(labels) < 5 else 3
    figure.legend(handles[::-1], labels[::-1], loc="lower center", ncols=columns, handlelength=2.6, handleheight=1.2)
    return figure


def _draw_run(axes: Axes, result: Result, scale: Multiple) -> None:
    history = bands_of(result.history)
    kept = _drawn_points(result)
    clock = multiple("s", history["time_s"])
    _stack(axes, result, {name: values[kept] for name, values in history.items()}, clock, scale)
    sinks = np.min(history["potential_J"]) < -0.01 * result.energy["input_J"]
    axes.set_title("Energy, whole run" + (" (bands stand on the potential energy where it is negative)" if sinks else ""))
    axes.set_xlabel(f"Time [{clock.unit}]")


def _draw_contact(axes: Axes, result: Result, impact: int, scale: Multiple) -> None:
    duration = result.impacts["duration_s"][impact]
    part = _resampled(bands_of(history_around(result, impact)))
    clock = multiple("s", duration)
    _stack(axes, result, part, clock, scale)
    for edge in (0.0, duration / clock.size):
        axes.axvline(edge, color=INK, linewidth=0.8, linestyle=(0, (1, 2)))
    axes.set_title(f"Energy through the contact of impact {impact + 1}, enlarged (dotted: first touch and release)")
    axes.set_xlabel(f"Time since first touch [{clock.unit}]")
    axes.set_xlim(-MARGIN * duration / clock.size, (1.0 + MARGIN) * duration / clock.size)


def _stack(axes: Axes, result: Result, part: dict[str, Floats], clock: Multiple, scale: Multiple) -> None:
    time, whole = part["time_s"] / clock.size, bands_of(result.history)
    shown = [name for name in BANDS if name in part]
    # below the height of first touch the potential energy is negative: the stack starts from it
    bottom = sum((np.minimum(part[name], 0.0) for name in shown), np.zeros_like(time)) / scale.size
    for name in shown:
        label = _MOTIONS[name][0] if name in _MOTIONS else ALL_HISTORY_COLUMNS[name].short
        colour, hatch = BANDS[name]
        if name == "contact_dissipated_J" and "plate_motion_J" in part:
            label = "damping of the contact"  # as opposed to that of the bodies
        top = bottom + np.maximum(part[name], 0.0) / scale.size
        if np.any(whole[name] > 1e-6 * result.energy["input_J"]):
            axes.fill_between(time, bottom, top, facecolor=colour, hatch=hatch, edgecolor="#3d3d3d", linewidth=0.3, label=label)
        bottom = top
    axes.axhline(result.energy["input_J"] / scale.size, color=INK, linewidth=1.6, linestyle="--", label="total put in")
    label_vertical(axes, f"Energy [{scale.unit}]")
    axes.margins(x=0.0)
    axes.set_ylim(top=1.06 * result.energy["input_J"] / scale.size)


def bands_of(history: dict[str, Floats]) -> dict[str, Floats]:
    """Return the time and the energies of the bands of a history [SI].

    Kinetic and strain energy of a vibrating body alternate, so they are summed to one band.
    """
    bands = {name: values for name, values in history.items() if name in BANDS or name == "time_s"}
    if "plate_strain_J" in history:
        bands |= {name: history[kinetic] + history[strain] for name, (_, kinetic, strain) in _MOTIONS.items()}
    return bands


def _drawn_points(result: Result) -> Indices:
    """Return the indices of the points of the history to draw: evenly spaced ones, and those at touch and release of the first contacts."""
    time, touch = result.history["time_s"], result.impacts["time_s"][:45]
    release = touch + result.impacts["duration_s"][:45]
    count = min(max(4 * len(touch), _COLUMNS), 2 * _COLUMNS)
    spread = np.searchsorted(time, np.linspace(time[0], time[-1], count))
    # energies change faster in contact than in flight: a contact long enough to be visible gets more points
    close = np.searchsorted(time, np.linspace(time[0], time[-1], 4 * _COLUMNS))
    close = close[result.history["indentation_m"][close.clip(max=len(time) - 1)] > 0.0]
    beside = [np.searchsorted(time, touch), np.searchsorted(time, release, side="right") - 1, [len(time) - 1]]
    kept = np.unique(np.concatenate([spread, close, *beside]).clip(0, len(time) - 1))
    # energy stored in a local element at release is lost at once: keep the first point from release on without it
    calm = np.flatnonzero(result.history["contact_elastic_J"] <= 1e-4 * result.energy["input_J"])
    after = np.searchsorted(calm, np.searchsorted(time, release, side="right") - 1)
    kept = np.union1d(kept, calm[after[after < len(calm)]])
    # a contact too short to be visible would show as a hairline wherever a point happens to lie inside it
    impact = np.searchsorted(result.impacts["time_s"], time[kept], side="right") - 1
    brief = np.append(result.impacts["duration_s"], 0.0)[impact] < 3.0 * (time[-1] - time[0]) / _COLUMNS
    inside = result.history["contact_elastic_J"][kept] > 1e-4 * result.energy["input_J"]
    return np.asarray(kept[~(brief & inside)])


def _resampled(part: dict[str, Floats]) -> dict[str, Floats]:
    """Return a part of the history interpolated linearly at equally spaced times."""
    time = np.linspace(part["time_s"][0], part["time_s"][-1], _COLUMNS)
    return {name: np.interp(time, part["time_s"], part[name]) for name in part}
