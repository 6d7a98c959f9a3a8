"""Records of inverted polarity: found by the pulse that explains them."""

from __future__ import annotations

import numpy as np

from vibroimpact.identification.measured import Measured
from vibroimpact.identification.plate import Place, Plate
from vibroimpact.identification.pulses import Search, search_place

_POOR = 0.1
"""Part of the records' energy that the best pulse leaves, from which on signs are tried."""
_BETTER = 0.6
"""Part of what is left by one sign that is left by the other, down to which this one is right."""


def upright(
    plate: Plate, measured: Measured, place: Place | None = None
) -> tuple[Measured, Search]:
    """Return records with the signs that a force explains best, and the search for its place.

    Signs are changed one after the other as long as much less is left, or all at once. That a force
    pushes tells the sign of a single one.

    Parameters
    ----------
    plate, measured, place
        As those of `search_place`.
    """
    search = search_place(plate, measured, place)
    sensors = len(measured.sensors)
    signs = [1.0 - 2.0 * np.eye(sensors)[sensor] for sensor in range(sensors)]
    if sensors > 1:
        signs.append(-np.ones(sensors))
    for _ in range(sensors // 2 + 1):
        misfit = float(search.misfit.min())
        if misfit < _POOR:
            break
        inverted = [measured.inverted(sign) for sign in signs]
        searches = [search_place(plate, records, place) for records in inverted]
        misfits = [float(other.misfit.min()) for other in searches]
        best = int(np.argmin(misfits))
        if misfits[best] > _BETTER * misfit:
            break
        measured = inverted[best]
        search = searches[best]
    return measured, search
