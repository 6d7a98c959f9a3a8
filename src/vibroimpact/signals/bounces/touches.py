"""Touches in a record: where its power rises at once, beside what it was before."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices
from vibroimpact.signals.record import Record

WINDOW = 2e-3
"""Time before and after a touch over which the power is compared [s]."""

FEWEST = 8
"""Least number of samples of that time."""

_HUM_CUT_OFF = 500.0
"""Cut-off of the filter that takes away hum [Hz].

Mains and their harmonics lie below, the sound of impacts above.
"""

_HUM_ORDER = 4
"""Order of that filter."""

_RISE_FACTOR = 5.5
"""Least rise of the logarithm of the power, in standard deviations of its fluctuation."""

_LEAST_RISE = 1.0
"""Least rise of the logarithm of the power, of any signal."""

_FLOOR = 1e-8
"""Power below which nothing is heard, as part of the largest."""

_FLOOR_OF_CODED = 1e-3
"""The same of sound that is coded with losses, where what is quieter is left out or added."""

_QUIET = 1e-4
"""Part of the mean power around a touch below which a change of the power is none.

Filters of recorders sound before a touch.
"""

_CLICK_SAMPLES = 3
"""Samples in a row that hold most of the energy of a click; the sound of a touch lasts longer."""

_CLICK_PART = 0.7
"""Part of the energy, above that of the noise, that they hold."""

MOST = 80
"""Touches that are kept, the clearest ones."""


class Touches(NamedTuple):
    """Sudden rises of the power, in the order of time.

    Parameters
    ----------
    sample : array of int, shape (n,)
        The sample at which each begins.
    rise : array, shape (n,)
        Rise of the natural logarithm of the power there.
    click : array of bool, shape (n,)
        Whether its energy lies in three samples: that is no sound.
    threshold : float
        The least rise that counts.
    """

    sample: Indices
    rise: Floats
    click: NDArray[np.bool_]
    threshold: float


def without_hum(record: Record) -> Floats:
    """Return the samples of a record above 500 Hz, or above an eighth of a lower rate.

    The filter looks only back: an impact does not sound before it begins.

    Examples
    --------
    >>> hum = Record("microphone", np.sin(100.0 * np.pi * np.arange(4800) / 48e3), 48e3, "Pa")
    >>> float(np.abs(without_hum(hum)[2400:]).max()) < 2e-4
    True
    """
    from scipy.signal import butter, sosfilt, sosfilt_zi

    sections = butter(
        _HUM_ORDER, min(_HUM_CUT_OFF, record.rate / 8.0), "highpass", fs=record.rate, output="sos"
    )
    return np.asarray(sosfilt(sections, record.value, zi=sosfilt_zi(sections) * record.value[0])[0])


def find_touches(value: Floats, rate: float, blur: float = 0.0) -> Touches:
    """Return the touches in samples from which hum is taken away.

    The logarithm of the power over 2 ms after each sample is compared with that over 2 ms before.
    Its fluctuation, by which the threshold is set, is that of noise, or of what sounds on.

    Parameters
    ----------
    value : array, shape (samples,)
        The samples.
    rate : float
        Their rate [Hz].
    blur : float, default 0
        Time over which a coder spread what begins suddenly [s].

    Examples
    --------
    >>> time = np.arange(4800) / 48e3
    >>> taps = sum(
    ...     np.where(
    ...         time >= at, np.exp(-(time - at).clip(0.0) / 2e-3) * np.sin(2e4 * (time - at)), 0.0
    ...     )
    ...     for at in (0.03, 0.06)
    ... )
    >>> (find_touches(taps, 48e3).sample / 48e3).round(3).tolist()
    [0.03, 0.06]
    """
    from scipy.signal import find_peaks

    window = max(FEWEST, round(WINDOW * rate))
    no_touches = Touches(
        np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0, dtype=bool), _LEAST_RISE
    )
    if len(value) < 3 * window:
        return no_touches
    energy_before = np.concatenate([[0.0], np.cumsum(value**2)])
    # over the window that begins at each sample
    power = energy_before[window:] - energy_before[:-window]
    relative_floor = _FLOOR_OF_CODED if blur else _FLOOR
    floor = relative_floor * float(power.max())
    if not floor > 0.0:
        return no_touches
    level = np.log(np.maximum(power, floor))
    rise = level[window:] - level[:-window]  # at samples from the end of the first window on
    # the median deviation of normal numbers is their standard deviation over 1.4826
    fluctuation = 1.4826 * float(np.median(np.abs(rise - np.median(rise))))
    # that of white noise is about 2 / sqrt(window)
    fluctuation = max(fluctuation, 2.0 / np.sqrt(window))
    threshold = max(_LEAST_RISE, _RISE_FACTOR * fluctuation)
    peaks, _ = find_peaks(rise, height=threshold, distance=window, plateau_size=1)
    clearest = np.argsort(-rise[peaks], kind="stable")[:MOST]
    peaks = np.sort(peaks[clearest])
    # the power rises most where one window ends and the next begins
    change_points = [_change_point(value, int(peak) + window, window) for peak in peaks]
    begins = np.array(change_points, dtype=np.intp)
    click = np.array([_is_click(value, int(begin), window) for begin in begins], dtype=bool)
    return Touches(begins, rise[peaks], click, threshold)


def _is_click(value: Floats, begin: int, window: int) -> bool:
    """Return whether a few samples hold most of the energy that a touch adds."""
    before = value[max(begin - window, 0) : begin] ** 2
    after = value[max(begin, 0) : begin + window] ** 2
    shortly = float(np.convolve(after, np.ones(_CLICK_SAMPLES)).max())
    return shortly > _CLICK_PART * float(after.sum() - before.sum())


def _change_point(value: Floats, near: int, window: int) -> int:
    """Return the sample near another at which the variance most likely changes.

    That is the maximum likelihood of Gaussian samples, of one variance before and one after.
    """
    first = near - window
    energy = np.cumsum(value[first : near + 2 * window] ** 2)
    count = len(energy)
    fewest = max(2, window // 8)
    split = np.arange(fewest, min(2 * window, count - fewest))
    quiet = _QUIET * energy[-1] / count
    variance_before = energy[split - 1] / split
    variance_after = (energy[-1] - energy[split - 1]) / (count - split)
    # minus twice the logarithm of the likelihood, apart from constants
    cost = split * np.log(variance_before + quiet) + (count - split) * np.log(
        variance_after + quiet
    )
    return first + int(split[np.argmin(cost)])
