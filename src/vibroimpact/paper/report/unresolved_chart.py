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
        top = max(
            float(np.max(part))
            for some in marks.values()
            for mark in some
            for part in upwards(mark)
        )
        up = Axis(*_AXES[name], range=(0.0, _HEADROOM * top))
        rows.append(
            tuple(Panel(across, up, some, f"Type {kind}: {title}") for kind, some in marks.items())
        )
    whole = {kind: resolved_impact(superposed(runs, kind, "coarse")) for kind in (2, 3)}
    caption = (
        "Up to steps of 0.19 ms the method takes the more energy the longer they are. On "
        "the coarse mesh the three numbers of Type 2 "
        f"come nearest to the printed ones in steps of {digits(1e6 * step, 2)} µs (off by "
        f"{digits(100.0 * float(best.misfit(paper_impact(runs, 2))[0]), 2)} %); the "
        "resolved contact lasts "
        f"{digits(1e6 * whole[2]['duration_s'], 3)} µs. Bands: {len(PHASES)} places of the "
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
        problem, (role, band) = superposed(runs, kind, mesh), _ROLES[mesh]
        swept = sweep_steps(problem)
        values = swept.found[name]
        marks.append(Band(swept.steps, values.min(axis=1), values.max(axis=1), role=band))
        marks.append(Line(swept.steps, swept.median(name), f"{mesh} mesh, median and range", role))
        limit = np.array([resolved_impact(problem)[name]])
        marks.append(Points(np.array([_LIMIT * STEPS[0]]), limit, f"{mesh} mesh, resolved", role))
    marks.append(Level(paper_impact(runs, kind)[name], "printed", "matched"))
    marks.append(
        Level(step, f"step fitted to Type 2, {digits(1e6 * step, 2)} µs", "dotted", upright=True)
    )
    return tuple(marks)
