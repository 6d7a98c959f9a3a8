"""Restitution prescribed to the contact laws of a study and achieved by the drops:
summary, sentence and chart.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Level, Line, Mark, Points
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.drops import Group, drop_texts, grouped
from vibroimpact.studies.report.outputs import (
    drop_numbers,
    independent_values,
    sampled_output,
    sampled_places,
)
from vibroimpact.studies.report.panels import in_rows
from vibroimpact.studies.report.scales import is_spread_by_factors
from vibroimpact.units.display import fixed

_MOST = 3000  # maximum number of impacts drawn
_MOST_IMPACTS = 5  # of each drop


class RestitutionSummary(NamedTuple):
    """Restitution at the first impacts of all drops, prescribed ("asked") and achieved.

    Attributes
    ----------
    asked, achieved : (float, float) or None
        Minimum and maximum; None if there are no values.
    difference : float
        Median of the achieved minus the prescribed value; NaN without either.
    """

    asked: tuple[float, float] | None
    achieved: tuple[float, float] | None
    difference: float


def summarize_restitution(study: Study) -> RestitutionSummary:
    """Return the summary of prescribed and achieved restitution at the first impacts."""
    if "first_restitution_achieved" not in study.shapes:
        return RestitutionSummary(None, None, math.nan)
    achieved = independent_values(study, "first_restitution_achieved")
    achieved_range = _extremes(achieved)
    if "first_restitution_asked" not in study.shapes:
        return RestitutionSummary(None, achieved_range, math.nan)
    asked = independent_values(study, "first_restitution_asked")
    asked_range = _extremes(asked)
    # in place: there may be millions of values
    differences = np.subtract(achieved, asked, out=achieved)
    del asked
    differences = differences[np.isfinite(differences)]
    median = math.nan
    if len(differences):
        median = float(np.median(differences, overwrite_input=True))
    return RestitutionSummary(asked_range, achieved_range, median)


def _extremes(values: Floats) -> tuple[float, float] | None:
    """Return minimum and maximum of the finite values."""
    low = float(np.fmin.reduce(values))
    high = float(np.fmax.reduce(values))
    return (low, high) if math.isfinite(low) else None


def restitution_sentence(summary: RestitutionSummary) -> str:
    """Return a sentence on prescribed and achieved restitution; "" if there is no
    achieved value.
    """
    if summary.achieved is None:
        return ""
    achieved = f"the first impacts achieved {_ends(summary.achieved)}"
    if summary.asked is None:
        return f"No restitution is asked of the law; {achieved}."
    sign = "" if summary.difference <= 0.0 else "+"
    return (
        f"Restitution asked: {_ends(summary.asked)}; {achieved}. The median difference, achieved "
        f"less asked, is {sign}{fixed(summary.difference, 4)}."
    )


class _Impacts(NamedTuple):
    """Impacts that are drawn: number of the drop and of the impact, restitution
    prescribed and achieved, and approach speed.
    """

    drop: Indices
    impact: Indices
    asked: Floats
    achieved: Floats
    speed: Floats


def restitution_chart(study: Study) -> Chart | None:
    """Return the chart of achieved over prescribed restitution, and of their difference over the
    approach speed.

    If all prescribed values are equal, the achieved restitution is drawn over the approach speed
    instead; None if none is prescribed.
    """
    impacts = _impacts(study)
    if not len(impacts.drop):
        return None
    marks = "Each mark is the first impact of a drop"
    if impacts.impact.max() > 1:
        marks = f"Each mark is an impact, of the first {_MOST_IMPACTS} of a drop at most"
    caption = (
        f"{marks}; dashed: the restitution asked of the law. The restitution achieved may "
        "depend on the speed of the impact."
    )
    panels = _panels(impacts, _groups(study, impacts))
    return Chart("restitution", "Restitution asked and achieved", in_rows(panels), caption, 3.0)


def _groups(study: Study, impacts: _Impacts) -> list[Group]:
    """Return the impacts in groups of a colour each, with their labels."""
    quantities = {
        "Restitution asked": ("1", impacts.asked),
        "Restitution achieved": ("1", impacts.achieved),
        "Approach speed": ("m/s", impacts.speed),
    }
    axes = [axis for axis in study_axes(study) if axis.varies]
    drops = impacts.drop
    if impacts.impact.max() == 1:
        return grouped(study, axes, drops, drop_texts(study, quantities, drops), {})
    texts = drop_texts(study, quantities, drops, impacts.impact)
    names = [f"impact {number}" for number in impacts.impact.tolist()]
    others = {"Impact": np.array(names, dtype=object)}
    return grouped(study, axes, drops, texts, others)


def _panels(impacts: _Impacts, groups: list[Group]) -> list[Panel]:
    """Return the panels; a single one over the speed if all impacts are asked the same."""
    achieved = Axis("Restitution achieved")
    speed = Axis("Approach speed", "m/s", log=is_spread_by_factors(np.unique(impacts.speed)))
    least = float(impacts.asked.min())
    largest = float(impacts.asked.max())
    if least == largest:
        over_speed: tuple[Mark, ...] = (
            Level(largest, "as asked", "reference"),
            *_points(groups, impacts.speed, impacts.achieved),
        )
        return [Panel(speed, achieved, over_speed)]
    lowest = min(least, float(impacts.achieved.min()))
    highest = max(largest, float(impacts.achieved.max()))
    ends = np.array([lowest, highest])
    over_asked: tuple[Mark, ...] = (
        Line(ends, ends, "as asked", "reference"),
        *_points(groups, impacts.asked, impacts.achieved),
    )
    differences: tuple[Mark, ...] = (
        Level(0.0, "as asked", "reference"),
        *_points(groups, impacts.speed, impacts.achieved - impacts.asked),
    )
    return [
        Panel(Axis("Restitution asked"), achieved, over_asked, "Achieved over asked"),
        Panel(speed, Axis("Difference of restitution"), differences, "Achieved less asked"),
    ]


def _points(groups: list[Group], across: Floats, up: Floats) -> list[Points]:
    return [
        Points(
            across[group.chosen],
            up[group.chosen],
            group.name,
            group.role,
            group.texts,
            group.keys,
        )
        for group in groups
    ]


def _impacts(study: Study) -> _Impacts:
    """Return the first impacts of some drops that have both values; the first one of each
    if no others were kept.
    """
    names = ("restitution_asked", "restitution_achieved", "approach_speed_m_s")
    each = 1
    if all(name in study.shapes and study.shapes[name][-1] for name in names):
        each = min(study.shapes[names[0]][-1], _MOST_IMPACTS)
    else:
        names = (
            "first_restitution_asked",
            "first_restitution_achieved",
            "first_approach_speed_m_s",
        )
    if names[0] not in study.shapes:
        return _Impacts(np.empty(0, np.intp), np.empty(0, np.intp), *np.empty((3, 0)))
    drops = drop_numbers(study, *sampled_places(study, _MOST // each))
    columns = []
    for name in names:
        values = sampled_output(study, name, _MOST // each)
        columns.append(values.reshape(len(drops), -1)[:, :each].ravel())
    with_both = np.isfinite(columns[0]) & np.isfinite(columns[1])
    drop = np.repeat(drops, each)
    impact = np.tile(np.arange(1, each + 1), len(drops))
    return _Impacts(
        drop[with_both],
        impact[with_both],
        *(column[with_both] for column in columns),
    )


def _ends(ends: tuple[float, float]) -> str:
    low = fixed(ends[0], 4)
    high = fixed(ends[1], 4)
    return low if low == high else f"{low} to {high}"
