"""Charts of histograms: the sampled inputs, and the results."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Bars, Level, Mark
from vibroimpact.quoting import shortened, visible
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.labels import keys_told
from vibroimpact.studies.report.outputs import Output, independent_drops, independent_values
from vibroimpact.studies.report.panels import HEIGHT, in_rows
from vibroimpact.studies.report.scales import (
    is_log,
    is_spread_by_factors,
    key_axis,
    names_of,
    places,
    result_axis,
)

FEWEST = 20
"""Minimum number of drops of a histogram."""

_MOST_BINS = 60


def inputs_chart(study: Study, axes: list[StudyAxis]) -> Chart:
    """Return the chart of histograms of the sampled inputs."""
    panels = []
    for axis in axes:
        drawn = places(axis, axis.values[: independent_drops(study)])
        if axis.numeric:
            bars = _histogram(drawn, log=is_spread_by_factors(axis.values))
        else:
            names = tuple(shortened(visible(name), 60) for name in names_of(axis))
            counts = np.bincount(drawn.astype(int), minlength=len(names)).astype(float)
            bars = Bars(np.arange(float(len(names))), counts, role="pale", texts=names)
        panels.append(Panel(key_axis(axis), Axis("Drops", integer=True), (bars,)))
    caption = f"Histograms of the sampled values{_of_what(study)}. {keys_told(axes)}"
    return Chart("inputs", "Sampled keys", in_rows(panels), caption, HEIGHT)


def outputs_chart(study: Study, outputs: list[Output]) -> Chart:
    """Return the chart of histograms of the results with their percentiles."""
    panels = []
    for output in outputs:
        values = independent_values(study, output.name)
        low, _, median, _, high = output.spread.percentiles
        marks: tuple[Mark, ...] = (
            _histogram(values[np.isfinite(values)], log=is_log(output)),
            Level(low, "5 and 95 %", "mark line", upright=True),
            Level(high, "5 and 95 %", "mark line", upright=True),
            Level(median, "median", "main", upright=True),
        )
        panels.append(Panel(result_axis(output, output.title), Axis("Drops", integer=True), marks))
    return Chart(
        "outputs",
        "Distribution of the results",
        in_rows(panels),
        f"Histograms of the results{_of_what(study)}.",
        HEIGHT,
    )


def _of_what(study: Study) -> str:
    if study.design != "saltelli":
        return ""
    return " in the blocks A and B, whose drops are independent"


def _histogram(values: Floats, *, log: bool) -> Bars:
    # Rice's rule: twice the cube root of the number of values
    number = int(np.clip(2.0 * np.cbrt(len(values)), 8, _MOST_BINS))
    low = float(values.min())
    high = float(values.max())
    edges = np.linspace(low, high, number + 1)
    if log and low > 0.0:
        edges = np.geomspace(low, high, number + 1)
    edges = np.unique(edges)  # fewer where all values are about the same
    counts, _ = np.histogram(values, edges)
    return Bars(edges, counts.astype(float), role="pale")
