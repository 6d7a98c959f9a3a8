"""The charts of an identification: the records and what explains them, the force, and the place."""

from __future__ import annotations

from functools import partial

import numpy as np

from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Band, Line, Map, Points
from vibroimpact.identification.identify import Identification
from vibroimpact.quoting import shortened, visible
from vibroimpact.signals.estimate import Estimate

_HEIGHT = 3.2


def identification_charts(identification: Identification) -> list[Chart]:
    """Return the charts of an identification.

    Parameters
    ----------
    identification : Identification
        What was identified.

    Returns
    -------
    list of Chart
        `records` with their fit, `force` with its band and, if the place was sought, `place`.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("signals:coal-gangue", {"plate.modes": 30})
    >>> record = vi.signals.Record("a1", vi.simulate(case).signals()["a1"].value, 25.6e3, "m/s2")
    >>> identification = vi.identification.identify(case, [record], place=(0.0, 0.0))
    >>> [chart.name for chart in identification_charts(identification)]
    ['records', 'force']
    """
    makers = {"records": _records_chart, "force": _force_chart}
    if identification.search.misfit.size > 1:
        makers["place"] = _place_chart
    return made_charts({name: partial(make, identification) for name, make in makers.items()})


def _records_chart(identification: Identification) -> Chart:
    measured = identification.measured
    time = np.arange(measured.value.shape[1]) / measured.rate - identification.sphere.parameters[4]
    axis = Axis("Time since first touch", "s")
    rows = []
    for sensor, value, residual in zip(
        measured.sensors, measured.value, identification.sphere.residual, strict=True
    ):
        name = shortened(visible(sensor.name), 40)
        lines = (
            Line(time, value, "record", "measured"),
            Line(time, value - residual, "fit", "fit"),
            Line(time, residual, "residual", "difference"),
        )
        rows.append((Panel(axis, Axis(sensor.quantity.capitalize(), sensor.unit), lines, name),))
    caption = "Each record, the signal of the sphere that explains all of them, and the difference."
    return Chart("records", "Records and fit", tuple(rows), caption, _HEIGHT)


def _force_chart(identification: Identification) -> Chart:
    force = identification.force
    contact = identification.sphere.force
    touch = float(identification.sphere.parameters[4])
    marks: tuple[Band | Line, ...] = (
        Line(contact.time, contact.value, "contact of the sphere that was found", "fit"),
    )
    caption = (
        "The force of the sphere that was found under the contact law of the case. That from "
        "the records alone contradicts it: withheld."
    )
    if force is not None:
        time = force.time - touch
        spread = Estimate(0.0, 1.0).interval[1] * force.found.deviation
        band = Band(time, force.found.force - spread, force.found.force + spread, "95 %", "band")
        marks = (band, Line(time, force.found.force, "from the records alone"), *marks)
        caption = (
            "The force from the records alone, with its 95 % band, and that of the sphere that "
            "was found under the contact law of the case."
        )
    panel = Panel(Axis("Time since first touch", "s"), Axis("Contact force", "N"), marks)
    return Chart("force", "Contact force", ((panel,),), caption, _HEIGHT)


def _place_chart(identification: Identification) -> Chart:
    search = identification.search
    sensors = {sensor.name: sensor for sensor in identification.measured.sensors}
    sensor_positions = [
        (sensor.name, sensor.position)
        for sensor in identification.plate.case.sensors
        if sensor.name in sensors and not isinstance(sensor.position, str)
    ]
    names = [shortened(visible(name), 40) for name, _ in sensor_positions]
    at = np.array([place for _, place in sensor_positions]).reshape(-1, 2)
    scale = Axis("Part of the records' energy that a pulse there explains", range=(0.0, 1.0))
    places = np.array(
        [
            identification.sphere.parameters[:2].tolist(),
            *(candidate.place for candidate in search.candidates[1:]),
        ]
    )
    texts = ("the force", *("as likely" for _ in search.candidates[1:]))
    marks = (
        Map(search.x, search.y, 1.0 - search.misfit, scale),
        Points(at[:, 0], at[:, 1], "sensors", "sensor", tuple(names)),
        Points(places[:, 0], places[:, 1], "position of the force", "mark", texts),
    )
    panel = Panel(Axis("x on the plate", "m"), Axis("y on the plate", "m"), marks)
    caption = (
        "The share of the records' energy that the best pulse of force at each position explains. "
        "The records do not distinguish positions where it is equally high. The mark is the "
        "position of the final fit."
    )
    return Chart("place", "Position of the force", ((panel,),), caption, 4.6)
