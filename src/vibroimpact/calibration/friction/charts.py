"""Charts of calibrated friction: what was measured and what is computed, over the angle
of incidence.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.friction.calibrate import FrictionCalibration
from vibroimpact.calibration.friction.parameters import ImpactModel
from vibroimpact.calibration.observed.matchable import ALONG_PLATE
from vibroimpact.calibration.observed.noise import standard_deviations
from vibroimpact.cases.reader import case_of
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Line, Mark, Points
from vibroimpact.runs.slip_map import moduli_ratio, slip_map

_SMOOTH = 121
_ALIKE = 0.05
"""Relative spread of the speeds up to which they count as one."""


class Curve(NamedTuple):
    """Computed impacts over the angle of incidence [deg]: their model and their
    quantities, name and role.
    """

    angle: Floats
    model: ImpactModel
    outcomes: dict[str, Floats]
    name: str
    role: str


def friction_charts(calibration: FrictionCalibration) -> list[Chart]:
    """Return the charts of calibrated friction.

    Parameters
    ----------
    calibration : FrictionCalibration
        Result of the calibration.

    Returns
    -------
    list of Chart
        `angle`: tangential restitution, rebound angle, and what else was measured, over the angle
        of incidence; `slip_map`, where the moduli of the materials are known.
    """
    return made_charts(
        {
            "angle": lambda: _angle_chart(calibration, _curves(calibration)),
            "slip_map": lambda: _slip_chart(calibration, _curves(calibration)),
        }
    )


def _angle_chart(calibration: FrictionCalibration, curves: list[Curve]) -> Chart:
    impacts = calibration.impacts
    axis = Axis("Angle of incidence from the normal", "deg")
    panels = []
    for name, (_, unit, phrase) in ALONG_PLATE.items():
        if name not in impacts.measured and name not in ("tangential_restitution", "rebound_angle"):
            continue
        marks: list[Mark] = [
            Line(angle, outcomes[name], label, role) for angle, _, outcomes, label, role in curves
        ]
        if not curves:
            marks.append(
                Points(
                    impacts.angle,
                    calibration.outcomes[name],
                    "computed",
                    "other mark",
                    impacts.seen.labels,
                )
            )
        if name in impacts.measured:
            values = impacts.measured[name]
            low = None
            high = None
            if name in calibration.weights and impacts.seen.deviations_known:
                deviation = standard_deviations(impacts.seen.noise[name])
                low = values - deviation
                high = values + deviation
            marks.append(
                Points(
                    impacts.angle,
                    values,
                    "measured",
                    "measured",
                    impacts.seen.labels,
                    low=low,
                    high=high,
                )
            )
        panels.append(Panel(axis, Axis(f"{phrase[:1].upper()}{phrase[1:]}", unit), tuple(marks)))
    rows = tuple(tuple(panels[start : start + 2]) for start in range(0, len(panels), 2))
    caption = (
        f"Single impacts under friction by {calibration.parameters.law.name}, measured, and "
        "computed with the fitted parameters."
    )
    if any(
        mark.low is not None for panel in panels for mark in panel.marks if isinstance(mark, Points)
    ):
        caption += " Bars: one standard deviation to either side."
    return Chart(
        "angle", "Measured and computed over the angle of incidence", rows, caption, height=3.0
    )


def _slip_chart(calibration: FrictionCalibration, curves: list[Curve]) -> Chart | None:
    """Return the dimensionless map of the impacts; None where its scale is not known."""
    law = calibration.parameters.with_values(calibration.values)
    source = calibration.problem.source
    model = calibration.model
    impacts = calibration.impacts
    case = None if source is None else case_of(source)
    ratio = moduli_ratio(law, case)
    scale = float(law.coefficient) * ratio
    radius = float(calibration.problem.sphere.contact_offset)
    if not scale > 0.0:
        return None
    # of the change of the centre's velocity is that of the contact point
    whole = 1.0 + 1.0 / float(calibration.problem.inertia_ratio)

    def psi(
        impact_model: ImpactModel, outcomes: Mapping[str, Floats], more: Floats | float = 0.0
    ) -> tuple[Floats, Floats]:
        """Return dimensionless slips before and after impacts that leave so much more
        velocity along the plate than computed [m/s].
        """
        before = impact_model.velocity - radius * impact_model.spin
        after = outcomes["separation_velocity_x"] - radius * outcomes["spin_y_after"] + whole * more
        return before / (scale * impact_model.speeds), after / (scale * impact_model.speeds)

    marks: list[Mark] = [
        Line(*psi(impact_model, outcomes), phrase, role)
        for _, impact_model, outcomes, phrase, role in curves
        if role == "fit"
    ]
    before, computed = psi(model, calibration.outcomes)
    if not marks:
        marks.append(Points(before, computed, "computed", "other mark", impacts.seen.labels))
    more = _measured_velocity(calibration, radius) - calibration.outcomes["separation_velocity_x"]
    marks.append(
        Points(*psi(model, calibration.outcomes, more), "measured", "measured", impacts.seen.labels)
    )
    restitution = calibration.outcomes["separation_speed"] / impacts.seen.speeds
    caption = "Single impacts, measured, and computed with the fitted parameters."
    return slip_map(
        marks,
        before,
        restitution,
        np.full(len(before), ratio),
        calibration.problem.inertia_ratio,
        caption,
    )


def _measured_velocity(calibration: FrictionCalibration, radius: float) -> Floats:
    """Return the velocities along the plate after the impacts [m/s] by what was matched."""
    impacts = calibration.impacts
    matched = calibration.impacts.seen.wanted
    if "tangential_restitution" in matched:
        return np.asarray(matched["tangential_restitution"] * impacts.velocity)
    if "separation_velocity_x" in matched:
        return matched["separation_velocity_x"]
    if "rebound_angle" in matched:
        return np.asarray(
            calibration.outcomes["separation_speed"] * np.tan(np.radians(matched["rebound_angle"]))
        )
    turned = matched["spin_y_after"] - calibration.outcomes["spin_y_after"]
    return np.asarray(
        calibration.outcomes["separation_velocity_x"]
        - float(calibration.problem.inertia_ratio) * radius * turned
    )


def _curves(calibration: FrictionCalibration) -> list[Curve]:
    """Return the curves over the angle of incidence; none where speeds or spins of the
    impacts differ.
    """
    impacts = calibration.impacts
    along = impacts.seen.speeds
    across = np.abs(impacts.velocity)
    speeds = {"total": np.hypot(along, across), "normal": along}
    spreads = {name: float(np.ptp(speed) / speed.mean()) for name, speed in speeds.items()}
    steady = min(spreads, key=lambda name: spreads[name])
    if (
        spreads[steady] > _ALIKE
        or np.ptp(impacts.spin) > _ALIKE * np.abs(impacts.spin).max()
        or len(along) < 2
    ):
        return []
    margin = 0.02 * float(np.ptp(impacts.angle))
    least = max(impacts.angle.min() - margin, 1e-3)
    largest = min(impacts.angle.max() + margin, 89.0)
    angle = np.linspace(least, largest, _SMOOTH)
    speed = float(speeds[steady].mean())
    turned = np.radians(angle)
    normal = np.full(_SMOOTH, speed)
    if steady == "total":
        normal = speed * np.cos(turned)
    # the law of an impact of about this angle, as it may differ between impacts
    order = np.argsort(impacts.angle)
    following = np.searchsorted(impacts.angle[order], angle)
    nearest = order[np.minimum(following, len(order) - 1)]
    model = replace(
        calibration.model,
        law=calibration.model.law.take(nearest),
        speeds=normal,
        velocity=normal * np.tan(turned),
        spin=np.full(_SMOOTH, impacts.spin.mean()),
    )
    curves = [(calibration.values, "computed", "fit")]
    if calibration.as_given and not np.allclose(calibration.given, calibration.values, rtol=1e-3):
        curves.insert(0, (calibration.given, "as the case gives it", "muted"))
    drawn = []
    for values, phrase, role in curves:
        outcomes = {name: row[0] for name, row in model(values[None]).items()}
        drawn.append(Curve(angle, model, outcomes, phrase, role))
    return drawn
