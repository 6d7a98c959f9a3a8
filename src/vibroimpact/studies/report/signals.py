"""Figure of the signals of a sensor in the drops of a study: percentile band and single signals."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from vibroimpact.arrays import Floats
from vibroimpact.files.plain_names import plain_names
from vibroimpact.report.layout import label_vertical, new_figure, wide_axes
from vibroimpact.report.style import ACCENT, INK, LOOPS, lettering
from vibroimpact.studies.drop_variables import SIGNAL
from vibroimpact.studies.report.labels import BAND, drops_text, with_unit
from vibroimpact.studies.report.outputs import sampled_output
from vibroimpact.studies.report.panels import add_legend
from vibroimpact.studies.study import Study
from vibroimpact.units.display import Multiple, multiple

MOST = 2
"""Maximum number of sensors drawn."""

_BYTES = 30e6  # maximum memory of the evaluated signals
_COLUMNS = 300  # time intervals of the band
_CLOSE = 250  # samples shown of single signals from their onset
_FEW = 3
_BEGINS = 0.02  # fraction of the peak at which a signal has its onset


def signal_figures(study: Study) -> dict[str, str]:
    """Return the names of the figures of sensors, with the names of the sensors."""
    sensors = [name.removeprefix(SIGNAL) for name in study.shapes if name.startswith(SIGNAL)]
    return {f"signal_{plain_name}": sensor for sensor, plain_name in list(plain_names(sensors).items())[:MOST]}


def draw_signals(study: Study, sensor: str) -> Figure | None:
    """Draw the signals of a sensor: percentile band of its readings over time, and single signals from their onset."""
    name = f"{SIGNAL}{sensor}"
    samples, unit = study.shapes[name][-1], study.meanings[name][0]
    signals = sampled_output(study, name, max(_FEW, int(_BYTES / (8 * samples))))
    signals = signals[np.isfinite(signals).all(axis=1)]
    if not len(signals) or not np.abs(signals).max() > 0.0:
        return None
    time = study.times(sensor)
    scale = multiple(unit, signals)
    figure = new_figure(5.9)
    whole, close = wide_axes(figure, 3.65, 1.85), wide_axes(figure, 0.95, 1.85)
    begin = min(_begin(one) for one in signals)
    begin = max(begin - (len(time) - begin) // 20, 0)
    _draw_band(whole, time[begin:], signals[:, begin:] / scale.size)
    _draw_few(close, time, signals, scale)
    for axes in (whole, close):
        label_vertical(axes, with_unit(study.meanings[name][1].split(" that ")[0].capitalize(), scale.unit))
    whole.set_title(f"Readings of {lettering(sensor, 40)} in {drops_text(len(signals))}, from just before the first one begins")
    add_legend(figure, close)
    return figure


def _draw_band(axes: Axes, time: Floats, signals: Floats) -> None:
    """Draw the percentile band of the readings in short time intervals."""
    spans = np.array_split(np.arange(len(time)), min(_COLUMNS, len(time)))
    parts = np.array([np.percentile(signals[:, span], (0, 5, 50, 95, 100)) for span in spans])
    clock = multiple("s", time)
    middle = np.array([time[span].mean() for span in spans]) / clock.size
    axes.fill_between(middle, parts[:, 0], parts[:, 4], color=ACCENT, alpha=0.15, linewidth=0.0, label="all")
    axes.fill_between(middle, parts[:, 1], parts[:, 3], color=ACCENT, alpha=0.55, linewidth=0.0, label=BAND)
    axes.plot(middle, parts[:, 2], color=INK, linewidth=0.9, label="median")
    axes.margins(x=0.01)
    axes.legend(loc="upper right", ncols=3)
    axes.set_xlabel(f"Time [{clock.unit}]")


def _draw_few(axes: Axes, time: Floats, signals: Floats, scale: Multiple) -> None:
    """Draw the signals with the smallest, the median and the largest peak, each from its onset."""
    by_peak = np.argsort(np.abs(signals).max(axis=1), kind="stable")
    chosen = dict.fromkeys([int(by_peak[0]), int(by_peak[len(by_peak) // 2]), int(by_peak[-1])])
    titles = ("smallest peak", "middle peak", "largest peak") if len(chosen) == _FEW else ("smallest peak", "largest peak")
    step = time[1] - time[0] if len(time) > 1 else 1.0
    clock = multiple("s", _CLOSE * step)
    for place, (colour, dashes), title in zip(chosen, LOOPS, titles if len(chosen) > 1 else ("the drop",), strict=False):
        one = signals[place]
        begin = max(_begin(one) - _CLOSE // 20, 0)
        part = one[begin : begin + _CLOSE]
        axes.plot(np.arange(len(part)) * step / clock.size, part / scale.size, color=colour, linestyle=dashes, linewidth=1.0, label=title)
    axes.margins(x=0.01)
    axes.xaxis.set_major_locator(MaxNLocator(8, steps=[1, 2, 5, 10]))
    axes.set_title("Single drops, each from just before its signal begins")
    axes.set_xlabel(f"Time [{clock.unit}]")


def _begin(signal: Floats) -> int:
    """Return the index of the onset of a signal."""
    moved = np.abs(signal - signal[0])
    return int(np.argmax(moved > _BEGINS * moved.max()))
