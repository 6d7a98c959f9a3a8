"""The table of features: a row a signal, a column a feature, and a reason wherever there
is no number.
"""

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
from vibroimpact.signals.feature import Feature
from vibroimpact.signals.packets import DEAD_TIME, check_settings
from vibroimpact.signals.reasons import Reason
from vibroimpact.signals.record import checked_rate, real_numbers
from vibroimpact.signals.registry import families, features, find_feature

_AT_ONCE = 2**15
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
    >>> table = vi.feature_table(
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
        return self.values[
            :, find_named("feature", name, {one: place for place, one in enumerate(self.names)})
        ]

    def lacking(self, signal: int) -> dict[str, str]:
        """Return why a signal has no value of some features, in words by the name of the
        feature.
        """
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
    signals, frequency = real_numbers(values), checked_rate(rate)
    if signals.ndim != 2:
        raise InputError(
            f"the signals are an array of {signals.ndim} dimensions; give a table of shape "
            "(signals, samples)"
        )
    check_settings(threshold, dead_time)
    wanted = {name: find_feature(name) for name in (features() if names is None else names)}
    found, reasons = (
        np.empty((len(signals), len(wanted))),
        np.zeros((len(signals), len(wanted)), dtype=np.int8),
    )
    removed = np.zeros((len(signals), 2))
    step = _step(signals.shape[1])
    for first in range(0, len(signals), step):
        part = slice(first, first + step)
        recorded = signals[part].astype(np.float64)
        baseline = np.stack([baseline_of(one) for one in recorded])
        removed[part] = [removed_of(one) for one in baseline]
        found[part], reasons[part] = features_at_rest(
            recorded - baseline, recorded, frequency, wanted, threshold, dead_time
        )
        if progress is not None:
            progress(min(first + step, len(signals)), len(signals))
    units = tuple(one.unit_for(unit) for one in wanted.values())
    return FeatureTable(tuple(wanted), units, found, reasons, removed[:, 0], removed[:, 1])


def features_at_rest(
    signals: Floats,
    recorded: Floats,
    rate: float,
    wanted: Mapping[str, Feature],
    threshold: float | None,
    dead_time: float,
) -> tuple[Floats, NDArray[np.int8]]:
    """Return values and reasons, each of the shape (signals, features), of signals that rest at
    zero; a few at once.

    Parameters
    ----------
    signals, recorded : array, shape (signals, samples)
        The signals, and as they were recorded, with their baselines.
    rate, threshold, dead_time
        As those of `feature_table`.
    wanted : mapping of str to Feature
        The features that are wanted, by name.
    """
    values, reasons = (
        np.empty((len(signals), len(wanted))),
        np.zeros((len(signals), len(wanted)), dtype=np.int8),
    )
    step = _step(signals.shape[1])
    for first in range(0, len(signals), step):
        part = slice(first, first + step)
        values[part], reasons[part] = _features_of(
            signals[part], recorded[part], rate, wanted, threshold, dead_time
        )
    return values, reasons


def _step(samples: int) -> int:
    """Return the number of signals of a block."""
    return max(1, _AT_ONCE // max(1, samples))


def _features_of(
    signals: Floats,
    recorded: Floats,
    rate: float,
    wanted: Mapping[str, Feature],
    threshold: float | None,
    dead_time: float,
) -> tuple[Floats, NDArray[np.int8]]:
    """Return values and reasons of a block of signals (n, samples), each of the shape (n,
    features).
    """
    count, samples = signals.shape
    values, reasons = (
        np.full((count, len(wanted)), np.nan),
        np.zeros((count, len(wanted)), dtype=np.int8),
    )
    if not samples:
        reasons[:] = Reason.EMPTY
        return values, reasons
    finite = np.isfinite(signals).all(axis=1)
    reasons[~finite] = Reason.NOT_FINITE
    if not finite.any():
        return values, reasons
    # a number without a value is NaN, and no warning
    chosen = [
        family
        for family in families()
        if any(feature.name in wanted for feature in family.features)
    ]
    with np.errstate(all="ignore"):
        block, exponent = _scaled(signals[finite], recorded[finite], rate, threshold, dead_time)
        constant = np.ptp(block.value, axis=1) == 0.0
        place = {name: column for column, name in enumerate(wanted)}
        for family in chosen:
            here = [
                (column, feature)
                for column, feature in enumerate(family.features)
                if feature.name in wanted
            ]
            long = samples >= min(feature.least for _, feature in here)
            computed = (
                family.of(block)
                if long
                else np.full((len(block.value), len(family.features)), np.nan)
            )
            for column, feature in here:
                number = (
                    computed[:, column]
                    if samples >= feature.least
                    else np.full(len(block.value), np.nan)
                )
                values[finite, place[feature.name]], reasons[finite, place[feature.name]] = _told(
                    feature, number, exponent, constant, samples
                )
    return values, reasons


def _scaled(
    signals: Floats, recorded: Floats, rate: float, threshold: float | None, dead_time: float
) -> tuple[Block, Integers]:
    """Return signals with largest magnitudes of 1/2 to 1, and the powers of two that they
    were divided by; such a division is exact.
    """
    exponent = np.frexp(np.abs(signals).max(axis=1))[1].astype(np.int64)
    # in two steps, since the power of two itself may be out of range
    half = exponent // 2
    value = np.ldexp(np.ldexp(signals, -half[:, None]), (half - exponent)[:, None])
    # a threshold that is nothing beside a signal is still above zero
    given = (
        None
        if threshold is None
        else np.maximum(np.ldexp(np.ldexp(threshold, -half), half - exponent), np.finfo(float).tiny)
    )
    return Block(value, rate, given, dead_time, recorded), exponent


def _told(
    feature: Feature, number: Floats, exponent: Integers, constant: Bools, samples: int
) -> tuple[Floats, NDArray[np.int8]]:
    """Return the values of a feature at the scale of the signals, and a reason where
    there is none.
    """
    power = feature.degree * exponent
    half = power // 2
    value = np.ldexp(np.ldexp(number, half), power - half)
    reason = np.zeros(len(value), dtype=np.int8)
    beyond = np.isinf(value) | ((value == 0.0) & (number != 0.0))
    reason[beyond], value[beyond] = Reason.OUT_OF_RANGE, np.nan
    missing = np.isnan(number)
    if samples < feature.least:
        reason[missing] = Reason.TOO_SHORT
    else:
        reason[missing] = np.where(constant[missing], Reason.CONSTANT, feature.lacking)
    return value, reason
