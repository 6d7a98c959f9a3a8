"""The baseline of a record: the level at which it rests, which an amplifier shifts and lets drift.

A record is baseline and vibration. Where it rests, only the baseline is left: blocks of samples are
compared by their scatter, and a constant, a line or an exponential on a constant is fitted to the
levels of those that are quiet. It is removed only if it stands out from what noise and slow
vibration do to these levels, so that a record without offset stays as it is, to the last digit.
Where a record begins at rest, the level there decides: what comes only with the impacts, such as
the motion of a free plate, is signal.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.quoting import quoted
from vibroimpact.signals.record import Record, Removed

_LEAST = 128
"""Samples below which no baseline is sought: a handful of blocks tells no rest from vibration."""
_BLOCKS, _IN_BLOCK = 128, 8
"""Largest number of blocks, and least number of samples of one."""
_QUIET_PART, _AS_QUIET, _QUIET_SHARE = 0.2, 3.0, 2e-3
"""Part of the blocks that is quiet in any case, the scatter over theirs up to which
others are too, and over that of the loudest.
"""
_PASSES = 3
"""How often a baseline is sought in what the one before left."""
_STERN = 3.0
"""Weight of a further parameter, over that of Schwarz' criterion: levels of slow
vibrations are no independent numbers.
"""
_REST = 0.15
"""Part of the blocks that must be quiet with their neighbours; with fewer a record is
nowhere at rest, and all its blocks count.
"""
_STEEP = 6.0
"""Median rise within quiet blocks, beside that of all, over the deviation of a level,
above which a vibration is slower than blocks.
"""
_CURVED, _NEAR = 3.0, 0.01
"""Variance by the likeness of neighbours from which on what a drift leaves is a curve,
and what of it is small beside the drift.
"""
_SURE = 4.0
"""Baseline over its standard deviation from which on it is removed."""
_NOTHING = 1e-6
"""Baseline over the largest magnitude of a record that is none: of filters and of rounding."""
_WIDE, _FOR_DRIFT = 0.8, 16
"""Part of the record that quiet blocks must span for a drift to be told, and their least number."""
_AT_REST = 3
"""Quiet blocks before the first loud one that make a rest before the first touch."""
_ALIKE = 1e-3
"""Distance of a fit from the level at rest, over the largest magnitude, up to which they
agree in any case.
"""
_BESIDE = 0.05
"""Largest magnitude of what is left, over the drift, below which the drift is the signal."""
_LARGE = 0.1
"""Baseline over the largest magnitude of what is left from which on it is doubted: a
threshold of a tenth would have met it.
"""


class _Levels(NamedTuple):
    """Levels of the blocks of a signal: centres as parts of the record, levels, which are
    quiet, and the deviation of a level.
    """

    place: Floats
    level: Floats
    quiet: Bools
    deviation: float


class _Fit(NamedTuple):
    """A baseline: constant, slope over the record, and the amplitude of an exponential of
    a time constant, as a part of the record.
    """

    constant: float
    slope: float = 0.0
    amplitude: float = 0.0
    time_constant: float = 1.0

    def at(self, place: Floats) -> Floats:
        return (
            self.constant
            + self.slope * place
            + self.amplitude * np.exp(-place / self.time_constant)
        )


def baseline_of(value: Floats) -> Floats:
    """Return the baseline of a signal, (samples,): zero throughout where none stands out.

    Parameters
    ----------
    value : array, shape (samples,)
        The samples; not all need be finite, but then there is no baseline.

    Examples
    --------
    >>> time = np.arange(4000) / 10e3
    >>> burst = np.where(
    ...     time >= 0.1, np.exp(-(time - 0.1).clip(0.0) / 5e-3) * np.sin(6e3 * (time - 0.1)), 0.0
    ... )
    >>> baseline_of(burst)[:2].tolist(), baseline_of(burst + 0.25)[:2].round(6).tolist()
    ([0.0, 0.0], [0.25, 0.25])
    """
    none = np.zeros(len(value))
    if len(value) < _LEAST:
        return none
    least, largest = float(value.min()), float(value.max())
    scale = max(-least, largest)
    # of a constant nothing tells what of it is offset; NaN and infinity fail the comparison
    if not (np.isfinite(scale) and largest > least):
        return none
    shares = value / scale
    place = (np.arange(len(value)) + 0.5) / len(value)
    found = none
    # the scatter of blocks contains the drift in them until it is removed
    for _ in range(_PASSES):
        fit = _fitted(_levels(shares - found), float(np.ptp(shares)))
        if fit is None:
            break
        found = found + fit.at(place)
    # a record of nothing but a slow change has no baseline beside it
    if not found.any() or float(np.abs(shares - found).max()) < _BESIDE * float(np.ptp(found)):
        return none
    return found * scale


def without_baseline(record: Record) -> Record:
    """Return a record without its baseline, with what was removed, and with a doubt if that is
    large; as it is, if that was done before.

    Parameters
    ----------
    record : Record
        The record.

    Examples
    --------
    >>> time = np.arange(4000) / 10e3
    >>> burst = np.where(
    ...     time >= 0.1, np.exp(-(time - 0.1).clip(0.0) / 5e-3) * np.sin(6e3 * (time - 0.1)), 0.0
    ... )
    >>> clean = without_baseline(Record("geophone", burst - 0.25, 10e3, "V"))
    >>> round(clean.removed.offset, 6), round(clean.removed.drift, 6), clean.doubts[0][:30]
    (-0.25, 0.0, 'an offset of -0.25 V was remov')
    """
    if record.removed is not None:
        return record
    level = baseline_of(record.value)
    removed = removed_of(level)
    if removed == Removed(0.0, 0.0):
        return replace(record, removed=removed)
    value = record.value - level
    largest, peak = float(np.abs(level).max()), float(np.abs(value).max())
    doubts = record.doubts
    if is_large(largest, peak):
        unit = "" if record.unit in ("", "1") else f" {record.unit}"
        drift = (
            f" that drifts by {removed.drift:.4g}{unit}" if removed.drift > _LARGE * largest else ""
        )
        part = (
            f"{'up to ' if drift else ''}{largest / peak:.2g} times the largest magnitude "
            "of what is left"
            if peak
            else "all that there is"
        )
        words = (
            f"an offset of {removed.offset:.4g}{unit}{drift} was removed from "
            f"{quoted(record.name)}, {part}"
        )
        doubts += (
            f"{words}: check that the channel rests at zero, and that it is not what you measure",
        )
    return replace(record, value=value, removed=removed, recorded=record.value, doubts=doubts)


def is_large(baseline: Floats | float, peak: Floats | float) -> Any:
    """Return whether a baseline is large beside the largest magnitude of what is left, so
    that it is doubted.
    """
    return baseline > _LARGE * peak


def removed_of(baseline: Floats) -> Removed:
    """Return what a baseline removes: its mean and its span."""
    scale = float(np.abs(baseline).max(initial=0.0))
    if scale == 0.0:
        return Removed(0.0, 0.0)
    # the sum of samples near the largest number is infinite
    shares = baseline / scale
    return Removed(scale * float(shares.mean()), scale * float(np.ptp(shares)))


def _levels(value: Floats) -> _Levels:
    """Return the levels of the blocks of a signal: means of the middle half of their
    samples, which bursts do not move.
    """
    count = min(_BLOCKS, len(value) // _IN_BLOCK)
    size = len(value) // count
    blocks = value[: count * size].reshape(count, size)
    # a drift within a block is no scatter; the halves tell it, without bursts that are shorter than
    # a part of them
    halves = np.stack(
        [_middle(part)[0] for part in (blocks[:, : size // 2], blocks[:, size - size // 2 :])]
    )
    rise = (halves[1] - halves[0]) * size / (size - size // 2)
    level, scatter = _middle(blocks - rise[:, None] * ((np.arange(size) + 0.5) / size - 0.5))
    quiet_scatter = float(np.quantile(scatter, _QUIET_PART, method="lower"))
    quiet = scatter <= max(_AS_QUIET * quiet_scatter, _QUIET_SHARE * float(scatter.max()))
    # beside a loud block stand the edges of its burst
    apart = quiet.copy()
    apart[1:] &= quiet[:-1]
    apart[:-1] &= quiet[1:]
    # quiet blocks that stand alone are where a vibration turns, and no rest
    quiet = apart if np.count_nonzero(apart) >= _REST * count else np.ones(count, dtype=bool)
    place = (np.arange(count) + 0.5) * size / len(value)
    # of white noise the middle half spans 1.35 standard deviations, and its mean has 1.09 times the
    # deviation of the mean of all
    deviation = 0.81 * float(np.median(scatter[quiet])) / np.sqrt(size)
    if float(
        np.median(np.abs(rise[quiet] - np.median(rise[quiet])))
    ) > _STEEP * deviation + _QUIET_SHARE * float(scatter.max()):
        # what rises here and falls there is a slow vibration where it crosses its middle, and no
        # rest
        quiet[:] = True
    return _Levels(place, level, quiet, deviation)


def _middle(blocks: Floats) -> tuple[Floats, Floats]:
    """Return mean and span of the middle half of the samples of blocks, (count,)."""
    size = blocks.shape[1]
    low, high = size // 4, size - size // 4
    part = np.partition(blocks, (low, high - 1), axis=1)
    return np.asarray(part[:, low:high].mean(axis=1)), np.asarray(part[:, high - 1] - part[:, low])


def _fitted(found: _Levels, span: float) -> _Fit | None:
    """Return the baseline of levels of a signal with a span; None if none stands out."""
    place, level = found.place[found.quiet], found.level[found.quiet]
    least = _NOTHING * span
    fit, parameters = _best(place, level, max(least, found.deviation))
    lead = int(np.argmin(found.quiet)) if not found.quiet.all() else 0
    if lead < _AT_REST:
        return fit if _stands_out(fit, parameters, place, level, found.deviation, least) else None
    begin, rest = found.place[:lead], found.level[:lead]
    sure = max(float(rest.std()), found.deviation) / np.sqrt(lead)
    agrees = abs(float((rest - fit.at(begin)).mean())) <= _SURE * sure + _ALIKE * span
    if agrees and _stands_out(fit, parameters, place, level, found.deviation, least):
        return fit
    before = _Fit(float(rest.mean()))
    return before if _stands_out(before, 1, begin, rest, found.deviation, least) else None


def _stands_out(
    fit: _Fit, parameters: int, place: Floats, level: Floats, deviation: float, least: float
) -> bool:
    """Return whether a baseline is more than noise and slow vibrations make of levels."""
    baseline = fit.at(place)
    left = level - baseline
    scatter = max(float(np.sqrt(left @ left / len(left))), deviation)
    unsure = scatter * float(np.sqrt(_alike(left) * parameters / len(left)))
    return float(np.sqrt(baseline @ baseline / len(left))) > max(least, _SURE * unsure)


def _best(place: Floats, level: Floats, deviation: float) -> tuple[_Fit, int]:
    """Return the constant, line or exponential that tells levels best, by Schwarz'
    criterion, and the number of its parameters.
    """
    constant = _Fit(float(level.mean()))
    if len(place) < _FOR_DRIFT or place[-1] - place[0] < _WIDE:
        return constant, 1
    slope, middle = np.polyfit(place - place.mean(), level, 1)
    drifts = (
        (_Fit(float(middle - slope * place.mean()), float(slope)), 2),
        (_exponential(place, level), 3),
    )
    candidates = ((constant, 1), *(one for one in drifts if _is_drift(one[0].at(place), level)))

    def surprise(candidate: tuple[_Fit, int]) -> float:
        fit, parameters = candidate
        left = level - fit.at(place)
        variance = left @ left / len(left) + (0.1 * deviation) ** 2
        return float(len(left) * np.log(variance) + _STERN * parameters * np.log(len(left)))

    return min(candidates, key=surprise)


def _is_drift(baseline: Floats, level: Floats) -> bool:
    """Return whether a drift leaves of levels what is no curve: a part of a slow
    vibration is only similar to it.
    """
    left = level - baseline
    return _alike(left) < _CURVED or float(np.sqrt(left @ left / len(left))) < _NEAR * float(
        np.ptp(baseline)
    )


def _exponential(place: Floats, level: Floats) -> _Fit:
    """Return the exponential on a constant that is nearest to levels: by its time
    constant on a grid that is refined.
    """
    constants = _time_constants()
    for _ in range(4):
        rows = np.exp(-place[None] / constants[:, None])
        rows -= (middle := rows.mean(axis=1, keepdims=True))
        about = level - level.mean()
        amplitude = rows @ about / np.einsum("ij,ij->i", rows, rows)
        best = int(np.argmax(amplitude**2 * np.einsum("ij,ij->i", rows, rows)))
        found = _Fit(
            float(level.mean() - amplitude[best] * middle[best, 0]),
            0.0,
            float(amplitude[best]),
            float(constants[best]),
        )
        below, above = constants[max(best - 1, 0)], constants[min(best + 1, len(constants) - 1)]
        constants = np.geomspace(below, above, 9)
    return found


@lru_cache(maxsize=1)
def _time_constants() -> Floats:
    return np.geomspace(0.05, 3.0, 16)


def _alike(left: Floats) -> float:
    """Return by how much the likeness of neighbours makes a mean less sure: the variance
    over that of unlike ones.
    """
    power = float(left @ left)
    if not power:
        return 1.0
    likeness = float(left[1:] @ left[:-1]) / power
    likeness += (1.0 + 3.0 * likeness) / len(left)  # of few it comes out too low
    likeness = min(max(likeness, 0.0), 0.99)
    return (1.0 + likeness) / (1.0 - likeness)
