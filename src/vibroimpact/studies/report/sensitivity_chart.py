"""Chart of the sensitivity of the results to the swept keys."""

from __future__ import annotations

from functools import partial

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Bars, Level, Mark
from vibroimpact.quoting import shortened, visible
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.labels import keys_told
from vibroimpact.studies.report.outputs import Output
from vibroimpact.studies.report.panels import in_rows
from vibroimpact.studies.report.scales import sentence
from vibroimpact.studies.report.sensitivity_table import RANGES, RANKS, SOBOL, Sensitivity

_MOST_KEYS = 15
_LETTERS = 34  # letters of a key beside the bars
_LABELS = {
    SOBOL: ("Fraction of the variance", ""),
    RANKS: ("Rank correlation", ""),
    RANGES: ("From the middle", "%"),
}
_WORDS = {
    SOBOL: "Sobol's indices: fraction of the variance due to a key alone, and in total; the thin "
    "lines are 95 % intervals.",
    RANKS: "Spearman's rank correlation of results with keys that are numbers.",
    RANGES: "Range of a result along one key, with the others at their middle level. Each panel "
    "has its own scale.",
}


def sensitivity_chart(
    study: Study, sensitivity: Sensitivity, outputs: list[Output]
) -> Chart | None:
    """Return the chart of indices, correlations or ranges, one panel per result; None with fewer
    than two keys or no result.

    Parameters
    ----------
    study : Study
        The study.
    sensitivity : Sensitivity
        Its sensitivities.
    outputs : list of Output
        The results to draw.
    """
    shown = [output for output in outputs if output.name in sensitivity.rows]
    if not shown or len(sensitivity.keys) < 2:
        return None
    # sort the keys by their effect summed over all results, the largest at the top
    effects = np.nansum([sensitivity.strength[output.name] for output in shown], axis=0)
    order = np.argsort(effects, kind="stable")[-_MOST_KEYS:]
    axes = {axis.key: axis for axis in study_axes(study)}
    keys = [axes[sensitivity.keys[key]] for key in order]
    names = tuple(shortened(visible(sentence(axis.words)), 60) for axis in keys)
    panels = []
    limits = (-1.05, 1.05) if sensitivity.way == RANKS else None
    across = Axis(*_LABELS[sensitivity.way], range=limits)
    up = Axis(names=tuple(shortened(name, _LETTERS) for name in names))
    for output in shown:
        if sensitivity.way == RANGES:
            # an axis of its own, as ranges may differ widely between results
            across = Axis(*_LABELS[RANGES])
        marks = (*_bars(sensitivity, output, order, names), Level(0.0, role="main", upright=True))
        panels.append(Panel(across, up, marks, shortened(visible(output.short), 40)))
    cut = ""
    if len(sensitivity.keys) > _MOST_KEYS:
        cut = (
            f" The {_MOST_KEYS} of {len(sensitivity.keys)} keys with the largest effects are drawn."
        )
    caption = f"{_WORDS[sensitivity.way]}{cut} {keys_told(keys[::-1])}"
    return Chart("sensitivity", "Sensitivity", in_rows(panels), caption, 0.7 + 0.28 * len(order))


def _bars(
    sensitivity: Sensitivity, output: Output, order: Indices, names: tuple[str, ...]
) -> tuple[Mark, ...]:
    """Return the bars of one result, one for each of the named keys."""
    lying = partial(Bars, lying=True, texts=names)
    row = sensitivity.rows[output.name]
    places = np.arange(float(len(order)))
    if sensitivity.way == SOBOL:
        sides = (
            (0.18, "first_order", "alone (first order)", "detail"),
            (-0.18, "total", "in all (total)", "pale"),
        )
        return tuple(
            lying(
                places + side,
                row[name][order],
                label,
                role,
                0.34,
                low=row[f"{name}_low"][order],
                high=row[f"{name}_high"][order],
            )
            for side, name, label, role in sides
        )
    if sensitivity.way == RANKS:
        return (lying(places, np.nan_to_num(row["rank_correlation"][order])),)
    middle = row["at_the_middle"][order]
    high = _percent_off(row["highest"][order], middle)
    low = _percent_off(row["lowest"][order], middle)
    return (
        lying(places, high, "up to the highest", "detail"),
        lying(places, low, "down to the lowest", "lower"),
    )


def _percent_off(values: Floats, middle: Floats) -> Floats:
    """Return how far values are from those at the middle [%]; 0 where these are zero."""
    difference = np.nan_to_num(values - middle)
    relative = np.zeros(len(middle))
    np.divide(difference, np.abs(middle), out=relative, where=middle != 0.0)
    return 100.0 * relative
