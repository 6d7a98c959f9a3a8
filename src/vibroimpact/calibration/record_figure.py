"""Figure of a measured record and its simulation with calibrated values."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from vibroimpact.calibration.overlay import Overlay
from vibroimpact.report.layout import label_vertical, new_figure, row_of_axes, wide_axes
from vibroimpact.report.style import ACCENT, INK, MARK
from vibroimpact.runs.figure_data import decimated
from vibroimpact.units.display import Multiple, multiple

_FEW = 400  # samples up to which points are drawn; more would overlap

_PER_ROW = 3
"""Panels per row."""


def draw_record(overlays: Sequence[Overlay]) -> Figure:
    """Draw a record over its simulation, and the difference below a position.

    Parameters
    ----------
    overlays : sequence of Overlay
        Contacts of a force, or one record of a position.
    """
    return _draw_position(overlays[0]) if overlays[0].quantity == "position" else _draw_forces(overlays)


def _draw_forces(overlays: Sequence[Overlay]) -> Figure:
    rows = -(-len(overlays) // _PER_ROW)
    figure = new_figure(0.85 + 2.55 * rows)
    across = min(len(overlays), _PER_ROW)
    places = [axes for row in reversed(range(rows)) for axes in row_of_axes(figure, across, 0.95 + 2.55 * row, 1.8)]
    clock = multiple("s", np.concatenate([one.simulated[0] for one in overlays]))
    scale = multiple("N", np.concatenate([one.simulated[1] for one in overlays]))
    for number, (axes, one) in enumerate(zip(places, overlays, strict=False)):
        time, force = one.simulated
        _measured(axes, *one.measured, clock, scale)
        axes.plot(time / clock.size, force / scale.size, color=ACCENT, label="simulated", zorder=3)
        axes.set_title(f"Impact {number + 1}")
        axes.set_xlim(-0.25 * time[-1] / clock.size, 1.25 * time[-1] / clock.size)
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.set_xlabel(f"Time since first touch [{clock.unit}]")
        if number % across == 0:
            label_vertical(axes, f"Contact force [{scale.unit}]")
    for axes in places[len(overlays) :]:
        axes.remove()
    figure.legend(*places[0].get_legend_handles_labels(), loc="lower center", ncols=2, handlelength=3.0)
    return figure


def _draw_position(one: Overlay) -> Figure:
    figure = new_figure(5.0)
    upper, lower = wide_axes(figure, 2.45, 2.2), wide_axes(figure, 0.9, 1.1)
    (time, position), (_, simulated) = one.measured, one.simulated
    clock, scale, apart = multiple("s", time), multiple("m", position), position - simulated
    known = np.isfinite(simulated)
    fine = multiple("m", apart[known])
    _measured(upper, time, position, clock, scale)
    upper.plot(*decimated(time[known] / clock.size, simulated[known] / scale.size), color=ACCENT, label="simulated", zorder=3)
    upper.set_title("Height of the sphere's centre, from the first impact on as simulated")
    label_vertical(upper, f"Height [{scale.unit}]")
    lower.plot(*decimated(time[known] / clock.size, apart[known] / fine.size), color=MARK, linewidth=0.9)
    lower.set_title("Measured less simulated")
    label_vertical(lower, f"Difference [{fine.unit}]")
    lower.set_xlabel(f"Time [{clock.unit}]")
    lower.set_xlim(upper.get_xlim())
    figure.legend(*upper.get_legend_handles_labels(), loc="lower center", ncols=2, handlelength=3.0)
    return figure


def _measured(axes: Axes, time: np.ndarray, values: np.ndarray, clock: Multiple, scale: Multiple) -> None:
    if len(time) <= _FEW:
        axes.plot(time / clock.size, values / scale.size, "o", color=MARK, markersize=2.5, label="measured")
    else:
        axes.plot(*decimated(time / clock.size, values / scale.size), color=INK, linewidth=2.2, alpha=0.45, label="measured")
