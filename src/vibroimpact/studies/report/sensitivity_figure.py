"""Figure of the sensitivity of the results to the swept keys."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibroimpact.report.layout import WIDTH, new_figure
from vibroimpact.report.style import ACCENT, INK, MARK, lettering
from vibroimpact.studies.report.outputs import Output
from vibroimpact.studies.report.sensitivity import RANGES, RANKS, SOBOL, Sensitivity
from vibroimpact.studies.study import Study

_LEFT, _RIGHT, _BETWEEN = 2.35, 7.8, 0.25  # [in]
_LINE, _ROW = 0.3, 0.85  # height of a key, and of the surroundings of a row of panels [in]
_COLUMNS = 3
_MOST_KEYS = 15
_LETTERS = 24  # letters of a title that fit over a narrow panel
_LABELS = {SOBOL: "Part of the variance", RANKS: "Rank correlation", RANGES: "From the middle [%]"}


def draw_sensitivity(study: Study, found: Sensitivity, outputs: list[Output]) -> Figure | None:
    """Draw indices, correlations or ranges, one panel per result; None with fewer than two keys or no result."""
    shown = [one for one in outputs if one.name in found.rows]
    if not shown or len(found.keys) < 2:
        return None
    # sort the keys by their effect summed over all results, the largest at the top
    order = np.argsort(np.nansum([found.strength[one.name] for one in shown], axis=0), kind="stable")[-_MOST_KEYS:]
    rows, tall = math.ceil(len(shown) / _COLUMNS), _LINE * len(order) + 0.1
    foot = 0.85 if found.way == SOBOL else 0.5
    figure = new_figure(foot + rows * (tall + _ROW) - 0.4)
    width = (_RIGHT - _LEFT - (_COLUMNS - 1) * _BETWEEN) / _COLUMNS
    drawn = []
    for number, output in enumerate(shown):
        row, column = divmod(number, _COLUMNS)
        low = foot + (rows - 1 - row) * (tall + _ROW)
        place = (_LEFT + column * (width + _BETWEEN), low, width, tall)
        total = figure.get_figheight()
        axes = figure.add_axes((place[0] / WIDTH, low / total, width / WIDTH, tall / total))
        _draw(axes, found, output, order)
        names = [lettering(found.keys[key], 34) for key in order]
        axes.set_yticks(range(len(order)), names if column == 0 else [""] * len(order))
        axes.set_ylim(-0.6, len(order) - 0.4)
        axes.set_title(lettering(output.short, _LETTERS))
        if number + _COLUMNS >= len(shown):
            axes.set_xlabel(_LABELS[found.way])
        drawn.append(axes)
    if found.way == SOBOL:
        figure.legend(*drawn[0].get_legend_handles_labels(), loc="lower center", ncols=2)
    _same_widths(drawn, found.way)
    return figure


def _draw(axes: Axes, found: Sensitivity, output: Output, order: np.ndarray[tuple[int], np.dtype[np.intp]]) -> None:
    """Draw the bars of one result, and a line at zero effect."""
    row, places = found.rows[output.name], np.arange(len(order))
    if found.way == SOBOL:
        for side, name, colour, label in (
            (0.18, "first_order", ACCENT, "alone (first order)"),
            (-0.18, "total", "#b9c9d8", "in all (total)"),
        ):
            error = row[name][order] - row[f"{name}_low"][order]
            axes.barh(places + side, row[name][order], 0.34, color=colour, edgecolor=INK, linewidth=0.4, label=label)
            axes.errorbar(row[name][order], places + side, xerr=error, fmt="none", ecolor=INK, elinewidth=0.8, capsize=1.5)
    elif found.way == RANKS:
        axes.barh(places, np.nan_to_num(row["rank_correlation"][order]), 0.55, color=ACCENT)
    else:
        middle = row["at_the_middle"][order]
        low, high = (100.0 * (row[name][order] - middle) / np.abs(middle) for name in ("lowest", "highest"))
        axes.barh(places, np.nan_to_num(high), 0.55, color=ACCENT, label="highest")
        axes.barh(places, np.nan_to_num(low), 0.55, color=MARK, hatch="////", edgecolor="white", linewidth=0.0, label="lowest")
    axes.axvline(0.0, color=INK, linewidth=0.8)
    axes.grid(axis="y", visible=False)
    axes.tick_params(axis="y", length=0)
    axes.locator_params(axis="x", nbins=4)


def _same_widths(drawn: list[Axes], way: str) -> None:
    """Give all panels a common scale, except for ranges, which may differ widely between results."""
    if way == RANKS:
        for axes in drawn:
            axes.set_xlim(-1.05, 1.05)
    elif way == SOBOL:
        most = max(axes.get_xlim()[1] for axes in drawn)
        least = min(axes.get_xlim()[0] for axes in drawn)
        for axes in drawn:
            axes.set_xlim(least, most)
