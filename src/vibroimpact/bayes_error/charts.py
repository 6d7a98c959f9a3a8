"""The charts of a bound: errors by what is measured, over band and noise, and the falls
as one impact shows them.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from vibroimpact.bayes_error.bound import BANDWIDTHS, SIGNAL_TO_NOISE, Bound
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Bars, Map, Points
from vibroimpact.charts.palette import of_class

_MOST_POINTS = 1500


def bound_charts(bound: Bound) -> list[Chart]:
    """Return the charts of a bound.

    Parameters
    ----------
    bound : Bound
        The bound.

    Returns
    -------
    list of Chart
        `errors` by what is measured, `impacts`, each fall a point, and `sensors`, the error over
        band and noise.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> [
    ...     chart.name
    ...     for chart in bound_charts(
    ...         vi.bayes_error.bound_of(vi.studies.load_sweep("signals:coal-gangue", samples=256))
    ...     )
    ... ]
    ['errors', 'impacts', 'sensors']
    """
    makers = {"errors": _errors, "impacts": _impacts, "sensors": _sensors}
    return made_charts({name: partial(make, bound) for name, make in makers.items()})


def _errors(bound: Bound) -> Chart:
    names = tuple(reversed(bound.errors))
    errors = [bound.errors[name] for name in names]
    upper = 100.0 * np.array([error.upper for error in errors])
    low, high = (
        100.0 * np.array([(error.lower, error.upper + error.standard_error) for error in errors]).T
    )
    bars = Bars(
        np.arange(float(len(names))),
        upper,
        "",
        "detail",
        lying=True,
        low=low,
        high=high,
        texts=names,
    )
    panel = Panel(Axis("Bayes error", "%", range=(0.0, float("nan"))), Axis(names=names), (bars,))
    caption = (
        "The Bayes error of the population: the lowest error of a classifier that sees only "
        "these quantities, with the assumed scatter. "
        "Each interval reaches from the lower bound to one standard error above the upper one."
    )
    return Chart("errors", "Lowest possible classification error", ((panel,),), caption, 4.5)


def _impacts(bound: Bound) -> Chart:
    falls = bound.falls
    some = np.arange(0, len(falls), max(1, len(falls) // _MOST_POINTS))
    marks = []
    for number, name in enumerate(np.unique(falls.classes).tolist()):
        members = some[falls.classes[some] == name]
        marks.append(
            Points(falls.impulse[members], falls.duration[members], name, of_class(number))
        )
    panel = Panel(
        Axis("Impulse", "N s", log=True), Axis("Contact time", "s", log=True), tuple(marks)
    )
    caption = (
        "Each point is a fall. Falls of different classes with the same impulse and contact "
        "time cannot be distinguished by these two."
    )
    return Chart("impacts", "Impulse and contact time of the falls", ((panel,),), caption, 4.5)


def _sensors(bound: Bound) -> Chart:
    scale = Axis("Bayes error from one impact", "%")
    rows = tuple(f"{bandwidth / 1e3:g} kHz" for bandwidth in BANDWIDTHS)
    columns = tuple(f"{ratio:g} dB" for ratio in SIGNAL_TO_NOISE)
    values = Map(
        np.arange(float(len(columns))), np.arange(float(len(rows))), 100.0 * bound.map, scale
    )
    panel = Panel(
        Axis("Peak force of the median fall over noise in 10 kHz", names=columns),
        Axis("Bandwidth", names=rows),
        (values,),
    )
    caption = (
        "Upper bounds on the Bayes error from impulse and contact time of one impact at a "
        "known position, over bandwidth and "
        "signal-to-noise ratio of the sensor."
    )
    return Chart("sensors", "Bayes error over bandwidth and noise", ((panel,),), caption, 4.0)
