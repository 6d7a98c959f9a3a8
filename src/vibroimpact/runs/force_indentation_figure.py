"""Figure of contact force over indentation: one hysteresis loop per contact."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibroimpact.arrays import Floats, Indices
from vibroimpact.report.layout import label_vertical, new_figure, wide_axes
from vibroimpact.report.style import ENLARGED, LOOPS, MARK
from vibroimpact.results.result import Result
from vibroimpact.runs.figure_data import contact_history, contacts_with_duration
from vibroimpact.units.display import Multiple, multiple, text

_MOST_OTHERS = 60
"""Largest number of unlabelled loops; more would only fill the corner near the origin."""


def draw_loops(result: Result) -> Figure:
    """Draw contact force over indentation, with the first contacts labelled by impact and approach speed."""
    figure, found = new_figure(5.0), contacts_with_duration(result)
    axes = wide_axes(figure, 0.5, 4.2)
    depth, force = multiple("m", result.impacts["max_indentation_m"]), multiple("N", result.impacts["max_force_N"])
    labelled = found if len(found) <= len(LOOPS) else found[:ENLARGED]
    for impact, (colour, dashes) in zip(labelled, LOOPS, strict=False):
        label = f"impact {impact + 1}, {text(result.impacts['approach_speed_m_s'][impact], 'm/s')}"
        axes.plot(*_loop(result, impact, depth, force), color=colour, linestyle=dashes, linewidth=1.5, label=label)
    _draw_others(axes, result, found[len(labelled) :], depth, force)
    _mark_largest_forces(axes, result, labelled, depth, force)
    axes.set_title("Contact force over indentation")
    axes.set_xlabel(f"Indentation [{depth.unit}]")
    label_vertical(axes, f"Contact force [{force.unit}]")
    axes.margins(x=0.03, y=0.05)
    axes.legend(loc="upper left", title="Impact, approach speed", alignment="left", handlelength=4.5)
    return figure


def _loop(result: Result, impact: int, depth: Multiple, force: Multiple) -> tuple[Floats, Floats]:
    part = contact_history(result, impact)
    return part["indentation_m"] / depth.size, part["force_N"] / force.size


def _draw_others(axes: Axes, result: Result, others: Indices, depth: Multiple, force: Multiple) -> None:
    """Draw the unlabelled loops as one thin grey line with gaps."""
    if not len(others):
        return
    drawn = others[np.unique(np.linspace(0, len(others) - 1, _MOST_OTHERS).round().astype(int))]
    loops = [np.column_stack(_loop(result, impact, depth, force)) for impact in drawn]
    gap = np.full((1, 2), np.nan)
    x, y = np.concatenate([part for loop in loops for part in (loop, gap)]).T
    which = f"impacts {others[0] + 1} to {others[-1] + 1}" + (f" ({len(drawn)} of them)" if len(drawn) < len(others) else "")
    axes.plot(x, y, color="#9a9a9a", linewidth=0.6, zorder=1.5, label=which)


def _mark_largest_forces(axes: Axes, result: Result, shown: Indices, depth: Multiple, force: Multiple) -> None:
    when = result.impacts["time_of_max_force_s"][shown]
    x = _indentation_at(result, shown, when) / depth.size
    y = result.impacts["max_force_N"][shown] / force.size
    axes.plot(x, y, "o", markersize=4.5, markerfacecolor="white", markeredgecolor=MARK, zorder=3, label="largest force")


def _indentation_at(result: Result, shown: Indices, when: Floats) -> Floats:
    """Return the indentation of each contact at a given time during it [m], interpolated linearly."""
    parts = [contact_history(result, impact) for impact in shown]
    return np.array([np.interp(time, part["time_s"], part["indentation_m"]) for time, part in zip(when, parts, strict=True)])
