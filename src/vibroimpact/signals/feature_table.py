"""The table of features: a row a signal, a column a feature, reasons where there is no number."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.registry import find_named
from vibroimpact.signals.baseline import baseline_of, removed_of
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature
from vibroimpact.signals.packets import DEAD_TIME, check_settings
from vibroimpact.signals.reasons import Reason
from vibroimpact.signals.record import checked_rate, real_numbers
from vibroimpact.signals.registry import families, find_feature, signal_features

_SAMPLES_AT_ONCE = 2**15
"""Samples of a block of signals: its arrays stay in the cache of a processor."""


@dataclass(frozen=True)
class FeatureTable:
    """Features of signals, a row each.

    Parameters
    ----------
    names : tuple of str
        Names of the features.
    units : tuple of str
        Their units.
    values : array, shape (signals, features)
        The values; NaN where there is none.
    reasons : array of int, shape (signals, features)
        Why there is none, as members of `Reason`; 0 where there is one.
    offset, drift : array, shape (signals,)
        Mean and span of the baseline that was removed, in the unit of the signals; 0 where none
        stands out.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> table = vi.signals.feature_table(
    ...     np.sin(np.arange(200) / 3.0)[None], 1e3, ["rms", "decay_time"], unit="V"
    ... )
    >>> table.names, table.units, table["rms"].round(2).tolist()
    (('rms', 'decay_time'), ('V', 's'), [0.7])
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    values: Floats
    reasons: NDArray[np.int8]
    offset: Floats
    drift: Floats

    def __getitem__(self, name: str) -> Floats:
        """Return the values of a feature, (signals,)."""
        columns = {feature: column for column, feature in enumerate(self.names)}
        return self.values[:, find_named("feature", name, columns)]

    def lacking(self, signal: int) -> dict[str, str]:
        """Return why a signal has no value of some features, by the name of the feature."""
        return {
            name: Reason(code).text
            for name, code in zip(self.names, self.reasons[signal], strict=True)
            if code
        }


def feature_table(
    values: Any,
    rate: float,
    names: Iterable[str] | None = None,
    *,
    unit: str = "1",
    threshold: float | None = None,
    dead_time: float = DEAD_TIME,
    progress: Callable[[int, int], None] | None = None,
) -> FeatureTable:
    """Return the features of signals, a row each, once their baselines are removed.

    Parameters
    ----------
    values : array, shape (signals, samples)
        Signals of one length and rate, best aligned at their onset; real numbers of any type.
    rate : float
        Sampling rate [Hz].
    names : iterable of str, optional
        The features that are wanted, in this order; by default all.
    unit : str, default "1"
        Unit of the signals, for those of the features.
    threshold : float, optional
        Threshold of the envelope, in the unit of the signals, for onset, times and packets; by
        default a tenth of the largest value of the envelope of each signal.
    dead_time : float, default 5e-3
        How long the envelope is below the threshold before a packet is over [s].
    progress : callable, optional
        Called with the number of signals that are done, and the number of all.

    Returns
    -------
    FeatureTable
        The features. A signal with a sample that is not finite has none.

    Raises
    ------
    InputError
        If the signals are not a table of real numbers, or the rate, a name or a setting is not
        allowed.

    Examples
    --------
    >>> time = np.arange(1000) / 10e3
    >>> tones = np.sin(2.0 * np.pi * np.outer([50.0, 200.0], time))
    >>> table = feature_table(tones, 10e3, ["rms", "peak_frequency"], unit="V")
    >>> table["peak_frequency"].tolist(), table.units
    ([50.0, 200.0], ('V', 'Hz'))
    """
    signals = real_numbers(values)
    sampling_rate = checked_rate(rate)
    if signals.ndim != 2:
        raise InputError(
            f"the signals are an array of {signals.ndim} dimensions; give a table of shape "
            "(signals, samples)"
        )
    check_settings(threshold, dead_time)
    if names is None:
        names = list(signal_features())
    wanted = {name: find_feature(name) for name in names}
    count, samples = signals.shape
    numbers, reasons = _empty_table(count, len(wanted))
    offset = np.zeros(count)
    drift = np.zeros(count)
    step = _signals_at_once(samples)
    for first in range(0, count, step):
        block = slice(first, first + step)
        recorded = signals[block].astype(np.float64)
        baselines = np.stack([baseline_of(signal) for signal in recorded])
        removed = [removed_of(baseline) for baseline in baselines]
        offset[block] = [baseline.offset for baseline in removed]
        drift[block] = [baseline.drift for baseline in removed]
        numbers[block], reasons[block] = features_at_rest(
            recorded - baselines, recorded, sampling_rate, wanted, threshold, dead_time
        )
        if progress is not None:
            progress(min(first + step, count), count)
    units = tuple(feature.unit_for(unit) for feature in wanted.values())
    return FeatureTable(tuple(wanted), units, numbers, reasons, offset, drift)


