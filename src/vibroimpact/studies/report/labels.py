"""Text common to tables, captions and the terminal: values of an axis, labels, counts and percentages."""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact.shown import shortened, visible
from vibroimpact.studies.percentiles import PERCENTILES
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.units.display import digits, multiple, text

BAND = f"{PERCENTILES[0]} to {PERCENTILES[-1]} %"
"""Label of the percentile bands in all figures."""


def value_text(axis: StudyAxis, value: Any) -> str:
    """Return one value of an axis as text."""
    return text(float(value), axis.unit) if axis.numeric else shortened(visible(str(value)), 60)


def range_text(axis: StudyAxis) -> str:
    """Return the range or the names of an axis as text."""
    if not axis.varies:
        return f"{value_text(axis, axis.values[0])} alone"
    if not axis.numeric:
        names = list(dict.fromkeys(axis.values))
        more = f", and {len(names) - 6} more" if len(names) > 6 else ""
        return ", ".join(shortened(visible(str(name)), 40) for name in names[:6]) + more
    low, high = float(np.min(axis.values)), float(np.max(axis.values))
    scale = multiple(axis.unit, [low, high])
    return f"{digits(low / scale.size)} to {digits(high / scale.size)}\u00a0{scale.unit}".rstrip("\u00a0")


def drops_text(number: int) -> str:
    """Return a number of drops in words.

    Examples
    --------
    >>> drops_text(1), drops_text(12)
    ('1 drop', '12 drops')
    """
    return f"{number} drop{'' if number == 1 else 's'}"


def percent(part: float) -> str:
    """Return a fraction as a percentage with two digits.

    Examples
    --------
    >>> percent(1 / 6)
    '17 %'
    """
    return f"{digits(100.0 * part, 2)} %"


def with_unit(name: str, unit: str) -> str:
    """Return a label: a name with its unit, if any, in brackets."""
    return f"{name} [{unit}]" if unit else name
