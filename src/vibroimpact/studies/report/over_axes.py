"""Chart of a result over each key of a study with many: single drops, and the median and
percentile band of all of them.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Band, Line, Mark, Points
from vibroimpact.quoting import shortened, visible
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.answer import FEW_DROPS
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.drops import MOST_DROPS, Group, values_at
from vibroimpact.studies.report.labels import BAND, keys_told
from vibroimpact.studies.report.outputs import (
    Output,
    drop_numbers,
    independent_drops,
    sampled_output,
    sampled_places,
)
from vibroimpact.studies.report.panels import HEIGHT, in_rows
from vibroimpact.studies.report.percentiles import PERCENTILES
from vibroimpact.studies.report.scales import key_axis, places, result_axis

MOST_AXES = 8
"""Maximum number of axes drawn."""

_BANDED = 100_000  # maximum number of drops for the medians
_BINS = 12
_FULL = 15
_FEWEST = 300  # drops from which on medians are drawn
_PARTS = np.array([PERCENTILES[0], 50, PERCENTILES[-1]]) / 100.0


def over_axes_chart(
    study: Study, axes: list[StudyAxis], output: Output, groups: list[Group]
) -> Chart:
    """Return the chart of a result over each axis: points of a subset of drops, and median and band
    of a larger one.

    Parameters
    ----------
    study : Study
        The study.
    axes : list of StudyAxis
        The keys that vary.
    output : Output
        The result.
    groups : list of Group
        The drops that are drawn as points.
    """
    up = result_axis(output, output.short)
    drawn = sampled_output(study, output.name, MOST_DROPS)
    heights = [drawn[group.chosen] for group in groups]
    chosen = sampled_places(study, _BANDED)
    numbers = drop_numbers(study, *chosen)
    values = sampled_output(study, output.name, _BANDED)
    panels = []
    for axis in axes[:MOST_AXES]:
        marks: list[Mark] = [
            _drops(study, axes, axis, group, height)
            for group, height in zip(groups, heights, strict=True)
        ]
        if np.isfinite(values).any() and _has_medians(study):
            where = places(axis, values_at(study, axis, numbers))
            marks = _with_medians(marks, axis, where, values, has_band=_has_band(study, axis))
        panels.append(Panel(key_axis(axis), up, tuple(marks)))
    return Chart(
        output.name,
        shortened(visible(output.title), 60),
        in_rows(panels),
        _caption(study, axes),
        HEIGHT,
    )


def _drops(
    study: Study, axes: list[StudyAxis], axis: StudyAxis, group: Group, height: Floats
) -> Mark:
    """Return drops as points; few of them with a line where only their keys together change."""
    where = group.places[axis.key]
    # points of several names are no path
    is_whole = len(group.chosen) == study.size
    is_path = study.design == "zip" or (len(axes) == 1 and not study.is_grid)
    if is_path and is_whole and axis.numeric and study.size <= FEW_DROPS:
        order = np.argsort(where, kind="stable")
        texts = tuple(group.texts[number] for number in order.tolist())
        return Line(where[order], height[order], "", group.role, marked=True, texts=texts)
    return Points(where, height, group.name, group.role, group.texts, group.keys)


def _has_medians(study: Study) -> bool:
    """Return whether medians are drawn: on a grid, where levels have several drops, and of enough
    points.
    """
    return study.is_grid or independent_drops(study) > _FEWEST


def _has_band(study: Study, axis: StudyAxis) -> bool:
    """Return whether percentiles are drawn beside medians: not those of levels of few drops."""
    if study.is_grid:
        return study.size > FEW_DROPS * len(axis.values)
    return _has_medians(study)


def _with_medians(
    marks: list[Mark], axis: StudyAxis, where: Floats, values: Floats, *, has_band: bool
) -> list[Mark]:
    """Return marks with the median of values along an axis, and with the band below them."""
    finite = np.isfinite(values)
    middles, bands = _in_bins(where[finite], values[finite], axis)
    low, middle, high = bands.T
    if not axis.numeric and has_band:
        return [*marks, Points(middles, middle, f"median, {BAND}", "main", low=low, high=high)]
    if not axis.numeric:
        return [*marks, Points(middles, middle, "median", "main")]
    median = Line(middles, middle, "median", "main", marked=len(middles) <= _BINS)
    if has_band:
        return [Band(middles, low, high, BAND, "band"), *marks, median]
    return [*marks, median]


def _in_bins(where: Floats, values: Floats, axis: StudyAxis) -> tuple[Floats, Floats]:
    """Return bin centres along an axis, with equal numbers of drops per bin, or its names
    or few levels, and the band in each bin.
    """
    distinct = np.unique(where)
    if not axis.numeric or len(distinct) <= _BINS:  # a list of values: a bin would mix them
        at_places = [np.quantile(values[where == place], _PARTS) for place in distinct]
        return distinct, np.array(at_places)
    order = np.argsort(where, kind="stable")
    bin_count = min(_BINS, len(order) // _FULL)
    groups = [group for group in np.array_split(order, bin_count) if len(group)]
    middles = np.array([float(np.median(where[group])) for group in groups])
    return middles, np.array([np.quantile(values[group], _PARTS) for group in groups])


def _caption(study: Study, axes: list[StudyAxis]) -> str:
    number = len(drop_numbers(study, *sampled_places(study, MOST_DROPS)))
    some = "All drops"
    if number < independent_drops(study):
        some = f"{number} of the drops"
    blocks = ""
    if study.design == "saltelli":
        blocks = " of the blocks A and B"
    band = ""
    if any(_has_band(study, axis) for axis in axes[:MOST_AXES]):
        band = (
            f"; the line and the band are the median and {BAND} of drops with the same value, or "
            f"of drops next to each other where a key has more than {_BINS} numbers"
        )
    elif _has_medians(study):
        band = "; the line is the median of drops with the same value"
    first = ""
    if len(axes) > MOST_AXES:
        first = f" The first {MOST_AXES} of {len(axes)} keys are drawn."
    return f"{some}{blocks}, over each key{band}.{first} {keys_told(axes[:MOST_AXES])}"
