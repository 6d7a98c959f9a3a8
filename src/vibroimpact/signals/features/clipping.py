"""The part of a signal that is clipped: an overdriven converter repeats its largest value."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature

_RUN = 3
"""Samples in a row that make a clipping: a sampled tone can touch its extreme twice."""
_AT_REST = 1e-6
"""Part of the largest magnitude up to which a signal rests.

The level of a force between impacts is no end of a converter's range.
"""


def _clipped_part(block: Block) -> Floats:
    clipped_part = np.zeros(len(block.value))
    recorded = block.value
    if block.recorded is not None:
        # without a drift samples at the end of a converter's range would no longer be the same
        recorded = block.recorded
    rest = _AT_REST * block.peak[:, None]
    if block.samples < _RUN:
        return clipped_part[:, None]
    for sign in (1.0, -1.0):
        side = sign * recorded
        at_extreme = (side == side.max(axis=1, keepdims=True)) & (sign * block.value > rest)
        # at each sample, whether a run begins there
        run = np.lib.stride_tricks.sliding_window_view(at_extreme, _RUN, axis=1).all(axis=2)
        in_run = np.zeros_like(at_extreme)
        for offset in range(_RUN):
            in_run[:, offset : offset + run.shape[1]] |= run
        clipped_part += np.count_nonzero(in_run, axis=1) / block.samples
    return clipped_part[:, None]


FAMILY = Family(
    (
        Feature(
            name="clipped_part",
            meaning="part of the samples in runs of three or more at the largest positive or the "
            "most negative value",
            equation="sum(x[i] = max(x) > 0 or x[i] = min(x) < 0, in runs of 3 and more) / "
            "samples, extremes of what was recorded",
            source="of this program",
        ),
    ),
    _clipped_part,
)
