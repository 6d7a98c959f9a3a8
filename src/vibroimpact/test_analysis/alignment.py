"""How much later records are than their simulation.

All of them together are, and channels that were not sampled with the others.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import fftconvolve

from vibroimpact.arrays import Floats
from vibroimpact.signals.delay import Delay, band_limited, delay_between
from vibroimpact.test_analysis.acquired import LEAD, Acquired

ALIGNED = 5e-3
"""Time from the first touch on by which records are aligned, if it has samples enough [s]: later,
small errors of frequencies have added up.
"""

LEAST = 64
"""Least number of samples from the first touch on, also of those by which records are aligned."""

_TOGETHER = 0.5
"""Distance of the delays of two records that is none, in samples."""

_SURE = 0.85
_BETTER = 0.05
"""Correlation coefficient from which on a record has a delay of its own, and by how much it is
larger than with the common one.
"""

_NEAR = 2.0
"""Samples about the lag that is found, within which it is found to a part of one."""


def aligned_time(rate: float, length: float) -> float:
    """Return the time from the first touch on by which records are aligned [s].

    `rate` is theirs [Hz], and `length` the time that is compared [s].

    Examples
    --------
    >>> aligned_time(51200.0, 0.1), aligned_time(6400.0, 0.1), aligned_time(51200.0, 0.002)
    (0.005, 0.01, 0.002)
    """
    return max(LEAST / rate, min(ALIGNED, length))


def delay_of(
    acquired: Acquired, simulated: Floats, band: tuple[float, float], length: float
) -> tuple[Delay, Floats]:
    """Return how much later the records are than the simulation, and how much later each is still.

    It is found by what begins at the first touch. Channels that were not sampled together have
    delays of their own: the common one is then that of the record which comes when it should, as
    far as a force tells that, and otherwise of that which is most like its simulation.
    """
    rate = acquired.rate
    aligned_samples = round(aligned_time(rate, length) * rate)
    onset = acquired.onsets[0]
    window = slice(max(0, onset - LEAD - aligned_samples), onset + aligned_samples)
    fade = _fade(window.stop - window.start, aligned_samples // 2)
    measured_start = acquired.value[:, window]
    simulated_start = simulated[:, window]
    common = delay_between(
        fade[: measured_start.shape[1]] * measured_start,
        fade[: simulated_start.shape[1]] * simulated_start,
        rate,
        band,
        aligned_samples / rate,
    )
    own_delays = [
        _own_delay(measured_signal, simulated_signal, window, fade, rate, band)
        for measured_signal, simulated_signal in zip(acquired.value, simulated, strict=True)
    ]
    times = np.array([delay.time for delay in own_delays])
    correlation = np.array([delay.correlation[0] for delay in own_delays])
    sure = correlation > _SURE
    has_own_delay = (
        (np.abs(times - common.time) * rate > _TOGETHER)
        & sure
        & (correlation > common.correlation + _BETTER)
    )
    if not has_own_delay.any():
        return common, np.zeros(len(times))
    candidates = np.flatnonzero(sure)
    if acquired.force is not None:
        # sampled with the force, a record is as late as its simulation under that force
        reference = candidates[np.argmin(np.abs(times[candidates]))]
    else:
        reference = candidates[np.argmax(correlation[candidates])]
    # a record unlike its simulation has no delay to go by, and one of less than half a sample none
    skew = np.where(sure, times - times[reference], 0.0)
    skew = np.where(np.abs(skew) * rate > _TOGETHER, skew, 0.0)
    polarity = np.array([delay.polarity[0] for delay in own_delays])
    gain = np.array([delay.gain[0] for delay in own_delays])
    return Delay(float(times[reference]), polarity, correlation, gain), skew


def _fade(samples: int, fading: int) -> Floats:
    """Return weights that are 1, and fall to 0 over the last samples."""
    weights = np.ones(samples)
    weights[-fading:] = 0.5 + 0.5 * np.cos(np.pi * (np.arange(fading) + 0.5) / fading)
    return weights


def _own_delay(
    value: Floats,
    simulated: Floats,
    window: slice,
    fade: Floats,
    rate: float,
    band: tuple[float, float],
) -> Delay:
    """Return how much later one record is than its simulation.

    At each lag the same part of it is compared: what of a late record would be missing in one
    window would move the delay.
    """
    reach = len(fade) // 2
    expected_start = simulated[window]
    # the fade acts on both signals, and so as its square on their products
    weight = fade[: len(expected_start)] ** 2
    ahead = min(window.start, reach)
    measured = band_limited(value[window.start - ahead : window.stop + reach], rate, band)
    expected = weight * band_limited(expected_start, rate, band)
    # Correlation with the simulation over the norm of the record, at each lag. The norm of the
    # simulation is the same at all of them.
    products = fftconvolve(measured, expected[::-1], "valid")
    power = fftconvolve(measured**2, weight[::-1], "valid")
    least_power = 1e-12 * power.max() + 1e-300
    similarity = np.abs(products) / np.sqrt(np.maximum(power, least_power))
    lag = int(np.argmax(similarity)) - ahead
    # then to a part of a sample, about this lag
    begin = window.start + lag
    piece = np.sqrt(weight) * value[begin : begin + len(weight)]
    weighted = np.sqrt(weight) * expected_start
    delay = delay_between(piece[None], weighted[None], rate, band, _NEAR / rate)
    return delay._replace(time=delay.time + lag / rate)
