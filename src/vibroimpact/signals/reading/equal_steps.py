"""Sampling rate of a column of times, and samples at equal steps where the times are rounded or jitter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError

_LARGEST_SHIFT = 0.1
"""Largest distance of a time from equal steps, as a part of a step: times are written with few digits."""
_LONGEST_STEP, _LARGEST_JITTER = 3.0, 0.5
"""Longest step, and standard deviation of steps, over their median, of times that jitter; others are those of a history, or have gaps."""
_ROUNDED = 0.75
"""Largest distance of rounded times from equal steps, in units of their last digit: a half, and what is uncertain of the steps."""
_WHOLE = 1e-3
"""Distance from a multiple of the last digit, as a part of it, that is none."""
_FEWEST = 16
"""Least number of times whose rounding or jitter is told."""


class Sampled(NamedTuple):
    """Samples at equal steps.

    Parameters
    ----------
    rate : float
        Sampling rate [Hz].
    start : float
        Time of the first sample [s].
    values : list of array
        The channels.
    doubts : tuple of str
        For each channel a sentence on what was done to its times; "" if nothing was.
    """

    rate: float
    start: float
    values: list[Floats]
    doubts: tuple[str, ...]


def rate_of(time: Floats) -> float:
    """Return the rate of samples at equal steps [Hz].

    Raises
    ------
    InputError
        If there are fewer than two times, or they do not rise by equal steps.

    Examples
    --------
    >>> rate_of(np.array([0.0, 0.001, 0.002]))
    1000.0
    """
    if len(time) < 2:
        raise InputError("a record has two samples or more; the rate follows from their times")
    step = (time[-1] - time[0]) / (len(time) - 1)
    if not (step > 0.0 and np.isfinite(step)):
        raise InputError("the times do not rise")
    shift = np.abs(time - (time[0] + step * np.arange(len(time)))) / step
    worst = int(np.argmax(shift))
    if not shift[worst] <= _LARGEST_SHIFT:
        raise InputError(
            f"the times do not rise by equal steps: sample {worst + 1} is {shift[worst]:.2g} steps off its place; resample the record"
        )
    return float(f"{1.0 / step:.12g}")  # the digits that times have


def at_equal_steps(time: Floats, values: Sequence[Floats]) -> Sampled:
    """Return channels at equal steps: as they are, if their times are or are only rounded; resampled, if they jitter.

    Parameters
    ----------
    time : array, shape (samples,)
        Times of the samples [s].
    values : sequence of array
        The channels.

    Raises
    ------
    InputError
        If there are fewer than two times, they do not rise, or their steps differ by more than jitter.

    Examples
    --------
    >>> time = np.arange(100) / 400.0
    >>> found = at_equal_steps(np.round(time, 2), [time])
    >>> round(found.rate, 1), found.doubts[0][:41]
    (399.8, 'its times are rounded to 0.01 s, 4 steps;')
    """
    try:
        return Sampled(rate_of(time), float(time[0]), list(values), ("",) * len(values))
    except InputError:
        step = np.diff(time)
        if len(time) < _FEWEST or not (step >= 0.0).all():
            raise
        place = np.arange(len(time))
        slope, begin = np.polyfit(place, time, 1).tolist()
        last_digit = float(step[step > _WHOLE * step.max()].min(initial=np.inf))
        multiple = (time - time[0]) / last_digit
        off = np.abs(time - begin - slope * place).max()
        if np.abs(multiple - np.round(multiple)).max() < _WHOLE and off < _ROUNDED * last_digit and last_digit > slope * _LARGEST_SHIFT:
            words = f"its times are rounded to {last_digit:.3g} s, {last_digit / slope:.3g} steps; the equal steps behind them are taken"
            unsure = 100.0 * last_digit / (time[-1] - time[0])
            return Sampled(1.0 / slope, begin, list(values), (f"{words}, which are known to {unsure:.2g} %",) * len(values))
        middle = float(np.median(step))
        if not ((step > 0.0).all() and step.max() <= _LONGEST_STEP * middle and step.std() <= _LARGEST_JITTER * middle):
            raise
    return _resampled(time, values)


def _resampled(time: Floats, values: Sequence[Floats]) -> Sampled:
    """Return channels by cubic splines at the mean step, with the difference from straight lines as what that may add."""
    from scipy.interpolate import CubicSpline

    count = len(time)
    new = np.linspace(time[0], time[-1], count)
    found = [np.asarray(CubicSpline(time, one)(new)) for one in values]
    doubts = []
    for one, value in zip(values, found, strict=True):
        size = float(np.std(one))
        part = float(np.sqrt(np.mean((value - np.interp(new, time, one)) ** 2))) / size if size else 0.0
        jitter = 100.0 * float(np.std(np.diff(time))) * (count - 1) / (time[-1] - time[0])
        words = f"its times jitter by {jitter:.2g} % of a step; it is resampled to equal steps, which adds an error of up to"
        doubts.append(f"{words} {100.0 * part:.2g} % of its standard deviation (rms)")
    return Sampled((count - 1) / float(time[-1] - time[0]), float(time[0]), found, tuple(doubts))
