"""Where a drop on bodies that vibrate can't be foretold."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.sensitivity import RELATIVE_CHANGE

_FORETOLD = 1e-3  # of the motion: a larger change of it is told
_LOST = 0.3  # a larger one leaves no digit


def sensitivity_doubts(change: NDArray[np.float64]) -> list[str]:
    """Return from which impact on a drop can't be foretold.

    Parameters
    ----------
    change : array, shape (impacts,)
        To what part of the motion a change of the drop that nobody can rule out has grown by each impact.

    Examples
    --------
    >>> sensitivity_doubts(np.array([5e-10, 0.02]))[0].partition(":")[0]
    'the drop is sensitive from impact 2 on'
    """
    over = np.flatnonzero(~(change <= _FORETOLD))
    if not over.size:
        return []
    first, lost = over[0], np.flatnonzero(~(change <= _LOST))
    grown = [] if lost.size and lost[0] == first else [f"to {100.0 * change[first]:.2g} % of the motion by impact {first + 1}"]
    grown += [f"to all of it by impact {lost[0] + 1}"] if lost.size else []
    return [
        f"the drop is sensitive from impact {first + 1} on: a relative change of {RELATIVE_CHANGE:g} in it grows {' and '.join(grown)}, "
        "so that these impacts are some of many that are possible; give the plate its damping, or ask a study over drop.height for "
        "their distribution"
    ]
