"""Restitution prescribed to the contact laws of a study and achieved by the drops: summary, sentence and figure."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibroimpact.arrays import Floats
from vibroimpact.report.layout import label_vertical, new_figure, row_of_axes, wide_axes
from vibroimpact.report.style import LOOPS, MARKS
from vibroimpact.studies.report.outputs import independent_values, sampled_output
from vibroimpact.studies.report.panels import add_legend
from vibroimpact.studies.report.ticks import is_spread_by_factors, plain_log_ticks
from vibroimpact.studies.study import Study
from vibroimpact.units.display import fixed

_MOST = 1200  # maximum number of drops drawn
_FEW, _SOME = 100, 300  # drops up to which marks are large, and are drawn as vectors
_AS_ASKED: dict[str, Any] = {"color": "#888888", "linewidth": 0.9, "linestyle": (0, (4, 2)), "zorder": 1.5, "label": "as asked"}


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
    return RestitutionSummary(asked, achieved, float(np.median(found, overwrite_input=True)) if len(found) else math.nan)


def _extremes(values: Floats) -> tuple[float, float] | None:
    """Return minimum and maximum of the finite values."""
    low, high = float(np.fmin.reduce(values)), float(np.fmax.reduce(values))
    return (low, high) if math.isfinite(low) else None


def restitution_sentence(found: RestitutionSummary) -> str:
    """Return a sentence on prescribed and achieved restitution; "" if there is no achieved value."""
    if found.achieved is None:
        return ""
    achieved = f"the first impacts achieved {_ends(found.achieved)}"
    if found.asked is None:
        return f"No restitution is asked of the law; {achieved}."
    median = fixed(found.difference, 4) if found.difference <= 0.0 else f"+{fixed(found.difference, 4)}"
    return f"Restitution asked: {_ends(found.asked)}; {achieved}. The median of what was achieved less what was asked is {median}."


def draw_restitution(study: Study) -> Figure | None:
    """Draw achieved over prescribed restitution, and their difference over the approach speed; None if none is prescribed.

    If all prescribed values are equal, the achieved restitution is drawn over the approach speed instead.
    """
    found = _asked_achieved_speed(study)
    if found is None:
        return None
    asked, achieved, speed = found
    least, most = float(np.nanmin(asked)), float(np.nanmax(asked))
    figure = new_figure(4.3)
    if most > least:
        left, right = row_of_axes(figure, 2, 0.9, 3.0)
        _plot_impacts(left, asked, achieved)
        ends = [min(least, float(np.nanmin(achieved))), max(most, float(np.nanmax(achieved)))]
        left.plot(ends, ends, **_AS_ASKED)
        left.set_title("Achieved over asked")
        left.set_xlabel("Restitution asked")
        _plot_impacts(right, speed, achieved - asked)
        right.axhline(0.0, **_AS_ASKED)
        right.set_title("Achieved less asked")
    else:
        left = right = wide_axes(figure, 0.9, 3.0)
        _plot_impacts(right, speed, achieved)
        right.axhline(most, **_AS_ASKED)
        right.set_title("Achieved over the approach speed")
    label_vertical(left, "Restitution achieved")
    right.set_xlabel("Approach speed [m/s]")
    if is_spread_by_factors(np.unique(speed[np.isfinite(speed)])):
        right.set_xscale("log")
        plain_log_ticks(right.xaxis)
    add_legend(figure, left, 1.0 if len(asked) < _FEW else 2.5)
    return figure


def _asked_achieved_speed(study: Study) -> tuple[Floats, Floats, Floats] | None:
    """Return prescribed and achieved restitution and approach speed, (drops, impacts) each: of all impacts if kept, else of the first."""
    names = ("restitution_asked", "restitution_achieved", "approach_speed_m_s")
    if not all(name in study.shapes for name in names):
        names = ("first_restitution_asked", "first_restitution_achieved", "first_approach_speed_m_s")
    if names[0] not in study.shapes:
        return None
    asked, achieved, speed = (np.atleast_2d(sampled_output(study, name, _MOST).T).T for name in names)
    return (asked, achieved, speed) if (np.isfinite(asked) & np.isfinite(achieved)).any() else None


def _plot_impacts(axes: Axes, across: Floats, up: Floats) -> None:
    """Draw the first impacts of each drop, with one mark style per impact."""
    for impact, (mark, (colour, _), x, y) in enumerate(zip(MARKS, LOOPS, across.T, up.T, strict=False)):
        axes.plot(
            x,
            y,
            color=colour,
            marker=mark,
            linestyle="",
            markersize=3.0 if len(x) < _FEW else 1.8,
            markeredgewidth=0.0,
            label=f"impact {impact + 1}",
            rasterized=len(x) > _SOME,
        )


def _ends(ends: tuple[float, float]) -> str:
    low, high = fixed(ends[0], 4), fixed(ends[1], 4)
    return low if low == high else f"{low} to {high}"
