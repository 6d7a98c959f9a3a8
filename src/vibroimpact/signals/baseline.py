"""The baseline of a record: the level at rest, which an amplifier shifts and lets drift.

A record is baseline and vibration. Where it rests, only the baseline is left: blocks of samples are
compared by their scatter, and a constant, a line or an exponential on a constant is fitted to the
levels of the quiet blocks. The baseline is removed only if it stands out from what noise and slow
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

_LEAST_SAMPLES = 128
"""Samples below which no baseline is sought: a handful of blocks tells no rest from vibration."""
_MOST_BLOCKS = 128
"""Largest number of blocks."""
_LEAST_IN_BLOCK = 8
"""Least number of samples of a block."""
_QUIET_PART = 0.2
"""Part of the blocks that is quiet in any case."""
_QUIET_FACTOR = 3.0
"""Scatter, over the largest of that part, up to which other blocks are quiet too."""
_QUIET_SHARE = 2e-3
"""Scatter, over that of the loudest block, up to which blocks are quiet too."""
_PASSES = 3
"""How often a baseline is sought in what the pass before left."""
_PENALTY = 3.0
"""Weight of a further parameter, over that of Schwarz' criterion.

Levels of slow vibrations are no independent numbers.
"""
_LEAST_REST = 0.15
"""Part of the blocks that must be quiet with their neighbours.

With fewer, a record is nowhere at rest, and all its blocks count.
"""
_STEEP = 6.0
"""Median rise within quiet blocks, over the deviation of a level, of a slow vibration.

The rise is that beside the median of all. Above it, a vibration is slower than the blocks.
"""
_CURVED = 3.0
"""Variance inflation by the correlation of neighbours from which on the residual is a curve."""
_SMALL_RESIDUAL = 0.01
"""Residual, over the span of the drift, below which a curve in it does not matter."""
_SURE = 4.0
"""Baseline over its standard deviation from which on it is removed."""
_NEGLIGIBLE = 1e-6
"""Baseline over the largest magnitude that is none: that of filters and of rounding."""
_DRIFT_SPAN = 0.8
"""Part of the record that quiet blocks must span for a drift to be told."""
_DRIFT_BLOCKS = 16
"""Least number of quiet blocks for a drift to be told."""
_AT_REST = 3
"""Quiet blocks before the first loud one that make a rest before the first touch."""
_AGREEMENT = 1e-3
"""Distance of a fit from the level at rest, over the largest magnitude, that is none."""
_LEAST_SIGNAL = 0.05
"""Largest magnitude of what is left, over the drift, below which the drift is the signal."""
_LARGE = 0.1
"""Baseline, over the largest magnitude of what is left, from which on it is doubted.

A threshold of a tenth would have met it.
"""


class _Levels(NamedTuple):
    """Levels of the blocks of a signal.

    Centres as parts of the record, levels, which of them are quiet, and the deviation of a level.
    """

    position: Floats
    level: Floats
    quiet: Bools
    deviation: float


class _Fit(NamedTuple):
    """A baseline: constant, slope over the record, and an exponential.

    The time constant of the exponential is a part of the record.
    """

    constant: float
    slope: float = 0.0
    amplitude: float = 0.0
    time_constant: float = 1.0

    def at(self, position: Floats) -> Floats:
        return (
            self.constant
            + self.slope * position
            + self.amplitude * np.exp(-position / self.time_constant)
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
    if len(value) < _LEAST_SAMPLES:
        return none
    lowest = float(value.min())
    highest = float(value.max())
    scale = max(-lowest, highest)
    # of a constant nothing tells what of it is offset; NaN and infinity fail the comparison
    if not (np.isfinite(scale) and highest > lowest):
        return none
    # at the scale of the largest magnitude, no square overflows
    scaled = value / scale
    span = float(np.ptp(scaled))
    position = (np.arange(len(value)) + 0.5) / len(value)
    baseline = none
    # the scatter of blocks contains the drift in them until it is removed
    for _ in range(_PASSES):
        fit = _fitted(_levels(scaled - baseline), span)
        if fit is None:
            break
        baseline = baseline + fit.at(position)
    if not baseline.any():
        return none
    # a record of nothing but a slow change has no baseline beside it
    if float(np.abs(scaled - baseline).max()) < _LEAST_SIGNAL * float(np.ptp(baseline)):
        return none
    return baseline * scale


def without_baseline(record: Record) -> Record:
    """Return a record without its baseline, and with a doubt if that is large.

    What was removed is `removed` of the record; if that is known already, the record is returned.

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
    baseline = baseline_of(record.value)
    removed = removed_of(baseline)
    if removed == Removed(0.0, 0.0):
        return replace(record, removed=removed)
    value = record.value - baseline
    largest = float(np.abs(baseline).max())
    peak = float(np.abs(value).max())
    doubts = record.doubts
    if is_large(largest, peak):
        doubts += (_offset_doubt(record, removed, largest, peak),)
    return replace(record, value=value, removed=removed, recorded=record.value, doubts=doubts)


