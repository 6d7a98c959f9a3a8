"""Restitution asked of the contact laws of a study, and what the drops achieved: in words, and as a figure."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from vibroimpact.quantity import fixed
from vibroimpact.report.excerpt import Floats
from vibroimpact.report.layout import label_vertical, new_figure, row_of_axes, wide_axes
from vibroimpact.report.study.axes import is_spread_by_factors, plain_log_ticks
from vibroimpact.report.study.outputs import independent, some
from vibroimpact.report.study.panels import add_legend
from vibroimpact.report.style import ENLARGED, LOOPS
from vibroimpact.storage.study import Study

_MOST = 1200  # drops that are drawn
_FEW = 100  # drops up to which marks are large
_MARKS = ("o", "s", "^", "D", "v")


class Restitution(NamedTuple):
    """Restitution at the first impacts of all drops.

    Attributes
    ----------
    asked, achieved : (float, float) or None
        The least and the largest; None where there is none.
    difference : float
        The median of what was achieved less what was asked; NaN without either.
    """

    asked: tuple[float, float] | None
    achieved: tuple[float, float] | None
    difference: float


def restitution_of(study: Study) -> Restitution:
    """Return how restitution asked and achieved compare at the first impacts."""
    if "first_restitution_achieved" not in study.shapes:
        return Restitution(None, None, math.nan)
    found = independent(study, "first_restitution_achieved")
    achieved = _reach(found)
    if "first_restitution_asked" not in study.shapes:
        return Restitution(None, achieved, math.nan)
    wanted = independent(study, "first_restitution_asked")
    asked = _reach(wanted)
    found -= wanted
    del wanted  # there may be millions
    found = found[np.isfinite(found)]
    return Restitution(asked, achieved, float(np.median(found, overwrite_input=True)) if len(found) else math.nan)


def _reach(values: Floats) -> tuple[float, float] | None:
    """Return the least and the largest of the finite values."""
    low, high = float(np.fmin.reduce(values)), float(np.fmax.reduce(values))
    return (low, high) if math.isfinite(low) else None


def restitution_sentence(found: Restitution) -> str:
    """Return in words what was asked and what was achieved; "" if nothing was achieved."""
    if found.achieved is None:
        return ""
    achieved = f"the first impacts achieved {_ends(found.achieved)}"
    if found.asked is None:
        return f"No restitution is asked of the law; {achieved}."
    median = fixed(found.difference, 4) if found.difference <= 0.0 else f"+{fixed(found.difference, 4)}"
    return f"Restitution asked: {_ends(found.asked)}; {achieved}. The median of what was achieved less what was asked is {median}."


def draw_restitution(study: Study) -> Figure | None:
    """Draw restitution achieved over that asked, and the difference over the approach speed; None where none is asked."""
    by_impact = all(name in study.shapes for name in ("restitution_asked", "restitution_achieved", "approach_speed_m_s"))
    before = "" if by_impact else "first_"
    if f"{before}restitution_asked" not in study.shapes:
        return None
    names = (f"{before}restitution_asked", f"{before}restitution_achieved", f"{before}approach_speed_m_s")
    asked, achieved, speed = (some(study, name, _MOST).reshape(-1, study.shapes[name][-1] if by_impact else 1) for name in names)
    if not (np.isfinite(asked) & np.isfinite(achieved)).any():
        return None
    figure, one_asked = new_figure(4.3), not np.ptp(asked[np.isfinite(asked)]) > 0.0
    left, right = [wide_axes(figure, 0.9, 3.0)] * 2 if one_asked else row_of_axes(figure, 2, 0.9, 3.0)
    for impact in range(min(asked.shape[1], ENLARGED)):
        look: dict[str, Any] = {
            "color": LOOPS[impact][0],
            "marker": _MARKS[impact],
            "linestyle": "",
            "markersize": 3.0 if len(asked) < _FEW else 1.8,
            "markeredgewidth": 0.0,
            "label": f"impact {impact + 1}",
            "rasterized": len(asked) > 300,
        }
        if not one_asked:
            left.plot(asked[:, impact], achieved[:, impact], **look)
        right.plot(speed[:, impact], achieved[:, impact] - (0.0 if one_asked else asked[:, impact]), **look)
    wanted: dict[str, Any] = {"color": "#888888", "linewidth": 0.9, "linestyle": (0, (4, 2)), "zorder": 1.5, "label": "as asked"}
    label_vertical(left, "Restitution achieved")
    right.set_xlabel("Approach speed [m/s]")
    if one_asked:
        right.axhline(float(np.nanmax(asked)), **wanted)
        right.set_title("Achieved over the approach speed")
    else:
        ends = np.array([min(np.nanmin(asked), np.nanmin(achieved)), max(np.nanmax(asked), np.nanmax(achieved))])
        left.plot(ends, ends, **wanted)
        right.axhline(0.0, **wanted)
        left.set_title("Achieved over asked")
        left.set_xlabel("Restitution asked")
        right.set_title("Achieved less asked")
    if is_spread_by_factors(np.unique(speed[np.isfinite(speed)])):
        right.set_xscale("log")
        plain_log_ticks(right.xaxis)
    add_legend(figure, left, 1.0 if len(asked) < _FEW else 2.5)
    return figure


def _ends(ends: tuple[float, float]) -> str:
    low, high = fixed(ends[0], 4), fixed(ends[1], 4)
    return low if low == high else f"{low} to {high}"
