"""The chart of the scatter of Table 2: ranges of the errors of sampled peaks, and the
sampling of one contact.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Bars, Line, Mark, Points, Spans
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

_OFFSET = 0.19
"""Horizontal offset of the two dampings from the impact number."""

_WIDTHS = (0.30, 0.16)
_BARS = {"constant": "series 7", "variable": "contact elastic"}
_CURVES = {"compression": "series 0", "force": "series 2"}


def sampling_chart(runs: Runs) -> Chart:
    """Return the chart of the errors of Table 2 with the ranges of the errors of sampled peaks.

    Parameters
    ----------
    runs : Runs
        The simulations.
    """
    step = output_step()
    spacing = spacing_bound(runs)
    # the contact drawn below has sampling instants for both errors, and the largest error on the
    # printed grid
    candidates = [
        contact
        for contact in CONTACTS
        if not np.isnan(
            [implied_instants(runs, quantity, *contact) for quantity in QUANTITIES]
        ).any()
    ]
    damping, impact = max(candidates, key=lambda contact: grid_error(runs, step, "force", *contact))
    rows = (
        tuple(_errors(runs, quantity, step, spacing) for quantity in QUANTITIES),
        (_contact(runs, damping, impact, step),),
    )
    caption = (
        "The printed errors (dots) scatter about the exact ones (bars across) within what "
        f"samples {1e6 * spacing:.0f} µs apart can "
        f"give; samples {1e3 * step:.2f} ms apart can give almost anything. Below, one "
        "contact: the times at which compression and "
        "force have the printed values, and the one sample that the printed output step puts there."
    )
    return Chart("sampling", "Table 2: what can be read off samples", rows, caption, 2.4)


def _errors(runs: Runs, quantity: str, step: float, spacing: float) -> Panel:
    """Return the ten errors of a quantity: exact, printed, and the ranges of both spacings."""
    ranges = {}
    for damping in DAMPINGS:
        for size in (0.0, spacing, step):
            of_impacts = [error_range(runs, size, quantity, damping, impact) for impact in IMPACTS]
            ranges[damping, size] = np.array(of_impacts)
    ends = np.concatenate([ranges[damping, spacing] for damping in DAMPINGS])
    low = math.floor(ends.min()) - 1.0
    high = math.ceil(ends.max()) + 1.0
    positions = {
        damping: np.array(IMPACTS) + offset
        for damping, offset in zip(DAMPINGS, (-_OFFSET, _OFFSET), strict=True)
    }
    marks: list[Mark] = []
    for damping, x in positions.items():
        clipped = np.clip(ranges[damping, step], low - 1.0, high + 1.0)
        name = f"samples {1e3 * step:.2f} ms apart, beyond the picture"
        marks.append(_bars(x, clipped, name, "body", _WIDTHS[0]))
    for damping, x in positions.items():
        name = f"samples {1e6 * spacing:.0f} µs apart, {damping} damping"
        marks.append(_bars(x, ranges[damping, spacing], name, _BARS[damping], _WIDTHS[1]))
    for damping, x in positions.items():
        marks.append(_exact_line(x, ranges[damping, 0.0][:, 0]))
        texts = tuple(f"impact {impact}, {damping} damping" for impact in IMPACTS)
        values = np.array([table2_error(quantity, damping, impact).value for impact in IMPACTS])
        marks.append(Points(x, values, "printed", "published", texts))
    ticks = tuple(float(impact) for impact in IMPACTS)
    across = Axis("Impact", range=(0.5, len(IMPACTS) + 0.5), ticks=ticks)
    up = Axis("Below the theory's by", "%", range=(low, high))
    return Panel(across, up, tuple(marks), f"Largest {quantity}")


def _exact_line(x: Floats, values: Floats) -> Line:
    """Return short strokes at values, as one line with gaps."""
    half_width = 0.5 * _WIDTHS[0]
    gap = np.full(len(x), np.nan)
    across = np.column_stack([x - half_width, x + half_width, gap])
    up = np.column_stack([values, values, gap])
    return Line(across.ravel(), up.ravel(), "exact")


def _bars(x: Floats, ranges: Floats, name: str, role: str, width: float) -> Bars:
    heights = ranges[:, 1] - ranges[:, 0]
    return Bars(x, heights, name, role, width, base=np.ascontiguousarray(ranges[:, 0]))


def _contact(runs: Runs, damping: str, impact: int, step: float) -> Panel:
    """Return compression and force of one contact relative to the theory's peaks, with
    the instants at which they were sampled.
    """
    marks: list[Mark] = []
    pulses = contact_pulses(runs)
    for quantity, role in _CURVES.items():
        simulation = pulses[damping, quantity, impact]
        # per cent of the theory's peak
        scale = 100.0 / pulses["theory", quantity, impact].value
        name = f"{quantity} of the simulation"
        marks.append(Line(simulation.times, scale * simulation.values, name, role))
        value = 100.0 - table2_error(quantity, damping, impact).value
        instants = np.array(implied_instants(runs, quantity, damping, impact))
        marks.append(Points(instants, np.full(len(instants), value), f"printed {quantity}", role))
        times, values = grid_samples(runs, damping, step, quantity, impact)
        marks.append(Points(times, scale * values, f"output every {1e3 * step:.2f} ms", "muted"))
    duration = float(simulation.times[-1])
    marks.insert(0, Spans(np.array([0.0]), np.array([duration]), "in contact"))
    across = Axis("Time since first touch", "s", range=(-0.03 * duration, 1.03 * duration))
    up = Axis("Of the theory's peak", "%", range=(0.0, 108.0))
    title = f"Impact {impact}, {damping} damping, in parts of the theory's peaks"
    return Panel(across, up, tuple(marks), title)