def _offset_doubt(record: Record, removed: Removed, largest: float, peak: float) -> str:
    """Return the doubt about a baseline with a largest magnitude, beside the peak of the rest."""
    unit = "" if record.unit in ("", "1") else f" {record.unit}"
    drift = ""
    up_to = ""
    if removed.drift > _LARGE * largest:
        drift = f" that drifts by {removed.drift:.4g}{unit}"
        up_to = "up to "
    share = "all that there is"
    if peak:
        share = f"{up_to}{largest / peak:.2g} times the largest magnitude of the rest of the record"
    return (
        f"an offset of {removed.offset:.4g}{unit}{drift} was removed from "
        f"{quoted(record.name)}, {share}: check that the channel rests at zero, and that it is "
        "not what you measure"
    )


def is_large(baseline: Floats | float, peak: Floats | float) -> Any:
    """Return whether a baseline is doubted: large beside the largest magnitude of the rest."""
    return baseline > _LARGE * peak


def removed_of(baseline: Floats) -> Removed:
    """Return what a baseline removes: its mean and its span."""
    scale = float(np.abs(baseline).max(initial=0.0))
    if scale == 0.0:
        return Removed(0.0, 0.0)
    # the sum of samples near the largest number is infinite
    scaled = baseline / scale
    return Removed(scale * float(scaled.mean()), scale * float(np.ptp(scaled)))


