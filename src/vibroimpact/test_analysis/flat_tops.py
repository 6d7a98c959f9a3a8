"""Samples at the end of a converter's range, with what comes between them.

They lie in runs, in pairs on many peaks, and with the noise of what follows the converter.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.features.clipping import FAMILY

_LEAST_SAMPLES = 6
"""Least number of samples within a width of the extreme."""
_LEAST_RATIO = 5.0
"""How many times as many they must be as within the width below.

Tops of vibrations have 3 times as many at most for 6 samples, and 2.4 times for many.
"""
_NOISE_WIDTH = 8.0
"""Width that holds an extreme with noise, in standard deviations of that."""
_WIDTHS = (1e-9, 1e-4, 1e-3, 5e-3)
"""Further widths, over the span of the record: one number, and what filters make of it."""
_WIDEST = 0.1
"""Largest width, over the span of the record."""
_AT_REST = 0.1
"""Part of the largest magnitude below which an extreme is that of a rest."""
_LEAST_AT_REST = 8
"""Least number of samples at rest that tell noise."""


def clipped_count(value: Floats, recorded: Floats, rest: Floats) -> int:
    """Return how many samples of a record lie at an end of a range; 0 if nothing piles up there.

    Parameters
    ----------
    value, recorded : array, shape (samples,)
        The samples without and with their baseline.
    rest : array, shape (k,)
        Samples at rest, of which the noise is estimated; fewer than eight tell none.

    Examples
    --------
    >>> time = np.arange(400) / 400.0
    >>> tone = np.exp(-3.0 * time) * np.sin(97.0 * time)
    >>> noise = 1e-3 * np.random.default_rng(0).standard_normal(400)
    >>> [
    ...     clipped_count(record, record, noise) > 0
    ...     for record in (tone, np.minimum(tone, 0.6) + noise, tone + noise)
    ... ]
    [False, True, False]
    """
    # runs of equal samples, as the feature `clipped_part` counts them
    clipped_part = float(FAMILY.of(Block(value[None], 1.0, recorded=recorded[None]))[0, 0])
    count = round(clipped_part * len(value))
    noise = 0.0
    if len(rest) >= _LEAST_AT_REST:
        noise = float(np.std(rest))
    span = float(np.ptp(recorded))
    widths = [*(width * span for width in _WIDTHS), _NOISE_WIDTH * noise]
    peak = float(np.abs(value).max())
    for sign in (1.0, -1.0):
        side = sign * recorded
        top = float(side.max())
        if sign * float(value[np.argmax(side)]) < _AT_REST * peak:
            continue  # the level at which a force rests is no end of a range
        for width in widths:
            if not 0.0 < width <= _WIDEST * span:
                continue
            at_top, below, peaks = _counts(side, top, width)
            # two blows that are alike have twice as many
            blows = 2 if peaks == 2 else 1
            if at_top >= blows * _LEAST_SAMPLES and at_top > _LEAST_RATIO * below:
                count = max(count, at_top)
    return count


def _counts(side: Floats, top: float, width: float) -> tuple[int, int, int]:
    """Return how many samples lie within a width below the top, and within a width below that.

    The third number is that of the peaks that reach the first width.
    """
    high: Bools = side >= top - width
    at_top = int(np.count_nonzero(high))
    below = int(np.count_nonzero(side >= top - 2.0 * width)) - at_top
    peaks = int(np.count_nonzero(high[1:] & ~high[:-1])) + int(high[0])
    return at_top, below, peaks
