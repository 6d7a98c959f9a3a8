"""Where an accelerometer is driven beyond its range: what it cuts off, and what that takes from the samples."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import REACH, AntiAlias, kernel, parallel
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain
from vibroimpact.dynamics.sensors.sampled import follow_filtered_chain
from vibroimpact.dynamics.sensors.sensor import sample_count

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment

_FINER, _PER_PERIOD = 8, 64.0
"""How many times finer than its samples a clipped signal is followed, at least; and samples a period of a resonance, at least."""
_RINGING = 60
"""Samples after which a Butterworth filter has forgotten."""


@dataclass(frozen=True)
class Overload:
    """What an accelerometer cuts off.

    Parameters
    ----------
    rate : float
        Samples per second at which it is followed [Hz]: a whole multiple of the sensor's rate.
    excess : array, shape (samples,)
        What lies beyond the range [m/s^2].
    peak : float
        The largest magnitude before it is clipped [m/s^2].
    time : float
        For how long it is driven beyond its range, in all [s].
    """

    rate: float
    excess: Floats
    peak: float
    time: float


def finer_rate(rate: float, resonance: float | None) -> float:
    """Return at how many samples per second a clipped signal is followed: a whole multiple of the rate."""
    return rate * max(_FINER, math.ceil(_PER_PERIOD * (resonance or 0.0) / rate))


def overload(chain: MeasuringChain, rate: float, segments: Sequence[VibratingSegment], end: float, ahead: float, limit: float) -> Overload:
    """Return what a chain of one output [m/s^2] has beyond a limit, followed at a rate [Hz] until a time and a little `ahead` [s]."""
    value = follow_filtered_chain(chain, rate, segments, sample_count(end + ahead, rate), np.array([limit]))[0]
    excess = np.maximum(np.abs(value) - limit, 0.0) * np.sign(value)
    within = sample_count(end, rate)
    return Overload(rate, excess, float(np.abs(value[:within]).max(initial=0.0)), float(np.count_nonzero(excess[:within]) / rate))


def taken_away(found: Overload, through: AntiAlias, rate: float, count: int) -> Floats:
    """Return what the excess would have given in the samples behind an anti-alias filter, (count,)."""
    taken, cut = np.zeros(count), np.flatnonzero(found.excess)
    if not len(cut):
        return taken
    finer = round(found.rate / rate)
    if not through.reach:
        return _through_poles(found, through, finer, count)
    from scipy.signal import upfirdn

    taps = kernel(np.arange(-REACH * finer, REACH * finer + 1) / finer) / finer
    begin = cut[0] // finer  # of the samples, the one at or before the first excess
    given = upfirdn(taps, found.excess[begin * finer : cut[-1] + 1], 1, finer)  # its first lies the reach before `begin`
    first = begin - REACH
    here = slice(max(first, 0), min(first + len(given), count))
    taken[here] = given[here.start - first : here.stop - first]
    return taken


def _through_poles(found: Overload, through: AntiAlias, finer: int, count: int) -> Floats:
    """Return the same behind pairs of poles: exact for an excess that is straight between its samples."""
    from scipy.signal import cont2discrete, lfilter

    cut = np.flatnonzero(found.excess)
    begin, end = cut[0], min(cut[-1] + 1 + _RINGING * finer, len(found.excess))
    whole = np.zeros(end)
    for (level, slope), (stiffness, damping) in parallel(through.sections):
        numerator, denominator, _ = cont2discrete(([slope, level], [1.0, damping, stiffness]), 1.0 / found.rate, method="foh")
        whole[begin:] += lfilter(np.ravel(numerator), denominator, found.excess[begin:end])
    taken = np.zeros(count)
    samples = whole[::finer][:count]
    taken[: len(samples)] = samples
    return taken
