"""The axes of a study as figures and tables show them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.quantity import digits
from vibroimpact.report.excerpt import Floats
from vibroimpact.report.study.units import study_multiple, study_text, with_unit
from vibroimpact.storage.study import Study

_LONGEST = 24  # letters of a name on an axis
_BESIDE = 36  # letters of all names below a panel


@dataclass(frozen=True, eq=False)
class StudyAxis:
    """A swept key.

    Attributes
    ----------
    key : str
        Dotted, as the study has it.
    unit : str
        SI; "1" of a plain number.
    values : array
        The levels of a grid, or one value a drop; floats [SI], or names.
    """

    key: str
    unit: str
    values: NDArray[Any]

    @property
    def numeric(self) -> bool:
        """Are its values numbers?"""
        return self.values.dtype.kind in "fiu"

    @property
    def varies(self) -> bool:
        """Has it two values or more?"""
        return bool(len(self.values) and (self.values != self.values[0]).any())


def study_axes(study: Study) -> list[StudyAxis]:
    """Return the axes in the order of the points."""
    return [StudyAxis(key, study.meanings[key][0], _as_numbers(values)) for key, values in study.coordinates.items()]


def design_of(study: Study) -> str:
    """Return the name of the design, such as "grid"."""
    return str(study.table["sweep"].get("design", "grid"))


class Ticks:
    """Where the values of an axis lie on a figure: as numbers in a multiple of their unit, or as names one beside the other.

    Parameters
    ----------
    axis : StudyAxis
        Of which there may be more values than are shown.
    """

    def __init__(self, axis: StudyAxis) -> None:
        self.names: list[str] = []
        self.is_log = False
        self.label = plain(axis.key)
        if axis.numeric:
            scale = study_multiple(axis.unit, axis.values)
            self._size = scale.size
            self.label = with_unit(self.label, scale.unit)
            self.is_log = is_spread_by_factors(axis.values)
        else:
            self.names = list(dict.fromkeys(axis.values))

    @property
    def turned(self) -> bool:
        """Are there names that have no room beside each other?"""
        return sum(len(shortened(name, _LONGEST)) for name in self.names) > _BESIDE

    def places(self, values: NDArray[Any]) -> Floats:
        """Return where values lie."""
        if self.names:
            where = {name: float(place) for place, name in enumerate(self.names)}
            return np.array([where[value] for value in values])
        return np.asarray(values, dtype=float) / self._size

    def set_on(self, axis: Any, side: str = "x") -> None:
        """Scale and label an axis of a figure, "x" or "y"."""
        line = axis.xaxis if side == "x" else axis.yaxis
        if self.is_log:
            getattr(axis, f"set_{side}scale")("log")
            plain_log_ticks(line)
        if self.names:
            step = -(-len(self.names) // 12)
            shown = range(0, len(self.names), step)
            line.set_ticks(list(shown), [plain(shortened(self.names[place], _LONGEST)) for place in shown])
            getattr(axis, f"set_{side}lim")(-0.5, len(self.names) - 0.5)
            if side == "x" and self.turned:
                for text in line.get_ticklabels():
                    text.set(rotation=20, ha="right", rotation_mode="anchor")


def plain_log_ticks(line: Any) -> None:
    """Label a logarithmic axis at 1, 2 and 5 of each decade, in plain numbers; at the decades alone where there are many."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = sorted(line.get_view_interval())
    decades = math.log10(high / low) if low > 0.0 else 9.0
    line.set_major_locator(LogLocator(10.0, subs=(1.0, 2.0, 5.0) if decades < 2.2 else (1.0,)))
    if decades < 5.0:
        line.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.6g}"))
    line.set_minor_formatter(NullFormatter())


def is_spread_by_factors(values: NDArray[Any]) -> bool:
    """Are levels about the same multiple of the one before, or drawn values spread like that, rather than by even steps?

    Examples
    --------
    >>> [is_spread_by_factors(np.array(levels)) for levels in ([1.0, 2.0, 4.0], [1.0, 2.0, 3.0], [0.02, 0.04, 1.0], [1.0, 3.0])]
    [True, False, True, False]
    """
    values = np.asarray(values, dtype=float)
    if len(values) > 10_000:
        values = values[:10_000]
    if len(values) < 3 or not np.all(values > 0.0) or not np.isfinite(values).all():
        return False
    logs, even = np.sort(np.log(values)), np.sort(values)
    factor = math.exp(logs[-1] - logs[0])
    if factor < 3.0:
        return False
    # whichever is closer to a straight line
    steady = np.linspace(0.0, 1.0, len(values))
    by_factors = np.abs((logs - logs[0]) / (logs[-1] - logs[0]) - steady).max()
    by_steps = np.abs((even - even[0]) / (even[-1] - even[0]) - steady).max()
    return bool(by_factors < by_steps and (by_factors < 0.1 or factor > 8.0))


def value_text(axis: StudyAxis, value: Any) -> str:
    """Return one value of an axis as it is read."""
    return study_text(float(value), axis.unit) if axis.numeric else shortened(str(value), 60)


def range_text(axis: StudyAxis) -> str:
    """Return in words what an axis runs over."""
    if not axis.varies:
        return f"{value_text(axis, axis.values[0])} alone"
    if not axis.numeric:
        names = list(dict.fromkeys(axis.values))
        more = f", and {len(names) - 6} more" if len(names) > 6 else ""
        return ", ".join(shortened(str(name), 40) for name in names[:6]) + more
    low, high = float(np.min(axis.values)), float(np.max(axis.values))
    scale = study_multiple(axis.unit, [low, high])
    return f"{digits(low / scale.size)} to {digits(high / scale.size)}\u00a0{scale.unit}".rstrip("\u00a0")


def shortened(words: str, most: int) -> str:
    """Return words, without their end where there are too many letters."""
    return words if len(words) <= most else f"{words[: most - 1]}…"


def plain(words: str) -> str:
    """Return words as a figure shows them letter by letter: a dollar sign would begin a formula."""
    return words.replace("$", r"\$")


def _as_numbers(values: NDArray[Any]) -> NDArray[Any]:
    """Return texts that are all plain numbers as these; a list of whole numbers is written as texts."""
    if values.dtype != object or not len(values):
        return values
    try:
        return np.array([float(value) for value in values])
    except ValueError:
        return values
