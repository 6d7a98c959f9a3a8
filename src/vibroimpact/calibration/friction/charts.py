"""Charts of calibrated friction: what was measured and what is computed, over the angle of incidence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.friction.calibrate import FrictionCalibration
from vibroimpact.calibration.matchable import ALONG_PLATE
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Line, Mark, Points

_SMOOTH = 121
_ALIKE = 0.05
"""Relative spread of the speeds up to which they count as one."""


def friction_charts(found: FrictionCalibration) -> list[Chart]:
    """Return the charts of calibrated friction.

    Parameters
    ----------
    found : FrictionCalibration
        Result of the calibration.

    Returns
    -------
    list of Chart
        `angle`: tangential restitution, rebound angle, and what else was measured, over the angle of incidence.
    """
    return [_angle_chart(found)]


def _angle_chart(found: FrictionCalibration) -> Chart:
    impacts, axis = found.impacts, Axis("Angle of incidence from the normal", "deg")
    curves = _curves(found)
    panels = []
    for name, (_, unit, phrase) in ALONG_PLATE.items():
        if name not in impacts.measured and name not in ("tangential_restitution", "rebound_angle"):
            continue
        marks: list[Mark] = [Line(angle, outcomes[name], words, role) for angle, outcomes, words, role in curves]
        if not curves:
            marks.append(Points(impacts.angle, found.outcomes[name], "computed", "other mark", impacts.seen.labels))
        if name in impacts.measured:
            values, low, high = impacts.measured[name], None, None
            if name in found.weights and impacts.seen.deviations_known:
                deviation = np.linalg.norm(impacts.seen.noise[name], axis=1)
                low, high = values - deviation, values + deviation
            marks.append(Points(impacts.angle, values, "measured", "matched", impacts.seen.labels, low=low, high=high))
        panels.append(Panel(axis, Axis(f"{phrase[:1].upper()}{phrase[1:]}", unit), tuple(marks)))
    rows = tuple(tuple(panels[start : start + 2]) for start in range(0, len(panels), 2))
    caption = f"Single impacts under friction by {found.parameters.law.name}, measured and computed with what was found."
    if any(mark.low is not None for panel in panels for mark in panel.marks if isinstance(mark, Points)):
        caption += " Bars: one standard deviation to either side."
    return Chart("angle", "Measured and computed over the angle of incidence", rows, caption, height=3.0)


def _curves(found: FrictionCalibration) -> list[tuple[Floats, dict[str, Floats], str, str]]:
    """Return angles [deg], quantities over them, name and role of the curves; none where speeds or spins of the impacts differ."""
    impacts = found.impacts
    along, across = impacts.seen.speeds, np.abs(impacts.velocity)
    speeds = {"total": np.hypot(along, across), "normal": along}
    spreads = {name: float(np.ptp(speed) / speed.mean()) for name, speed in speeds.items()}
    steady = min(spreads, key=lambda name: spreads[name])
    if spreads[steady] > _ALIKE or np.ptp(impacts.spin) > _ALIKE * np.abs(impacts.spin).max() or len(along) < 2:
        return []
    margin = 0.02 * float(np.ptp(impacts.angle))
    angle = np.linspace(max(impacts.angle.min() - margin, 1e-3), min(impacts.angle.max() + margin, 89.0), _SMOOTH)
    speed, turned = float(speeds[steady].mean()), np.radians(angle)
    normal = speed * np.cos(turned) if steady == "total" else np.full(_SMOOTH, speed)
    order = np.argsort(impacts.angle)
    nearest = order[np.clip(np.searchsorted(impacts.angle[order], angle), 0, len(order) - 1)]
    model = replace(
        found.model,
        law=found.model.law.take(nearest),
        speeds=normal,
        velocity=normal * np.tan(turned),
        spin=np.full(_SMOOTH, impacts.spin.mean()),
    )
    curves = [(found.values, "computed", "fit")]
    if found.as_given and not np.allclose(found.given, found.values, rtol=1e-3):
        curves.insert(0, (found.given, "as the case gives it", "muted"))
    return [(angle, {name: row[0] for name, row in model(values[None]).items()}, words, role) for values, words, role in curves]
