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

_LOWEST, _ORDER = 500.0, 4
"""Cut-off [Hz] and order of the filter that takes away hum: mains and their harmonics lie
below, the sound of impacts above.
"""

_ABOVE, _LEAST = 5.5, 1.0
"""Least rise of the logarithm of the power: in standard deviations of its fluctuation,
and of any signal.
"""

_FLOOR = 1e-8
"""Power below which nothing is heard, as part of the largest."""

_FLOOR_OF_CODED = 1e-3
"""The same of sound that is coded with losses, where what is quieter is left out or added."""

_QUIET = 1e-4
"""Part of the mean power around a touch below which a change of the power is none:
filters of recorders sound before a touch.
"""

_CLICK, _PART = 3, 0.7
"""Samples in a row that hold so much of the energy of a click, above that of the noise;
the sound of a touch lasts longer.
"""

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
        _ORDER, min(_LOWEST, record.rate / 8.0), "highpass", fs=record.rate, output="sos"
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
    none = Touches(np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0, dtype=bool), _LEAST)
    if len(value) < 3 * window:
        return none
    summed = np.concatenate([[0.0], np.cumsum(value**2)])
    power = summed[window:] - summed[:-window]  # over the window that begins at each sample
    floor = (_FLOOR_OF_CODED if blur else _FLOOR) * float(power.max())
    if not floor > 0.0:
        return none
    level = np.log(np.maximum(power, floor))
    rise = level[window:] - level[:-window]  # at samples from the end of the first window on
    spread = 1.4826 * float(np.median(np.abs(rise - np.median(rise))))
    threshold = max(_LEAST, _ABOVE * max(spread, 2.0 / np.sqrt(window)))
    found, _ = find_peaks(rise, height=threshold, distance=window, plateau_size=1)
    found = np.sort(found[np.argsort(-rise[found], kind="stable")[:MOST]])
    begins = np.array([_begin(value, int(at) + window, window) for at in found], dtype=np.intp)
    click = np.array([_is_click(value, int(at), window) for at in begins], dtype=bool)
    return Touches(begins, rise[found], click, threshold)


def _is_click(value: Floats, begin: int, window: int) -> bool:
    """Return whether a few samples hold what energy a touch adds."""
    before, after = (
        value[max(first, 0) : first + window] ** 2 for first in (begin - window, begin)
    )
    return float(np.convolve(after, np.ones(_CLICK)).max()) > _PART * float(
        after.sum() - before.sum()
    )


def _begin(value: Floats, near: int, window: int) -> int:
    """Return the sample near another at which the variance most likely changes (maximum
    likelihood of Gaussian samples).
    """
    first = near - window
    power = np.cumsum(value[first : near + 2 * window] ** 2)
    count = np.arange(1, len(power) + 1)
    fewest = max(2, window // 8)
    split = np.arange(fewest, min(2 * window, len(power) - fewest))
    tiny = _QUIET * power[-1] / len(power)
    before, after = power[split - 1] / split, (power[-1] - power[split - 1]) / (count[-1] - split)
    cost = split * np.log(before + tiny) + (count[-1] - split) * np.log(after + tiny)
    return first + int(split[np.argmin(cost)])
