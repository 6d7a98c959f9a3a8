"""The sampling rate of a column of times."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError

_LARGEST_SHIFT = 0.1
"""Largest distance of a time from equal steps, as a part of a step: times are written with few digits."""


def rate_of(time: Floats) -> float:
    """Return the rate of samples at equal steps [Hz].

    Raises
    ------
    InputError
        If there are fewer than two times, or they do not rise by equal steps.

    Examples
    --------
    >>> rate_of(np.array([0.0, 0.001, 0.002]))
    1000.0
    """
    if len(time) < 2:
        raise InputError("a record has two samples or more; the rate follows from their times")
    step = (time[-1] - time[0]) / (len(time) - 1)
    if not (step > 0.0 and np.isfinite(step)):
        raise InputError("the times do not rise")
    shift = np.abs(time - (time[0] + step * np.arange(len(time)))) / step
    worst = int(np.argmax(shift))
    if not shift[worst] <= _LARGEST_SHIFT:
        raise InputError(
            f"the times do not rise by equal steps: sample {worst + 1} is {shift[worst]:.2g} steps off its place; resample the record"
        )
    return float(f"{1.0 / step:.12g}")  # the digits that times have
