"""Times of the envelope: rise, duration, decay, centroid."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature
from vibroimpact.signals.reasons import Reason

_FIRST_DECIBELS, _LAST_DECIBELS = -5.0, -25.0


def _of(block: Block) -> Floats:
    above = (block.envelope >= block.threshold[:, None]) & (block.threshold[:, None] > 0.0)
    heard = above.any(axis=1)
    onset = np.where(heard, above.argmax(axis=1), np.nan)
    last = block.samples - 1 - above[:, ::-1].argmax(axis=1)
    top = block.envelope.argmax(axis=1)
    # the energy that is still to come, and where it has fallen to a part of all
    left = np.cumsum((block.value**2)[:, ::-1], axis=1)[:, ::-1]
    left = left / left[:, :1]
    first_fall, last_fall = (
        _fall(left, 10.0 ** (level / 10.0)) for level in (_FIRST_DECIBELS, _LAST_DECIBELS)
    )
    decay = (
        2.0 * (last_fall - first_fall) / (np.log(10.0) / 10.0 * (_FIRST_DECIBELS - _LAST_DECIBELS))
    )
    centroid = (block.value**2) @ np.arange(block.samples) / block.square_sum - onset
    return np.stack([top - onset, last - onset, decay, centroid], axis=1) / block.rate


def _fall(left: Floats, part: float) -> Floats:
    """Return the sample, between samples by interpolation, at which what is left falls
    below a part; it ends at zero.
    """
    row = np.arange(len(left))
    after = np.count_nonzero(left >= part, axis=1)
    begin = left[row, np.maximum(after - 1, 0)]
    end = np.where(after < left.shape[1], left[row, np.minimum(after, left.shape[1] - 1)], 0.0)
    found = after - 1 + (begin - part) / (begin - end)
    return np.asarray(np.where(np.isnan(begin), np.nan, found))


_EMISSION = "ASTM E1316, Terminology for Nondestructive Examinations, section B: acoustic emission"

FAMILY = Family(
    (
        Feature(
            name="rise_time",
            meaning="from where the envelope first reaches the threshold to its maximum",
            equation="t(max a) - t(first a >= threshold)",
            source=f"{_EMISSION}, by the envelope",
            unit="s",
            lacking=Reason.NO_ONSET,
        ),
        Feature(
            name="duration",
            meaning="from the first to the last time at which the envelope reaches the threshold",
            equation="t(last a >= threshold) - t(first a >= threshold)",
            source=f"{_EMISSION}, by the envelope",
            unit="s",
            lacking=Reason.NO_ONSET,
        ),
        Feature(
            name="decay_time",
            meaning="time constant of the amplitude, from the energy still to come between -5 and "
            "-25 dB",
            equation="2 (t(-25 dB) - t(-5 dB)) / ln(100), with the level of sum(x[j]^2, j >= i)",
            source="Schroeder 1965, J. Acoust. Soc. Am. 37:409; ISO 3382-1, T20",
            unit="s",
        ),
        Feature(
            name="temporal_centroid",
            meaning="mean time of the energy, from where the envelope first reaches the threshold",
            equation="sum(t x^2) / sum(x^2) - t(first a >= threshold)",
            source="Peeters 2004, A large set of audio features, IRCAM, section 2.3, by the energy",
            unit="s",
            lacking=Reason.NO_ONSET,
        ),
    ),
    _of,
)
