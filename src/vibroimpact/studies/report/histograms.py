"""Histograms of sampled inputs and of results."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibroimpact.arrays import Floats
from vibroimpact.report.style import ACCENT, INK, MARK
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.outputs import Output, independent_drops, independent_values
from vibroimpact.studies.report.panels import add_legend, is_log, panels, title_of
from vibroimpact.studies.report.ticks import Ticks, plain_log_ticks
from vibroimpact.studies.study import Study

FEWEST = 20
"""Minimum number of drops of a histogram."""

_MOST_BINS = 60


def draw_inputs(study: Study, axes: list[StudyAxis]) -> Figure:
    """Draw histograms of the sampled inputs."""
    ticks = [Ticks(axis) for axis in axes]
    figure, some = panels([one.turned for one in ticks])
    for axis, one, panel in zip(axes, ticks, some, strict=True):
        drawn = one.places(axis.values[: independent_drops(study)])
        if one.names:
            panel.bar(range(len(one.names)), np.bincount(drawn.astype(int), minlength=len(one.names)), width=0.6, color=ACCENT)
        else:
            _draw_histogram(panel, drawn, one.is_log)
        one.set_on(panel)
        panel.set_xlabel(one.label)
        panel.set_title("Drops")
    return figure


def draw_outputs(study: Study, outputs: list[Output]) -> Figure:
    """Draw histograms of the results with their percentiles."""
    figure, some = panels([False] * len(outputs), legend=True)
    for output, panel in zip(outputs, some, strict=True):
        size = output.scale.size
        values = independent_values(study, output.name)
        values = values[np.isfinite(values)]
        values /= size
        _draw_histogram(panel, values, is_log(output))
        low, _, middle, _, high = output.spread.percentiles
        panel.axvline(middle / size, color=INK, linewidth=1.2, label="median")
        for number, edge in enumerate((low, high)):
            panel.axvline(edge / size, color=MARK, linewidth=1.0, linestyle=(0, (4, 2)), label="5 and 95 %" if not number else None)
        if is_log(output):
            panel.set_xscale("log")
            plain_log_ticks(panel.xaxis)
        panel.set_xlabel(title_of(output))
        panel.set_title("Drops")
    add_legend(figure, some[0])
    return figure


def _draw_histogram(panel: Axes, values: Floats, log: bool) -> None:
    number = int(np.clip(2.0 * np.cbrt(len(values)), 8, _MOST_BINS))
    low, high = float(values.min()), float(values.max())
    edges = np.geomspace(low, high, number + 1) if log and low > 0.0 else np.linspace(low, high, number + 1)
    counts, _ = np.histogram(values, np.unique(edges))
    panel.stairs(counts, np.unique(edges), fill=True, color=ACCENT, alpha=0.35)
    panel.stairs(counts, np.unique(edges), color=ACCENT, linewidth=0.9)
