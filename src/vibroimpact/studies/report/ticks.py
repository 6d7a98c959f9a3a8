"""Positions, ticks and labels of the values of a study axis on a figure."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices
from vibroimpact.report.style import lettering
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.labels import with_unit
from vibroimpact.units.display import multiple

_LONGEST = 24  # maximum letters of a name on an axis
_BESIDE = 36  # letters of all names that fit side by side below a panel
_MOST_NAMES = 12
_LOOKED_AT = 10_000  # values examined for the choice of the scale


class Ticks:
    """An axis of a figure: numbers in a multiple of their unit, or names at equal distances.

    Parameters
    ----------
    axis : StudyAxis
        The study axis; it may have more values than are shown.
    """

    def __init__(self, axis: StudyAxis) -> None:
        self.names: list[str] = []
        self.is_log = False
        self.label = lettering(axis.key)
        if axis.numeric:
            scale = multiple(axis.unit, axis.values)
            self._size = scale.size
            self.label = with_unit(self.label, scale.unit)
            self.is_log = is_spread_by_factors(axis.values)
        else:
            self.names = list(dict.fromkeys(axis.values))

    @property
    def turned(self) -> bool:
        """Whether the names must be rotated to fit."""
        return sum(len(lettering(name, _LONGEST)) for name in self.names) > _BESIDE

    def places(self, values: NDArray[Any]) -> Floats:
        """Return the positions of values on the axis."""
        if self.names:
            where = {name: float(place) for place, name in enumerate(self.names)}
            return np.array([where[value] for value in values])
        return np.asarray(values, dtype=float) / self._size

    def set_on(self, axes: Any, side: str = "x") -> None:
        """Set scale and ticks of an axis of a figure, "x" or "y"."""
        line = axes.xaxis if side == "x" else axes.yaxis
        if self.is_log:
            getattr(axes, f"set_{side}scale")("log")
            plain_log_ticks(line)
        if self.names:
            shown = range(0, len(self.names), math.ceil(len(self.names) / _MOST_NAMES))
            line.set_ticks(list(shown), [lettering(self.names[place], _LONGEST) for place in shown])
            getattr(axes, f"set_{side}lim")(-0.5, len(self.names) - 0.5)
            if side == "x" and self.turned:
                for text in line.get_ticklabels():
                    text.set(rotation=20, ha="right", rotation_mode="anchor")


def ascending_order(axis: StudyAxis, most: int | None = None) -> Indices:
    """Return the indices that sort the levels of an axis, names by first occurrence; thinned evenly if there are more than `most`.

    Examples
    --------
    >>> axis = StudyAxis("sphere.radius", "m", np.array([0.03, 0.01, 0.02]))
    >>> ascending_order(axis).tolist(), ascending_order(axis, most=2).tolist()
    ([1, 2, 0], [1, 0])
    """
    order = np.argsort(Ticks(axis).places(axis.values), kind="stable")
    return order if most is None else order[:: math.ceil(len(order) / most)]


def plain_log_ticks(line: Any) -> None:
    """Label a logarithmic axis at 1, 2 and 5 of each decade in plain notation, or only at the decades if there are many."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = sorted(line.get_view_interval())
    decades = math.log10(high / low) if low > 0.0 else 9.0
    line.set_major_locator(LogLocator(10.0, subs=(1.0, 2.0, 5.0) if decades < 2.2 else (1.0,)))
    if decades < 5.0:
        line.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.6g}"))
    line.set_minor_formatter(NullFormatter())


def is_spread_by_factors(values: NDArray[Any]) -> bool:
    """Return whether levels, or sampled values, are closer to a geometric than to an arithmetic progression.

    Examples
    --------
    >>> [is_spread_by_factors(np.array(levels)) for levels in ([1.0, 2.0, 4.0], [1.0, 2.0, 3.0], [0.02, 0.04, 1.0], [1.0, 3.0])]
    [True, False, True, False]
    """
    even = np.sort(np.asarray(values[:_LOOKED_AT], dtype=float))
    if len(even) < 3 or not np.isfinite(even).all() or not even[0] > 0.0 or even[-1] < 3.0 * even[0]:
        return False
    by_steps, by_factors = _off_a_line(even), _off_a_line(np.log(even))
    return bool(by_factors < by_steps and (by_factors < 0.1 or even[-1] > 8.0 * even[0]))


def _off_a_line(values: Floats) -> float:
    """Return the largest deviation of sorted values from equal steps, relative to their range."""
    return float(np.abs((values - values[0]) / (values[-1] - values[0]) - np.linspace(0.0, 1.0, len(values))).max())
