"""Sampling rate of a column of times, and equal steps behind times that are rounded or jitter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.errors import InputError

_LARGEST_SHIFT = 0.1
"""Largest distance of a time from equal steps, as a part of a step.

Times are written with few digits.
"""
_LONGEST_STEP = 3.0
"""Longest step, over their median, of times that jitter.

Others are those of a history, or have gaps.
"""
_LARGEST_JITTER = 0.5
"""Standard deviation of steps, over their median, of times that jitter."""
_ROUNDED = 0.75
"""Largest distance of rounded times from equal steps, in units of their last digit.

It is a half, and what is uncertain of the steps.
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
    backwards = np.flatnonzero(np.diff(time) < 0.0)
    if backwards.size:
        earlier = int(backwards[0])
        later = earlier + 1
        if lines is None:
            above = "the previous one"
            remedy = _THEY_MUST
        else:
            above = "the one above"
            remedy = "if the file has several records, one below the other, keep one of them"
        raise InputError(
            f"the times do not rise: {_sample(later, lines)} is "
            f"{time[earlier] - time[later]:.3g} s before {above}, at {time[later]:.9g} s; {remedy}"
        )
    if not (step > 0.0 and np.isfinite(step)):
        remedy = _THEY_MUST
        if lines is not None:
            remedy = "write them with more digits"
        raise InputError(f"the times do not rise: all are {time[0]:.9g} s; {remedy}")
    shift = np.abs(time - (time[0] + step * np.arange(len(time)))) / step
    worst = int(np.argmax(shift))
    if not shift[worst] <= _LARGEST_SHIFT:
        longest = int(np.argmax(np.diff(time))) + 1
        raise InputError(
            f"the times do not rise by equal steps: {_sample(worst, lines)} is "
            f"{shift[worst]:.2g} steps off its place, and the longest step, "
            f"{time[longest] - time[longest - 1]:.4g} s, leads to {_sample(longest, lines)}; keep "
            "the part before or after it, or resample the record"
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
    """Return channels at equal steps.

    They stay as they are, if their times have equal steps or are only rounded; they are resampled,
    if their times jitter. Samples that have the time of the one before and all its values are left
    out, where others have neither: a logger wrote them twice.

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
        twice, left_out = written_twice(time, values, lines)
        if left_out:
            return _without_repeated(time, values, lines, twice, left_out)
        if len(time) < _FEWEST:
            raise
        rounded = _rounded_times(time)
        if rounded is not None:
            return Sampled(
                1.0 / rounded.step, rounded.start, list(values), (rounded.doubt,) * len(values)
            )
        if not _jitters(step):
            raise
    return _resampled(time, values)


def _without_repeated(
    time: Floats,
    values: Sequence[Floats],
    lines: Sequence[int] | None,
    twice: Bools,
    left_out: str,
) -> Sampled:
    """Return channels at equal steps without samples that were written twice, with that doubt."""
    if lines is not None:
        lines = np.asarray(lines)[~twice].tolist()
    once = at_equal_steps(time[~twice], [value[~twice] for value in values], lines)
    doubts = [f"{left_out}; {doubt}" if doubt else left_out for doubt in once.doubts]
    return once._replace(doubts=tuple(doubts))


def _jitters(step: Floats) -> bool:
    """Return whether steps differ by no more than jitter."""
    median = float(np.median(step))
    return bool(
        (step > 0.0).all()
        and step.max() <= _LONGEST_STEP * median
        and step.std() <= _LARGEST_JITTER * median
    )


class _EqualSteps(NamedTuple):
    """The equal steps behind rounded times [s], with a doubt."""

    start: float
    step: float
    doubt: str


def _rounded_times(time: Floats) -> _EqualSteps | None:
    """Return the equal steps behind times that are rounded; None if they are not."""
    number = np.arange(len(time))
    step, start = np.polyfit(number, time, 1).tolist()
    digits = ""
    last_digit = _last_digit(time, start, step)
    if last_digit is None:
        # of steps that are no multiple of the last digit, such as 2 and 3 of it, the least is not
        # that digit
        behind = behind_decimals(time)
        if behind is not None:
            _, last_digit = behind
    if last_digit is None:
        significant = _to_significant_digits(time, start + step * number)
        if significant is None:
            return None
        count, last_digit = significant
        digits = f"{count} significant digits, up to "
    uncertainty = 100.0 * last_digit / (time[-1] - time[0])
    doubt = (
        f"its times are rounded to {digits}{last_digit:.3g} s, {last_digit / step:.3g} steps; "
        f"the equal steps behind them are taken, which are known to {uncertainty:.2g} %"
    )
    return _EqualSteps(start, step, doubt)


def _last_digit(time: Floats, start: float, step: float) -> float | None:
    """Return the least step of times, of which all are multiples where they are rounded; or None.

    The equal steps behind them are given.
    """
    steps = np.diff(time)
    least = float(steps[steps > _WHOLE * steps.max()].min(initial=np.inf))
    multiple = (time - time[0]) / least
    if not np.abs(multiple - np.round(multiple)).max() < _WHOLE:
        return None
    distance = np.abs(time - start - step * np.arange(len(time))).max()
    if distance < _ROUNDED * least and least > step * _LARGEST_SHIFT:
        return least
    return None


def behind_decimals(time: Floats) -> tuple[Floats, float] | None:
    """Return the equal steps behind times that are rounded to some decimals; None if they are not.

    With them comes the last of these decimals [s].

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
    number = np.arange(len(time))
    step, start = np.polyfit(number, time, 1).tolist()
    regular = start + step * number
    distance = float(np.abs(time - regular).max())
    for decimals in range(_MOST_DIGITS):
        last_digit = 10.0**-decimals
        multiple = time / last_digit
        if np.abs(multiple - np.round(multiple)).max() < _WHOLE:
            # what is off by less than that is equal steps already
            if _WHOLE * last_digit < distance < _ROUNDED * last_digit:
                return regular, last_digit
            return None
    return None


def _to_significant_digits(time: Floats, regular: Floats) -> tuple[int, float] | None:
    """Return to how many digits times are rounded, and the largest step of this; or None.

    Programs do that which write %.6g.
    """
    # zero has all digits, but no power of ten
    is_zero = time == 0.0
    power = np.floor(np.log10(np.where(is_zero, 1.0, np.abs(time))))
    for digits in range(2, _MOST_DIGITS + 1):
        last_digit = 10.0 ** (power - digits + 1)
        multiple = time / last_digit
        if np.all(np.abs(multiple - np.round(multiple)) < _WHOLE):
            shift = _LARGEST_SHIFT * (regular[1] - regular[0])
            largest = np.maximum(_ROUNDED * last_digit, shift)
            is_rounded = np.abs(time - regular) <= largest
            if np.all(is_rounded | is_zero):
                return digits, float(last_digit.max())
            return None
    return None


def _sample(index: int, lines: Sequence[int] | None) -> str:
    """Return the name of a sample in messages."""
    sample = f"sample {index + 1}"
    if lines is None:
        return sample
    return f"{sample} (line {lines[index]})"


def written_twice(
    time: Floats, values: Sequence[Floats], lines: Sequence[int] | None = None
) -> tuple[Bools, str]:
    """Return which samples repeat the one before, and a sentence on them; "" if none does.

    All samples that have the time of the one before must have its values, which are not all one;
    else their times are rounded.
    """
    same_time = np.append(False, np.diff(time) == 0.0)
    same_values = np.logical_and.reduce([np.diff(value) == 0.0 for value in values])
    same = np.append(False, same_values) & same_time
    changes = any(np.any(np.diff(value)[~same_time[1:]] != 0.0) for value in values)
    if not (same.any() and changes and np.array_equal(same, same_time)):
        return np.zeros(len(time), dtype=bool), ""
    count = int(same.sum())
    have = "samples have" if count > 1 else "sample has"
    are = "they are" if count > 1 else "it is"
    first = _sample(int(np.argmax(same)), lines)
    sentence = (
        f"{count} {have} time and value of the one before, the first is {first}: {are} left out"
    )
    return same, sentence


def _resampled(time: Floats, values: Sequence[Floats]) -> Sampled:
    """Return channels by cubic splines at the mean step.

    The difference from straight lines is what that may add, in the doubts.
    """
    from scipy.interpolate import CubicSpline

    count = len(time)
    equal_steps = np.linspace(time[0], time[-1], count)
    span = time[-1] - time[0]
    jitter = 100.0 * float(np.std(np.diff(time))) * (count - 1) / span
    resampled = []
    doubts = []
    for value in values:
        by_splines = np.asarray(CubicSpline(time, value)(equal_steps))
        difference = by_splines - np.interp(equal_steps, time, value)
        deviation = float(np.std(value))
        error = 0.0
        if deviation:
            error = float(np.sqrt(np.mean(difference**2))) / deviation
        resampled.append(by_splines)
        doubts.append(
            f"its times jitter by {jitter:.2g} % of a step; it is resampled to equal steps, "
            f"which adds an rms error of up to {100.0 * error:.2g} % of its standard deviation, "
            "where its frequencies are below a third of the rate"
        )
    return Sampled((count - 1) / float(span), float(time[0]), resampled, tuple(doubts))
