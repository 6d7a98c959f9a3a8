"""The figure of the unresolved runs: the first impact over the step length."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator, NullFormatter, NullLocator

from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.runs import Runs
from vibroimpact.paper.step_sweep import (
    COMPARED,
    MESHES,
    PHASES,
    STEPS,
    Mesh,
    closest,
    paper_impact,
    resolved_impact,
    superposed,
    sweep_steps,
)
from vibroimpact.report.layout import label_vertical, new_figure, row_of_axes
from vibroimpact.report.style import ACCENT, INK, MARK
from vibroimpact.units.display import digits

_ROW, _BOTTOM = 1.75, 1.0
"""Height of a row, and margin below all rows [in]."""

_LIMIT = 0.7
"""Abscissa at which the resolved run is marked, as a fraction of the shortest step."""

_LABELS = {"max_force_N": ("Force", "kN", 1e-3), "separation_speed_m_s": ("Speed", "m/s", 1.0), "sphere_strain_J": ("Energy", "J", 1.0)}
_TITLES = ("largest force", "rebound speed", "largest strain energy of the sphere")
_LINES: dict[Mesh, tuple[str, str | tuple[int, tuple[int, ...]]]] = {"coarse": (ACCENT, "-"), "fine": ("#7a7a7a", (0, (6, 2)))}


def draw_unresolved(runs: Runs) -> Drawing:
    """Draw the first impact of Types 2 and 3 by the implicit Euler method over the step length.

    Parameters
    ----------
    runs : Runs
        The simulations.
    """
    best = closest(superposed(runs, 2, "coarse"), paper_impact(runs, 2))
    step = float(best.steps[0])
    figure = new_figure(_BOTTOM + len(COMPARED) * _ROW)
    for number, (name, title) in enumerate(zip(COMPARED, _TITLES, strict=True)):
        last = number == len(COMPARED) - 1
        row = row_of_axes(figure, 2, _BOTTOM + (len(COMPARED) - 1 - number) * _ROW, _ROW - 0.45)
        for kind, axes in zip((2, 3), row, strict=True):
            _draw_quantity(axes, runs, kind, name, step)
            axes.set_title(f"Type {kind}: {title}")
            axes.tick_params(labelbottom=last)
            if last:
                axes.set_xlabel("Step [µs]")
        top = max(axes.get_ylim()[1] for axes in row)
        for axes in row:
            axes.set_ylim(0.0, top)
        label_vertical(row[0], "{} [{}]".format(*_LABELS[name]))
    figure.legend(*row[0].get_legend_handles_labels(), loc="lower center", ncols=3, handlelength=3.0)
    whole = {kind: resolved_impact(superposed(runs, kind, "coarse")) for kind in (2, 3)}
    sentence = (
        "The longer the step, the more energy the method takes. On the coarse mesh the three numbers of Type 2 come nearest to the printed "
        f"ones in steps of {digits(1e6 * step, 2)} µs (off by {digits(100.0 * float(best.misfit(paper_impact(runs, 2))[0]), 2)} %); the "
        f"resolved contact lasts {digits(1e6 * whole[2]['duration_s'], 3)} µs. Bands: {len(PHASES)} places of the touch in a step."
    )
    return Drawing(figure, "What an unresolved run gives: the first impact over the length of the step", sentence)


def _draw_quantity(axes: Axes, runs: Runs, kind: int, name: str, step: float) -> None:
    """Draw a quantity of Type 2 or 3 on both meshes, with the printed value and the resolved runs."""
    size = _LABELS[name][2]
    for mesh in MESHES:
        problem, (colour, dashes) = superposed(runs, kind, mesh), _LINES[mesh]
        swept = sweep_steps(problem)
        values = size * swept.found[name]
        axes.fill_between(1e6 * swept.steps, values.min(axis=1), values.max(axis=1), color=colour, alpha=0.2, linewidth=0.0)
        axes.plot(1e6 * swept.steps, np.median(values, axis=1), color=colour, linestyle=dashes, label=f"{mesh} mesh, median and range")
        limit = size * resolved_impact(problem)[name]
        axes.plot(1e6 * _LIMIT * STEPS[0], limit, "<", color=colour, markersize=5.0, clip_on=False, label=f"{mesh} mesh, resolved")
    axes.axhline(size * paper_impact(runs, kind)[name], color=MARK, linewidth=1.0, label="printed")
    axes.axvline(1e6 * step, color=INK, linewidth=0.8, linestyle=(0, (2, 2)), label=f"step fitted to Type 2, {digits(1e6 * step, 2)} µs")
    axes.set_xscale("log")
    axes.set_xlim(1e6 * _LIMIT * STEPS[0], 1e6 * STEPS[-1])
    axes.set_xticks([5, 10, 20, 50, 100, 200], labels=["5", "10", "20", "50", "100", "200"])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_major_locator(MaxNLocator(4, min_n_ticks=3, steps=[1, 2, 2.5, 5, 10]))
