"""Overload of an accelerometer: the signal beyond its range, and clipping of the samples."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH, AntiAlias, kernel, parallel
from vibroimpact.dynamics.sensors.instruments.sensor import sample_count

_LEAST_OVERSAMPLING = 8
"""Least oversampling of a clipped signal."""
_SAMPLES_PER_PERIOD = 64.0
"""Least number of samples of a clipped signal per period of a resonance."""
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
    for_resonance = math.ceil(_SAMPLES_PER_PERIOD * (resonance or 0.0) / rate)
    return rate * max(_LEAST_OVERSAMPLING, for_resonance)


def overload_of(value: Floats, rate: float, first: int, end: float, limit: float) -> Overload:
    """Return the excess of samples over a limit [m/s^2].

    The samples have a rate [Hz] and begin with sample `first`; the run ends at a time [s].
    """
    excess = np.maximum(np.abs(value) - limit, 0.0) * np.sign(value)
    # the peak and the time beyond the range are those of the run alone
    in_run = slice(max(-first, 0), max(sample_count(end, rate) - first, 0))
    return Overload(
        rate=rate,
        first=first,
        excess=excess,
        peak=float(np.abs(value[in_run]).max(initial=0.0)),
        time=float(np.count_nonzero(excess[in_run]) / rate),
    )


def clipped_part(overload: Overload, antialias: AntiAlias, rate: float, count: int) -> Floats:
    """Return the contribution of the excess to the samples after an anti-alias filter, (count,)."""
    clipped = np.flatnonzero(overload.excess)
    if not len(clipped):
        return np.zeros(count)
    oversampling = round(overload.rate / rate)
    if not antialias.half_length:
        return _through_poles(overload, antialias, oversampling, count)
    from scipy.signal import upfirdn

    lead = HALF_LENGTH * oversampling
    taps = kernel(np.arange(-lead, lead + 1) / oversampling) / oversampling
    begin = clipped[0] // oversampling  # the sample at or before the first excess
    excess = overload.excess[begin * oversampling : clipped[-1] + 1]
    # the filtered excess begins `HALF_LENGTH` samples before `begin`
    filtered = upfirdn(taps, excess, 1, oversampling)
    return _placed(filtered, overload.first // oversampling + begin - HALF_LENGTH, count)


def _through_poles(
    overload: Overload, antialias: AntiAlias, oversampling: int, count: int
) -> Floats:
    """Return the contribution of the excess after pairs of poles, (count,).

    It is exact for an excess that is linear between its samples.
    """
    from scipy.signal import cont2discrete, lfilter

    clipped = np.flatnonzero(overload.excess)
    begin = clipped[0]
    end = min(clipped[-1] + 1 + RINGING * oversampling, len(overload.excess))
    response = np.zeros(end)
    for (constant, slope), (stiffness, damping) in parallel(antialias.sections):
        transfer_function = ([slope, constant], [1.0, damping, stiffness])
        numerator, denominator, _ = cont2discrete(
            transfer_function, 1.0 / overload.rate, method="foh"
        )
        response[begin:] += lfilter(np.ravel(numerator), denominator, overload.excess[begin:end])
    return _placed(response[::oversampling], overload.first // oversampling, count)


def _placed(values: Floats, first: int, count: int) -> Floats:
    """Return samples 0 to `count` of values that begin with sample `first`, zero elsewhere."""
    samples = np.zeros(count)
    inside = slice(max(first, 0), min(first + len(values), count))
    samples[inside] = values[inside.start - first : inside.stop - first]
    return samples
