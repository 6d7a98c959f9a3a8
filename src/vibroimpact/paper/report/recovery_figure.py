"""The figure of the restitution and the full-damping penetration: each piece of evidence as a line with a band, and the joint estimate."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from vibroimpact.paper.evidence import PENETRATIONS, RESTITUTIONS, Evidence
from vibroimpact.paper.printed import printed
from vibroimpact.paper.recovery import RecoveredParameters, implied_restitution, off_joint, penetration_bands, recover_parameters
from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.runs import Runs
from vibroimpact.report.layout import label_vertical, new_figure, row_of_axes
from vibroimpact.report.style import LOOPS, MARK

_ZOOM = (2.0e-4, 1.2e-7)
"""Half-widths of the enlarged window around the joint estimate: restitution [-], penetration [m]."""

_SEARCH_MARGIN = 20.0
"""Margin of the searched restitutions around the window, in half-widths of the band."""

_POINTS, _ROWS = 401, 121


class _Window(NamedTuple):
    """A window of the plane: ranges of the restitution [-] and of the penetration [m]."""

    restitutions: tuple[float, float]
    penetrations: tuple[float, float]


def draw_recovery(runs: Runs) -> Drawing:
    """Draw the restitution and the full-damping penetration that each printed number implies.

    Parameters
    ----------
    runs : Runs
        The simulations.
    """
    found = recover_parameters(runs)
    e, d = found.restitution.value, found.penetration.value
    given = printed("full_damping_penetration")
    close = _Window((e - _ZOOM[0], e + _ZOOM[0]), (d - _ZOOM[1], d + _ZOOM[1]))
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
    enlarged.plot(found.round_values[0], 1e6 * found.round_values[1], "x", color="black", markersize=6.0, zorder=5)
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
        "Each printed number is a line in the plane of the two, with a band as wide as rounding or its own scatter allows, where "
        f"it is not wider than the picture. {_caption(found)}",
    )


def _drawn_evidence(found: RecoveredParameters) -> list[Evidence]:
    """Return the evidence to draw: that without sampling bias."""
    return [one for one in found.evidence if not one.sampled]


def _caption(found: RecoveredParameters) -> str:
    """Return the sentences on the distances of the joint estimate and of the printed penetration from the bands."""
    off = [off_joint(found, one) for one in _drawn_evidence(found)]
    given = printed("full_damping_penetration").value
    met = penetration_bands(found, given)
    return (
        f"The joint estimate, e_h = {found.restitution.value:.4f} and d_max = {1e6 * found.penetration.value:.2f} µm, lies in "
        f"{sum(one <= 1.0 for one in off)} of the {len(off)} bands, and from no line farther than {max(off):.1f} times half the width of "
        f"its band; the printed {1e6 * given:g} µm lies in {sum(met) or 'none'} of the {len(met)} bands that depend on d_max alone."
    )


def _draw_lines(axes: Axes, found: RecoveredParameters, window: _Window) -> None:
    """Draw the lines of the evidence with their bands."""
    across, up = np.array(window.restitutions), np.geomspace(*window.penetrations, _ROWS)
    for (colour, dashes), one in zip(LOOPS, _drawn_evidence(found), strict=False):
        restitution_alone, penetration_alone = found.alone[one.name]
        style: dict[str, Any] = {"color": colour, "linestyle": dashes, "linewidth": 1.4}
        if restitution_alone is None and penetration_alone is not None:
            half = 1e6 * one.half_width * penetration_alone.deviation
            axes.axhspan(
                1e6 * penetration_alone.value - half, 1e6 * penetration_alone.value + half, color=colour, alpha=0.13, linewidth=0.0
            )
            axes.axhline(1e6 * penetration_alone.value, label=one.name, **style)
        elif restitution_alone is not None:
            half = one.half_width * restitution_alone.deviation
            searched = (across[0] - _SEARCH_MARGIN * half, across[1] + _SEARCH_MARGIN * half)
            restitutions = np.linspace(max(RESTITUTIONS[0], searched[0]), min(RESTITUTIONS[1], searched[1]), _POINTS)
            line = implied_restitution(one, restitutions, up)
            if half < 0.5 * (across[1] - across[0]):  # a wider band would only tint the background
                axes.fill_betweenx(1e6 * up, line - half, line + half, color=colour, alpha=0.13, linewidth=0.0)
            axes.plot(line, 1e6 * up, label=one.name, **style)
    axes.set_xlim(*across)
    axes.set_ylim(*(1e6 * end for end in window.penetrations))
