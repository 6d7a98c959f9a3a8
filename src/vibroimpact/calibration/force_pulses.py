"""Pulses in a record of force: where they are, how long, how strong, and how well that is known."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.calibration.force_baseline import baseline_under_impact, record_baseline
from vibroimpact.calibration.record_noise import ABOVE_NOISE, record_noise
from vibroimpact.errors import InputError

_FEWEST = 5

_SMALL, _LEAST = 0.02, 1e-9
"""Parts of the largest force: what is no impact, and the least noise that a record has."""

_UPSIDE_DOWN = 3.0  # how much farther down than up a force goes whose sign is wrong

_SIGHTS, _MARGIN = 3, 0.25
"""How often the force at rest is told anew, and the part of an impact's time that goes to it on either side."""

_PEAK, _TOP = 0.003, 0.8
"""How well the largest force is told from what is above so much of it."""


class DetectedPulses(NamedTuple):
    """Where a force pushes: the force as it was recorded, its noise, which samples are quiet, and runs of samples that push, as first and
    behind the last.
    """

    force: Floats
    noise: float
    quiet: Bools
    runs: list[tuple[int, int]]


class Pulse(NamedTuple):
    """A pulse of force: when it begins and how long it lasts [s], its largest force [N] and its impulse [N s], with standard deviations;
    how far the force at rest wanders beside it, beyond what noise explains [N]; and times and forces about it, above that at rest.
    """

    begin: float
    duration: float
    largest: float
    largest_deviation: float
    impulse: float
    impulse_deviation: float
    wanders: float
    piece: tuple[Floats, Floats]


def find_pulses(time: Floats, force: Floats) -> DetectedPulses:
    """Return where a force pushes.

    Raises
    ------
    InputError
        If it does nowhere, downwards, or everywhere.
    """
    noise = max(record_noise(force), _LEAST * float(np.ptp(force)))
    low, high = float(force.min()), float(force.max())
    if not high > low:
        raise InputError("the record does not show an impact: the force is the same throughout")
    middle = float(np.median(force))
    if middle - low > max(_UPSIDE_DOWN * (high - middle), 2.0 * ABOVE_NOISE * noise):
        raise InputError("the force is negative; it must be positive where it pushes the sphere up")
    rest = np.full_like(force, np.median(force[force < 0.5 * (low + high)]))  # of what belongs to no impact, at first sight
    for sight in range(_SIGHTS):
        above = force - rest
        threshold = max(ABOVE_NOISE * noise, _SMALL * float(above.max()))
        runs = [(begin, end) for begin, end in _joined(_runs(above > threshold)) if above[begin:end].max() > 2.0 * threshold]
        if not runs:
            raise InputError("the record does not show an impact: no force stands out from the noise")
        quiet = np.ones(len(force), dtype=bool)
        for begin, end in runs:
            margin = _margin(begin, end)
            quiet[max(begin - margin, 0) : end + margin] = False
        if np.count_nonzero(quiet) < _FEWEST:
            raise InputError("the record shows nothing but the impact; it takes some time before or after it, to tell the force at rest")
        if sight < _SIGHTS - 1:
            rest = record_baseline(time, force, quiet)
    return DetectedPulses(force, noise, quiet, runs)


def evaluate_pulses(time: Floats, seen: DetectedPulses, runs: list[tuple[int, int]]) -> list[Pulse]:
    """Return the pulses of some of the runs."""
    between = [0, *((end + begin) // 2 for (_, end), (begin, _) in itertools.pairwise(seen.runs)), len(time)]
    rooms = itertools.pairwise(between)
    return [_pulse(time, seen, run, room) for run, room in zip(seen.runs, rooms, strict=True) if run in runs]


def _pulse(time: Floats, seen: DetectedPulses, run: tuple[int, int], room: tuple[int, int]) -> Pulse:
    """Return one pulse, integrated with some time on either side, within its room, above its level at rest."""
    begin, end = run
    margin = _margin(begin, end)
    part = slice(max(begin - margin, room[0]), min(end + margin, room[1]))
    level = baseline_under_impact(time, seen.force, seen.quiet, part, room, end - begin, seen.noise)
    force, at, step = seen.force[part] - level.values, time[part], float(np.median(np.diff(time)))
    impulse = float(np.trapezoid(force, at))
    noise = seen.noise * step * np.sqrt(part.stop - part.start)
    # what every other sample would tell, beyond what noise makes of that, says how much there is between the samples
    coarse = [np.trapezoid(force[first::2], at[first::2]) for first in (0, 1)]
    between = 0.5 * max(0.0, float(np.abs(impulse - np.array(coarse)).max()) - 2.0 * noise)
    unsure = float(np.linalg.norm([noise, level.impulse_deviation, between]))
    inside = force[begin - part.start : end - part.start]
    largest, deviation = _largest(np.arange(len(inside)), inside), np.hypot(seen.noise, level.deviation)
    return Pulse(
        begin=float(time[begin]),
        duration=float(time[end - 1] - time[begin]),
        largest=largest,
        largest_deviation=float(np.hypot(deviation, _PEAK * largest)),
        impulse=impulse,
        impulse_deviation=unsure,
        wanders=level.wanders,
        piece=(at, force),
    )


def _largest(number: Indices, force: Floats) -> float:
    """Return the top of a parabola through the largest samples; the largest of them if they are few."""
    largest = float(force.max())
    top = np.flatnonzero(force > _TOP * largest)
    if len(top) > _FEWEST:
        across = number[top] - number[top].mean()
        a, b, c = np.linalg.lstsq(np.vander(across, 3), force[top], rcond=None)[0]
        largest = float(c - b * b / (4.0 * a)) if a < 0.0 else largest
    return largest


def _margin(begin: int, end: int) -> int:
    return int(_MARGIN * (end - begin)) + 1


def _joined(runs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return runs, with those as one between which noise alone makes a gap."""
    joined: list[tuple[int, int]] = []
    for begin, end in runs:
        if joined and begin - joined[-1][1] < _MARGIN * max(end - begin, joined[-1][1] - joined[-1][0]):
            joined[-1] = (joined[-1][0], end)
        else:
            joined.append((begin, end))
    return joined


def _runs(above: Bools) -> list[tuple[int, int]]:
    """Return where samples in a row are above, as first and behind the last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], above, [False]]).astype(int)))
    return [(int(begin), int(end)) for begin, end in edges.reshape(-1, 2)]
