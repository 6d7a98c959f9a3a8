"""Traces of the recorder by which classes can be told, though they do not come from the impacts.

What comes before the onset, the length of a record, its steps and its clock say nothing about what
falls. Whether they tell classes better than chance is tested by exchanging the classes of whole
groups. No bound on the error is needed for that.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import factorial, prod
from typing import NamedTuple

import numpy as np
from scipy.stats import rankdata

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH
from vibroimpact.quoting import quoted
from vibroimpact.recognition.labelled_signals import LabelledSignals, SensorSignals, lengths
from vibroimpact.units.display import digits

_FALSE_ALARM_RATE = 0.01
"""Part of the data sets without a leak in which chance makes one."""
_EXCHANGES = 999
"""Number of exchanges that are drawn; if there are no more, each is tried."""
_ROUNDING = 1e-9
"""Rounding of how well a quantity tells classes."""
_ONSET = 0.1
"""Part of the largest magnitude that is the onset."""
_FEWEST = 8
"""Least number of samples before the onset that tell something."""
_FAINT = 0.01
"""Part of the largest magnitude at which a signal begins, if it is above the noise."""
_ABOVE_NOISE = 1.2
"""The least that is more than the largest noise, in parts of that."""
_ONSET_TOLERANCE = 2.0
"""Difference of the onsets of classes that is due to what falls [samples].

