"""The axes of a study and its results as axes of charts, and where values lie on them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.axis import Axis
from vibroimpact.quoting import shortened, visible
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.outputs import Output

_LONGEST = 24  # letters of a name on an axis
_MOST_NAMES = 12  # names written on an axis
_LOOKED_AT = 10_000  # values examined for the choice of the scale
_FACTORS = 30.0  # ratio of the 95th to the 5th percentile above which the scale is logarithmic


def key_axis(axis: StudyAxis) -> Axis:
    """Return the axis of a chart for a swept key: numbers, or names at 0, 1, 2 and so on.

    Parameters
    ----------
    axis : StudyAxis
        The swept key; it may have more values than are drawn.

    Examples
    --------
    >>> key_axis(
    ...     StudyAxis("sphere.radius", "radius of the sphere", "m", np.array([0.01, 0.02]))
    ... ).label
    'Radius of the sphere'
    """
    label = shortened(visible(sentence(axis.words)), 60)
    if axis.numeric:
        return Axis(label, _shown_unit(axis.unit), log=is_spread_by_factors(axis.values))
    names = names_of(axis)
    step = math.ceil(len(names) / _MOST_NAMES)
    written = [""] * len(names)
    written[::step] = [shortened(visible(name), _LONGEST) for name in names[::step]]
    return Axis(label, names=tuple(written))


def _shown_unit(unit: str) -> str:
    """Return a unit as an axis has it: none for a pure number."""
    return "" if unit == "1" else unit


def result_axis(output: Output, label: str) -> Axis:
    """Return the axis of a chart for a result, with a label: its title, its short one, or
    none where a panel has the title.
    """
    return Axis(shortened(visible(label), 60), _shown_unit(output.unit), log=is_log(output))


def is_log(output: Output) -> bool:
    """Return whether a result is shown on a logarithmic scale, as it spans a large ratio."""
    low = output.spread.percentiles[0]
    high = output.spread.percentiles[-1]
    return low > 0.0 and high > _FACTORS * low


def sentence(phrase: str) -> str:
    """Return words with a capital letter at the beginning."""
    return phrase[:1].upper() + phrase[1:]


def names_of(axis: StudyAxis) -> list[str]:
    """Return the different names of an axis by first occurrence."""
    return [str(name) for name in dict.fromkeys(axis.values)]


def places(axis: StudyAxis, values: NDArray[Any]) -> Floats:
    """Return where values of a swept key lie on its axis: numbers where they are, names
    at 0, 1, 2 and so on.
    """
    if axis.numeric:
        return np.asarray(values, dtype=float)
    where = {name: float(place) for place, name in enumerate(names_of(axis))}
    return np.array([where[value] for value in values])


def ascending_order(axis: StudyAxis, most: int | None = None) -> Indices:
    """Return the indices that sort the levels of an axis, names by first occurrence; thinned evenly
    if there are more than `most`.

    Examples
    --------
    >>> axis = StudyAxis("sphere.radius", "radius of the sphere", "m", np.array([0.03, 0.01, 0.02]))
    >>> ascending_order(axis).tolist(), ascending_order(axis, most=2).tolist()
    ([1, 2, 0], [1, 0])
    """
    order = np.argsort(places(axis, axis.values), kind="stable")
    if most is None:
        return order
    return order[:: math.ceil(len(order) / most)]


def is_spread_by_factors(values: NDArray[Any]) -> bool:
    """Return whether levels, or sampled values, are closer to a geometric than to an arithmetic
    progression.

    Examples
    --------
    >>> [
    ...     is_spread_by_factors(np.array(levels))
    ...     for levels in ([1.0, 2.0, 4.0], [1.0, 2.0, 3.0], [0.02, 0.04, 1.0], [1.0, 3.0])
    ... ]
    [True, False, True, False]
    """
    even = np.sort(np.asarray(values[:_LOOKED_AT], dtype=float))
    if (
        len(even) < 3
        or not np.isfinite(even).all()
        or not even[0] > 0.0
        or even[-1] < 3.0 * even[0]
    ):
        return False
    by_steps = _off_a_line(even)
    by_factors = _off_a_line(np.log(even))
    return bool(by_factors < by_steps and (by_factors < 0.1 or even[-1] > 8.0 * even[0]))


def _off_a_line(values: Floats) -> float:
    """Return the largest deviation of sorted values from equal steps, relative to their range."""
    relative = (values - values[0]) / (values[-1] - values[0])
    equal_steps = np.linspace(0.0, 1.0, len(values))
    return float(np.abs(relative - equal_steps).max())
