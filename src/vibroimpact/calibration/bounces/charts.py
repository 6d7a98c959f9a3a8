"""Charts of bounces: the record with the touches in it, and restitution over the approach speed."""

from __future__ import annotations

from functools import partial

import numpy as np

from vibroimpact.calibration.bounces.rebounds import Rebounds
from vibroimpact.calibration.bounces.speed_laws import Fitted
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.decimation import decimated
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Band, Line, Mark, Points
from vibroimpact.charts.palette import series

_COLUMNS = 25_000
"""Columns into which a long record is divided; up to four samples of each are drawn."""

_SMOOTH = 200


def bounce_charts(rebounds: Rebounds) -> list[Chart]:
    """Return the charts `record` and `restitution`.

    Parameters
    ----------
    rebounds : Rebounds
        The impacts.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> microphone = vi.signals.Record("microphone", np.zeros(48000), 48e3, "Pa")
    >>> time = np.array([0.0, 0.4, 0.72, 0.976])
    >>> heard = vi.signals.Bounces(microphone, time, np.full(4, 1e-5), np.ones(4), np.zeros(0), ())
    >>> [chart.name for chart in bounce_charts(vi.calibration.rebounds_of(heard))]
    ['record', 'restitution']
    """
    of_impacts = partial(
        restitution_chart, rebounds, each="Each impact whose restitution is known", noun="impact"
    )
    return made_charts({"record": partial(_record_chart, rebounds), "restitution": of_impacts})


def _record_chart(rebounds: Rebounds) -> Chart:
    bounces = rebounds.bounces
    record = rebounds.bounces.record
    names = tuple(f"impact {number + 1}" for number in range(len(bounces.time)))
    marks: list[Mark] = [
        Line(*decimated(record.time, record.value, _COLUMNS), record.name, "measured record"),
        Points(bounces.time, bounces.peak, "bounces of the ball", "measured", names),
    ]
    if len(bounces.others):
        level = np.full(len(bounces.others), float(np.abs(bounces.peak).max()))
        marks.append(Points(bounces.others, level, "other sounds", "muted", bounces.reasons))
    label = f"{record.name[:1].upper()}{record.name[1:]}"
    unit = "" if record.unit == "1" else record.unit
    panel = Panel(Axis("Time", "s"), Axis(label, unit), tuple(marks))
    others = ""
    if len(bounces.others):
        others = ", and other sounds marked by crosses"
    caption = f"The record, with the bounces of the ball marked at their largest magnitude{others}."
    return Chart("record", "Bounces in the record", ((panel,),), caption, height=2.6)


def restitution_chart(
    fitted: Fitted, each: str = "Each row of the table", noun: str = "row"
) -> Chart:
    """Return the chart of restitutions over the approach speed with their fits; `each`
    and `noun`: what a point is.
    """
    known = np.isfinite(fitted.restitution) & np.isfinite(fitted.approach_speed)
    speed, (low, high) = fitted.approach_speed[known], fitted.intervals[known].T
    names = tuple(f"{noun} {number + 1}" for number in np.flatnonzero(known))
    smooth = np.linspace(speed.min(), speed.max(), _SMOOTH)
    marks: list[Mark] = []
    ends = fitted.laws[-1].band(smooth, fitted.confidence)
    if np.isfinite(ends).all():
        marks.append(
            Band(
                smooth,
                *ends,
                f"{100.0 * fitted.confidence:g} % band of the {fitted.laws[-1].name} law",
                "band",
            )
        )
    marks += [
        Line(smooth, law(smooth), law.name, series(number))
        for number, law in enumerate(fitted.laws)
    ]
    whole = np.isfinite([low, high]).all()
    bars = {"low": low, "high": high} if whole else {}
    marks.append(Points(speed, fitted.restitution[known], f"{noun}s", "measured", names, **bars))
    panel = Panel(Axis("Approach speed", "m/s"), Axis("Restitution"), tuple(marks))
    interval = ""
    if whole:
        interval = f", with its {100.0 * fitted.confidence:g} % interval"
    fits = "fits" if len(fitted.laws) > 1 else "fit"
    caption = f"{each}{interval}, and the {fits}."
    return Chart(
        "restitution", "Restitution over the approach speed", ((panel,),), caption, height=3.2
    )
