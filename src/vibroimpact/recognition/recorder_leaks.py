"""Traces of the recorder by which classes can be told, though they do not come from the impacts:
found without any bound.

What comes before the onset, the length of a record, its steps and its clock say nothing about what
falls. Whether they tell classes better than chance is tested by exchanging the classes of whole
groups.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import factorial, prod

import numpy as np
from scipy.stats import rankdata

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH
from vibroimpact.quoting import quoted
from vibroimpact.recognition.labelled_signals import LabelledSignals, SensorSignals, lengths
from vibroimpact.units.display import digits

_RATE = 0.01
"""Part of the data sets without a leak in which chance makes one."""
_DRAWS = 999
"""Number of exchanges that are drawn; if there are no more, each is tried."""
_SAME = 1e-9
"""Rounding of how well a quantity tells classes."""
_ONSET, _FEWEST = 0.1, 8
"""Part of the largest magnitude that is the onset, and least number of samples before it
that tell something.
"""
_FAINT = 0.01
"""Part of the largest magnitude at which a signal begins, if it is above the noise."""
_ABOVE = 1.2
"""The least that is more than the largest noise, in parts of that."""
_LATER = 2.0
"""Samples by which onsets of classes differ by what falls, beside the time in which the
signals rise.
"""
_CLOCK = 3e-3
"""Difference of clocks below which the modes of a plate may shift with what falls."""
_STRETCH, _GRID, _SMOOTH = 0.05, 4096, 161
"""Largest stretch of a clock that is sought, points of the logarithmic axis of frequency,
and those over which resonances are smoothed.
"""

LENGTH, ONSET, STEP = (
    "the length",
    "the number of samples before the onset",
    "the step between sample values",
)
CLOCK = "the deviation of the frequencies at which the plate rings down"


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
    found = []
    plates = signals.groups.get("plate", np.zeros(len(classes), dtype=np.intp))
    for sensor, one in signals.sensors.items():
        traces = {
            name: values for name, values in _traces(one, plates).items() if np.ptp(values) > 0.0
        }
        if not traces:
            continue
        for name, (apart, chance) in _tested(traces, classes, groups, seed).items():
            if chance > _RATE or not _matters(name, traces[name], classes, one):
                continue
            medians = [
                float(np.median(traces[name][classes == number])) for number in np.unique(classes)
            ]
            told = ", ".join(
                f"{_shown(name, value, one.unit)} for {signals.class_names[place]}"
                for place, value in enumerate(medians)
            )
            often = (
                f"in {50.0 + 50.0 * apart:.0f} % of pairs, by chance in at most "
                f"{100.0 * _RATE:g} % of data sets"
            )
            words = (
                f"{name} tells the classes apart (medians {told}; {often}); it does not come "
                "from what falls"
            )
            found.append(
                f"leak of the recorder at {quoted(sensor)}: {words}: record all {group}s alike"
            )
    return found + _too_few(classes, groups, group)


def _too_few(classes: Indices, groups: Indices, group: str) -> list[str]:
    """Return a sentence if there are so few exchanges of classes between groups that
    nothing can be told from chance.
    """
    firsts = _class_of_groups(classes, groups)
    if firsts is None:
        return []
    counts = np.bincount(firsts)
    counts = counts[counts > 0]
    # with classes of equally many groups exchanged whole, all is apart as it was
    alike = factorial(len(counts)) if len(set(counts.tolist())) == 1 else 1
    least = alike / _exchanges(counts)
    if least <= _RATE:
        return []
    needed = 2
    while factorial(len(counts)) / _exchanges(np.full(len(counts), needed)) > _RATE:
        needed += 1
    return [
        f"leaks of the recorder can't be told from chance with {len(firsts)} {group}s: "
        "chance separates classes fully in at "
        f"least {digits(100.0 * least, 2)} % of data sets; {needed} {group}s of each class suffice"
    ]


def _class_of_groups(classes: Indices, groups: Indices) -> Indices | None:
    """Return the class of each group; None if a group has several."""
    labels, place = np.unique(groups, return_inverse=True)
    firsts = np.array([classes[np.argmax(place == number)] for number in range(len(labels))])
    return firsts if (firsts[place] == classes).all() else None


def _exchanges(counts: Indices) -> float:
    """Return the number of ways in which classes of so many groups each can be given to them."""
    return factorial(int(counts.sum())) / prod(factorial(one) for one in counts.tolist())


def _all_exchanges(firsts: list[int]) -> Iterator[list[int]]:
    """Yield each of these ways once."""
    if not firsts:
        yield []
    for one in sorted(set(firsts)):
        rest = firsts.copy()
        rest.remove(one)
        for others in _all_exchanges(rest):
            yield [one, *others]


def _matters(name: str, values: Floats, classes: Indices, one: SensorSignals) -> bool:
    """Return whether a difference is more than what falls may make of it."""
    medians = [float(np.median(values[classes == number])) for number in np.unique(classes)]
    if name == ONSET:
        return float(np.ptp(medians)) > _LATER + _rise(one)
    return name != CLOCK or float(np.ptp(medians)) > _CLOCK


def _shown(name: str, value: float, unit: str) -> str:
    """Return the median of a quantity with its unit."""
    if name in (LENGTH, ONSET):
        return f"{value:.10g} sample{'' if value == 1.0 else 's'}"
    if name == CLOCK:
        return f"{100.0 * np.expm1(value):+.2g} %"
    if name.startswith("the correlation"):
        return f"{value:.2g}"
    if name == STEP and not value:
        return "none"
    return f"{value:.4g}{'' if unit in ('', '1') else f' {unit}'}"


def _tested(
    traces: Mapping[str, Floats], classes: Indices, groups: Indices, seed: int
) -> dict[str, tuple[float, float]]:
    """Return by name how well a quantity tells classes, |2 A - 1|, and how often one of
    all does as well with the classes exchanged.
    """
    ranks = np.stack([rankdata(values) for values in traces.values()])
    ranks = (ranks - ranks.mean(axis=1, keepdims=True)) / len(classes)
    random, names = np.random.default_rng(seed), np.unique(classes)
    _, place = np.unique(groups, return_inverse=True)
    firsts = _class_of_groups(classes, groups)

    def exchanged() -> Indices:
        if firsts is not None:
            return np.asarray(random.permutation(firsts)[place])
        order = np.lexsort((random.random(len(classes)), place))
        drawn = np.empty_like(classes)
        drawn[np.lexsort((np.arange(len(classes)), place))] = classes[order]
        return drawn

    def apart(of: Indices) -> Floats:
        most = np.zeros(len(ranks))
        for number in names:
            own = of == number
            share = own.mean()
            # of a class and all others: the mean of ranks tells the area under the curve
            most = np.maximum(most, np.abs(2.0 * ranks[:, own].mean(axis=1) / (1.0 - share)))
        return most

    seen = apart(classes)
    if firsts is not None and _exchanges(np.bincount(firsts)) <= _DRAWS:
        every = np.array(
            [apart(np.array(one)[place]).max() for one in _all_exchanges(firsts.tolist())]
        )
        return {
            name: (float(value), float((every >= value - _SAME).mean()))
            for name, value in zip(traces, seen, strict=True)
        }
    largest = np.array([apart(exchanged()).max() for _ in range(_DRAWS)])
    return {
        name: (float(value), float((1 + (largest >= value).sum()) / (_DRAWS + 1)))
        for name, value in zip(traces, seen, strict=True)
    }


def _traces(one: SensorSignals, plates: Indices) -> dict[str, Floats]:
    """Return the quantities of signals that do not come from what falls, (signals,) each;
    those that all have a value for.
    """
    value = np.nan_to_num(one.values.astype(float))
    length = lengths(one.values)
    onset = _reached(value, _ONSET)
    found = {LENGTH: length.astype(float), ONSET: _reached(value, _FAINT).astype(float)}
    quiet = onset - HALF_LENGTH - 1
    if quiet.min() < _FEWEST:
        quiet = onset - 4
    if np.quantile(quiet, 0.05) >= _FEWEST:
        before = [row[: max(_FEWEST, end)] for row, end in zip(value, quiet.tolist(), strict=True)]
        found["the level before the onset"] = np.array([row.mean() for row in before])
        found["the noise before the onset"] = np.array([row.std() for row in before])
        found["the drift before the onset"] = np.array(
            [row[len(row) // 2 :].mean() - row[: len(row) // 2].mean() for row in before]
        )
        for lag in (1, 2):
            found[f"the correlation of samples {lag} apart before the onset"] = np.array(
                [_likeness(row, lag) for row in before]
            )
    found[STEP] = np.array(
        [_step(row[:end]) for row, end in zip(value, length.tolist(), strict=True)]
    )
    found[CLOCK] = _clock(value, onset, length, plates)
    return found


def _likeness(row: Floats, lag: int) -> float:
    about = row - row.mean()
    power = float(about @ about)
    return float(about[lag:] @ about[:-lag]) / power if power else 0.0


def _step(row: Floats) -> float:
    """Return the least difference of two values, as a converter and a gain make it; 0 if
    all values differ, so that nothing tells one.
    """
    values = np.unique(row)
    if len(values) < 3 or len(values) > 0.9 * len(row):
        return 0.0
    return float(np.diff(values).min())


def _rise(one: SensorSignals) -> float:
    """Return the median time from where the signals leave their noise to a tenth of their
    largest magnitude [samples].
    """
    value = np.nan_to_num(one.values.astype(float))
    return float(np.median(_reached(value, _ONSET) - _reached(value, _FAINT)))


def _reached(value: Floats, part: float) -> Indices:
    """Return where each signal is first further from its level at the start than a part
    of its largest magnitude, and than noise.
    """
    about = np.abs(value - np.median(value[:, :_FEWEST], axis=1)[:, None])
    high = np.argmax(about >= _ONSET * about.max(axis=1)[:, None], axis=1)
    noise = np.array(
        [row[: max(1, end - 4)].max() for row, end in zip(about, high.tolist(), strict=True)]
    )
    least = np.clip(_ABOVE * noise, part * about.max(axis=1), _ONSET * about.max(axis=1))
    return np.asarray(np.argmax(about >= least[:, None], axis=1))


def _clock(value: Floats, onset: Indices, length: Indices, plates: Indices) -> Floats:
    """Return by how much the axis of frequency of each ring-down is stretched beside that
    of all on the same plate, as a logarithm.
    """
    rings = [
        row[begin + (end - begin) // 3 : end]
        for row, begin, end in zip(value, onset.tolist(), length.tolist(), strict=True)
    ]
    samples = int(np.median([len(row) for row in rings]))
    if samples < 4 * _FEWEST:
        return np.zeros(len(value))
    axis = np.geomspace(4.0 / samples, 0.45, _GRID)
    padded = 1 << (4 * samples - 1).bit_length()
    levels = np.empty((len(value), _GRID))
    for number, row in enumerate(rings):
        part = row[:samples]
        spectrum = np.abs(np.fft.rfft(part * np.hanning(len(part)), padded))
        level = np.log(
            np.interp(axis * padded, np.arange(len(spectrum)), spectrum)
            + 1e-9 * spectrum.max()
            + 1e-300
        )
        levels[number] = level - np.convolve(
            np.pad(level, _SMOOTH // 2, mode="edge"), np.full(_SMOOTH, 1.0 / _SMOOTH), "valid"
        )
    step, reach = float(np.log(axis[1] / axis[0])), int(_STRETCH / np.log(axis[1] / axis[0]))
    found = np.zeros(len(value))
    for plate in np.unique(plates):
        own = np.flatnonzero(plates == plate)
        mean = levels[own].mean(axis=0)
        together = np.fft.irfft(np.fft.rfft(levels[own]) * np.fft.rfft(mean).conj(), _GRID)
        lags = np.arange(-reach, reach + 1)
        near = together[:, lags]
        best = np.clip(near.argmax(axis=1), 1, 2 * reach - 1)
        rows = np.arange(len(own))
        low, top, high = near[rows, best - 1], near[rows, best], near[rows, best + 1]
        bend = low - 2.0 * top + high
        shift = np.where(bend < 0.0, 0.5 * (low - high) / np.where(bend < 0.0, bend, 1.0), 0.0)
        found[own] = step * (lags[best] + np.clip(shift, -1.0, 1.0))
    return found
