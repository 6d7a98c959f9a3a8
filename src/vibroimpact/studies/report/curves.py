"""Figure of a study with one axis: curves of the results over it."""

from __future__ import annotations

from matplotlib.figure import Figure

from vibroimpact.report.style import ENLARGED, LOOPS, MARKS, lettering
from vibroimpact.studies.drop_variables import PEAK_TABLE
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.outputs import Output, on_grid
from vibroimpact.studies.report.panels import add_legend, panels, scale_vertical, title_of
from vibroimpact.studies.report.ticks import Ticks, ascending_order
from vibroimpact.studies.study import Study

_MOST_MARKED, _MOST = 40, 3000  # levels up to which points are marked, and drawn


def draw_curves(study: Study, axis: StudyAxis, outputs: list[Output]) -> Figure:
    """Draw the results over one axis, with one line per impact for the first impacts if impacts were kept."""
    ticks, order = Ticks(axis), ascending_order(axis, _MOST)
    places = ticks.places(axis.values[order])
    number = min(_impacts_kept(study), ENLARGED)
    figure, some = panels([ticks.turned] * len(outputs), legend=number > 1)
    for axes, output in zip(some, outputs, strict=True):
        column = _column(study, output)
        values = on_grid(study, column or output.name)[order].reshape(len(order), -1) / output.scale.size
        for impact, (mark, (colour, dashes)) in enumerate(zip(MARKS[: values.shape[1]], LOOPS, strict=False)):
            axes.plot(
                places,
                values[:, impact],
                marker=mark if ticks.names or len(places) <= _MOST_MARKED else "",
                color=colour,
                linestyle="" if ticks.names else dashes,
                markersize=3.0,
                label=f"impact {impact + 1}",
            )
        axes.set_title(title_of(output._replace(title=output.short) if column else output))
        scale_vertical(axes, output)
        ticks.set_on(axes)
        axes.set_xlabel(ticks.label)
    if number > 1:
        add_legend(figure, max(some, key=lambda axes: len(axes.lines)))
    return figure


def curve_words(study: Study, axis: StudyAxis) -> str:
    """Return the caption of the curves."""
    kept = _impacts_kept(study)
    words = f"Results over {lettering(axis.key)}"
    if not kept:
        return f"{words}; impacts were not kept one by one, so that these are the peaks of each drop."
    of_many = f" (the first {ENLARGED} of {kept})" if kept > ENLARGED else ""
    return f"{words}, a line an impact{of_many}." if kept > 1 else f"{words}."


def _column(study: Study, output: Output) -> str:
    """Return the column of the impact table from which a result is taken; "" if there is none or it was not kept."""
    column = PEAK_TABLE[output.name].column if output.name in PEAK_TABLE else ""
    return column if column in study.shapes else ""


def _impacts_kept(study: Study) -> int:
    """Return the number of impacts kept per drop; 0 if none."""
    return max((study.shapes[peak.column][-1] for peak in PEAK_TABLE.values() if peak.column in study.shapes), default=0)
