"""Chart of a sensor: its signal over the run, and the amplitude spectrum of the response
to the first impact.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Level, Line, Rug
from vibroimpact.files.plain_names import plain_names
from vibroimpact.quoting import shortened, visible
from vibroimpact.resolved_case import ResolvedSensor
from vibroimpact.results.result import Result
from vibroimpact.runs.chart_data import drawn_signal, spans_of_contact
from vibroimpact.runs.spectrum import amplitude_spectrum, first_response
from vibroimpact.runs.vibration_charts import plate_time
from vibroimpact.units.display import digits, largest, multiple

MOST = 8
"""Number of sensors drawn; the signals of all are in the data files."""

_NEAR = 0.3
"""Part of its range that a signal must reach for the range to be drawn."""

_DECADES = 4.5
"""Decades below its peak down to which a spectrum is shown."""


def drawn_sensors(result: Result) -> dict[str, str]:
    """Return the names of the sensors that are drawn, by the name of the chart; none
    without an impact.
    """
    plain = plain_names(list(result.signals))
    return {
        f"sensor_{plain[name]}": name
        for name in list(result.signals)[:MOST]
        if len(result.impacts["time_s"])
    }


def sensor_chart(result: Result, chart: str, name: str, caption: str) -> Chart:
    """Return the chart of a sensor's signal, and of its amplitude spectrum from the first touch to
    the next.

    Parameters
    ----------
    result : Result
        The result.
    chart : str
        Name of the chart.
    name : str
        Name of the sensor.
    caption : str
        The caption.
    """
    signal = result.signals[name]
    first = first_response(result, name)
    sensor = signal.sensor
    level = Axis(sensor.quantity.capitalize(), sensor.unit)
    range_words, levels = _range(result, name)
    time = plate_time(result)
    line = Line(*drawn_signal(signal, first.start, first.stop))
    upper = Panel(
        time,
        level,
        (spans_of_contact(result), line, *levels),
        f"{sensor.quantity.capitalize()}{range_words}",
    )
    rows: list[tuple[Panel, ...]] = [(upper,)]
    if first.stop - first.start > 1:  # a slow sensor may have no sample between two touches
        rows.append((_spectrum(result, name),))
    return Chart(chart, f"Sensor {shortened(visible(name), 60)}", tuple(rows), caption, height=2.6)


def _range(result: Result, name: str) -> tuple[str, tuple[Level, ...]]:
    """Return the part of the title that states the range of a sensor, and lines at its
    ends if the signal comes near.
    """
    signal = result.signals[name]
    end = min(
        (
            end
            for sensor in result.case.get("sensors", ())
            if sensor["name"] == name
            for end in _ends(sensor)
        ),
        default=None,
    )
    if end is None:
        return "", ()
    scale = multiple(signal.sensor.unit, signal.largest)
    phrase = f" (range ±{digits(end / scale.size, 3)} {scale.unit}"
    # drawn to the range, the signal would be too small to read
    if largest(signal.value) < _NEAR * end:
        return f"{phrase}, beyond the axes)", ()
    return f"{phrase})", (Level(-end, "range", "mark line"), Level(end, "range", "mark line"))


def _ends(sensor: ResolvedSensor) -> Iterator[float]:
    """Yield the largest readings that a sensor's accelerometer and its converter permit,
    in the unit of its samples.
    """
    meter = sensor.get("accelerometer", {})
    gain = sensor.get("amplifier", {}).get("gain", 1.0)
    if "range" in meter:
        yield meter["range"] * meter.get("sensitivity", 1.0) * gain
    if "converter" in sensor:
        yield sensor["converter"]["range"]


def _spectrum(result: Result, name: str) -> Panel:
    signal = result.signals[name]
    spectrum = amplitude_spectrum(signal.value[first_response(result, name)], signal.sensor.rate)
    most = largest(spectrum.amplitude[1:])
    modes = np.array(result.frequencies("plate"))
    modes = modes[modes < 0.5 * signal.sensor.rate]
    shown = min(0.5 * signal.sensor.rate, 1.25 * float(modes.max(initial=0.0)) or np.inf)
    if not np.isfinite(shown):
        shown = np.nan  # as far as the spectrum reaches
    frequency = Axis("Frequency", "Hz", range=(0.0, shown))
    limits = None
    if most > 0.0:
        limits = (most * 10.0**-_DECADES, 3.0 * most)
    amplitude = Axis("Amplitude", signal.sensor.unit, log=True, range=limits)
    line = Line(
        spectrum.frequency[1:],
        np.maximum(spectrum.amplitude[1:], 1e-12 * most + 1e-300),
        role="detail",
    )
    return Panel(
        frequency,
        amplitude,
        (line, Rug(modes, "modes")),
        "Amplitude spectrum after the first touch",
    )
