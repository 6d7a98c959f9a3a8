"""All charts of a run."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from vibroimpact.charts.chart import Chart
from vibroimpact.charts.made import made_charts
from vibroimpact.results.result import Result
from vibroimpact.runs.captions import caption
from vibroimpact.runs.chart_data import contacts_with_duration, drawn_history
from vibroimpact.runs.deflection_chart import deflection_chart
from vibroimpact.runs.energy_chart import ledger_chart
from vibroimpact.runs.force_indentation_chart import loops_chart
from vibroimpact.runs.history_charts import ACCELERATION, FORCE, POSITION, VELOCITY, history_chart
from vibroimpact.runs.oblique_chart import moves_along, oblique_chart
from vibroimpact.runs.path_chart import moves_over, path_chart
from vibroimpact.runs.sensor_charts import drawn_sensors, sensor_chart
from vibroimpact.runs.vibration_charts import (
    plate_energy_chart,
    plate_motion_chart,
    sphere_energy_chart,
)


def chart_makers(result: Result) -> dict[str, Callable[[], Chart]]:
    """Return what makes each chart of a result, by the name of the chart, in the order of the
    report.

    Parameters
    ----------
    result : Result
        Result of one drop.

    Returns
    -------
    dict of str to callable
        `position`, `force`, `velocity`, `acceleration`, `force_indentation`, `along_plate` and
        `path` where there is such a motion, and `energy`; where bodies vibrate also
        `sphere_energy`, `plate_motion`, `plate_energy` and `deflection`; and one per sensor. Force,
        acceleration and force over indentation exist only for contacts of finite duration, not with
        an instantaneous law.
    """
    history = drawn_history(result)
    in_contact = bool(len(contacts_with_duration(result)))
    over_time = {"position": POSITION}
    if in_contact:
        over_time["force"] = FORCE
    over_time["velocity"] = VELOCITY
    if in_contact:
        over_time["acceleration"] = ACCELERATION
    makers: dict[str, Callable[..., Chart]] = {
        name: partial(history_chart, result, history, what) for name, what in over_time.items()
    }
    if in_contact:
        makers["force_indentation"] = partial(loops_chart, result)
    if moves_along(history):
        makers["along_plate"] = partial(oblique_chart, result, history)
    if moves_over(history):
        makers["path"] = partial(path_chart, result, history)
    makers["energy"] = partial(ledger_chart, result, history)
    if result.vibrates and len(result.impacts["time_s"]):
        makers["sphere_energy"] = partial(sphere_energy_chart, result, history)
        if "plate" in result.peaks:
            makers |= {
                "plate_motion": partial(plate_motion_chart, result, history),
                "plate_energy": partial(plate_energy_chart, result, history),
            }
            if result.deflection is not None:
                makers["deflection"] = partial(deflection_chart, result)
    makers |= {
        name: partial(sensor_chart, result, name, sensor)
        for name, sensor in drawn_sensors(result).items()
    }
    return {name: partial(_with_caption, make, name, result) for name, make in makers.items()}


def _with_caption(make: Callable[[str], Chart], name: str, result: Result) -> Chart:
    return make(caption(name, result))


def run_charts(result: Result) -> list[Chart]:
    """Return the charts of a result in the order of its report.

    Parameters
    ----------
    result : Result
        Result of one drop.

    Returns
    -------
    list of Chart
        `position`, `force` and `velocity` first.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> response = vi.simulate(vi.load_case("paper:type1-theory"))
    >>> [chart.name for chart in run_charts(vi.result_of(response))]
    ['position', 'force', 'velocity', 'acceleration', 'force_indentation', 'energy']
    """
    return made_charts(chart_makers(result))
