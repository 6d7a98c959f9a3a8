"""What makes a data set unfit for recognition, or its score too good: each said in one
sentence before anything is learned.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from vibroimpact.arrays import Floats, Indices
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.recognition.folds import default_folds
from vibroimpact.recognition.labelled_signals import GROUPS, LabelledSignals, lengths
from vibroimpact.units.display import digits

DURATION, FORCE = "first_duration_s", "largest_force_N"
_COPY, _SUMS = 1e-4, 8
"""Difference of two signals, over their size, below which one is a copy; and number of
random sums by which copies are sought.
"""
_CORNER = 0.67
"""Frequency at which the spectrum of Hertz's force has fallen by 3 dB, times the contact time."""


def check_signals(signals: LabelledSignals, group: str, folds: int | None = None) -> list[str]:
    """Check that classifiers can be trained on signals and tested honestly, and return what is
    doubtful.

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
    """Return the group of each signal, after a check that the groups can be split so that
    every part has every class.
    """
    if group not in signals.groups:
        known = tuple(signals.groups)
        words = f"there are {', '.join(known)}" if known else "there are none"
        raise InputError(
            f'"{group}" is no group of these signals; '
            f"{words}.{did_you_mean(group, known or GROUPS)}",
            "group",
        )
    groups = signals.groups[group]
    names = {int(one): np.unique(groups[classes == one]) for one in np.unique(classes)}
    if len(np.unique(groups)) == 1:
        more = (
            ", or use more of the signals (--most)"
            if signals.total is not None and signals.total > len(signals)
            else ""
        )
        raise InputError(
            f"all {len(groups)} signals are of one {group}, so that no classifier can be "
            f"tested on another {group}; "
            f"give signals of several {group}s{more}"
        )
    if all(len(one) == 1 for one in names.values()):
        raise InputError(
            f"each class is in one {group} only: differences between {group}s would be "
            "confounded with differences between classes; "
            f"give several {group}s of each class"
        )
    fewest = min(names, key=lambda one: len(names[one]))
    folds = default_folds(classes, groups) if folds is None else folds
    if (count := len(names[fewest])) < folds:
        remedy = (
            f"or ask for {count} folds"
            if count > 1
            else "since training on one can't be tested on another"
        )
        raise InputError(
            f"{signals.class_names[fewest]} is in {count} "
            f"{group}{'s' if count > 1 else ''}, too few for {folds} folds; "
            f"give signals of it from {folds} {group}s or more, {remedy}"
        )
    return groups


def check_lengths(signals: LabelledSignals, classes: Indices) -> None:
    """Raise InputError if the length of signals tells their class: a simulation that
    ended, and nothing that a plate could tell.
    """
    for sensor, one in signals.sensors.items():
        found = lengths(one.values)
        for name in np.unique(classes):
            own, others = found[classes == name], found[classes != name]
            low, high = int(own.min()), int(own.max())
            if not ((others >= low) & (others <= high)).any():
                words = f"{low}" if low == high else f"{low} to {high}"
                raise InputError(
                    "the length of a signal reveals its class: those of "
                    f"{signals.class_names[name]} have {words} samples at {sensor}, and "
                    "no signal of another class has; cut or record all to one length"
                )


def check_duplicates(signals: LabelledSignals, groups: Indices, group: str) -> None:
    """Raise InputError if two groups hold the same signal, which would then be trained on and
    tested on; silent signals do not count.

    Signals that differ by less than a ten-thousandth are the same: scaled, rounded or resampled
    anew.
    """
    parts = [np.nan_to_num(one.values.astype(float)) for one in signals.sensors.values()]
    silent = np.all([np.ptp(part, axis=1) == 0.0 for part in parts], axis=0)
    loud = np.flatnonzero(~silent)
    sizes = np.sqrt(sum(np.sum(part[loud] ** 2, axis=1) for part in parts))
    # neighbours among a few random sums of samples are looked at whole
    random = np.random.default_rng(0)
    sums = (
        sum(part[loud] @ random.standard_normal((part.shape[1], _SUMS)) for part in parts)
        / sizes[:, None]
    )
    pairs = cKDTree(sums).query_pairs(_COPY * _SUMS, output_type="ndarray")
    for one, other in np.sort(loud[pairs], axis=1)[np.lexsort(pairs.T[::-1])].tolist():
        if groups[one] == groups[other]:
            continue
        apart, size = (
            sum(float(np.sum(row**2)) for row in rows) for rows in _rows(parts, one, other)
        )
        if apart <= _COPY**2 * size:
            exact = (
                "are the same"
                if not apart
                else f"differ by only {np.sqrt(apart / size):.1g} of their size"
            )
            raise InputError(
                f"signals {signals.places[one]} and {signals.places[other]}, counted from "
                f"0, {exact} and lie in two {group}s "
                f"({groups[one]} and {groups[other]}): one could be trained on and the "
                "other tested on; remove one"
            )


def _rows(parts: list[Floats], one: int, other: int) -> tuple[list[Floats], list[Floats]]:
    """Return the differences of two signals, a row a sensor, and the first of them."""
    return [part[one] - part[other] for part in parts], [part[one] for part in parts]


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
    median = max(float(np.nanmedian(duration[classes == one])) for one in np.unique(classes))
    fastest = max(signals.sensors, key=lambda name: signals.sensors[name].rate)
    rate = signals.sensors[fastest].rate
    needed = 2.0 * _CORNER / median
    if not rate < needed:  # or no impact has a duration
        return []
    words = (
        f"{fastest} samples at {digits(rate)} Hz and resolves up to {digits(0.5 * rate)} "
        f"Hz; contacts of {digits(median * 1e6, 3)} us, the "
        "longest median of a class, affect the spectrum from "
        f"{digits(_CORNER / median, 3)} Hz on, so contact times need {digits(needed)} Hz or more"
    )
    if FORCE in signals.truth and separation(signals.truth[FORCE], classes) < 0.5 * separation(
        duration, classes
    ):
        raise InputError(
            "the sampling rate is too low: the classes differ far more in contact time "
            f"than in force; {words}"
        )
    return [f"contact times can't be resolved: {words}"]


def separation(values: Floats, classes: Indices) -> float:
    """Return how well one quantity tells classes apart: the largest, over pairs, of |2 A - 1|, A
    being the area under the ROC curve.

    Examples
    --------
    >>> separation(np.array([1.0, 2.0, 3.0, 4.0]), np.array([0, 0, 1, 1]))
    1.0
    """
    there = np.isfinite(values)
    values, classes = values[there], classes[there]
    found = [0.0]
    names = np.unique(classes)
    for place, one in enumerate(names):
        for other in names[place + 1 :]:
            low, high = np.sort(values[classes == one]), values[classes == other]
            below = np.searchsorted(low, high, side="left") + np.searchsorted(
                low, high, side="right"
            )
            found.append(abs(float(below.mean()) / len(low) - 1.0))
    return max(found)
