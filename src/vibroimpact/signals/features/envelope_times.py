"""Times of the envelope: rise, duration, decay, centroid."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature
from vibroimpact.signals.reasons import Reason

_FIRST_DECIBELS = -5.0
"""Level of the energy still to come at which the decay time begins [dB]."""
_LAST_DECIBELS = -25.0
"""Level at which it ends [dB]."""


def _envelope_times(block: Block) -> Floats:
    # a signal that is zero throughout has the threshold zero, which it does not reach
    above = (block.envelope >= block.threshold[:, None]) & (block.threshold[:, None] > 0.0)
    onset = np.where(above.any(axis=1), above.argmax(axis=1), np.nan)
    last_above = block.samples - 1 - above[:, ::-1].argmax(axis=1)
    maximum = block.envelope.argmax(axis=1)
    square = block.value**2
    centroid = square @ np.arange(block.samples) / block.square_sum - onset
    times = [maximum - onset, last_above - onset, _decay_time(square), centroid]
    return np.stack(times, axis=1) / block.rate


def _decay_time(square: Floats) -> Floats:
    """Return the time constant of the amplitude, in samples, from the squares of the samples.

    The energy still to come (Schroeder 1965) falls by 10 / ln(10) dB in half a time constant.
    """
    to_come = np.cumsum(square[:, ::-1], axis=1)[:, ::-1]
    to_come = to_come / to_come[:, :1]
    first_fall = _fall(to_come, 10.0 ** (_FIRST_DECIBELS / 10.0))
    last_fall = _fall(to_come, 10.0 ** (_LAST_DECIBELS / 10.0))
    nepers = np.log(10.0) / 10.0 * (_FIRST_DECIBELS - _LAST_DECIBELS)
    return np.asarray(2.0 * (last_fall - first_fall) / nepers)


def _fall(to_come: Floats, level: float) -> Floats:
    """Return the sample at which the energy still to come falls below a level.

    Between samples it is linear; behind the last one it is zero.
    """
    signal = np.arange(len(to_come))
    samples = to_come.shape[1]
    following = np.count_nonzero(to_come >= level, axis=1)
    begin = to_come[signal, np.maximum(following - 1, 0)]
    end = to_come[signal, np.minimum(following, samples - 1)]
    end = np.where(following < samples, end, 0.0)
    fall = following - 1 + (begin - level) / (begin - end)
    return np.asarray(np.where(np.isnan(begin), np.nan, fall))


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
    _envelope_times,
)
