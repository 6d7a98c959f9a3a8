"""Charts of a grid as curves: the results over one axis, a line for each of the first
impacts, or for each level of a second axis.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Line, Mark, Points
from vibroimpact.charts.palette import series
from vibroimpact.quoting import shortened, visible
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.planning.drop_variables import PEAK_TABLE
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.drops import MOST_DROPS, drop_texts, results_of
from vibroimpact.studies.report.labels import keys_told, level_words
from vibroimpact.studies.report.outputs import Output, drop_numbers, on_grid, on_two_axes
from vibroimpact.studies.report.panels import HEIGHT, in_rows
from vibroimpact.studies.report.scales import ascending_order, key_axis, places, result_axis

MOST_LINES = 6
"""Maximum number of levels drawn as lines; an axis of more levels is one of a map."""

_MOST_IMPACTS = 5
_MOST_MARKED = 40
_MOST = 3000


def impact_curves(study: Study, axis: StudyAxis, outputs: list[Output]) -> Chart:
    """Return the chart of results over the only axis, with one line per impact for the first
    impacts if impacts were kept.

    Parameters
    ----------
    study : Study
        A study on a grid.
    axis : StudyAxis
        Its axis of several levels.
    outputs : list of Output
        The results to draw.
    """
    order = ascending_order(axis, _MOST)
    across = key_axis(axis)
    number = min(_impacts_kept(study), _MOST_IMPACTS)
    table = {}
    for output in outputs:
        variable = _column(study, output) or output.name
        values = on_grid(study, variable)[order]
        table[output.name] = values.reshape(len(order), -1)
    texts = [
        _texts_of_impact(study, outputs, table, order, impact, number)
        for impact in range(max(number, 1))
    ]
    panels = []
    for output in outputs:
        marks = []
        # a column per impact, or one of peaks
        for impact, values in enumerate(table[output.name].T[: len(texts)]):
            name = f"impact {impact + 1}" if number > 1 else ""
            marks.append(_curve(axis, order, values, impact, name, texts[impact]))
        title = shortened(visible(_title(study, output)), 60)
        panels.append(Panel(across, result_axis(output, ""), tuple(marks), title))
    return Chart(
        "curves", f"Over the {axis.words}", in_rows(panels), _impact_words(study, axis), HEIGHT
    )


def level_curves(
    study: Study, axes: list[StudyAxis], outputs: list[Output], over: StudyAxis, each: StudyAxis
) -> Chart:
    """Return the chart of results over one axis of a grid, with a line for each level of another.

    Parameters
    ----------
    study : Study
        A study on a grid.
    axes : list of StudyAxis
        Its axes of several levels.
    outputs : list of Output
        The results to draw; of more than two axes their median over the others.
    over, each : StudyAxis
        The axis along which they are drawn, and that of the lines.
    """
    order = ascending_order(over, _MOST)
    levels = ascending_order(each)
    across = key_axis(over)
    names = [level_words(each, level) for level in levels]
    if each.numeric:
        names = [f"{each.words} {name}" for name in names]
    texts: list[tuple[str, ...]] = [()] * len(levels)
    if len(axes) == 2 and study.size <= MOST_DROPS:
        drop_descriptions = np.array(
            drop_texts(study, results_of(study, outputs), drop_numbers(study)), dtype=object
        )
        if axes[0] is over:
            drop_descriptions = drop_descriptions.reshape([len(axis.values) for axis in axes])
        else:
            drop_descriptions = drop_descriptions.reshape([len(axis.values) for axis in axes]).T
        texts = [tuple(drop_descriptions[order, level]) for level in levels]
    panels = []
    for output in outputs:
        values = on_two_axes(study, output.name, axes.index(over), axes.index(each))
        curves = zip(levels, names, texts, strict=True)
        marks = [
            _curve(over, order, values[order, level], line, name, phrase)
            for line, (level, name, phrase) in enumerate(curves)
        ]
        panels.append(
            Panel(
                across, result_axis(output, ""), tuple(marks), shortened(visible(output.title), 60)
            )
        )
    if len(axes) == 2:
        phrase = ""
    else:
        phrase = (
            " Two of the keys, those with the largest effect on the first result where it is "
            "known; lines are medians over the others."
        )
    caption = f"A line for each {each.words}.{phrase} {keys_told([over, each])}"
    return Chart(
        "curves", f"Over the {over.words}, for each {each.words}", in_rows(panels), caption, HEIGHT
    )


def _curve(
    axis: StudyAxis, order: Indices, values: Floats, line: int, name: str, texts: tuple[str, ...]
) -> Mark:
    """Return a line over the levels of an axis, or points over names, between which there
    is nothing.
    """
    across = places(axis, axis.values[order])
    if not axis.numeric:
        return Points(across, values, name, series(line), texts)
    return Line(across, values, name, series(line), marked=len(across) <= _MOST_MARKED, texts=texts)


def _texts_of_impact(
    study: Study,
    outputs: list[Output],
    table: dict[str, NDArray[Any]],
    order: Indices,
    impact: int,
    number: int,
) -> tuple[str, ...]:
    """Return what each drop is, with the results of one of its impacts."""
    if len(order) > MOST_DROPS:
        return ()
    results = {}
    for output in outputs:
        values = table[output.name]
        column = min(impact, values.shape[1] - 1)
        results[_title(study, output)] = (output.unit, values[:, column])
    numbers = drop_numbers(study)[order]  # of a grid of one axis with several levels
    impacts = None
    if number > 1:
        impacts = np.full(len(numbers), impact + 1)
    return drop_texts(study, results, numbers, impacts)


def _impact_words(study: Study, axis: StudyAxis) -> str:
    """Return the caption of the curves of impacts."""
    kept = _impacts_kept(study)
    phrase = f"Results over the {axis.words}"
    if not kept:
        return (
            f"{phrase}; single impacts were not kept; these are the peaks of each drop. "
            f"{keys_told([axis])}"
        )
    of_many = ""
    if kept > _MOST_IMPACTS:
        of_many = f" (the first {_MOST_IMPACTS} of {kept})"
    if kept > 1:
        return f"{phrase}, a line an impact{of_many}. {keys_told([axis])}"
    return f"{phrase}. {keys_told([axis])}"


def _column(study: Study, output: Output) -> str:
    """Return the column of the impact table from which a result is taken; "" if there is
    none or it was not kept.
    """
    if output.name not in PEAK_TABLE:
        return ""
    column = PEAK_TABLE[output.name].column
    return column if column in study.shapes else ""


def _title(study: Study, output: Output) -> str:
    """Return the title of a result: the short one where it is told of single impacts."""
    return output.short if _column(study, output) else output.title


def _impacts_kept(study: Study) -> int:
    """Return the number of impacts kept per drop; 0 if none."""
    return max(
        (
            study.shapes[peak.column][-1]
            for peak in PEAK_TABLE.values()
            if peak.column in study.shapes
        ),
        default=0,
    )
