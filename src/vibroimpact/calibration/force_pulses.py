"""Pulses in a force record: detection, duration, impulse and largest force, with standard deviations."""

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
"""Detection threshold as a fraction of the largest force, and the lower bound of the noise as a fraction of the range of the record."""

_UPSIDE_DOWN = 3.0  # ratio of negative to positive excursion above which the sign of the force is wrong

_PASSES, _MARGIN = 3, 0.25
"""Number of passes of detection and baseline, and the margin on either side of a pulse as a fraction of its duration."""

_PEAK, _TOP = 0.003, 0.8
"""Relative standard deviation of the largest force, and the fraction of it above which samples enter its parabola."""


class DetectedPulses(NamedTuple):
    """Pulses found in a force record: the force as recorded, its noise [N], a mask of the samples outside all pulses (quiet), and the
    pulses as half-open index ranges.
    """

    force: Floats
    noise: float
    quiet: Bools
    runs: list[tuple[int, int]]


class Pulse(NamedTuple):
    """A force pulse: start and duration [s]; largest force [N] and impulse [N s] with standard deviations; scatter of the baseline beside
    it in excess of the noise [N]; times and forces above the baseline around it.
    """

    begin: float
    duration: float
    largest: float
    largest_deviation: float
    impulse: float
    impulse_deviation: float
    excess_scatter: float
    samples: tuple[Floats, Floats]


def find_pulses(time: Floats, force: Floats) -> DetectedPulses:
    """Return the pulses in a force record.

    Raises
    ------
    InputError
        If there are none, the force is negative, or no samples remain for the baseline.
    """
    noise = max(record_noise(force), _LEAST * float(np.ptp(force)))
    low, high = float(force.min()), float(force.max())
    if not high > low:
        raise InputError("the record does not show an impact: the force is the same throughout")
    middle = float(np.median(force))
    if middle - low > max(_UPSIDE_DOWN * (high - middle), 2.0 * ABOVE_NOISE * noise):
        raise InputError("the force is negative; it must be positive where it pushes the sphere up")
    rest = np.full_like(force, np.median(force[force < 0.5 * (low + high)]))  # first estimate of the baseline
    for number in range(_PASSES):
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
            raise InputError("the record contains only the impact; some time before or after it is needed to determine the force at rest")
        if number < _PASSES - 1:
            rest = record_baseline(time, force, quiet)
    return DetectedPulses(force, noise, quiet, runs)


def evaluate_pulses(time: Floats, seen: DetectedPulses, runs: list[tuple[int, int]]) -> list[Pulse]:
    """Return the evaluated pulses of the selected index ranges."""
    between = [0, *((end + begin) // 2 for (_, end), (begin, _) in itertools.pairwise(seen.runs)), len(time)]
    segments = itertools.pairwise(between)
    return [_pulse(time, seen, run, segment) for run, segment in zip(seen.runs, segments, strict=True) if run in runs]


def _pulse(time: Floats, seen: DetectedPulses, run: tuple[int, int], segment: tuple[int, int]) -> Pulse:
    """Return one pulse, integrated above its baseline with a margin on either side, within its own segment of the record."""
    begin, end = run
    margin = _margin(begin, end)
    part = slice(max(begin - margin, segment[0]), min(end + margin, segment[1]))
    level = baseline_under_impact(time, seen.force, seen.quiet, part, segment, end - begin, seen.noise)
    force, at, step = seen.force[part] - level.values, time[part], float(np.median(np.diff(time)))
    impulse = float(np.trapezoid(force, at))
    noise = seen.noise * step * np.sqrt(part.stop - part.start)
    # sampling error: the change of the impulse at half the sampling rate, beyond that expected from noise
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
        excess_scatter=level.excess_scatter,
        samples=(at, force),
    )


def _largest(number: Indices, force: Floats) -> float:
    """Return the apex of a parabola through the samples near the maximum; the largest sample if they are few."""
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
    """Return the index ranges, merged where the gap between them is short compared with their length."""
    joined: list[tuple[int, int]] = []
    for begin, end in runs:
        if joined and begin - joined[-1][1] < _MARGIN * max(end - begin, joined[-1][1] - joined[-1][0]):
            joined[-1] = (joined[-1][0], end)
        else:
            joined.append((begin, end))
    return joined


def _runs(above: Bools) -> list[tuple[int, int]]:
    """Return the half-open index ranges of consecutive samples above the threshold."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], above, [False]]).astype(int)))
    return [(int(begin), int(end)) for begin, end in edges.reshape(-1, 2)]
