"""Text common to tables, captions and the terminal: values of an axis, labels, counts and
percentages.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from vibroimpact.quoting import shortened, visible
from vibroimpact.studies.planning.population import CLASS
from vibroimpact.studies.report.axes import StudyAxis
from vibroimpact.studies.report.percentiles import PERCENTILES
from vibroimpact.units.display import digits, multiple, text

BAND = f"{PERCENTILES[0]} to {PERCENTILES[-1]} %"
"""Label of the percentile bands in all figures."""


def value_text(axis: StudyAxis, value: Any) -> str:
    """Return one value of an axis as text."""
    if axis.numeric:
        return text(float(value), axis.unit)
    return shortened(visible(str(value)), 60)


def level_words(axis: StudyAxis, level: int) -> str:
    """Return a level of an axis in the multiple of its unit that suits all of them, as short as it
    can be.

    Examples
    --------
    >>> axis = StudyAxis("sphere.radius", "radius of the sphere", "m", np.array([0.01, 0.0225]))
    >>> [level_words(axis, level).replace("\u00a0", " ") for level in (0, 1)]
    ['10 mm', '22.5 mm']
    """
    if not axis.numeric:
        return value_text(axis, axis.values[level])
    scale = multiple(axis.unit, axis.values)
    return f"{axis.values[level] / scale.size:.6g}\u00a0{scale.unit}".rstrip("\u00a0")


def keys_told(axes: Sequence[StudyAxis]) -> str:
    """Return the sentence of a caption that names the keys in a case file of axes that are drawn in
    words.

    Examples
    --------
    >>> keys_told([StudyAxis("sphere.radius", "radius of the sphere", "m", np.array([0.01, 0.02]))])
    'In the case: sphere.radius.'
    """
    # the class is a label, and no key
    keys = [shortened(visible(axis.key), 60) for axis in axes if axis.key != CLASS]
    if not keys:
        return ""
    return f"In the case: {', '.join(keys)}."


def range_text(axis: StudyAxis) -> str:
    """Return the range or the names of an axis as text."""
    if not axis.varies:
        return f"{value_text(axis, axis.values[0])} alone"
    if not axis.numeric:
        names = list(dict.fromkeys(axis.values))
        phrases = [shortened(visible(str(name)), 40) for name in names[:6]]
        if len(names) > 6:
            phrases.append(f"and {len(names) - 6} more")
        return ", ".join(phrases)
    low = float(np.min(axis.values))
    high = float(np.max(axis.values))
    scale = multiple(axis.unit, [low, high])
    return f"{digits(low / scale.size)} to {digits(high / scale.size)}\u00a0{scale.unit}".rstrip(
        "\u00a0"
    )


def drops_text(number: int) -> str:
    """Return a number of drops in words.

    Examples
    --------
    >>> drops_text(1), drops_text(12)
    ('1 drop', '12 drops')
    """
    return "1 drop" if number == 1 else f"{number} drops"


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
