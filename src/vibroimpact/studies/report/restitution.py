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
from vibroimpact.studies.study import Study
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
    found = independent_values(study, "first_restitution_achieved")
    achieved = _extremes(found)
    if "first_restitution_asked" not in study.shapes:
        return RestitutionSummary(None, achieved, math.nan)
    wanted = independent_values(study, "first_restitution_asked")
    asked = _extremes(wanted)
    found -= wanted
    del wanted  # free memory: there may be millions of values
    found = found[np.isfinite(found)]
    return RestitutionSummary(
        asked, achieved, float(np.median(found, overwrite_input=True)) if len(found) else math.nan
    )


def _extremes(values: Floats) -> tuple[float, float] | None:
    """Return minimum and maximum of the finite values."""
    low, high = float(np.fmin.reduce(values)), float(np.fmax.reduce(values))
    return (low, high) if math.isfinite(low) else None


def restitution_sentence(found: RestitutionSummary) -> str:
    """Return a sentence on prescribed and achieved restitution; "" if there is no
    achieved value.
    """
    if found.achieved is None:
        return ""
    achieved = f"the first impacts achieved {_ends(found.achieved)}"
    if found.asked is None:
        return f"No restitution is asked of the law; {achieved}."
    median = (
        fixed(found.difference, 4) if found.difference <= 0.0 else f"+{fixed(found.difference, 4)}"
    )
    return (
        f"Restitution asked: {_ends(found.asked)}; {achieved}. The median difference, achieved "
        f"less asked, is {median}."
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
    found = _impacts(study)
    if not len(found.drop):
        return None
    several = bool(found.impact.max() > 1)
    told = {
        "Restitution asked": ("1", found.asked),
        "Restitution achieved": ("1", found.achieved),
        "Approach speed": ("m/s", found.speed),
    }
    texts = drop_texts(study, told, found.drop, found.impact if several else None)
    others = (
        {"Impact": np.array([f"impact {one}" for one in found.impact.tolist()], dtype=object)}
        if several
        else {}
    )
    groups = grouped(
        study, [axis for axis in study_axes(study) if axis.varies], found.drop, texts, others
    )
    achieved = Axis("Restitution achieved")
    fast = Axis("Approach speed", "m/s", log=is_spread_by_factors(np.unique(found.speed)))
    least, most = float(found.asked.min()), float(found.asked.max())
    if most > least:
        ends = np.array(
            [min(least, float(found.achieved.min())), max(most, float(found.achieved.max()))]
        )
        over: tuple[Mark, ...] = (
            Line(ends, ends, "as asked", "reference"),
            *_points(groups, found.asked, found.achieved),
        )
        less: tuple[Mark, ...] = (
            Level(0.0, "as asked", "reference"),
            *_points(groups, found.speed, found.achieved - found.asked),
        )
        panels = [
            Panel(Axis("Restitution asked"), achieved, over, "Achieved over asked"),
            Panel(fast, Axis("Difference of restitution"), less, "Achieved less asked"),
        ]
    else:
        panels = [
            Panel(
                fast,
                achieved,
                (
                    Level(most, "as asked", "reference"),
                    *_points(groups, found.speed, found.achieved),
                ),
            )
        ]
    words = (
        f"Each mark is an impact, of the first {_MOST_IMPACTS} of a drop at most"
        if several
        else "Each mark is the first impact of a drop"
    )
    caption = (
        f"{words}; dashed: the restitution asked of the law. The restitution achieved may "
        "depend on the speed of the impact."
    )
    return Chart("restitution", "Restitution asked and achieved", in_rows(panels), caption, 3.0)


def _points(groups: list[Group], across: Floats, up: Floats) -> list[Points]:
    return [
        Points(across[one.chosen], up[one.chosen], one.name, one.role, one.texts, one.keys)
        for one in groups
    ]


def _impacts(study: Study) -> _Impacts:
    """Return the first impacts of some drops that have both values; the first one of each
    if no others were kept.
    """
    names, each = ("restitution_asked", "restitution_achieved", "approach_speed_m_s"), 1
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
    columns = [
        sampled_output(study, name, _MOST // each).reshape(len(drops), -1)[:, :each].ravel()
        for name in names
    ]
    there = np.isfinite(columns[0]) & np.isfinite(columns[1])
    asked, achieved, speed = (column[there] for column in columns)
    return _Impacts(
        np.repeat(drops, each)[there],
        np.tile(np.arange(1, each + 1), len(drops))[there],
        asked,
        achieved,
        speed,
    )


def _ends(ends: tuple[float, float]) -> str:
    low, high = fixed(ends[0], 4), fixed(ends[1], 4)
    return low if low == high else f"{low} to {high}"
