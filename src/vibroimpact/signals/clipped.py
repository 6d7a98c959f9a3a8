"""Samples of a record that lie at the end of the range of what recorded it."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools
from vibroimpact.signals.record import Record

_STEPS = 3.0
"""Steps of a converter by which a peak rises above its neighbours where it is cut, and
not round.
"""
_ALL = 3
"""Number of samples at an extreme that are no chance, wherever they are."""
_AT_REST = 1e-6
"""Part of the largest magnitude up to which a signal rests: the level of a force between
impacts is no end of a converter's range.
"""


def clipped_samples(record: Record) -> Bools:
    """Return which samples of a record are clipped: at its largest or its lowest value, twice in a
    row or three times in all.

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
    recorded = record.value if record.recorded is None else record.recorded
    found = np.zeros(len(recorded), dtype=bool)
    levels = np.unique(recorded)
    if len(levels) < 2 or not np.isfinite(recorded).all():
        return found
    rest, step = _AT_REST * float(np.abs(record.value).max()), float(np.diff(levels).min())
    for sign in (1.0, -1.0):
        side = sign * recorded
        at_end = (side == side.max()) & (sign * record.value > rest)
        beside = np.concatenate([[False], at_end, [False]])
        runs = at_end & (beside[:-2] | beside[2:])
        if not (runs.any() or np.count_nonzero(at_end) >= _ALL):
            continue
        lower = np.unique(side)[-2]
        jumps = np.abs(np.diff(side))[np.flatnonzero(at_end[1:] != at_end[:-1])]
        if len(jumps) and max(jumps.max(), side.max() - lower) > _STEPS * step:
            found |= at_end
    return found
