"""Charts of a calibration: the value over the approach speed, the measured record, and
the remaining differences.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.contact_law.differences import COMPARED, WAYS, differences
from vibroimpact.calibration.friction.calibrate import FrictionCalibration
from vibroimpact.calibration.friction.charts import friction_charts
from vibroimpact.calibration.record_chart import record_chart
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Band, Level, Line, Mark, Points
from vibroimpact.charts.palette import series

_SMOOTH = 200
_FEW = 12
"""Impacts up to which each has its number on the axis."""


def calibration_charts(calibration: Calibration | FrictionCalibration) -> list[Chart]:
    """Return the charts of a calibration.

    Parameters
    ----------
    calibration : Calibration or FrictionCalibration
        Result of the calibration.

    Returns
    -------
    list of Chart
        `parameter`; `record` if a record was measured; `differences` if there are several impacts
        and a reference. Of friction those of `friction_charts`.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> found = vi.calibration.calibrate_case(vi.calibration.load_calibration("paper:type1-theory"))
    >>> [chart.name for chart in calibration_charts(found)]
    ['parameter', 'differences']
    """
    if isinstance(calibration, FrictionCalibration):
        return friction_charts(calibration)
    makers = {"parameter": partial(_parameter_chart, calibration)}
    if calibration.overlays:
        makers["record"] = partial(record_chart, calibration.overlays)
    if differences(calibration) and len(calibration.drops["variable"]["impact"]) > 1:
        makers["differences"] = partial(_differences_chart, calibration)
    return made_charts(makers)


def parameter_words(calibration: Calibration) -> str:
    """Return in words what was found, such as "largest damping C"."""
    law = calibration.problem.laws[0]
    if calibration.parameter in law.__dataclass_fields__:
        return str(law.__dataclass_fields__[calibration.parameter].metadata["meaning"])
    return f"damping ratio of the {calibration.parameter.partition('.')[0]}"


def _parameter_chart(calibration: Calibration) -> Chart:
    function = calibration.fit.function
    speeds = calibration.observations.speeds
    phrase = parameter_words(calibration)
    marks: list[Mark] = []
    fitted_too = ""
    if function.degree or len(speeds) > 1:
        smooth = np.linspace(function.slowest, function.fastest, _SMOOTH)
        fitted = function(smooth)
        band = calibration.fit.band(smooth, calibration.confidence)
        if np.isfinite(band).all():
            of_what = "band of the misfit"
            if calibration.observations.measured:
                of_what = "band"
            low, high = calibration.allowed.bounded(np.array([fitted - band, fitted + band]))
            marks.append(
                Band(smooth, low, high, f"{100.0 * calibration.confidence:g} % {of_what}", "band")
            )
        if function.degree < 2:
            name = ("constant", "line")[function.degree]
        else:
            name = f"polynomial of degree {function.degree}"
        marks.append(Line(smooth, fitted, name, "fit"))
        of_impacts = np.allclose([function.slowest, function.fastest], [speeds.min(), speeds.max()])
        fitted_to = "the exact values at calibrate.speeds"
        if of_impacts:
            fitted_to = "them"
        fitted_too = f", and the {name} fitted to {fitted_to}"
    if calibration.curve is not None:
        marks.append(Line(*calibration.curve, "exact at each speed"))
    low = None
    high = None
    if calibration.intervals is not None:
        low, high = calibration.intervals.T
    marks.append(
        Points(
            speeds,
            calibration.values,
            "impacts matched",
            "matched",
            calibration.observations.labels,
            low=low,
            high=high,
        )
    )
    if calibration.as_given and not np.allclose(calibration.given, calibration.values, rtol=1e-3):
        marks.append(
            Points(
                speeds,
                calibration.given,
                "as the case gives it",
                "muted",
                calibration.observations.labels,
            )
        )
    panel = Panel(
        Axis("Approach speed", "m/s"), Axis(_begun(phrase), calibration.unit), tuple(marks)
    )
    if "." in calibration.parameter:
        key = calibration.parameter
    else:
        key = f"contact.{calibration.parameter}"
    caption = f"In a case it is {key}. Each impact by itself{fitted_too}."
    if calibration.intervals is not None:
        caption += f" Bars: the interval of each impact at {100.0 * calibration.confidence:g} %."
    return Chart(
        "parameter", f"{_begun(phrase)} over the approach speed", ((panel,),), caption, height=3.4
    )


def _differences_chart(calibration: Calibration) -> Chart:
    off = differences(calibration)
    shown = [
        name
        for name in COMPARED
        if name in off and not (name == "separation_speed_m_s" and "rebound_height_m" in off)
    ]
    panels = []
    for name in shown:
        marks: list[Mark] = [Level(0.0)]
        for number, way in enumerate(WAYS):
            values = 100.0 * off[name][way]
            marks.append(
                Line(np.arange(1.0, len(values) + 1.0), values, way, series(number), marked=True)
            )
        ticks: tuple[int, ...] = ()
        if len(values) <= _FEW:
            ticks = tuple(range(1, len(values) + 1))
        panels.append(
            Panel(
                Axis("Impact", ticks=ticks, integer=True),
                Axis("Difference", "%"),
                tuple(marks),
                COMPARED[name],
            )
        )
    rows = tuple(tuple(panels[start : start + 2]) for start in range(0, len(panels), 2))
    caption = (
        "Each impact of the drop compared with the target, with the value given in three ways: "
        "that of the first impact throughout "
    )
    caption += (
        "(constant), each impact its own (variable), and the polynomial of "
        "the approach speed (function)."
    )
    return Chart("differences", "Remaining differences", rows, caption, height=2.3)


def _begun(phrase: str) -> str:
    return phrase[:1].upper() + phrase[1:]
