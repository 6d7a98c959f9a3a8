"""The chart of the unresolved runs: the first impact over the step length."""

from __future__ import annotations

import numpy as np

from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Band, Level, Line, Mark, Points, upwards
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
from vibroimpact.units.display import digits

_LIMIT = 0.7
"""Abscissa at which the resolved run is marked, as a fraction of the shortest step."""

_HEADROOM = 1.06
"""Top of a vertical axis, relative to the largest value."""

_AXES = {
    "max_force_N": ("Force", "N"),
    "separation_speed_m_s": ("Speed", "m/s"),
    "sphere_strain_J": ("Energy", "J"),
}
_TITLES = ("largest force", "rebound speed", "largest strain energy of the sphere")
_ROLES: dict[Mesh, tuple[str, str]] = {
    "coarse": ("series 0", "series 0 band"),
    "fine": ("series 5", "series 5 band"),
}
"""Roles of line and band of each mesh."""
_TICKS = (5e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4)


def unresolved_chart(runs: Runs) -> Chart:
    """Return the chart of the first impact of Types 2 and 3 by the implicit Euler method over the
    step length.

    Parameters
    ----------
    runs : Runs
        The simulations.
    """
    best = closest(superposed(runs, 2, "coarse"), paper_impact(runs, 2))
    step = float(best.steps[0])
    across = Axis(
        "Step",
        "s",
        log=True,
        range=(_LIMIT * float(STEPS[0]) / 1.08, 1.04 * float(STEPS[-1])),
        ticks=_TICKS,
    )
    rows = []
    for name, title in zip(COMPARED, _TITLES, strict=True):
        marks = {kind: _marks(runs, kind, name, step) for kind in (2, 3)}
        largest = max(
            float(np.max(values))
            for of_kind in marks.values()
            for mark in of_kind
            for values in upwards(mark)
        )
        up = Axis(*_AXES[name], range=(0.0, _HEADROOM * largest))
        panels = [
            Panel(across, up, of_kind, f"Type {kind}: {title}") for kind, of_kind in marks.items()
        ]
        rows.append(tuple(panels))
    misfit = float(best.misfit(paper_impact(runs, 2))[0])
    contact_time = resolved_impact(superposed(runs, 2, "coarse"))["duration_s"]
    caption = (
        "Up to steps of 0.19 ms the method takes the more energy the longer they are. On "
        "the coarse mesh the three numbers of Type 2 "
        f"come nearest to the printed ones in steps of {digits(1e6 * step, 2)} µs (off by "
        f"{digits(100.0 * misfit, 2)} %); the "
        "resolved contact lasts "
        f"{digits(1e6 * contact_time, 3)} µs. Bands: {len(PHASES)} places of the "
        "touch in a step."
    )
    return Chart(
        "unresolved",
        "What an unresolved run gives: the first impact over the length of the step",
        tuple(rows),
        caption,
        1.9,
    )


def _marks(runs: Runs, kind: int, name: str, step: float) -> tuple[Mark, ...]:
    """Return a quantity of Type 2 or 3 on both meshes, with the printed value and the
    resolved runs.
    """
    marks: list[Mark] = []
    for mesh in MESHES:
        problem = superposed(runs, kind, mesh)
        line_role, band_role = _ROLES[mesh]
        sweep = sweep_steps(problem)
        values = sweep.found[name]
        median = sweep.median(name)
        marks.append(Band(sweep.steps, values.min(axis=1), values.max(axis=1), role=band_role))
        marks.append(Line(sweep.steps, median, f"{mesh} mesh, median and range", line_role))
        marker = np.array([_LIMIT * STEPS[0]])
        resolved = np.array([resolved_impact(problem)[name]])
        marks.append(Points(marker, resolved, f"{mesh} mesh, resolved", line_role))
    marks.append(Level(paper_impact(runs, kind)[name], "printed", "published"))
    fitted = f"step fitted to Type 2, {digits(1e6 * step, 2)} µs"
    marks.append(Level(step, fitted, "dotted", upright=True))
    return tuple(marks)
