"""How much later records are than their simulation: all of them together, and channels
that were not sampled with the others.
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
_SURE, _BETTER = 0.85, 0.05
"""Correlation coefficient from which on a record has a delay of its own, and by how much
it is larger than with the common one.
"""
_NEAR = 2.0
"""Samples about the lag that is found, within which it is found to a part of one."""


def aligned_time(rate: float, length: float) -> float:
    """Return the time from the first touch on by which records of a rate and a length are aligned
    [s].

    Examples
    --------
    >>> aligned_time(51200.0, 0.1), aligned_time(6400.0, 0.1), aligned_time(51200.0, 0.002)
    (0.005, 0.01, 0.002)
    """
    return max(LEAST / rate, min(ALIGNED, length))


def delay_of(
    acquired: Acquired, simulated: Floats, band: tuple[float, float], length: float
) -> tuple[Delay, Floats]:
    """Return how much later the records are than the simulation, by what begins at the first touch,
    and how much later each is still.

    Channels that were not sampled together have delays of their own: the common one is then that of
    the record which comes when it should, as far as a force tells that, and otherwise of that which
    is most like its simulation.
    """
    rate = acquired.rate
    reach = round(aligned_time(rate, length) * rate)
    first = max(0, acquired.onsets[0] - LEAD - reach)
    last = acquired.onsets[0] + reach
    fade = np.ones(last - first)
    end = reach // 2
    fade[-end:] = 0.5 + 0.5 * np.cos(np.pi * (np.arange(end) + 0.5) / end)
    later, earlier = (
        fade[: one.shape[1]] * one
        for one in (acquired.value[:, first:last], simulated[:, first:last])
    )
    common = delay_between(later, earlier, rate, band, reach / rate)
    each = [
        _own_delay(whole, other, slice(first, last), fade, rate, band)
        for whole, other in zip(acquired.value, simulated, strict=True)
    ]
    times, alike = (
        np.array([one.time for one in each]),
        np.array([one.correlation[0] for one in each]),
    )
    apart = (
        (np.abs(times - common.time) * rate > _TOGETHER)
        & (alike > _SURE)
        & (alike > common.correlation + _BETTER)
    )
    if not apart.any():
        return common, np.zeros(len(times))
    sure = np.flatnonzero(alike > _SURE)
    chosen = sure[
        np.argmin(np.abs(times[sure])) if acquired.force is not None else np.argmax(alike[sure])
    ]
    skew = np.where(alike > _SURE, times - times[chosen], 0.0)
    polarity, gain = (
        np.array([getattr(one, name)[0] for one in each]) for name in ("polarity", "gain")
    )
    return Delay(float(times[chosen]), polarity, alike, gain), np.where(
        np.abs(skew) * rate > _TOGETHER, skew, 0.0
    )


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
    reach, weight = len(fade) // 2, fade[: len(simulated[window])] ** 2
    ahead = min(window.start, reach)
    heard = band_limited(value[window.start - ahead : window.stop + reach], rate, band)
    expected = weight * band_limited(simulated[window], rate, band)
    together = fftconvolve(heard, expected[::-1], "valid")
    power = fftconvolve(heard**2, weight[::-1], "valid")
    moved = (
        int(np.argmax(np.abs(together) / np.sqrt(np.maximum(power, 1e-12 * power.max() + 1e-300))))
        - ahead
    )
    begin = window.start + moved
    piece = np.sqrt(weight) * value[begin : begin + len(weight)]
    found = delay_between(
        piece[None], (np.sqrt(weight) * simulated[window])[None], rate, band, _NEAR / rate
    )
    return found._replace(time=found.time + moved / rate)
