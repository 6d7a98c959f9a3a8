"""Figures of a calibration: the value over the approach speed, the measured record, and the remaining differences."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from vibroimpact.calibration.calibration import Calibration
from vibroimpact.calibration.differences import COMPARED, WAYS, differences
from vibroimpact.calibration.record_figure import draw_record
from vibroimpact.report.layout import label_vertical, new_figure, row_of_axes, wide_axes
from vibroimpact.report.style import ACCENT, INK, LOOPS, MARK, style

_SMOOTH = 200


def draw_calibration(found: Calibration) -> dict[str, Figure]:
    """Draw the figures of a calibration.

    Parameters
    ----------
    found : Calibration
        Result of the calibration.

    Returns
    -------
    dict of str to Figure
        `parameter`; `record` if a record was measured; `differences` if there are several impacts and a reference.
    """
    with style():
        figures = {"parameter": _draw_parameter(found)}
        if found.overlays:
            figures["record"] = draw_record(found.overlays)
        if differences(found) and len(found.impacts[1]) > 1:
            figures["differences"] = _draw_differences(found)
    return figures


def _draw_parameter(found: Calibration) -> Figure:
    figure = new_figure(4.5)
    axes = wide_axes(figure, 1.0, 3.1)
    function, speeds = found.fit.function, found.observations.speeds
    if function.degree or len(speeds) > 1:
        smooth = np.linspace(function.slowest, function.fastest, _SMOOTH)
        fitted, band = function(smooth), found.fit.band(smooth, found.confidence)
        if np.isfinite(band).all():
            of_what = "band" if found.observations.measured else "band of the misfit"
            label = f"{100.0 * found.confidence:g} % {of_what}"
            low, high = found.allowed.bounded(np.array([fitted - band, fitted + band]))
            axes.fill_between(smooth, low, high, color=ACCENT, alpha=0.15, linewidth=0.0, label=label)
        name = ("constant", "line")[function.degree] if function.degree < 2 else f"polynomial of degree {function.degree}"
        axes.plot(smooth, fitted, color=ACCENT, linestyle=(0, (6, 2)), label=name)
    if found.curve is not None:
        axes.plot(*found.curve, color=INK, linewidth=0.9, label="exact at each speed")
    if found.intervals is not None:
        reach = np.abs(found.intervals.T - found.values)
        axes.errorbar(speeds, found.values, yerr=reach, fmt="none", ecolor=MARK, elinewidth=0.9, capsize=2.5)
    axes.plot(speeds, found.values, "o", color=MARK, markersize=4.5, label="impacts matched", zorder=3)
    if found.as_given and not np.allclose(found.given, found.values, rtol=1e-3):
        axes.plot(speeds, found.given, "x", color="#6b6b6b", markersize=5.0, label="as the case gives it")
    axes.set_title(f"{found.parameter} over the approach speed")
    axes.set_xlabel("Approach speed [m/s]")
    label_vertical(axes, f"{found.parameter} [{found.unit}]" if found.unit else found.parameter)
    figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncols=3, handlelength=3.0)
    return figure


def _draw_differences(found: Calibration) -> Figure:
    off = differences(found)
    shown = [name for name in COMPARED if name in off and not (name == "separation_speed_m_s" and "rebound_height_m" in off)]
    rows = -(-len(shown) // 2)
    figure = new_figure(0.75 + 2.5 * rows)
    places = [axes for row in reversed(range(rows)) for axes in row_of_axes(figure, min(2, len(shown)), 0.85 + 2.5 * row, 1.75)]
    for axes, name in zip(places, shown, strict=False):
        for way, (colour, dashes) in zip(WAYS, LOOPS, strict=False):
            values = 100.0 * off[name][way]
            impacts = np.arange(1, len(values) + 1)
            axes.plot(impacts, values, "o", color=colour, linestyle=dashes, markersize=3.5, label=way)
        axes.axhline(0.0, color="#888888", linewidth=0.8)
        axes.set_title(f"{COMPARED[name]} [%]")
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_xlabel("Impact")
    for axes in places[len(shown) :]:
        axes.remove()
    figure.legend(*places[0].get_legend_handles_labels(), loc="lower center", ncols=3, handlelength=4.0)
    return figure
