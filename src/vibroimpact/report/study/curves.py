"""The figures of a study with one axis: curves over it."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from vibroimpact.report.study.axes import StudyAxis, Ticks, plain
from vibroimpact.report.study.outputs import Output, on_grid
from vibroimpact.report.study.panels import add_legend, panels, scale_of, scale_vertical, title_of
from vibroimpact.report.style import ENLARGED, LOOPS
from vibroimpact.storage.study import Study

_BY_IMPACT = {
    "largest_force_N": ("max_force_N", "Largest force"),
    "largest_indentation_m": ("max_indentation_m", "Largest indentation"),
    "first_restitution_achieved": ("restitution_achieved", "Restitution achieved"),
    "first_duration_s": ("duration_s", "Duration of contact"),
    "total_energy_lost_J": ("energy_lost_J", "Energy lost"),
    "first_rebound_height_m": ("rebound_height_m", "Rebound height"),
}
"""The column of the impact table behind a result, and what it is called there."""

_MARKS = ("o", "s", "^", "D", "v")
_MOST_MARKED, _MOST = 40, 3000


def draw_curves(study: Study, axis: StudyAxis, outputs: list[Output]) -> Figure:
    """Draw results over one axis, each of the first impacts a line where impacts were kept."""
    ticks = Ticks(axis)
    order = np.argsort(ticks.places(axis.values), kind="stable")
    order = order[:: -(-len(order) // _MOST)]
    places = ticks.places(axis.values)[order]
    number = min(max((study.shapes[name][-1] for name, _ in _BY_IMPACT.values() if name in study.shapes), default=1), ENLARGED)
    figure, some = panels([ticks.turned] * len(outputs), legend=number > 1)
    for axes, output in zip(some, outputs, strict=True):
        name, title = _BY_IMPACT.get(output.name, ("", ""))
        size = scale_of(output).size
        values = on_grid(study, name)[order] if name in study.shapes else on_grid(study, output.name)[order, None]
        for impact in range(min(values.shape[1], number)):
            colour, dashes = LOOPS[impact]
            mark = _MARKS[impact] if len(places) <= _MOST_MARKED else ""
            line = "" if ticks.names else dashes
            axes.plot(places, values[:, impact] / size, mark, color=colour, linestyle=line, markersize=3.0, label=f"impact {impact + 1}")
        shown = output._replace(title=title) if name in study.shapes else output
        axes.set_title(title_of(shown))
        scale_vertical(axes, output)
        ticks.set_on(axes)
        axes.set_xlabel(ticks.label)
    if number > 1:
        longest = max(some, key=lambda axes: len(axes.lines))
        add_legend(figure, longest)
    return figure


def curve_words(study: Study, axis: StudyAxis) -> str:
    """Return the caption of the curves."""
    kept = [study.shapes[name][-1] for name, _ in _BY_IMPACT.values() if name in study.shapes]
    words = f"Results over {plain(axis.key)}"
    if not kept:
        return f"{words}; impacts were not kept one by one, so that these are the peaks of each drop."
    of_many = f" (the first {ENLARGED} of {max(kept)})" if max(kept) > ENLARGED else ""
    return f"{words}, a line an impact{of_many}." if max(kept) > 1 else f"{words}."
