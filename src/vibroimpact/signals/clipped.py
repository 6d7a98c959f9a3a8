"""Samples of a record that lie at the end of the range of what recorded it."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools
from vibroimpact.signals.record import Record, recorded_samples

_LEAST_STEPS = 3.0
"""Steps of a converter by which a cut peak rises above its neighbours, and a round one does not."""
_LEAST_IN_ALL = 3
"""Number of samples at an extreme that are no chance, wherever they are."""
_AT_REST = 1e-6
"""Part of the largest magnitude up to which a signal rests.

The level of a force between impacts is no end of a converter's range.
"""


def clipped_samples(record: Record) -> Bools:
    """Return which samples of a record are clipped: at an extreme twice in a row, or three times.

    A converter of few bits repeats the extreme of a round peak too; there the next value is only a
    step or two lower.

    Parameters
    ----------
    record : Record
        The record; extremes are those of what was recorded, before a baseline was removed.

    Examples
    --------
    >>> time = np.arange(40)
    >>> wave = Record("a", np.sin(0.3 * time), 1e3, "m/s2")
    >>> cut = Record("a", wave.value.clip(-0.9, 9.0), 1e3, "m/s2")
    >>> int(clipped_samples(wave).sum()), np.flatnonzero(clipped_samples(cut)).tolist()
    (0, [15, 16, 17, 36, 37, 38])
    """
    recorded = recorded_samples(record)
    clipped = np.zeros(len(recorded), dtype=bool)
    levels = np.unique(recorded)
    if len(levels) < 2 or not np.isfinite(recorded).all():
        return clipped
    rest = _AT_REST * float(np.abs(record.value).max())
    converter_step = float(np.diff(levels).min())
    for sign in (1.0, -1.0):
        side = sign * recorded
        at_extreme = (side == side.max()) & (sign * record.value > rest)
        neighbours = np.concatenate([[False], at_extreme, [False]])
        in_runs = at_extreme & (neighbours[:-2] | neighbours[2:])
        if not (in_runs.any() or np.count_nonzero(at_extreme) >= _LEAST_IN_ALL):
            continue
        # The steps up to the extreme and down from it. A signal that turns there on its own does so
        # in steps of the converter, and one that is cut off arrives fast.
        to_extreme = at_extreme[1:] != at_extreme[:-1]
        jumps = np.abs(np.diff(side))[to_extreme]
        next_lower = np.unique(side)[-2]
        gap = side.max() - next_lower
        if len(jumps) and max(jumps.max(), gap) > _LEAST_STEPS * converter_step:
            clipped |= at_extreme
    return clipped
