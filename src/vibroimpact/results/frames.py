"""The times at which a deflected body is worth a picture: through the first visit in fine steps, then on in coarser ones."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats

_IN_VISIT = 20
"""Frames in the first visit."""
_PER_PERIOD = 24
"""Frames a period of the lowest mode, at the end."""
_GROWTH = 1.15
"""By how much each step is longer than the last, in between."""


def frame_times(touch: float, duration: float, period: float, end: float, count: int) -> Floats:
    """Return times from just before first touch on [s].

    Parameters
    ----------
    touch, duration : float
        The first visit [s].
    period : float
        Of the lowest mode [s].
    end : float
        When the run ends [s].
    count : int
        How many times; fewer where the run ends before.

    Examples
    --------
    >>> frame_times(1.0, 1e-3, 0.1, 2.0, 96)[[0, 2, 22, -1]].round(4).tolist()
    [0.9999, 1.0, 1.001, 1.1925]
    """
    step = min(duration, 3.0 * period) / _IN_VISIT  # a sphere that stays is never released
    in_visit = touch + step * np.arange(-2, _IN_VISIT + 3)
    steps = np.minimum(step * _GROWTH ** np.arange(count - len(in_visit)), max(step, period / _PER_PERIOD))
    times = np.concatenate([in_visit, in_visit[-1] + np.cumsum(steps)])
    return np.asarray(times[(times >= 0.0) & (times <= end)])
