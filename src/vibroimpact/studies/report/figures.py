"""The figures of a study, chosen by its design and number of axes, with titles and captions."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from vibroimpact.report.style import style
from vibroimpact.studies.report.axes import StudyAxis, study_axes
from vibroimpact.studies.report.curves import curve_words, draw_curves
from vibroimpact.studies.report.histograms import FEWEST, draw_inputs, draw_outputs
from vibroimpact.studies.report.labels import BAND
from vibroimpact.studies.report.maps import draw_maps
from vibroimpact.studies.report.outputs import Output, drawn_outputs, independent_drops
from vibroimpact.studies.report.over_axes import MOST_AXES, MOST_POINTS, draw_bands, draw_points
from vibroimpact.studies.report.restitution import draw_restitution
from vibroimpact.studies.report.sensitivity import RANKS, SOBOL, Sensitivity
from vibroimpact.studies.report.sensitivity_figure import draw_sensitivity
from vibroimpact.studies.report.signals import draw_signals, signal_figures
from vibroimpact.studies.study import Study


class StudyFigure(NamedTuple):
    """A figure to be drawn: title, caption, and the function that draws it, which returns None if there is nothing to show."""

    title: str
    caption: str
    draw: Callable[[], Figure | None]


def study_figures(study: Study, outputs: list[Output], found: Sensitivity | None) -> dict[str, StudyFigure]:
    """Return the figures of a study by name, in the order of the page.

    Parameters
    ----------
    study : Study
        The study.
    outputs : list of Output
        Its results.
    found : Sensitivity or None
        Sensitivity of the results to the keys.
    """
    shown = drawn_outputs(outputs)
    figures: dict[str, StudyFigure] = {}
    axes = [axis for axis in study_axes(study) if (len(axis.values) > 1 if study.is_grid else axis.varies)]
    if shown and axes:
        figures |= _of_grid(study, axes, shown, found) if study.is_grid else _of_samples(study, axes, shown)
    words = "Each impact a mark; dashed is what was asked of the law. What it achieves may depend on the speed of the impact."
    figures["restitution"] = StudyFigure("Restitution asked and achieved", words, partial(draw_restitution, study))
    if found is not None:
        figures["sensitivity"] = StudyFigure("What matters", _sensitivity_words(found), partial(draw_sensitivity, study, found, shown[:6]))
    for name, sensor in signal_figures(study).items():
        caption = (
            "Above, the band of all readings in short spans of time. Below, single drops: where theirs begin they are laid over each other."
        )
        figures[name] = StudyFigure(f"Sensor {sensor}", caption, partial(draw_signals, study, sensor))
    return figures


def draw(figure: StudyFigure) -> Figure | None:
    """Draw a figure in the style of the report."""
    with style():
        return figure.draw()


def _of_grid(study: Study, axes: list[StudyAxis], shown: list[Output], found: Sensitivity | None) -> dict[str, StudyFigure]:
    if len(axes) == 1:
        return {"curves": StudyFigure(f"Over {axes[0].key}", curve_words(study, axes[0]), partial(draw_curves, study, axes[0], shown))}
    first, second = _map_axes(axes, shown, found)
    over = f"{axes[first].key} and {axes[second].key}"
    if len(axes) == 2:
        words = "Levels are at the middle of their cells. Hatched: the drop failed, or has no such value."
        return {"maps": StudyFigure(f"Over {over}", words, partial(draw_maps, study, axes, shown, (first, second)))}
    figures = {}
    for output in shown:
        caption = (
            f"Over each key: the median and the {BAND} band of all drops of the grid, whatever their other keys are.{_first_axes(axes)}"
        )
        figures[output.name] = StudyFigure(output.title, caption, partial(draw_bands, study, axes, output))
    words = "The two keys that matter most to the first result; drawn is the median over the others. Hatched: there is none."
    figures["maps"] = StudyFigure(f"Over {over}", words, partial(draw_maps, study, axes, shown, (first, second)))
    return figures


def _of_samples(study: Study, axes: list[StudyAxis], shown: list[Output]) -> dict[str, StudyFigure]:
    figures: dict[str, StudyFigure] = {}
    drops = independent_drops(study)
    if drops >= FEWEST and study.design != "zip":
        of_what = " in the blocks A and B, whose drops are independent" if study.design == "saltelli" else ""
        figures["inputs"] = StudyFigure(
            "What was drawn", f"How often values were drawn{of_what}.", partial(draw_inputs, study, axes[:MOST_AXES])
        )
        figures["outputs"] = StudyFigure("What came of it", f"How the results spread{of_what}.", partial(draw_outputs, study, shown))
    for output in shown:
        some = f"{MOST_POINTS} of the drops" if drops > MOST_POINTS else "All drops"
        if study.design == "saltelli":
            some = f"{some} of the blocks A and B"
        band = f"; the line and the band are the median and {BAND} of drops next to each other" if drops > 300 else ""
        caption = f"{some}, over each key{band}.{_first_axes(axes)}"
        figures[output.name] = StudyFigure(output.title, caption, partial(draw_points, study, axes, output))
    return figures


def _map_axes(axes: list[StudyAxis], shown: list[Output], found: Sensitivity | None) -> tuple[int, int]:
    """Return the indices of the two axes of the maps: those with the largest effect on the first result if known, else the first two."""
    strength = None if found is None else found.strength.get(shown[0].name)
    if len(axes) == 2 or strength is None:
        return 0, 1
    first, second = sorted(np.argsort(np.nan_to_num(strength), kind="stable")[-2:].tolist())
    return first, second


def _first_axes(axes: list[StudyAxis]) -> str:
    return f" Drawn are the first {MOST_AXES} of {len(axes)} keys." if len(axes) > MOST_AXES else ""


def _sensitivity_words(found: Sensitivity) -> str:
    if found.way == SOBOL:
        return "Sobol's indices: the part of the variance that a key makes alone, and in all; the thin lines are intervals of 95 %."
    if found.way == RANKS:
        return "Spearman's rank correlation of each result with each key."
    return (
        "How far each result moves along one key, the others at their middle level; plain up, hatched down. Each panel has its own scale."
    )
