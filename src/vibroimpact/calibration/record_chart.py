"""Chart of a measured record and its simulation with calibrated values, with the
difference below.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.overlay import Overlay
from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.decimation import visible_points
from vibroimpact.charts.marks import Line, Mark, Points
from vibroimpact.units.display import text

_FEW = 400
"""Samples up to which points are drawn; more would overlap."""

_MARGIN = 0.25
"""Time shown before first touch and after release of an enlarged contact, relative to its
duration.
"""

_COLUMNS = 25_000
"""Columns into which a very long record is divided; up to four samples of each are drawn."""

_MOST_VIEWS = 200


def record_chart(overlays: Sequence[Overlay]) -> Chart:
    """Return the chart of a record over its simulation, with the difference below.

    Parameters
    ----------
    overlays : sequence of Overlay
        Contacts of a force, or one record of a position.
    """
    if overlays[0].quantity == "position":
        return _position_chart(overlays[0])
    return _force_chart(overlays)


def _force_chart(overlays: Sequence[Overlay]) -> Chart:
    time = Axis(
        "Time",
        "s",
        views=tuple(_contact_view(number, overlay) for number, overlay in enumerate(overlays)),
    )
    upper: list[Mark] = []
    lower: list[Mark] = []
    for overlay in overlays:
        (measured_at, force), (at, simulated) = overlay.measured, overlay.simulated
        apart = force - np.interp(measured_at, at, simulated, left=0.0, right=0.0)
        upper += [
            _measured(overlay.touch + measured_at, force),
            Line(overlay.touch + at, simulated, "simulated", "detail"),
        ]
        lower.append(
            Line(overlay.touch + measured_at, apart, "measured less simulated", "difference")
        )
    panels = (
        (Panel(time, Axis("Contact force", "N"), tuple(upper)),),
        (Panel(time, Axis("Difference", "N"), tuple(lower)),),
    )
    caption = (
        "The record around each contact, and the simulation with the calibrated values: each "
        "impact at its own approach speed."
    )
    return Chart("record", "Measured and simulated contact force", panels, caption, height=2.3)


def _contact_view(number: int, overlay: Overlay) -> View:
    duration = float(overlay.simulated[0][-1])
    measured, simulated = (
        text(float(np.max(part[1])), "N", 3) for part in (overlay.measured, overlay.simulated)
    )
    headline = f"largest force: simulated {simulated}, measured {measured}"
    start = overlay.touch - _MARGIN * duration
    end = overlay.touch + (1.0 + _MARGIN) * duration
    return View(
        f"Impact {number + 1}",
        start,
        end,
        overlay.touch,
        f"Time since first touch of impact {number + 1}",
        headline,
    )


def _position_chart(overlay: Overlay) -> Chart:
    views = tuple(
        _flight_view(number, flight) for number, flight in enumerate(overlay.flights[:_MOST_VIEWS])
    )
    known = np.isfinite(overlay.simulated[1])
    apart = overlay.measured[1] - overlay.simulated[1]
    time = Axis("Time", "s", views=views)
    upper = (
        _measured(*_drawn(*overlay.measured)),
        Line(
            *_drawn(overlay.measured[0][known], overlay.simulated[1][known]), "simulated", "detail"
        ),
    )
    lower = (
        Line(
            *_drawn(overlay.measured[0][known], apart[known]),
            "measured less simulated",
            "difference",
        ),
    )
    panels = (
        (Panel(time, Axis("Height", "m"), upper),),
        (Panel(time, Axis("Difference", "m"), lower),),
    )
    caption = (
        "The height of the sphere's centre as measured, corrected by what the record itself "
        "determines, and simulated with the calibrated "
        "values, from the first impact on: each rebound begins when it does in the record."
    )
    return Chart("record", "Measured and simulated height", panels, caption, height=2.3)


def _flight_view(number: int, flight: tuple[float, float]) -> View:
    begin, end = flight
    more = 0.05 * (end - begin)
    since = f"Time since the start of rebound {number + 1}"
    return View(
        f"Rebound {number + 1}",
        begin - more,
        end + more,
        begin,
        since,
        f"lasts {text(end - begin, 's')}",
    )


def _measured(time: Floats, values: Floats) -> Mark:
    if len(time) <= _FEW:
        return Points(time, values, "measured", "measured samples")
    return Line(time, values, "measured", "measured record")


def _drawn(time: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return the samples that are drawn: all, or of a very long record those that show it."""
    kept = visible_points(
        len(time), lambda first, last: (time[first:last], values[first:last]), _COLUMNS
    )
    if kept is None:
        return time, values
    return time[kept], values[kept]
