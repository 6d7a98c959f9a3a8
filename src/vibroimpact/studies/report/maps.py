"""Chart of a grid of two or more axes as maps of the results over two of them."""

from __future__ import annotations

import numpy as np

from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Map
from vibroimpact.quoting import shortened, visible
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.drops import drop_texts, results_of
from vibroimpact.studies.report.labels import keys_told
from vibroimpact.studies.report.outputs import Output, drop_numbers, on_two_axes
from vibroimpact.studies.report.panels import HEIGHT, in_rows
from vibroimpact.studies.report.scales import ascending_order, key_axis, places, result_axis

_MOST = 200  # maximum number of levels drawn along an axis, close to the resolution of a panel
_MOST_TOLD = 4096  # maximum number of drops of which each cell tells which one it is


def maps_chart(
    study: Study, axes: list[StudyAxis], outputs: list[Output], across: StudyAxis, up: StudyAxis
) -> Chart:
    """Return the chart of maps of results over two axes of a grid.

    Parameters
    ----------
    study : Study
        A study on a grid.
    axes : list of StudyAxis
        Its axes of several levels.
    outputs : list of Output
        The results to draw; of more than two axes their median over the others.
    across, up : StudyAxis
        The two axes.
    """
    if not up.numeric and across.numeric:  # names fit better below
        across, up = up, across
    columns = ascending_order(across, _MOST)
    rows = ascending_order(up, _MOST)
    x = key_axis(across)
    y = key_axis(up)
    texts: tuple[str, ...] = ()
    if len(axes) == 2 and study.size <= _MOST_TOLD:
        descriptions = np.array(
            drop_texts(study, results_of(study, outputs), drop_numbers(study)), dtype=object
        )
        descriptions = descriptions.reshape([len(axis.values) for axis in axes])
        if axes[0] is across:
            descriptions = descriptions.T
        texts = tuple(descriptions[np.ix_(rows, columns)].ravel())
    panels = []
    for output in outputs:
        values = on_two_axes(study, output.name, axes.index(up), axes.index(across))
        values = values[np.ix_(rows, columns)]
        scale = result_axis(output, output.short)
        cells = Map(
            places(across, across.values[columns]),
            places(up, up.values[rows]),
            values,
            scale,
            texts=texts,
        )
        panels.append(Panel(x, y, (cells,), shortened(visible(output.title), 60)))
    if len(axes) == 2:
        phrase = ""
    else:
        phrase = (
            "Two of the keys, those with the largest effect on the first result where it is "
            "known; colours are medians over the others. "
        )
    caption = (
        f"{phrase}Levels are at the middle of their cells; a cell without a colour has no "
        f"value. {keys_told([across, up])}"
    )
    return Chart(
        "maps", f"Over the {across.words} and the {up.words}", in_rows(panels), caption, HEIGHT
    )
