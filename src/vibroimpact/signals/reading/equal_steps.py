"""Sampling rate of a column of times, and samples at equal steps where the times are
rounded or jitter.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.errors import InputError

_LARGEST_SHIFT = 0.1
"""Largest distance of a time from equal steps, as a part of a step: times are written
with few digits.
"""
_LONGEST_STEP, _LARGEST_JITTER = 3.0, 0.5
"""Longest step, and standard deviation of steps, over their median, of times that jitter;
others are those of a history, or have gaps.
"""
_ROUNDED = 0.75
"""Largest distance of rounded times from equal steps, in units of their last digit: a
half, and what is uncertain of the steps.
"""
_WHOLE = 1e-3
"""Distance from a multiple of the last digit, as a part of it, that is none."""
_MOST_DIGITS = 9
"""Largest number of significant digits of times that are sought."""
_THEY_MUST = "they must rise by equal steps"
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


def rate_of(time: Floats, lines: Sequence[int] | None = None) -> float:
    """Return the rate of samples at equal steps [Hz].

    Parameters
    ----------
    time : array, shape (samples,)
        Times of the samples [s].
    lines : sequence of int, optional
        Their lines in a file, for messages.

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
        raise InputError("a record needs two samples or more, as the rate follows from their times")
    step = (time[-1] - time[0]) / (len(time) - 1)
    back = np.flatnonzero(np.diff(time) < 0.0)
    if back.size:
        at = int(back[0])
        above = "the previous one" if lines is None else "the one above"
        words = (
            f"{_sample(at + 1, lines)} is {time[at] - time[at + 1]:.3g} s before {above}, at "
            f"{time[at + 1]:.9g} s"
        )
        several = "if the file has several records, one below the other, keep one of them"
        raise InputError(
            f"the times do not rise: {words}; {_THEY_MUST if lines is None else several}"
        )
    if not (step > 0.0 and np.isfinite(step)):
        remedy = _THEY_MUST if lines is None else "write them with more digits"
        raise InputError(f"the times do not rise: all are {time[0]:.9g} s; {remedy}")
    shift = np.abs(time - (time[0] + step * np.arange(len(time)))) / step
    worst = int(np.argmax(shift))
    if not shift[worst] <= _LARGEST_SHIFT:
        longest = int(np.argmax(np.diff(time))) + 1
        words = f"{_sample(worst, lines)} is {shift[worst]:.2g} steps off its place"
        gap = (
            f"the longest step, {time[longest] - time[longest - 1]:.4g} s, leads to "
            f"{_sample(longest, lines)}"
        )
        raise InputError(
            f"the times do not rise by equal steps: {words}, and {gap}; keep the part "
            "before or after it, or resample the record"
        )
    return float(f"{1.0 / step:.12g}")  # the digits that times have


def is_regular(time: Floats) -> bool:
    """Return whether times rise by equal steps.

    Examples
    --------
    >>> is_regular(np.array([0.0, 1.0, 2.0])), is_regular(np.array([0.0, 1.0, 3.0]))
    (True, False)
    """
    try:
        rate_of(time)
    except InputError:
        return False
    return True


def at_equal_steps(
    time: Floats, values: Sequence[Floats], lines: Sequence[int] | None = None
) -> Sampled:
    """Return channels at equal steps: as they are, if their times are or are only rounded;
    resampled, if they jitter.

    Samples that have the time of the one before and all its values are left out, where others have
    neither: a logger wrote them twice.

    Parameters
    ----------
    time : array, shape (samples,)
        Times of the samples [s].
    values : sequence of array
        The channels.
    lines : sequence of int, optional
        The lines of the samples in a file, for messages.

    Raises
    ------
    InputError
        If there are fewer than two times, they do not rise, or their steps differ by more than
        jitter.

    Examples
    --------
    >>> time = np.arange(100) / 400.0
    >>> found = at_equal_steps(np.round(time, 2), [time])
    >>> round(found.rate, 1), found.doubts[0][:41]
    (399.8, 'its times are rounded to 0.01 s, 4 steps;')
    """
    try:
        return Sampled(rate_of(time, lines), float(time[0]), list(values), ("",) * len(values))
    except InputError:
        step = np.diff(time)
        if not (step >= 0.0).all() or not (step > 0.0).any():
            raise
        twice, words = written_twice(time, values, lines)
        if words:
            kept = at_equal_steps(
                time[~twice],
                [one[~twice] for one in values],
                None if lines is None else np.asarray(lines)[~twice].tolist(),
            )
            return kept._replace(
                doubts=tuple(f"{words}; {doubt}" if doubt else words for doubt in kept.doubts)
            )
        if len(time) < _FEWEST:
            raise
        place = np.arange(len(time))
        slope, begin = np.polyfit(place, time, 1).tolist()
        last_digit = float(step[step > _WHOLE * step.max()].min(initial=np.inf))
        multiple = (time - time[0]) / last_digit
        off = np.abs(time - begin - slope * place).max()
        is_rounded = (
            np.abs(multiple - np.round(multiple)).max() < _WHOLE
            and off < _ROUNDED * last_digit
            and last_digit > slope * _LARGEST_SHIFT
        )
        # of steps that are no multiple of the last digit, such as 2 and 3 of it, the least is not
        # that digit
        if not is_rounded and (behind := behind_decimals(time)) is not None:
            is_rounded, last_digit = True, behind[1]
        if is_rounded:
            words = (
                f"its times are rounded to {last_digit:.3g} s, {last_digit / slope:.3g} steps; "
                "the equal steps behind them are taken"
            )
            unsure = 100.0 * last_digit / (time[-1] - time[0])
            return Sampled(
                1.0 / slope,
                begin,
                list(values),
                (f"{words}, which are known to {unsure:.2g} %",) * len(values),
            )
        if (rounded := _to_significant_digits(time, begin + slope * place)) is not None:
            digits, last_digit = rounded
            words = (
                f"its times are rounded to {digits} significant digits, up to {last_digit:.3g} "
                f"s, {last_digit / slope:.3g} steps"
            )
            unsure = 100.0 * last_digit / (time[-1] - time[0])
            words += f"; the equal steps behind them are taken, which are known to {unsure:.2g} %"
            return Sampled(1.0 / slope, begin, list(values), (words,) * len(values))
        middle = float(np.median(step))
        if not (
            (step > 0.0).all()
            and step.max() <= _LONGEST_STEP * middle
            and step.std() <= _LARGEST_JITTER * middle
        ):
            raise
    return _resampled(time, values)


