"""The figures of a run as files: its charts, and the animation of its plate."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from vibroimpact.charts.figures_folder import FIGURES as FIGURES
from vibroimpact.charts.files import save_charts
from vibroimpact.charts.made import SCENE, made_charts, warn_of_lost
from vibroimpact.results.result import Result
from vibroimpact.runs.animation import animate
from vibroimpact.runs.charts import run_charts
from vibroimpact.runs.setup import setup_chart

ANIMATION = "plate.gif"
"""The animation of the plate, in the folder of the figures."""


def write_figures(
    result: Result,
    directory: Path,
    formats: Sequence[str] = ("png",),
    progress: Callable[[float], None] = lambda done: None,
) -> None:
    """Write the charts of a run into an existing directory, and `plate.gif`, its plate in motion,
    if the plate deforms.

    Parameters
    ----------
    result : Result
        Result of one drop.
    directory : pathlib.Path
        Existing directory.
    formats : sequence of str
        Of "png", "svg" and "pdf".
    progress : callable, optional
        Called with the fraction done.
    """
    charts = [*made_charts({"setup": lambda: setup_chart(result)}), *run_charts(result)]
    save_charts(charts, directory, formats, progress)
    if result.deflection is None:
        return
    try:
        content = animate(result)
    except Exception as error:
        warn_of_lost(SCENE, error)
        return
    (directory / ANIMATION).write_bytes(content)
