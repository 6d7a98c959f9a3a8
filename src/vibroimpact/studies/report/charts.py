"""The charts of a study, chosen by its design and number of axes."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

import numpy as np

from vibroimpact.charts.chart import Chart
from vibroimpact.charts.made import made_charts
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.axes import StudyAxis, study_axes
from vibroimpact.studies.report.curves import MOST_LINES, impact_curves, level_curves
from vibroimpact.studies.report.drops import drawn_groups
from vibroimpact.studies.report.histograms import FEWEST, inputs_chart, outputs_chart
from vibroimpact.studies.report.maps import maps_chart
from vibroimpact.studies.report.outputs import (
    Output,
    drawn_outputs,
    independent_drops,
)
from vibroimpact.studies.report.over_axes import MOST_AXES, over_axes_chart
from vibroimpact.studies.report.restitution import restitution_chart
from vibroimpact.studies.report.sensitivity_chart import sensitivity_chart
from vibroimpact.studies.report.sensitivity_table import Sensitivity
from vibroimpact.studies.report.signals import signal_makers
from vibroimpact.studies.report.slip_chart import slip_chart

_Maker = Callable[[], Chart | None]

_MOST_RESULTS = 6  # of a chart of the sensitivity


def study_charts(
    study: Study, outputs: list[Output], sensitivity: Sensitivity | None
) -> list[Chart]:
    """Return the charts of a study in the order of its report.

    Parameters
    ----------
    study : Study
        The completed study.
    outputs : list of Output
        Its results.
    sensitivity : Sensitivity, optional
        The sensitivity to the keys of those that describe the response, if there is one.

    Returns
    -------
    list of Chart
        `curves` or `maps` of a grid; `inputs` and `outputs` of drawn points; of many keys one by
        the name of each result; `restitution`, `slip_map` of oblique impacts that were kept,
        `sensitivity`, and one per sensor whose signals were kept. Left out is what has nothing to
        show.
    """
    drawn = drawn_outputs(outputs)
    makers: dict[str, _Maker] = {}
    if drawn and study.is_grid:
        makers |= _of_grid(study, drawn, sensitivity)
    elif drawn:
        makers |= _of_samples(study, drawn)
    makers["restitution"] = partial(restitution_chart, study)
    makers["slip_map"] = partial(slip_chart, study)
    if sensitivity is not None:
        makers["sensitivity"] = partial(
            sensitivity_chart, study, sensitivity, drawn[:_MOST_RESULTS]
        )
    return made_charts(makers | signal_makers(study))


def _of_grid(
    study: Study, drawn: list[Output], sensitivity: Sensitivity | None
) -> dict[str, _Maker]:
    axes = [axis for axis in study_axes(study) if len(axis.values) > 1]
    if not axes:
        return {}
    if len(axes) == 1:
        return {"curves": partial(impact_curves, study, axes[0], drawn)}
    first, second = _two_axes(axes, drawn, sensitivity)
    # lines for names rather than numbers, and for the fewer levels
    each = min(
        (first, second),
        key=lambda axis: (len(axis.values) > MOST_LINES, axis.numeric, len(axis.values)),
    )
    makers: dict[str, _Maker] = {}
    if len(each.values) <= MOST_LINES:
        across = second if each is first else first
        makers["curves"] = partial(level_curves, study, axes, drawn, across, each)
    else:
        makers["maps"] = partial(maps_chart, study, axes, drawn, first, second)
    if len(axes) > 2:
        makers |= _over_axes(study, axes, drawn)
    return makers


def _of_samples(study: Study, drawn: list[Output]) -> dict[str, _Maker]:
    axes = [axis for axis in study_axes(study) if axis.varies]
    makers: dict[str, _Maker] = {}
    if not axes:
        return makers
    if independent_drops(study) >= FEWEST and study.design != "zip":
        makers["inputs"] = partial(inputs_chart, study, axes[:MOST_AXES])
        makers["outputs"] = partial(outputs_chart, study, drawn)
    return makers | _over_axes(study, axes, drawn)


def _over_axes(study: Study, axes: list[StudyAxis], drawn: list[Output]) -> dict[str, _Maker]:
    groups = cache(partial(drawn_groups, study, axes, drawn))

    def chart_of(output: Output) -> Chart:
        return over_axes_chart(study, axes, output, groups())

    return {output.name: partial(chart_of, output) for output in drawn}


def _two_axes(
    axes: list[StudyAxis], drawn: list[Output], sensitivity: Sensitivity | None
) -> tuple[StudyAxis, StudyAxis]:
    """Return the two axes of the largest effect on the first result if known, else the
    first two.
    """
    strength = None
    if sensitivity is not None:
        strength = sensitivity.strength.get(drawn[0].name)
    if len(axes) == 2 or strength is None:
        return axes[0], axes[1]
    strongest = np.argsort(np.nan_to_num(strength), kind="stable")[-2:]
    first, second = sorted(strongest.tolist())
    return axes[first], axes[second]
