"""What a notebook shows of a run: a chart by its name, and a short summary."""

from __future__ import annotations

from typing import TYPE_CHECKING

from markupsafe import Markup

from vibroimpact.charts.made import made_charts
from vibroimpact.charts.notebook import plotly_figure
from vibroimpact.errors import InputError, choices
from vibroimpact.quoting import quoted, visible
from vibroimpact.report.html_table import html_table
from vibroimpact.results.result import Result
from vibroimpact.runs.captions import sensor_caption
from vibroimpact.runs.charts import run_charts
from vibroimpact.runs.sensor_charts import sensor_chart
from vibroimpact.runs.setup import setup_chart
from vibroimpact.runs.tables import impact_table

if TYPE_CHECKING:
    import plotly.graph_objects as go

_SENSOR = "sensor "


def plot_result(result: Result, name: str = "position") -> go.Figure:
    """Return a chart of a result as a figure of plotly, for notebooks and scripts.

    Parameters
    ----------
    result : Result
        Result of one drop.
    name : str, default "position"
        Name of the chart: "setup", "position", "force", "velocity", "acceleration",
        "force_indentation" or "energy"; where bodies vibrate also "sphere_energy", "plate_motion",
        "plate_energy", "deflection", and "sensor NAME" for each sensor.

    Returns
    -------
    plotly.graph_objects.Figure
        The figure; values are in the multiples of units that its axes name.

    Raises
    ------
    InputError
        If the result has no such chart.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> response = vi.simulate(vi.load_case("paper:type1-theory"))
    >>> figure = vi.plot_result(vi.result_of(response), "force")
    >>> figure.layout.title.text, figure.layout.yaxis.title.text
    ('Contact force on the sphere', 'Force [kN]')
    """
    sensors = (
        {f"{_SENSOR}{sensor}": sensor for sensor in result.signals}
        if len(result.impacts["time_s"])
        else {}
    )
    if name in sensors:
        sensor = sensors[name]
        return plotly_figure(sensor_chart(result, name, sensor, sensor_caption(result, sensor)))
    charts = {
        chart.name: chart
        for chart in (*made_charts({"setup": lambda: setup_chart(result)}), *run_charts(result))
    }
    if name not in charts:
        known = [*(chart for chart in charts if not chart.startswith("sensor_")), *sensors]
        raise InputError(
            f"there is no chart {quoted(name)} of this run; there are {choices(known, str(name))}"
        )
    return plotly_figure(charts[name])


def result_html(result: Result) -> str:
    """Return a short summary of a result as a piece of HTML without scripts: name, status, impact
    table and doubts.

    Parameters
    ----------
    result : Result
        Result of one drop.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> html = vi.result_html(vi.result_of(vi.simulate(vi.load_case("paper:type1-theory"))))
    >>> html.count("<tr>"), "<script" in html
    (6, False)
    """
    parts = [
        Markup("<p><strong>{}</strong><br>{}</p>").format(
            visible(result.name), visible(result.status)
        ),
        _impacts(result),
    ]
    parts += [Markup("<p>Doubt: {}.</p>").format(visible(doubt)) for doubt in result.doubts]
    return str(Markup("\n").join(parts))


def _impacts(result: Result) -> Markup:
    table = impact_table(result)
    if not table.head:
        return Markup("<p>No impact within the run.</p>")
    gap = [f"… {table.left_out} more …"] if table.left_out else []
    return html_table(table.headers, [*table.head, *gap, *table.tail])
