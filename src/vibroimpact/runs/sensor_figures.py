"""Figure of a sensor: its signal over the whole run and after the first touch, and the amplitude spectrum of the response."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from vibroimpact.files.plain_names import plain_names
from vibroimpact.report.layout import label_vertical, new_figure, row_of_axes, wide_axes
from vibroimpact.report.style import ACCENT, INK, MARK, lettering
from vibroimpact.results.result import Result
from vibroimpact.runs.figure_data import decimated, decimated_samples
from vibroimpact.runs.spectrum import amplitude_spectrum, first_response
from vibroimpact.runs.vibration_figures import plate_span
from vibroimpact.units.display import Multiple, digits, largest, multiple

MOST = 8
"""Number of sensors drawn; the signals of all are in the data files."""

_NEAR = 0.3
"""Part of its range that a signal must reach for the range to be drawn."""

_DECADES = 4.5
"""Decades below its peak down to which a spectrum is shown."""


def drawn_sensors(result: Result) -> dict[str, str]:
    """Return the names of the sensors that are drawn, by the name of the figure; none without an impact."""
    plain = plain_names(list(result.signals))
    return {f"sensor_{plain[name]}": name for name in list(result.signals)[:MOST] if len(result.impacts["time_s"])}


def draw_sensor(result: Result, name: str) -> Figure:
    """Draw the signal of a sensor, and its amplitude spectrum from the first touch to the next."""
    signal = result.signals[name]
    scale, quantity = multiple(signal.sensor.unit, signal.largest), signal.sensor.quantity
    figure = new_figure(5.6)
    whole = wide_axes(figure, 3.65, 1.6)
    clock = multiple("s", signal.times(len(signal.value) - 1, len(signal.value)))
    time, value = decimated_samples(signal)
    whole.plot(time / clock.size, value / scale.size, color=INK, linewidth=0.8)
    whole.margins(x=0.01, y=0.08)
    whole.set_title(f"{quantity.capitalize()} at {lettering(name)}, whole run{_mark_range(whole, result, name, scale)}")
    whole.set_xlabel(f"Time [{clock.unit}]")
    label_vertical(whole, f"{quantity.capitalize()} [{scale.unit}]")
    left, right = row_of_axes(figure, 2, 0.5, 2.3)
    _draw_close(left, result, name, scale)
    _mark_range(left, result, name, scale)
    label_vertical(left, f"{quantity.capitalize()} [{scale.unit}]")
    _draw_spectrum(right, result, name)
    return figure


def _mark_range(axes: Axes, result: Result, name: str, scale: Multiple) -> str:
    """Draw the range of a sensor's accelerometer if the signal comes near it; return the part of the title that states the range.

    It is empty for a sensor without a range.
    """
    given = {one["name"]: one.get("accelerometer", {}).get("range") for one in result.case.get("sensors", ())}
    if (end := given.get(name)) is None:
        return ""
    words = f"range ±{digits(end / scale.size, 3)} {scale.unit}"
    if largest(result.signals[name].value) < _NEAR * end:  # drawn to the range, the signal would be too small to read
        return f" ({words}, beyond the axes)"
    for side in (-end, end):
        axes.axhline(side / scale.size, color=MARK, linewidth=0.8, linestyle=(0, (5, 3)))
    return f" (dashed: {words})"


def _draw_close(axes: Axes, result: Result, name: str, scale: Multiple) -> None:
    signal, touch, span = result.signals[name], float(result.impacts["time_s"][0]), plate_span(result)
    clock = multiple("s", span)
    first, last = signal.first_at(touch - 0.06 * span), signal.first_at(touch + span)
    axes.plot((signal.times(first, last) - touch) / clock.size, signal.value[first:last] / scale.size, color=ACCENT, linewidth=1.0)
    axes.axvline(0.0, color=MARK, linewidth=0.8, linestyle=(0, (1, 2)))
    axes.margins(x=0.01, y=0.08)
    axes.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
    axes.set_title("After the first touch (dotted)")
    axes.set_xlabel(f"Time since first touch [{clock.unit}]")


def _draw_spectrum(axes: Axes, result: Result, name: str) -> None:
    signal = result.signals[name]
    found = amplitude_spectrum(signal.value[first_response(result, name)], signal.sensor.rate)
    unit = multiple(signal.sensor.unit, largest(found.amplitude[1:]))
    amplitude, most = found.amplitude[1:] / unit.size, largest(found.amplitude[1:]) / unit.size
    axes.semilogy(*decimated(found.frequency[1:] / 1e3, np.maximum(amplitude, 1e-12 * most + 1e-300)), color=ACCENT, linewidth=0.8)
    modes = np.array(result.frequencies("plate"))
    modes = modes[modes < 0.5 * signal.sensor.rate] / 1e3
    axes.plot(modes, np.full(len(modes), 0.02), "|", markersize=5, color=MARK, markeredgewidth=0.6, transform=axes.get_xaxis_transform())
    if most > 0.0:
        axes.set_ylim(most * 10.0**-_DECADES, 3.0 * most)
    shown = min(0.5 * signal.sensor.rate / 1e3, 1.25 * float(modes.max(initial=0.0)) or np.inf)
    axes.set_xlim(0.0, shown if np.isfinite(shown) else None)
    axes.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
    axes.set_title(f"Amplitude spectrum [{unit.unit}] (ticks: modes)")
    axes.set_xlabel("Frequency [kHz]")
