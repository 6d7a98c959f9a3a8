"""Samples at the end of a converter's range: in runs, in pairs on many peaks, and with
the noise of what follows the converter.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.features.clipping import FAMILY

_LEAST, _MORE = 6, 5.0
"""Samples within a width of the extreme, and how many times as many as within the width below: tops
of vibrations have 3 times as many at most for 6 samples, and 2.4 times for many.
"""
_NOISE = 8.0
"""Width that holds an extreme with noise, in standard deviations of that."""
_WIDTHS = (1e-9, 1e-4, 1e-3, 5e-3)
"""Further widths, as parts of the span of the record: the same number, and what filters
and amplifiers make of it.
"""
_WIDE = 0.1
_REST, _FEWEST = 0.1, 8
"""Part of the largest magnitude below which an extreme is that of a rest; and least
number of samples that tell noise.
"""


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
    ...     clipped_count(one, one, noise) > 0
    ...     for one in (tone, np.minimum(tone, 0.6) + noise, tone + noise)
    ... ]
    [False, True, False]
    """
    most = round(
        float(FAMILY.of(Block(value[None], 1.0, recorded=recorded[None]))[0, 0]) * len(value)
    )
    spread = float(np.std(rest)) if len(rest) >= _FEWEST else 0.0
    span = float(np.ptp(recorded))
    peak = float(np.abs(value).max())
    for sign in (1.0, -1.0):
        side = sign * recorded
        top = float(side.max())
        if sign * float(value[np.argmax(side)]) < _REST * peak:
            continue  # the level at which a force rests is no end of a range
        for width in (*(part * span for part in _WIDTHS), _NOISE * spread):
            if not 0.0 < width <= _WIDE * span:
                continue
            inside, below, peaks = _counts(side, top, width)
            # two blows that are alike have twice as many
            if inside >= (2 if peaks == 2 else 1) * _LEAST and inside > _MORE * below:
                most = max(most, inside)
    return most


def _counts(side: Floats, top: float, width: float) -> tuple[int, int, int]:
    """Return how many samples lie within a width below the largest, within the same width
    below that, and the peaks of the first.
    """
    high: Bools = side >= top - width
    inside = int(np.count_nonzero(high))
    return (
        inside,
        int(np.count_nonzero(side >= top - 2.0 * width)) - inside,
        int(np.count_nonzero(high[1:] & ~high[:-1])) + int(high[0]),
    )