def features_at_rest(
    signals: Floats,
    recorded: Floats,
    rate: float,
    wanted: Mapping[str, Feature],
    threshold: float | None,
    dead_time: float,
) -> tuple[Floats, NDArray[np.int8]]:
    """Return values and reasons, each of the shape (signals, features), of signals at rest at zero.

    They are computed a few signals at once.

    Parameters
    ----------
    signals, recorded : array, shape (signals, samples)
        The signals, and as they were recorded, with their baselines.
    rate, threshold, dead_time
        As those of `feature_table`.
    wanted : mapping of str to Feature
        The features that are wanted, by name.
    """
    count, samples = signals.shape
    values, reasons = _empty_table(count, len(wanted))
    step = _signals_at_once(samples)
    for first in range(0, count, step):
        block = slice(first, first + step)
        values[block], reasons[block] = _features_of(
            signals[block], recorded[block], rate, wanted, threshold, dead_time
        )
    return values, reasons


def _empty_table(signals: int, columns: int) -> tuple[Floats, NDArray[np.int8]]:
    """Return values, NaN, and reasons, none, of the shape (signals, columns)."""
    return np.full((signals, columns), np.nan), np.zeros((signals, columns), dtype=np.int8)


def _signals_at_once(samples: int) -> int:
    """Return the number of signals of a block."""
    return max(1, _SAMPLES_AT_ONCE // max(1, samples))


def _features_of(
    signals: Floats,
    recorded: Floats,
    rate: float,
    wanted: Mapping[str, Feature],
    threshold: float | None,
    dead_time: float,
) -> tuple[Floats, NDArray[np.int8]]:
    """Return values and reasons of a block of signals (n, samples), (n, features) each."""
    count, samples = signals.shape
    values, reasons = _empty_table(count, len(wanted))
    if not samples:
        reasons[:] = Reason.EMPTY
        return values, reasons
    finite = np.isfinite(signals).all(axis=1)
    reasons[~finite] = Reason.NOT_FINITE
    if not finite.any():
        return values, reasons
    column_of = {name: column for column, name in enumerate(wanted)}
    # a number without a value is NaN, and no warning
    with np.errstate(all="ignore"):
        block, exponent = _scaled(signals[finite], recorded[finite], rate, threshold, dead_time)
        constant = np.ptp(block.value, axis=1) == 0.0
        for family in families():
            if not any(feature.name in wanted for feature in family.features):
                continue
            numbers = _family_numbers(family, block, wanted)
            for feature, number in zip(family.features, numbers.T, strict=True):
                if feature.name in wanted:
                    column = column_of[feature.name]
                    values[finite, column], reasons[finite, column] = _with_reasons(
                        feature, number, exponent, constant, samples
                    )
    return values, reasons


def _family_numbers(family: Family, block: Block, wanted: Mapping[str, Feature]) -> Floats:
    """Return the numbers of a family at the scale of a block, (n, features).

    They are NaN where a feature needs more samples.
    """
    least = np.array([feature.least for feature in family.features])
    needed = [feature.least for feature in family.features if feature.name in wanted]
    if block.samples < min(needed):
        return np.full((len(block.value), len(family.features)), np.nan)
    return np.where(block.samples >= least, family.of(block), np.nan)


def _scaled(
    signals: Floats, recorded: Floats, rate: float, threshold: float | None, dead_time: float
) -> tuple[Block, Integers]:
    """Return signals with largest magnitudes of 1/2 to 1, and the powers of two of their scales.

    Such a division is exact.
    """
    exponent = np.frexp(np.abs(signals).max(axis=1))[1].astype(np.int64)
    # in two steps, since the power of two itself may be out of range
    half = exponent // 2
    value = np.ldexp(np.ldexp(signals, -half[:, None]), (half - exponent)[:, None])
    if threshold is None:
        scaled_threshold = None
    else:
        scaled_threshold = np.ldexp(np.ldexp(threshold, -half), half - exponent)
        # a threshold that is nothing beside a signal is still above zero
        scaled_threshold = np.maximum(scaled_threshold, np.finfo(float).tiny)
    return Block(value, rate, scaled_threshold, dead_time, recorded), exponent


def _with_reasons(
    feature: Feature, number: Floats, exponent: Integers, constant: Bools, samples: int
) -> tuple[Floats, NDArray[np.int8]]:
    """Return the values of a feature at the scale of the signals, with reasons where there is none.

    The numbers are those of signals that were divided by two to the power of the exponents.
    """
    power = feature.degree * exponent
    half = power // 2
    value = np.ldexp(np.ldexp(number, half), power - half)
    reason = np.zeros(len(value), dtype=np.int8)
    beyond = np.isinf(value) | ((value == 0.0) & (number != 0.0))
    reason[beyond] = Reason.OUT_OF_RANGE
    value[beyond] = np.nan
    missing = np.isnan(number)
    if samples < feature.least:
        reason[missing] = Reason.TOO_SHORT
    else:
        reason[missing] = np.where(constant[missing], Reason.CONSTANT, feature.lacking)
    return value, reason