def _levels(value: Floats) -> _Levels:
    """Return the levels of the blocks of a signal: means of the middle half of their samples.

    A burst moves a few samples far, but not the middle half.
    """
    count = min(_MOST_BLOCKS, len(value) // _LEAST_IN_BLOCK)
    size = len(value) // count
    blocks = value[: count * size].reshape(count, size)
    rise = _rise(blocks)
    # a drift within a block is no scatter
    ramp = (np.arange(size) + 0.5) / size - 0.5
    level, scatter = _middle_half(blocks - rise[:, None] * ramp)
    quiet = _quiet(scatter)
    position = (np.arange(count) + 0.5) * size / len(value)
    # of white noise the middle half spans 1.35 standard deviations, and its mean has 1.09 times the
    # deviation of the mean of all: 1.09 / 1.35 = 0.81
    deviation = 0.81 * float(np.median(scatter[quiet])) / np.sqrt(size)
    quiet_rise = rise[quiet]
    unlike_rise = float(np.median(np.abs(quiet_rise - np.median(quiet_rise))))
    if unlike_rise > _STEEP * deviation + _QUIET_SHARE * float(scatter.max()):
        # what rises here and falls there is a slow vibration where it crosses its middle, and no
        # rest: all blocks count
        quiet[:] = True
    return _Levels(position, level, quiet, deviation)


def _rise(blocks: Floats) -> Floats:
    """Return by how much the level rises over each block, by the levels of its halves.

    These do not hold bursts that are shorter than a part of them.
    """
    size = blocks.shape[1]
    first_half, _ = _middle_half(blocks[:, : size // 2])
    second_half, _ = _middle_half(blocks[:, size - size // 2 :])
    return np.asarray((second_half - first_half) * size / (size - size // 2))


def _quiet(scatter: Floats) -> Bools:
    """Return which blocks are quiet by their scatter, with quiet neighbours; all, if few are."""
    lowest_scatter = float(np.quantile(scatter, _QUIET_PART, method="lower"))
    quiet = scatter <= max(_QUIET_FACTOR * lowest_scatter, _QUIET_SHARE * float(scatter.max()))
    # beside a loud block lie the edges of its burst, and quiet blocks that stand alone are where a
    # vibration turns, and no rest
    among_quiet = quiet.copy()
    among_quiet[1:] &= quiet[:-1]
    among_quiet[:-1] &= quiet[1:]
    if np.count_nonzero(among_quiet) >= _LEAST_REST * len(quiet):
        return among_quiet
    return np.ones(len(quiet), dtype=bool)


def _middle_half(blocks: Floats) -> tuple[Floats, Floats]:
    """Return mean and span of the middle half of the samples of blocks, (count,)."""
    size = blocks.shape[1]
    first = size // 4
    end = size - size // 4
    # only as far sorted as the ends of the middle half
    ordered = np.partition(blocks, (first, end - 1), axis=1)
    mean = ordered[:, first:end].mean(axis=1)
    span = ordered[:, end - 1] - ordered[:, first]
    return np.asarray(mean), np.asarray(span)


def _fitted(levels: _Levels, span: float) -> _Fit | None:
    """Return the baseline of levels of a signal with a span; None if none stands out."""
    position = levels.position[levels.quiet]
    level = levels.level[levels.quiet]
    least = _NEGLIGIBLE * span
    fit, parameters = _best_fit(position, level, max(least, levels.deviation))
    fit_stands_out = _stands_out(fit, parameters, position, level, levels.deviation, least)
    # the quiet blocks before the first touch; none if there is no loud block
    lead = 0
    if not levels.quiet.all():
        lead = int(np.argmin(levels.quiet))
    if lead < _AT_REST:
        return fit if fit_stands_out else None
    rest_position = levels.position[:lead]
    rest_level = levels.level[:lead]
    mean_deviation = max(float(rest_level.std()), levels.deviation) / np.sqrt(lead)
    distance = abs(float((rest_level - fit.at(rest_position)).mean()))
    if distance <= _SURE * mean_deviation + _AGREEMENT * span and fit_stands_out:
        return fit
    # what comes only with the impacts is signal
    at_rest = _Fit(float(rest_level.mean()))
    if _stands_out(at_rest, 1, rest_position, rest_level, levels.deviation, least):
        return at_rest
    return None


def _stands_out(
    fit: _Fit, parameters: int, position: Floats, level: Floats, deviation: float, least: float
) -> bool:
    """Return whether a baseline is more than noise and slow vibrations make of levels."""
    baseline = fit.at(position)
    residual = level - baseline
    count = len(residual)
    scatter = max(float(np.sqrt(residual @ residual / count)), deviation)
    baseline_deviation = scatter * float(
        np.sqrt(_variance_inflation(residual) * parameters / count)
    )
    rms = float(np.sqrt(baseline @ baseline / count))
    return rms > max(least, _SURE * baseline_deviation)


def _best_fit(position: Floats, level: Floats, deviation: float) -> tuple[_Fit, int]:
    """Return the constant, line or exponential that fits levels best, by Schwarz' criterion.

    With it comes the number of its parameters.
    """
    constant = _Fit(float(level.mean()))
    if len(position) < _DRIFT_BLOCKS or position[-1] - position[0] < _DRIFT_SPAN:
        return constant, 1
    slope, mean_level = np.polyfit(position - position.mean(), level, 1)
    line = _Fit(float(mean_level - slope * position.mean()), float(slope))
    exponential = _exponential(position, level)
    candidates = [(constant, 1)]
    for drift, parameters in ((line, 2), (exponential, 3)):
        if _is_drift(drift.at(position), level):
            candidates.append((drift, parameters))

    def schwarz(candidate: tuple[_Fit, int]) -> float:
        """Return Schwarz' criterion, n ln(variance) + k ln(n), with a larger weight of k."""
        fit, parameters = candidate
        residual = level - fit.at(position)
        count = len(residual)
        # a part of the noise is added, so that levels which a curve meets by chance do not decide
        variance = residual @ residual / count + (0.1 * deviation) ** 2
        return float(count * np.log(variance) + _PENALTY * parameters * np.log(count))

    return min(candidates, key=schwarz)


def _is_drift(baseline: Floats, level: Floats) -> bool:
    """Return whether the levels are a drift and scatter, and no curve is left of them.

    A part of a slow vibration is only similar to a drift.
    """
    residual = level - baseline
    if _variance_inflation(residual) < _CURVED:
        return True
    rms = float(np.sqrt(residual @ residual / len(residual)))
    return rms < _SMALL_RESIDUAL * float(np.ptp(baseline))


def _exponential(position: Floats, level: Floats) -> _Fit:
    """Return the exponential on a constant that is nearest to levels, by least squares.

    The time constant is sought on a grid that is refined.
    """
    time_constants = _time_constants()
    for _ in range(4):
        shapes = np.exp(-position[None] / time_constants[:, None])
        means = shapes.mean(axis=1, keepdims=True)
        # without the means the constant is eliminated
        shapes -= means
        centred = level - level.mean()
        energy = np.einsum("ij,ij->i", shapes, shapes)
        amplitude = shapes @ centred / energy
        # the square that each takes off the sum of those of the levels
        best = int(np.argmax(amplitude**2 * energy))
        fit = _Fit(
            constant=float(level.mean() - amplitude[best] * means[best, 0]),
            amplitude=float(amplitude[best]),
            time_constant=float(time_constants[best]),
        )
        shorter = time_constants[max(best - 1, 0)]
        longer = time_constants[min(best + 1, len(time_constants) - 1)]
        time_constants = np.geomspace(shorter, longer, 9)
    return fit


@lru_cache(maxsize=1)
def _time_constants() -> Floats:
    """Return the time constants that are tried first, as parts of the record."""
    return np.geomspace(0.05, 3.0, 16)


def _variance_inflation(residual: Floats) -> float:
    """Return the factor of the variance of a mean by the correlation of neighbours.

    For an autoregression of first order with the correlation r it is (1 + r) / (1 - r).
    """
    power = float(residual @ residual)
    if not power:
        return 1.0
    correlation = float(residual[1:] @ residual[:-1]) / power
    correlation += (1.0 + 3.0 * correlation) / len(residual)  # of few it comes out too low
    correlation = min(max(correlation, 0.0), 0.99)
    return (1.0 + correlation) / (1.0 - correlation)
