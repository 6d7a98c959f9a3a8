"""Overload of an accelerometer: the signal beyond its range, and the effect of clipping
on the samples.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH, AntiAlias, kernel, parallel
from vibroimpact.dynamics.sensors.sensor import sample_count

_FINER, _PER_PERIOD = 8, 64.0
"""Least oversampling of a clipped signal, and least number of samples per period of a resonance."""
RINGING = 60
"""Samples after which the response of a Butterworth filter has decayed."""


@dataclass(frozen=True)
class Overload:
    """The part of a signal beyond the range of an accelerometer.

    Parameters
    ----------
    rate : float
        Sampling rate of the excess [Hz]: an integer multiple of the sensor's rate.
    first : int
        Number of its first sample, 0 at the start of the run; before it there is none. It is at a
        sample of the sensor.
    excess : array, shape (samples,)
        The signal beyond the range [m/s^2].
    peak : float
        The largest magnitude before clipping [m/s^2].
    time : float
        Total time beyond the range [s].
    """

    rate: float
    first: int
    excess: Floats
    peak: float
    time: float


def finer_rate(rate: float, resonance: float | None) -> float:
    """Return the sampling rate of a clipped signal [Hz]: an integer multiple of the rate."""
    return rate * max(_FINER, math.ceil(_PER_PERIOD * (resonance or 0.0) / rate))


def overload(value: Floats, rate: float, first: int, end: float, limit: float) -> Overload:
    """Return the excess of samples [m/s^2] over a limit, at a rate [Hz] from sample
    `first` on, of a run that ends at a time [s].
    """
    excess = np.maximum(np.abs(value) - limit, 0.0) * np.sign(value)
    within = slice(max(-first, 0), max(sample_count(end, rate) - first, 0))
    return Overload(
        rate,
        first,
        excess,
        float(np.abs(value[within]).max(initial=0.0)),
        float(np.count_nonzero(excess[within]) / rate),
    )


def clipped_part(found: Overload, antialias: AntiAlias, rate: float, count: int) -> Floats:
    """Return the contribution of the excess to the samples after an anti-alias filter, (count,)."""
    taken, cut = np.zeros(count), np.flatnonzero(found.excess)
    if not len(cut):
        return taken
    finer = round(found.rate / rate)
    if not antialias.half_length:
        return _through_poles(found, antialias, finer, count)
    from scipy.signal import upfirdn

    taps = kernel(np.arange(-HALF_LENGTH * finer, HALF_LENGTH * finer + 1) / finer) / finer
    begin = cut[0] // finer  # the sample at or before the first excess
    # it begins `HALF_LENGTH` samples before `begin`
    given = upfirdn(taps, found.excess[begin * finer : cut[-1] + 1], 1, finer)
    first = found.first // finer + begin - HALF_LENGTH
    here = slice(max(first, 0), min(first + len(given), count))
    taken[here] = given[here.start - first : here.stop - first]
    return taken


def _through_poles(found: Overload, antialias: AntiAlias, finer: int, count: int) -> Floats:
    """Return the contribution of the excess after pairs of poles, exact for an excess
    that is linear between its samples.
    """
    from scipy.signal import cont2discrete, lfilter

    cut = np.flatnonzero(found.excess)
    begin, end = cut[0], min(cut[-1] + 1 + RINGING * finer, len(found.excess))
    response = np.zeros(end)
    for (level, slope), (stiffness, damping) in parallel(antialias.sections):
        numerator, denominator, _ = cont2discrete(
            ([slope, level], [1.0, damping, stiffness]), 1.0 / found.rate, method="foh"
        )
        response[begin:] += lfilter(np.ravel(numerator), denominator, found.excess[begin:end])
    taken, samples, first = np.zeros(count), response[::finer], found.first // finer
    here = slice(max(first, 0), min(first + len(samples), count))
    taken[here] = samples[here.start - first : here.stop - first]
    return taken