The time in which the signals rise is added to it.
"""
_CLOCK = 3e-3
"""Difference of clocks below which the modes of a plate may shift with what falls."""
_STRETCH = 0.05
"""Largest stretch of a clock that is sought."""
_GRID = 4096
"""Points of the logarithmic axis of frequency."""
_SMOOTH = 161
"""Points of that axis over which resonances are smoothed."""

LENGTH = "the length"
ONSET = "the number of samples before the onset"
STEP = "the step between sample values"
CLOCK = "the deviation of the frequencies at which the plate rings down"


class _Separation(NamedTuple):
    """How well a quantity tells classes apart.

    Attributes
    ----------
    strength : float
        |2 A - 1|, A being the area under the ROC curve; of several classes the largest.
    by_chance : float
        How often one of all quantities does as well with the classes exchanged.
    """

    strength: float
    by_chance: float


def recorder_leaks(
    signals: LabelledSignals, classes: Indices, groups: Indices, group: str, seed: int = 0
) -> list[str]:
    """Return a sentence for each trace of the recorder that tells the classes better than chance.

    Parameters
    ----------
    signals : LabelledSignals
        The signals.
    classes, groups : array of int, shape (signals,)
        Class and group of each.
    group : str
        What signals of a group share.
    seed : int, default 0
        Seed of the exchanges.
    """
    sentences = []
    plates = signals.groups.get("plate", np.zeros(len(classes), dtype=np.intp))
    for sensor, sensor_signals in signals.sensors.items():
        traces = {
            name: values
            for name, values in _traces(sensor_signals, plates).items()
            if np.ptp(values) > 0.0
        }
        if not traces:
            continue
        for name, separation in _separations(traces, classes, groups, seed).items():
            medians = _class_medians(traces[name], classes)
            if separation.by_chance > _FALSE_ALARM_RATE:
                continue
            if not _matters(name, list(medians.values()), sensor_signals):
                continue
            leak = _leak_description(name, medians, separation, signals, sensor_signals.unit)
            sentences.append(
                f"leak of the recorder at {quoted(sensor)}: {leak}: record all {group}s alike"
            )
    return sentences + _too_few_groups(classes, groups, group)


def _class_medians(values: Floats, classes: Indices) -> dict[int, float]:
    """Return the median of a quantity by the number of the class."""
    return {
        int(number): float(np.median(values[classes == number])) for number in np.unique(classes)
    }


def _matters(name: str, medians: list[float], signals: SensorSignals) -> bool:
    """Return whether a difference of medians is more than what falls may make of it."""
    if name == ONSET:
        return float(np.ptp(medians)) > _ONSET_TOLERANCE + _rise(signals)
    return name != CLOCK or float(np.ptp(medians)) > _CLOCK


def _leak_description(
    name: str,
    medians: Mapping[int, float],
    separation: _Separation,
    signals: LabelledSignals,
    unit: str,
) -> str:
    """Return how a quantity tells the classes, with its medians."""
    medians_text = ", ".join(
        f"{_median_text(name, median, unit)} for {signals.class_names[number]}"
        for number, median in medians.items()
    )
    # A is the part of pairs that the quantity puts in the right order
    frequency = (
        f"in {50.0 + 50.0 * separation.strength:.0f} % of pairs, by chance in at most "
        f"{100.0 * _FALSE_ALARM_RATE:g} % of data sets"
    )
    return (
        f"{name} tells the classes apart (medians {medians_text}; {frequency}); it does not come "
        "from what falls"
    )


def _median_text(name: str, median: float, unit: str) -> str:
    """Return the median of a quantity with its unit."""
    if name in (LENGTH, ONSET):
        samples = "sample" if median == 1.0 else "samples"
        return f"{median:.10g} {samples}"
    if name == CLOCK:
        return f"{100.0 * np.expm1(median):+.2g} %"
    if name.startswith("the correlation"):
        return f"{median:.2g}"
    if name == STEP and not median:
        return "none"
    if unit in ("", "1"):
        return f"{median:.4g}"
    return f"{median:.4g} {unit}"


def _too_few_groups(classes: Indices, groups: Indices, group: str) -> list[str]:
    """Return a sentence if there are so few groups that nothing can be told from chance.

    Their classes can then be exchanged in few ways only.
    """
    group_classes = _class_of_groups(classes, groups)
    if group_classes is None:
        return []
    counts = np.bincount(group_classes)
    counts = counts[counts > 0]
    whole_exchanges = 1
    if len(set(counts.tolist())) == 1:
        # with classes of equally many groups exchanged whole, all is apart as it was
        whole_exchanges = factorial(len(counts))
    least_chance = whole_exchanges / _exchanges(counts)
    if least_chance <= _FALSE_ALARM_RATE:
        return []
    needed = 2
    while factorial(len(counts)) / _exchanges(np.full(len(counts), needed)) > _FALSE_ALARM_RATE:
        needed += 1
    return [
        f"leaks of the recorder can't be told from chance with {len(group_classes)} {group}s: "
        "chance separates classes fully in at least "
        f"{digits(100.0 * least_chance, 2)} % of data sets; {needed} {group}s of each class suffice"
    ]


def _class_of_groups(classes: Indices, groups: Indices) -> Indices | None:
    """Return the class of each group; None if a group has several."""
    names, group_number = np.unique(groups, return_inverse=True)
    group_classes = np.array(
        [classes[np.argmax(group_number == number)] for number in range(len(names))]
    )
    if not (group_classes[group_number] == classes).all():
        return None
    return group_classes


def _exchanges(counts: Indices) -> float:
    """Return the number of ways in which classes of so many groups each can be given to them."""
    return factorial(int(counts.sum())) / prod(factorial(count) for count in counts.tolist())


def _all_exchanges(group_classes: list[int]) -> Iterator[list[int]]:
    """Yield each of these ways once."""
    if not group_classes:
        yield []
    for first in sorted(set(group_classes)):
        others = group_classes.copy()
        others.remove(first)
        for exchange in _all_exchanges(others):
            yield [first, *exchange]


def _random_exchange(
    random: np.random.Generator,
    classes: Indices,
    group_number: Indices,
    group_classes: Indices | None,
) -> Indices:
    """Return the classes of signals, exchanged at random.

    Groups of one class each exchange their classes; where a group has several, its signals exchange
    theirs among each other.
    """
    if group_classes is not None:
        return np.asarray(random.permutation(group_classes)[group_number])
    by_group = np.lexsort((np.arange(len(classes)), group_number))
    by_group_at_random = np.lexsort((random.random(len(classes)), group_number))
    exchanged = np.empty_like(classes)
    exchanged[by_group] = classes[by_group_at_random]
    return exchanged


def _separations(
    traces: Mapping[str, Floats], classes: Indices, groups: Indices, seed: int
) -> dict[str, _Separation]:
    """Return how well quantities tell classes, by name.

    Chance is that of all quantities together: the largest strength of any of them counts.
    """
    ranks = np.stack([rankdata(values) for values in traces.values()])
    ranks = (ranks - ranks.mean(axis=1, keepdims=True)) / len(classes)
    random = np.random.default_rng(seed)
    _, group_number = np.unique(groups, return_inverse=True)
    group_classes = _class_of_groups(classes, groups)
    strengths = _strengths(ranks, classes)
    separations = {}
    if group_classes is not None and _exchanges(np.bincount(group_classes)) <= _EXCHANGES:
        # exact: the exchanges include the classes as they are
        largest = np.array(
            [
                _strengths(ranks, np.array(exchange)[group_number]).max()
                for exchange in _all_exchanges(group_classes.tolist())
            ]
        )
        for name, strength in zip(traces, strengths, strict=True):
            by_chance = float((largest >= strength - _ROUNDING).mean())
            separations[name] = _Separation(float(strength), by_chance)
        return separations
    largest = np.array(
        [
            _strengths(ranks, _random_exchange(random, classes, group_number, group_classes)).max()
            for _ in range(_EXCHANGES)
        ]
    )
    for name, strength in zip(traces, strengths, strict=True):
        # the classes as they are count as one of the exchanges
        by_chance = float((1 + (largest >= strength).sum()) / (_EXCHANGES + 1))
        separations[name] = _Separation(float(strength), by_chance)
    return separations


def _strengths(ranks: Floats, classes: Indices) -> Floats:
    """Return |2 A - 1| of quantities, (quantities,), the largest over the classes.

    A is the area under the ROC curve of a class and all others; the ranks of the quantities,
    (quantities, signals), are relative to their means and to the number of signals.
    """
    largest = np.zeros(len(ranks))
    for number in np.unique(classes):
        in_class = classes == number
        share = in_class.mean()
        # the mean of ranks tells the area under the curve, after Mann and Whitney
        strength = np.abs(2.0 * ranks[:, in_class].mean(axis=1) / (1.0 - share))
        largest = np.maximum(largest, strength)
    return largest


def _traces(signals: SensorSignals, plates: Indices) -> dict[str, Floats]:
    """Return the quantities of signals that do not come from what falls, (signals,) each.

    Only those are there that all signals have a value for.
    """
    samples = np.nan_to_num(signals.values.astype(float))
    length = lengths(signals.values)
    onset = _first_beyond(samples, _ONSET)
    traces = {
        LENGTH: length.astype(float),
        ONSET: _first_beyond(samples, _FAINT).astype(float),
    }
    # an anti-alias filter may spread the onset over half its length; if that leaves too little, it
    # is taken to be sharp
    quiet_end = onset - HALF_LENGTH - 1
    if quiet_end.min() < _FEWEST:
        quiet_end = onset - 4
    if np.quantile(quiet_end, 0.05) >= _FEWEST:
        quiet = [
            row[: max(_FEWEST, end)] for row, end in zip(samples, quiet_end.tolist(), strict=True)
        ]
        traces |= _quiet_traces(quiet)
    traces[STEP] = np.array(
        [_step(row[:end]) for row, end in zip(samples, length.tolist(), strict=True)]
    )
    traces[CLOCK] = _clock_deviation(samples, onset, length, plates)
    return traces


def _drift(row: Floats) -> float:
    """Return by how much the mean of the second half of samples is above that of the first."""
    half = len(row) // 2
    return float(row[half:].mean() - row[:half].mean())


def _quiet_traces(quiet: list[Floats]) -> dict[str, Floats]:
    """Return quantities of the samples of each signal before its onset."""
    traces = {
        "the level before the onset": np.array([row.mean() for row in quiet]),
        "the noise before the onset": np.array([row.std() for row in quiet]),
        "the drift before the onset": np.array([_drift(row) for row in quiet]),
    }
    for lag in (1, 2):
        traces[f"the correlation of samples {lag} apart before the onset"] = np.array(
            [_autocorrelation(row, lag) for row in quiet]
        )
    return traces


def _autocorrelation(row: Floats, lag: int) -> float:
    """Return the correlation of samples that are a lag apart; 0 if all are alike."""
    deviation = row - row.mean()
    power = float(deviation @ deviation)
    if not power:
        return 0.0
    return float(deviation[lag:] @ deviation[:-lag]) / power


def _step(row: Floats) -> float:
    """Return the least difference of two values, as a converter and a gain make it.

    It is 0 if all values differ, so that nothing tells one.
    """
    levels = np.unique(row)
    if len(levels) < 3 or len(levels) > 0.9 * len(row):
        return 0.0
    return float(np.diff(levels).min())


def _rise(signals: SensorSignals) -> float:
    """Return the median time in which signals rise [samples].

    It is that from where they leave their noise to a tenth of their largest magnitude.
    """
    samples = np.nan_to_num(signals.values.astype(float))
    return float(np.median(_first_beyond(samples, _ONSET) - _first_beyond(samples, _FAINT)))


def _first_beyond(samples: Floats, part: float) -> Indices:
    """Return where each signal first exceeds a part of its peak, (signals,).

    Its distance from its level at the start counts. The peak is the largest such distance; noise
    does not count as exceeding it.
    """
    distance = np.abs(samples - np.median(samples[:, :_FEWEST], axis=1)[:, None])
    peak = distance.max(axis=1)
    onset = np.argmax(distance >= _ONSET * peak[:, None], axis=1)
    # the signal may rise in the last samples before the onset
    quiet = [row[: max(1, end - 4)] for row, end in zip(distance, onset.tolist(), strict=True)]
    noise = np.array([samples.max() for samples in quiet])
    threshold = np.clip(_ABOVE_NOISE * noise, part * peak, _ONSET * peak)
    return np.asarray(np.argmax(distance >= threshold[:, None], axis=1))


def _clock_deviation(samples: Floats, onset: Indices, length: Indices, plates: Indices) -> Floats:
    """Return the stretch of the axis of frequency of each ring-down, as a logarithm.

    It is relative to the mean of all ring-downs on the same plate, which has the same modes.
    """
    ring_downs = []
    for row, begin, end in zip(samples, onset.tolist(), length.tolist(), strict=True):
        # the last two thirds, in which the plate rings freely
        ring_downs.append(row[begin + (end - begin) // 3 : end])
    ring_length = int(np.median([len(ring_down) for ring_down in ring_downs]))
    if ring_length < 4 * _FEWEST:
        return np.zeros(len(samples))
    # on a logarithmic axis, in parts of the sampling rate, a stretch is a shift
    frequencies = np.geomspace(4.0 / ring_length, 0.45, _GRID)
    padded_length = 1 << (4 * ring_length - 1).bit_length()
    levels = np.stack(
        [_resonances(row[:ring_length], frequencies, padded_length) for row in ring_downs]
    )
    step = float(np.log(frequencies[1] / frequencies[0]))
    reach = int(_STRETCH / step)
    deviations = np.zeros(len(samples))
    for plate in np.unique(plates):
        on_plate = np.flatnonzero(plates == plate)
        deviations[on_plate] = step * _shifts(levels[on_plate], reach)
    return deviations


def _resonances(ring_down: Floats, frequencies: Floats, padded_length: int) -> Floats:
    """Return the logarithm of the spectrum of a ring-down, relative to its course when smoothed."""
    windowed = ring_down * np.hanning(len(ring_down))
    spectrum = np.abs(np.fft.rfft(windowed, padded_length))
    magnitude = np.interp(frequencies * padded_length, np.arange(len(spectrum)), spectrum)
    # the floor keeps gaps of the spectrum from counting more than resonances
    level = np.log(magnitude + 1e-9 * spectrum.max() + 1e-300)
    padded_level = np.pad(level, _SMOOTH // 2, mode="edge")
    smoothed = np.convolve(padded_level, np.full(_SMOOTH, 1.0 / _SMOOTH), "valid")
    return np.asarray(level - smoothed)


def _shifts(levels: Floats, reach: int) -> Floats:
    """Return by how many points, at most `reach`, each row is shifted beside the mean of all.

    It is where the circular cross-correlation with the mean is largest, between its points at the
    vertex of a parabola through the largest value and its neighbours.
    """
    mean = levels.mean(axis=0)
    cross_spectra = np.fft.rfft(levels) * np.fft.rfft(mean).conj()
    correlation = np.fft.irfft(cross_spectra, _GRID)
    lags = np.arange(-reach, reach + 1)
    near = correlation[:, lags]
    # one that has a neighbour on either side
    best = np.clip(near.argmax(axis=1), 1, 2 * reach - 1)
    rows = np.arange(len(levels))
    below = near[rows, best - 1]
    top = near[rows, best]
    above = near[rows, best + 1]
    curvature = below - 2.0 * top + above
    # at an end of the lags the values may still rise
    has_vertex = curvature < 0.0
    vertex = 0.5 * (below - above) / np.where(has_vertex, curvature, 1.0)
    vertex = np.where(has_vertex, vertex, 0.0)
    return np.asarray(lags[best] + np.clip(vertex, -1.0, 1.0))
