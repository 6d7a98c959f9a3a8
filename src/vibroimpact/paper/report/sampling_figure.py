"""The figure of the scatter of Table 2: ranges of the errors of sampled peaks, and the sampling of one contact."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes

from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.runs import DAMPINGS, IMPACTS, Runs
from vibroimpact.paper.sampling import (
    CONTACTS,
    QUANTITIES,
    contact_pulses,
    error_range,
    grid_error,
    grid_samples,
    implied_instants,
    output_step,
    spacing_bound,
    table2_error,
)
from vibroimpact.report.layout import heading, label_vertical, new_figure, row_of_axes, wide_axes
from vibroimpact.report.style import ACCENT, CONTACT, INK, MARK

_OFFSET = 0.19
"""Horizontal offset of the two dampings from the impact number."""

_HEIGHT = 6.57
_WIDTHS = (0.30, 0.16)
_BARS = {"constant": "#8fb8de", "variable": "#e3b08f"}
_CURVES = {"compression": (ACCENT, "-"), "force": (MARK, (0, (6, 2)))}


def draw_sampling(runs: Runs) -> Drawing:
    """Draw the errors of Table 2 with the ranges of the errors of sampled peaks.

    Parameters
    ----------
    runs : Runs
        The simulations.
    """
    step, spacing = output_step(), spacing_bound(runs)
    figure = new_figure(_HEIGHT)
    for axes, quantity in zip(row_of_axes(figure, 2, 3.72, 2.25), QUANTITIES, strict=True):
        _draw_errors(axes, runs, quantity, step, spacing)
        if quantity == "compression":
            label_vertical(axes, "Below the theory's by [%]")
            handles = axes.get_legend_handles_labels()
    figure.legend(*handles, loc="center", bbox_to_anchor=(0.5, 3.04 / _HEIGHT), ncols=3, handlelength=1.8)
    heading(figure, "The errors of Table 2", 6.25)
    # the contact drawn below has sampling instants for both errors, and the largest error on the printed grid
    candidates = [
        contact for contact in CONTACTS if not np.isnan([implied_instants(runs, quantity, *contact) for quantity in QUANTITIES]).any()
    ]
    damping, impact = max(candidates, key=lambda contact: grid_error(runs, step, "force", *contact))
    _draw_contact(wide_axes(figure, 0.52, 1.95), runs, damping, impact, step)
    return Drawing(
        figure,
        "Table 2: what can be read off samples",
        f"The printed errors (dots) scatter about the exact ones (bars across) within what samples {1e6 * spacing:.0f} µs apart can "
        f"give; samples {1e3 * step:.2f} ms apart can give almost anything. Below, one contact: the times at which compression and "
        "force have the printed values, and the one sample that the printed output step puts there.",
    )


def _draw_errors(axes: Axes, runs: Runs, quantity: str, step: float, spacing: float) -> None:
    """Draw the ten errors of a quantity: exact, printed, and the ranges of both spacings."""
    ends = []
    for damping, side in zip(DAMPINGS, (-_OFFSET, _OFFSET), strict=True):
        for impact in IMPACTS:
            first, at = impact == 1, impact + side
            low, high = error_range(runs, spacing, quantity, damping, impact)
            ends += [low, high]
            least, most = error_range(runs, step, quantity, damping, impact)
            exact = error_range(runs, 0.0, quantity, damping, impact)[0]
            value = table2_error(quantity, damping, impact).value
            label = f"samples {1e3 * step:.2f} ms apart, beyond the picture" if first and side < 0 else None
            axes.bar(at, most - least, _WIDTHS[0], bottom=least, color="#efefef", linewidth=0.0, zorder=1, label=label)
            label = f"samples {1e6 * spacing:.0f} µs apart, {damping} damping" if first else None
            axes.bar(at, high - low, _WIDTHS[1], bottom=low, color=_BARS[damping], linewidth=0.0, zorder=2, label=label)
            half = 0.5 * _WIDTHS[0]
            axes.plot([at - half, at + half], [exact, exact], color=INK, linewidth=1.2, label="exact" if first and side < 0 else None)
            axes.plot(
                at,
                value,
                "o",
                color=MARK,
                markersize=4.2,
                markeredgecolor="white",
                markeredgewidth=0.5,
                zorder=4,
                label="printed" if first and side < 0 else None,
            )
    axes.set_ylim(math.floor(min(ends)) - 1.0, math.ceil(max(ends)) + 1.0)
    axes.set_xticks(IMPACTS)
    axes.grid(visible=False, axis="x")
    axes.set_xlabel("Impact")
    axes.set_title(f"Largest {quantity}")


def _draw_contact(axes: Axes, runs: Runs, damping: str, impact: int, step: float) -> None:
    """Draw compression and force of one contact relative to the theory's peaks, with the instants at which they were sampled."""
    for quantity, (colour, dashes) in _CURVES.items():
        simulation, theory = (contact_pulses(runs)[name, quantity, impact] for name in (damping, "theory"))
        scale = 100.0 / theory.value
        axes.plot(1e6 * simulation.times, scale * simulation.values, color=colour, linestyle=dashes, label=f"{quantity} of the simulation")
        value = 100.0 - table2_error(quantity, damping, impact).value
        moments = [1e6 * time for time in implied_instants(runs, quantity, damping, impact)]
        axes.plot(
            moments,
            [value, value],
            "o",
            markersize=6.0,
            markerfacecolor="white",
            markeredgecolor=colour,
            zorder=4,
            label=f"printed {quantity}",
        )
        times, values = grid_samples(runs, damping, step, quantity, impact)
        axes.plot(1e6 * times, scale * values, "X", color=colour, markersize=7.0, markeredgecolor="white", zorder=4)
    axes.plot([], [], "X", color="#6b6b6b", label=f"output every {1e3 * step:.2f} ms")
    end = 1e6 * float(simulation.times[-1])
    axes.axvspan(0.0, end, color=CONTACT, alpha=0.5, linewidth=0.0, zorder=0)
    axes.set_xlim(-0.03 * end, 1.03 * end)
    axes.set_ylim(0.0, 108.0)
    axes.set_title(f"Impact {impact}, {damping} damping, in parts of the theory's peaks [%] (grey: in contact)")
    axes.set_xlabel("Time since first touch [µs]")
    label_vertical(axes, "Of the theory's peak [%]")
    axes.legend(loc="lower center", ncols=1, fontsize=7.5)
