"""The figure of the restitution and the full-damping penetration: each piece of evidence a line, and where they cross."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from vibroimpact.report.layout import label_vertical, new_figure, row_of_axes
from vibroimpact.report.reproduction.drawing import Drawing
from vibroimpact.report.style import LOOPS, MARK, style
from vibroimpact.reproduction.printed import printed
from vibroimpact.reproduction.recovery import PENETRATIONS, RESTITUTIONS, Recovery, implied_restitution, recover
from vibroimpact.reproduction.runs import Runs

_AROUND = (2.0e-4, 1.2e-7)
"""What is enlarged, to either side of the joint estimate: restitution [-], penetration [m]."""

_BEYOND = 20.0
_POINTS, _ROWS = 401, 121


class _Window(NamedTuple):
    """A part of the plane: ranges of the restitution and of the penetration [m]."""

    restitutions: tuple[float, float]
    penetrations: tuple[float, float]


def draw_recovery(runs: Runs) -> Drawing:
    """Draw what each printed number implies of the restitution and the full-damping penetration.

    Parameters
    ----------
    runs : Runs
        The cases.
    """
    found = recover(runs)
    e, d = found.restitution.value, found.penetration.value
    given = printed("full_damping_penetration")
    close = _Window((e - _AROUND[0], e + _AROUND[0]), (d - _AROUND[1], d + _AROUND[1]))
    with style():
        figure = new_figure(4.95)
        whole, enlarged = row_of_axes(figure, 2, 1.4, 3.2)
        _draw_lines(whole, found, _Window(RESTITUTIONS, PENETRATIONS))
        _draw_lines(enlarged, found, close)
        whole.set_yscale("log")
        whole.yaxis.set_major_formatter("{x:g}")
        whole.axhline(1e6 * given.value, color="#6b6b6b", linestyle=(0, (1, 2)), label=f"$d_{{max}}$ as printed, {1e6 * given.value:g} µm")
        whole.plot(e, 1e6 * d, "o", markersize=9.0, markerfacecolor="none", markeredgecolor=MARK, label="joint estimate")
        enlarged.errorbar(
            e, 1e6 * d, xerr=found.restitution.deviation, yerr=1e6 * found.penetration.deviation, color=MARK, elinewidth=1.4, zorder=4
        )
        enlarged.plot(round(e, 2), 1e6 * 10.0 ** round(math.log10(d), 2), "x", color="black", markersize=6.0, zorder=5)
        whole.set_title("All that was searched")
        enlarged.set_title("Where they cross, enlarged (cross: round values)")
        for axes in (whole, enlarged):
            axes.set_xlabel("Restitution asked for, $e_h$")
        enlarged.xaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
        label_vertical(whole, "Full-damping penetration $d_{max}$ [µm]")
        figure.legend(*whole.get_legend_handles_labels(), loc="lower center", ncols=2, handlelength=3.5)
    return Drawing(
        figure,
        "What the printed numbers imply: restitution and full-damping penetration",
        f"Each printed number is a line in the plane of the two, with a band as wide as rounding or its own scatter allows, where "
        "it is not wider than the picture. All cross, within their bands, at "
        f"e_h = {e:.4f} and d_max = {1e6 * d:.2f} µm; the printed {1e6 * given.value:g} µm is met by none of those that fix d_max.",
    )


def _draw_lines(axes: Axes, found: Recovery, window: _Window) -> None:
    """Draw the evidence that does not come from Table 2."""
    shown = [one for one in found.evidence if not one.name.startswith("Table 2")]
    across, up = np.array(window.restitutions), np.geomspace(*window.penetrations, _ROWS)
    for (colour, dashes), one in zip(LOOPS, shown, strict=False):
        by, through = found.alone[one.name]
        width = math.sqrt(3.0) if one.kind == "rounding" else 1.0
        style_of: dict[str, Any] = {"color": colour, "linestyle": dashes, "linewidth": 1.4}
        if by is None and through is not None:
            half = 1e6 * width * through.deviation
            axes.axhspan(1e6 * through.value - half, 1e6 * through.value + half, color=colour, alpha=0.13, linewidth=0.0)
            axes.axhline(1e6 * through.value, label=one.name, **style_of)
        elif by is not None:
            half = width * by.deviation
            reach = (across[0] - _BEYOND * half, across[1] + _BEYOND * half)
            restitutions = np.linspace(max(RESTITUTIONS[0], reach[0]), min(RESTITUTIONS[1], reach[1]), _POINTS)
            line = implied_restitution(one, restitutions, up)
            if half < 0.5 * (across[1] - across[0]):  # else it would only dye the ground
                axes.fill_betweenx(1e6 * up, line - half, line + half, color=colour, alpha=0.13, linewidth=0.0)
            axes.plot(line, 1e6 * up, label=one.name, **style_of)
    axes.set_xlim(*across)
    axes.set_ylim(*(1e6 * end for end in window.penetrations))
