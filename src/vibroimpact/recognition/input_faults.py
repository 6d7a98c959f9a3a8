"""What makes a data set unfit for recognition, or its score too good.

Each is said in one sentence before anything is learned.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
from scipy.spatial import cKDTree

from vibroimpact.arrays import Floats, Indices
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.recognition.folds import default_folds
from vibroimpact.recognition.labelled_signals import GROUPS, LabelledSignals, lengths
from vibroimpact.units.display import digits

DURATION = "first_duration_s"
FORCE = "largest_force_N"
_COPY = 1e-4
"""Difference of two signals, over their size, below which one is a copy."""
_SUMS = 8
"""Number of random sums of samples by which copies are sought."""
_CORNER = 0.67
"""Frequency at which the spectrum of Hertz's force has fallen by 3 dB, times the contact time."""


def check_signals(signals: LabelledSignals, group: str, folds: int | None = None) -> list[str]:
    """Check that classifiers can be trained on signals and tested honestly; return doubts.

    Parameters
    ----------
    signals : LabelledSignals
        The signals.
    group : str
        What signals of a group share; no group is both trained on and tested on.
    folds : int, optional
        Number of parts of the cross-validation; by default as many as the groups allow.

    Raises
    ------
    InputError
        If there is only one class, the groups can't be split, the length of a signal tells its
        class, two groups hold the same signal, or the signals are sampled too slowly to tell the
        classes.
    """
    if signals.classes is None:
        raise InputError(
            f"{signals.name}: the signals have no classes; the variable class is missing"
        )
    present = np.unique(signals.classes)
    if len(present) < 2:
        raise InputError(
            f"there is one class only: all {len(signals)} signals are "
            f"{signals.class_names[present[0]]}"
        )
    groups = check_groups(signals, signals.classes, group, folds)
    check_lengths(signals, signals.classes)
    check_duplicates(signals, groups, group)
    doubts = check_rates(signals, signals.classes)
    if len(np.unique(groups)) == len(groups):
        doubts.append(
            f"each signal has a {group} of its own, so the grouped split is a random split"
        )
    if signals.total is not None and signals.total > len(signals):
        doubts.append(
            f"of {signals.total:,} signals {len(signals):,} are used: failed drops are "
            "left out, and of more signals than asked for "
            "(most) whole groups are drawn at random"
        )
    return doubts


def check_groups(
    signals: LabelledSignals, classes: Indices, group: str, folds: int | None
) -> Indices:
    """Return the group of each signal.

    Before that it is checked that the groups can be split so that every part has every class.
    """
    if group not in signals.groups:
        known = tuple(signals.groups)
        choice = "there are none"
        if known:
            choice = f"there are {', '.join(known)}"
        raise InputError(
            f'"{group}" is no group of these signals; '
            f"{choice}.{did_you_mean(group, known or GROUPS)}",
            "group",
        )
    groups = signals.groups[group]
    if len(np.unique(groups)) == 1:
        remedy = f"give signals of several {group}s"
        if signals.total is not None and signals.total > len(signals):
            remedy += ", or use more of the signals (--most)"
        raise InputError(
            f"all {len(groups)} signals are of one {group}, so that no classifier can be "
            f"tested on another {group}; {remedy}"
        )
    group_counts = {
        int(number): len(np.unique(groups[classes == number])) for number in np.unique(classes)
    }
    if all(count == 1 for count in group_counts.values()):
        raise InputError(
            f"each class is in one {group} only: differences between {group}s would be "
            "confounded with differences between classes; "
            f"give several {group}s of each class"
        )
    rarest_class = min(group_counts, key=lambda number: group_counts[number])
    count = group_counts[rarest_class]
    if folds is None:
        folds = default_folds(classes, groups)
    if count < folds:
        if count > 1:
            few = f"{count} {group}s"
            remedy = f"or ask for {count} folds"
        else:
            few = f"{count} {group}"
            remedy = "since training on one can't be tested on another"
        raise InputError(
            f"{signals.class_names[rarest_class]} is in {few}, too few for {folds} folds; "
            f"give signals of it from {folds} {group}s or more, {remedy}"
        )
    return groups


def check_lengths(signals: LabelledSignals, classes: Indices) -> None:
    """Raise InputError if the length of signals tells their class.

    It is that of a simulation that ended, and nothing that a plate could tell.
    """
    for sensor, sensor_signals in signals.sensors.items():
        signal_lengths = lengths(sensor_signals.values)
        for number in np.unique(classes):
            own_lengths = signal_lengths[classes == number]
            other_lengths = signal_lengths[classes != number]
            shortest = int(own_lengths.min())
            longest = int(own_lengths.max())
            if not ((other_lengths >= shortest) & (other_lengths <= longest)).any():
                extent = f"{shortest} to {longest}"
                if shortest == longest:
                    extent = f"{shortest}"
                raise InputError(
                    "the length of a signal reveals its class: those of "
                    f"{signals.class_names[number]} have {extent} samples at {sensor}, and "
                    "no signal of another class has; cut or record all to one length"
                )