def behind_decimals(time: Floats) -> tuple[Floats, float] | None:
    """Return the equal steps behind times that are rounded to some decimals, and the last of these
    [s]; None if they are not.

    Examples
    --------
    >>> exact = 0.0013 + np.arange(200) / 240.0
    >>> found, last = behind_decimals(np.round(exact, 3))
    >>> last, bool(np.abs(found - exact).max() < 1e-4)
    (0.001, True)
    >>> behind_decimals(exact) is None
    True
    """
    if len(time) < _FEWEST:
        return None
    place = np.arange(len(time))
    slope, begin = np.polyfit(place, time, 1).tolist()
    regular = begin + slope * place
    off = float(np.abs(time - regular).max())
    for decimals in range(_MOST_DIGITS):
        last = 10.0**-decimals
        if np.abs(time / last - np.round(time / last)).max() < _WHOLE:
            # what is off by less than that is equal steps already
            return (regular, last) if _WHOLE * last < off < _ROUNDED * last else None
    return None


def _to_significant_digits(time: Floats, regular: Floats) -> tuple[int, float] | None:
    """Return to how many digits times are rounded, as programs do that write %.6g, and
    the largest step of this; None if they are not.
    """
    power = np.floor(np.log10(np.where(time == 0.0, 1.0, np.abs(time))))
    for digits in range(2, _MOST_DIGITS + 1):
        last = 10.0 ** (power - digits + 1)
        if np.all(np.abs(time / last - np.round(time / last)) < _WHOLE):
            is_rounded = np.abs(time - regular) <= np.maximum(
                _ROUNDED * last, _LARGEST_SHIFT * (regular[1] - regular[0])
            )
            return (digits, float(last.max())) if np.all(is_rounded | (time == 0.0)) else None
    return None


def _sample(place: int, lines: Sequence[int] | None) -> str:
    """Return the name of a sample in messages."""
    return f"sample {place + 1}" if lines is None else f"sample {place + 1} (line {lines[place]})"


def written_twice(
    time: Floats, values: Sequence[Floats], lines: Sequence[int] | None = None
) -> tuple[Bools, str]:
    """Return which samples repeat the one before, and a sentence on them; "" if none does.

    All samples that have the time of the one before must have its values, which are not all one;
    else their times are rounded.
    """
    same_time = np.append(False, np.diff(time) == 0.0)
    same = (
        np.append(False, np.logical_and.reduce([np.diff(one) == 0.0 for one in values])) & same_time
    )
    changes = any(np.any(np.diff(one)[~same_time[1:]] != 0.0) for one in values)
    if not (same.any() and changes and np.array_equal(same, same_time)):
        return np.zeros(len(time), dtype=bool), ""
    count = int(same.sum())
    have = "samples have" if count > 1 else "sample has"
    are = "they are" if count > 1 else "it is"
    first = _sample(int(np.argmax(same)), lines)
    return (
        same,
        f"{count} {have} time and value of the one before, the first is {first}: {are} left out",
    )


def _resampled(time: Floats, values: Sequence[Floats]) -> Sampled:
    """Return channels by cubic splines at the mean step, with the difference from
    straight lines as what that may add.
    """
    from scipy.interpolate import CubicSpline

    count = len(time)
    new = np.linspace(time[0], time[-1], count)
    found = [np.asarray(CubicSpline(time, one)(new)) for one in values]
    doubts = []
    for one, value in zip(values, found, strict=True):
        size = float(np.std(one))
        part = (
            float(np.sqrt(np.mean((value - np.interp(new, time, one)) ** 2))) / size
            if size
            else 0.0
        )
        jitter = 100.0 * float(np.std(np.diff(time))) * (count - 1) / (time[-1] - time[0])
        words = (
            f"its times jitter by {jitter:.2g} % of a step; it is resampled to equal steps, "
            "which adds an rms error of up to"
        )
        doubts.append(
            f"{words} {100.0 * part:.2g} % of its standard deviation, where its "
            "frequencies are below a third of the rate"
        )
    return Sampled((count - 1) / float(time[-1] - time[0]), float(time[0]), found, tuple(doubts))
