"""Remaining differences between calibrated drops and the target, impact by impact."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.observed.matchable import MATCHABLE

COMPARED = {
    MATCHABLE[name].column: MATCHABLE[name].phrase.capitalize()
    for name in ("max_indentation", "max_force", "duration", "rebound_height", "separation_speed")
}
"""Compared columns of the impact table, with their headings."""

WAYS = ("constant", "variable", "function")
"""How the value is prescribed: that of the first impact throughout, one per impact, or by the
fitted polynomial.
"""


def reference(calibration: Calibration) -> dict[str, Floats]:
    """Return the target values of the impacts of the drop by column.

    They are simulated, or measured if the measurement is of this drop.
    """
    if "target" in calibration.drops:
        _, values = calibration.impacts
        impact_count = len(values)
        table = {column: calibration.drops["target"][column][:impact_count] for column in COMPARED}
        return {column: target for column, target in table.items() if np.any(target > 0.0)}
    if not calibration.observations.of_the_drop:
        return {}
    return {
        MATCHABLE[name].column: target for name, target in calibration.observations.wanted.items()
    }


def differences(calibration: Calibration) -> dict[str, Mapping[str, Floats]]:
    """Return the relative deviations from the target by column and way of prescribing the value.

    They are NaN after the last impact.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> from vibroimpact.calibration.contact_law.calibrate import calibrate
    >>> found = calibrate(vi.load_case("paper:type1-constant"), vi.load_case("paper:type1-theory"))
    >>> [
    ...     round(100.0 * value, 2)
    ...     for value in differences(found)["max_indentation_m"]["constant"].tolist()
    ... ]
    [-0.38, -0.67, -1.7, -3.41, -5.7]
    """
    return {
        column: {
            way: _padded(calibration.drops[way][column], len(wanted)) / wanted - 1.0 for way in WAYS
        }
        for column, wanted in reference(calibration).items()
    }


def largest_misfit(calibration: Calibration) -> float:
    """Return the largest deviation of the polynomial from the exact values."""
    if calibration.curve is None:
        return calibration.fit.function.misfit(calibration.observations.speeds, calibration.values)
    speeds, values = calibration.curve
    return calibration.fit.function.misfit(speeds, values)


def _padded(values: Floats, length: int) -> Floats:
    """Return values cut to a length, or filled up with NaN."""
    missing = max(length - len(values), 0)
    return np.append(values, np.full(missing, np.nan))[:length]