def check_duplicates(signals: LabelledSignals, groups: Indices, group: str) -> None:
    """Raise InputError if two groups hold the same signal, as one could be trained and tested on.

    Signals that differ by less than a ten-thousandth are the same: scaled, rounded or resampled
    anew. Silent signals do not count.
    """
    samples_by_sensor = [
        np.nan_to_num(sensor.values.astype(float)) for sensor in signals.sensors.values()
    ]
    for first, second in _likely_copies(samples_by_sensor):
        if groups[first] == groups[second]:
            continue
        difference = sum(
            float(np.sum((samples[first] - samples[second]) ** 2)) for samples in samples_by_sensor
        )
        size = sum(float(np.sum(samples[first] ** 2)) for samples in samples_by_sensor)
        if difference <= _COPY**2 * size:
            likeness = "are the same"
            if difference:
                likeness = f"differ by only {np.sqrt(difference / size):.1g} of their size"
            raise InputError(
                f"signals {signals.places[first]} and {signals.places[second]}, counted from "
                f"0, {likeness} and lie in two {group}s "
                f"({groups[first]} and {groups[second]}): one could be trained on and the "
                "other tested on; remove one"
            )


def _likely_copies(samples_by_sensor: list[Floats]) -> list[list[int]]:
    """Return pairs of signals that are worth comparing whole, in ascending order.

    They are neighbours in a few random sums of their samples, relative to their sizes.
    """
    silent = np.all([np.ptp(samples, axis=1) == 0.0 for samples in samples_by_sensor], axis=0)
    loud = np.flatnonzero(~silent)
    # each sum projects a signal, of all sensors, onto a random direction: copies stay together
    random = np.random.default_rng(0)
    energies = np.zeros(len(loud))
    sums = np.zeros((len(loud), _SUMS))
    for samples in samples_by_sensor:
        directions = random.standard_normal((samples.shape[1], _SUMS))
        energies += np.sum(samples[loud] ** 2, axis=1)
        sums += samples[loud] @ directions
    sizes = np.sqrt(energies)
    neighbours = cKDTree(sums / sizes[:, None])
    pairs = neighbours.query_pairs(_COPY * _SUMS, output_type="ndarray")
    ascending = np.lexsort(pairs.T[::-1])
    ordered: list[list[int]] = np.sort(loud[pairs], axis=1)[ascending].tolist()
    return ordered


def check_rates(signals: LabelledSignals, classes: Indices) -> list[str]:
    """Return doubts about sampling rates at which contact times can't be seen.

    Raises
    ------
    InputError
        If the classes differ in contact time and hardly in force, and no sensor is fast enough to
        see the contact times.
    """
    if DURATION not in signals.truth:
        return []
    duration = signals.truth[DURATION]
    longest_median = max(
        float(np.nanmedian(duration[classes == number])) for number in np.unique(classes)
    )
    fastest = max(signals.sensors, key=lambda name: signals.sensors[name].rate)
    rate = signals.sensors[fastest].rate
    corner_frequency = _CORNER / longest_median
    needed_rate = 2.0 * _CORNER / longest_median
    if not rate < needed_rate:  # or no impact has a duration
        return []
    reason = (
        f"{fastest} samples at {digits(rate)} Hz and resolves up to {digits(0.5 * rate)} "
        f"Hz; contacts of {digits(longest_median * 1e6, 3)} us, the "
        "longest median of a class, affect the spectrum from "
        f"{digits(corner_frequency, 3)} Hz on, so contact times need {digits(needed_rate)} Hz or "
        "more"
    )
    if FORCE in signals.truth:
        by_force = separation(signals.truth[FORCE], classes)
        if by_force < 0.5 * separation(duration, classes):
            raise InputError(
                "the sampling rate is too low: the classes differ far more in contact time "
                f"than in force; {reason}"
            )
    return [f"contact times can't be resolved: {reason}"]


def separation(values: Floats, classes: Indices) -> float:
    """Return how well one quantity tells classes apart: the largest |2 A - 1| over pairs of them.

    A is the area under the ROC curve.

    Examples
    --------
    >>> separation(np.array([1.0, 2.0, 3.0, 4.0]), np.array([0, 0, 1, 1]))
    1.0
    """
    finite = np.isfinite(values)
    values = values[finite]
    classes = classes[finite]
    separations = [0.0]
    for first, second in combinations(np.unique(classes), 2):
        ordered = np.sort(values[classes == first])
        others = values[classes == second]
        # twice the number of values of the first class below each of the second; equal values
        # count a half
        below = np.searchsorted(ordered, others, side="left")
        not_above = np.searchsorted(ordered, others, side="right")
        separations.append(abs(float((below + not_above).mean()) / len(ordered) - 1.0))
    return max(separations)
