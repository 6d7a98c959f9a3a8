"""Chart of the signals of a sensor in the drops of a study: percentile band and single
signals, from first touch on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.decimation import visible_points
from vibroimpact.charts.marks import Band, Line
from vibroimpact.charts.palette import series
from vibroimpact.files.plain_names import plain_names
from vibroimpact.quoting import shortened, visible
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.planning.drop_variables import SIGNAL, SIGNAL_START
from vibroimpact.studies.report.labels import BAND, drops_text
from vibroimpact.studies.report.outputs import drop_numbers, sampled_output, sampled_places
from vibroimpact.units.display import text

MOST = 2
"""Maximum number of sensors drawn."""

_BYTES = 30e6  # maximum memory of the evaluated signals
_BEFORE = 0.05  # part of what is shown that lies before first touch
_COLUMNS = 1200  # time intervals of the band
# samples shown by the first view, and by each further one how many times more
_CLOSE = 250
_FARTHER = 8
_FEW = 5
_FINEST = 2500  # columns of a line that is drawn


def signal_makers(study: Study) -> dict[str, Callable[[], Chart | None]]:
    """Return what makes the charts of the signals of the first sensors, by the names of
    the charts.
    """
    sensors = [name.removeprefix(SIGNAL) for name in study.shapes if name.startswith(SIGNAL)]
    names = {
        sensor: f"signal_{plain_name}"
        for sensor, plain_name in list(plain_names(sensors).items())[:MOST]
    }
    return {name: partial(_signal_chart, study, sensor, name) for sensor, name in names.items()}


def _signal_chart(study: Study, sensor: str, name: str) -> Chart | None:
    """Return the chart of a sensor's signals: percentile band of its readings over time,
    and single signals; None without readings.
    """
    variable = f"{SIGNAL}{sensor}"
    most = max(_FEW, int(_BYTES / (8 * study.shapes[variable][-1])))
    signals = sampled_output(study, variable, most)
    numbers = drop_numbers(study, *sampled_places(study, most))
    touch = _first_touches(study, sensor, most)
    complete = np.isfinite(signals).all(axis=1) & np.isfinite(touch)
    signals = signals[complete]
    numbers = numbers[complete]
    touch = touch[complete]
    if not len(signals) or not np.abs(signals).max() > 0.0:
        return None
    times = study.times(sensor)
    step = 1.0
    if len(times) > 1:
        step = float(times[1] - times[0])
    before = float(min(touch.min(), _BEFORE * (times[-1] - touch.min())))
    label = "Time since first touch" if touch.any() else "Time"
    unit, meaning = study.meanings[variable]
    reading = Axis(meaning.split(" that ")[0].capitalize(), unit)
    band = Panel(
        Axis(label, "s"),
        reading,
        tuple(_band(signals, touch, step, before)),
        f"All readings in {drops_text(len(signals))}",
    )
    single = tuple(_single(signals, numbers, touch, times, before))
    lower = Panel(Axis(label, "s", views=_views(step, len(times))), reading, single, "Single drops")
    caption = (
        "Above, all readings in short spans of the time since first touch, as long as half "
        "of the drops have readings. Below, single drops "
        "aligned at first touch: those of the smallest and the largest peak, "
        "and up to three between."
    )
    title = f"Sensor {shortened(visible(sensor), 60)}"
    return Chart(name, title, ((band,), (lower,)), caption, 2.6)


def _first_touches(study: Study, sensor: str, most: int) -> Floats:
    """Return the time of first touch of each drop since its first sample; zeros where the
    dataset does not have it.
    """
    start = f"{sensor}{SIGNAL_START}"
    if "first_time_s" in study.shapes and start in study.shapes:
        return sampled_output(study, "first_time_s", most) - sampled_output(study, start, most)
    if "first_time_s" in study.shapes:
        return sampled_output(study, "first_time_s", most)
    return np.zeros(len(drop_numbers(study, *sampled_places(study, most))))


def _views(step: float, samples: int) -> tuple[View, ...]:
    """Return the views: the beginning, each of a span several times that of the one before."""
    spans: list[float] = []
    while (count := _CLOSE * _FARTHER ** len(spans)) < samples:
        spans.append(count * step)
    return tuple(View(f"the first {text(span, 's', 2)}", -_BEFORE * span, span) for span in spans)


def _band(signals: Floats, touch: Floats, step: float, before: float) -> Iterator[Band | Line]:
    """Yield all readings as bands in short intervals of the time since first touch."""
    # numbers of samples: of the first touch of each drop, and shown ahead of it
    touches = np.round(touch / step).astype(int)
    ahead = round(before / step)
    # as long as half of the drops have readings
    samples = ahead + signals.shape[1] - int(np.median(touches))
    aligned = _aligned(signals, touches - ahead, samples)
    spans = np.array_split(np.arange(samples), min(_COLUMNS, samples))
    percentiles = []
    for span in spans:
        readings = aligned[:, span].ravel()
        readings = readings[np.isfinite(readings)]
        percentiles.append(np.percentile(readings, (0, 5, 50, 95, 100)))
    least, low, median, high, most = np.array(percentiles).T
    time = step * np.array([span.mean() - ahead for span in spans])
    yield Band(time, least, most, "all", "band")
    yield Band(time, low, high, BAND, "inner band")
    yield Line(time, median, "median")


def _aligned(signals: Floats, starts: Indices, samples: int) -> Floats:
    """Return signals from the start of each on, with NaN where they have ended."""
    aligned = np.full((len(signals), samples), np.nan)
    for row, signal, start in zip(aligned, signals, starts.tolist(), strict=True):
        shown = signal[start : start + samples]
        row[: len(shown)] = shown
    return aligned


def _single(
    signals: Floats, numbers: Indices, touch: Floats, times: Floats, before: float
) -> Iterator[Line]:
    """Yield the signals with the smallest and the largest peak, and with some between,
    the largest below the others.
    """
    by_peak = np.argsort(-np.abs(signals).max(axis=1), kind="stable")
    ranks = np.linspace(0, len(by_peak) - 1, _FEW).astype(int)
    chosen = dict.fromkeys(by_peak[ranks].tolist())
    peaks = {}
    if len(chosen) > 1:
        largest = int(by_peak[0])
        smallest = int(by_peak[-1])
        peaks = {largest: ", largest peak", smallest: ", smallest peak"}
    for number, drop in enumerate(chosen):
        since_touch = times - touch[drop]
        start = int(np.searchsorted(since_touch, -before))
        x, y = _drawn(since_touch[start:], signals[drop][start:])
        yield Line(x, y, f"drop {numbers[drop]}{peaks.get(drop, '')}", series(number))


def _drawn(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Return the visible points of a signal, and all of its beginning, which the first
    views show.
    """
    kept = visible_points(len(x), lambda first, last: (x[first:last], y[first:last]), _FINEST)
    if kept is None:
        return x, y
    beginning = np.arange(np.searchsorted(x, (x[1] - x[0]) * _CLOSE * _FARTHER))
    shown = np.union1d(kept, beginning)
    return x[shown], y[shown]
