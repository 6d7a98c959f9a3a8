"""What a notebook shows of a study: a chart by its name, and a short table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from markupsafe import Markup

from vibroimpact.charts.notebook import plotly_figure
from vibroimpact.errors import InputError, choices
from vibroimpact.quoting import quoted, visible
from vibroimpact.report.html_table import html_table
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.charts import study_charts
from vibroimpact.studies.report.outputs import study_outputs
from vibroimpact.studies.report.tables import axes_table, counts_sentence, percentiles_table
from vibroimpact.studies.study import Study

if TYPE_CHECKING:
    import plotly.graph_objects as go

_RESULTS, _KEYS = 8, 20


def plot_study(study: Study, name: str = "") -> go.Figure:
    """Return a chart of a study as a figure of plotly, for notebooks and scripts.

    Parameters
    ----------
    study : Study
        The completed study.
    name : str
        Name of the chart, such as "maps", "restitution" or "sensitivity"; by default the first
        chart of the report.

    Returns
    -------
    plotly.graph_objects.Figure
        The figure; values are in the multiples of units that its axes name.

    Raises
    ------
    InputError
        If the study has no such chart.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory").to_problem().source
    >>> sweep = vi.studies.sweep_of(
    ...     {**case, "sweep": {"over": {"drop.height": ["1 m", "2 m", "4 m"]}}}
    ... )
    >>> with TemporaryDirectory() as folder:
    ...     vi.studies.plot_study(
    ...         vi.studies.load_study(vi.studies.run_sweep(sweep, f"{folder}/heights"))
    ...     ).layout.title.text
    'Over the drop height'
    """
    charts = {chart.name: chart for chart in study_charts(study)}
    if not charts:
        raise InputError("this study has no charts, as no result that they show varies")
    if name and name not in charts:
        raise InputError(
            f"there is no chart {quoted(name)} of this study; there are "
            f"{choices(charts, str(name))}"
        )
    return plotly_figure(charts[name or next(iter(charts))])


def study_html(study: Study) -> str:
    """Return a short summary of a study as a piece of HTML without scripts: name, drops, swept keys
    and the distribution of the results.

    Parameters
    ----------
    study : Study
        The completed study.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory").to_problem().source
    >>> sweep = vi.studies.sweep_of({**case, "sweep": {"over": {"drop.height": ["1 m", "2 m"]}}})
    >>> with TemporaryDirectory() as folder:
    ...     html = vi.studies.study_html(
    ...         vi.studies.load_study(vi.studies.run_sweep(sweep, f"{folder}/heights"))
    ...     )
    >>> "drop.height" in html, "<script" in html
    (True, False)
    """
    head = Markup("<p><strong>{}</strong><br>{}</p>").format(
        visible(study.name), counts_sentence(study)
    )
    keys = ["Key", "", "Values"], axes_table(study, study_axes(study))[:_KEYS]
    results = percentiles_table(study_outputs(study, _RESULTS))
    return str(
        Markup("\n").join(
            [
                head,
                *(html_table(headers, rows) if rows else "" for headers, rows in (keys, results)),
            ]
        )
    )
