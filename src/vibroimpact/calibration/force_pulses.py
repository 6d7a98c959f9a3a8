"""Pulses in a force record: detection, duration, impulse and largest force, with standard
deviations.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.calibration.force_baseline import baseline_under_impact, record_baseline
from vibroimpact.calibration.record_noise import ABOVE_NOISE, record_noise
from vibroimpact.errors import InputError
from vibroimpact.signals.inverse.hertz_pulse import hertz_rise

_FEWEST = 5

_SMALL, _LEAST = 0.02, 1e-9
"""Detection threshold as a fraction of the largest force, and the lower bound of the
noise as a fraction of the range of the record.
"""

# ratio of negative to positive excursion above which the sign of the force is wrong
_UPSIDE_DOWN = 3.0

_PASSES, _MARGIN = 3, 0.25
"""Number of passes of detection and baseline, and the least margin on either side of a
pulse as a fraction of its duration.
"""

_ABOVE, _FOOT, _SHOULDER = 3.0, 0.05, 0.8
"""Part of a flank from which the begin is extrapolated: above a multiple of the noise and a
fraction of the largest force, and below another fraction.
"""

_FINE, _BETWEEN, _COARSE = 50, 0.2, 0.3
"""Points of a spline per sample; standard deviation of its largest value: a fraction of what it is
above the samples, and a multiple of the inverse square of the number of samples.
"""

_FLAT, _FLAT_PART = 3, 0.1
"""Number of successive samples with the same largest value, and fraction of the pulse,
from which it is clipped.
"""

_PEAK, _TOP = 0.003, 0.8
"""Relative standard deviation of the largest force, and the fraction of it above which
samples enter its parabola.
"""


class DetectedPulses(NamedTuple):
    """Pulses found in a force record: the force as recorded, its noise [N], the force above the
    baseline as it was detected by a threshold [N], a mask of the samples outside all pulses
    (quiet), and the pulses as half-open index ranges.
    """

    force: Floats
    noise: float
    above: Floats
    threshold: float
    quiet: Bools
    runs: list[tuple[int, int]]


class Pulse(NamedTuple):
    """A force pulse: start and duration [s], with the standard deviations of start and end by
    noise.

    Largest force [N] and impulse [N s] with standard deviations, and how far the impulse may be off
    between samples, as a part of it; scatter of the baseline beside it in excess of the noise [N];
    times and forces above the baseline around it; number of its samples, and whether it is clipped:
    then largest force and impulse are too small.
    """

    begin: float
    begin_deviation: float
    duration: float
    end_deviation: float
    largest: float
    largest_deviation: float
    impulse: float
    impulse_deviation: float
    between_samples: float
    excess_scatter: float
    samples: tuple[Floats, Floats]
    length: int
    clipped: bool


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
        raise InputError(
            "the pulses of the force are negative; it must be positive where "
            "it pushes the sphere up"
        )
    # first estimate of the baseline
    rest = np.full_like(force, np.median(force[force < 0.5 * (low + high)]))
    for number in range(_PASSES):
        above = force - rest
        threshold = max(ABOVE_NOISE * noise, _SMALL * float(above.max()))
        runs = [
            (begin, end)
            for begin, end in _joined(_runs(above > threshold))
            if above[begin:end].max() > 2.0 * threshold
        ]
        if not runs:
            raise InputError(
                "the record does not show an impact: no force stands out from the noise"
            )
        quiet = np.ones(len(force), dtype=bool)
        for begin, end in runs:
            margin = _margin(begin, end, threshold / float(above[begin:end].max()))
            quiet[max(begin - margin, 0) : end + margin] = False
        if np.count_nonzero(quiet) < _FEWEST:
            words = (
                f"fewer than {_FEWEST} samples of the record lie outside impacts, and they "
                "determine the force at rest"
            )
            raise InputError(f"{words}; record some time before or after the impacts")
        if number < _PASSES - 1:
            rest = record_baseline(time, force, quiet)
    return DetectedPulses(force, noise, above, threshold, quiet, runs)


def evaluate_pulses(time: Floats, seen: DetectedPulses, runs: list[tuple[int, int]]) -> list[Pulse]:
    """Return the evaluated pulses of the selected index ranges."""
    between = [
        0,
        *((end + begin) // 2 for (_, end), (begin, _) in itertools.pairwise(seen.runs)),
        len(time),
    ]
    segments = itertools.pairwise(between)
    pulses = [
        _pulse(time, seen, run, segment)
        for run, segment in zip(seen.runs, segments, strict=True)
        if run in runs
    ]
    # one pulse shows what lies between its samples or not, by their place in it: all have it in the
    # mean
    mean = float(np.sqrt(np.mean([pulse.between_samples**2 for pulse in pulses])))
    return [
        pulse._replace(
            impulse_deviation=float(np.hypot(pulse.impulse_deviation, mean * pulse.impulse)),
            between_samples=mean,
        )
        for pulse in pulses
    ]


def _pulse(
    time: Floats, seen: DetectedPulses, run: tuple[int, int], segment: tuple[int, int]
) -> Pulse:
    """Return one pulse, integrated above its baseline with a margin on either side,
    within its own segment of the record.
    """
    begin, end = run
    margin = _margin(begin, end, seen.threshold / float(seen.above[begin:end].max()))
    part = slice(max(begin - margin, segment[0]), min(end + margin, segment[1]))
    level = baseline_under_impact(
        time, seen.force, seen.quiet, part, segment, end - begin, seen.noise
    )
    force, at, step = seen.force[part] - level.values, time[part], float(np.median(np.diff(time)))
    impulse = float(np.trapezoid(force, at))
    noise = seen.noise * step * np.sqrt(part.stop - part.start)
    # sampling error: the change of the impulse at half the sampling rate, beyond that expected from
    # noise
    coarse = [np.trapezoid(force[first::2], at[first::2]) for first in (0, 1)]
    between = 0.5 * max(0.0, float(np.abs(impulse - np.array(coarse)).max()) - 2.0 * noise)
    inside, deviation = (
        force[begin - part.start : end - part.start],
        np.hypot(seen.noise, level.deviation),
    )
    largest, between_samples = _largest(force, slice(begin - part.start, end - part.start))
    top = int(np.argmax(inside)) + begin - part.start
    lasting = _lasting(at, force, largest, top)
    start, start_deviation = _edge(at[: top + 1], force[: top + 1], largest, deviation, lasting)
    back, end_deviation = _edge(-at[top:][::-1], force[top:][::-1], largest, deviation, lasting)
    return Pulse(
        begin=start,
        begin_deviation=start_deviation,
        duration=-back - start,
        end_deviation=end_deviation,
        largest=largest,
        largest_deviation=float(np.linalg.norm([deviation, _PEAK * largest, between_samples])),
        impulse=impulse,
        impulse_deviation=float(np.hypot(noise, level.impulse_deviation)),
        between_samples=between / impulse,
        excess_scatter=level.excess_scatter,
        samples=(at, force),
        length=end - begin,
        clipped=_clipped(seen.force[begin:end]),
    )


def _clipped(force: Floats) -> bool:
    """Return whether the largest value as recorded is held for longer than by the steps
    of a converter.
    """
    (longest,) = np.diff(max(_runs(force >= force.max()), key=lambda run: run[1] - run[0]))
    return bool(longest >= max(_FLAT, _FLAT_PART * len(force)))


def _lasting(time: Floats, force: Floats, largest: float, top: int) -> float:
    """Return the duration of a pulse by its width at half of its largest force, as of
    Hertz's force [s].
    """
    half = 0.5 * largest
    before = (
        int(np.flatnonzero(force[: top + 1] < half)[-1]) if np.any(force[: top + 1] < half) else 0
    )
    after = (
        top + int(np.argmax(force[top:] < half)) if np.any(force[top:] < half) else len(force) - 1
    )

    def crossing(one: int, other: int) -> float:
        share = (
            np.clip((half - force[one]) / (force[other] - force[one]), 0.0, 1.0)
            if force[other] != force[one]
            else 0.5
        )
        return float(time[one] + share * (time[other] - time[one]))

    width = crossing(after - 1, after) - crossing(before, before + 1)
    return width / float(1.0 - 2.0 * hertz_rise(np.array(0.5))[0])


def _edge(
    time: Floats, force: Floats, largest: float, noise: float, lasting: float
) -> tuple[float, float]:
    """Return when a force that rises to its largest value, at the end of the samples, has begun
    [s], and its standard deviation by noise.

    The samples of the flank are placed on the rise of Hertz's force, over a time that is fitted
    with the begin. A flank of one sample or none lasts as long as of a pulse of the given duration.
    """
    below = np.flatnonzero(force < max(_ABOVE * noise, _FOOT * largest))
    first = int(below[-1]) + 1 if below.size else 0
    flank = np.arange(first, len(force))[force[first:] < _SHOULDER * largest]
    if len(flank) < 2:
        risen, per_part = (
            float(part) for part in hertz_rise(np.clip(force[first] / largest, 0.0, _SHOULDER))
        )
        # anywhere between two samples
        step = 0.0 if len(flank) else float(np.median(np.diff(time))) / np.sqrt(12.0)
        return float(time[first]) - lasting * risen, float(
            np.hypot(lasting * per_part * noise / largest, step)
        )
    place, slope = hertz_rise(force[flank] / largest)
    middle, weights = float(time[flank].mean()), 1.0 / slope
    across = np.stack([np.ones(len(flank)), time[flank] - middle], axis=1)
    inverse = np.linalg.inv((across * weights[:, None] ** 2).T @ across)
    level, rate = inverse @ (across.T @ (weights**2 * place))
    shift = level / rate
    by_noise = (
        noise
        / largest
        / rate
        * np.sqrt(np.array([1.0, -shift]) @ inverse @ np.array([1.0, -shift]))
    )
    return middle - float(shift), float(by_noise)


def _largest(force: Floats, pulse: slice) -> tuple[float, float]:
    """Return the largest value of a force between its samples, and the standard deviation by
    sampling.

    It is the apex of a parabola through the samples near the maximum, or if they are few of a
    spline through all samples.
    """
    inside = force[pulse]
    largest = float(inside.max())
    top = np.flatnonzero(inside > _TOP * largest)
    if len(top) > _FEWEST:
        across = top - top.mean()
        a, b, c = np.linalg.lstsq(np.vander(across, 3), inside[top], rcond=None)[0]
        return (float(c - b * b / (4.0 * a)) if a < 0.0 else largest), 0.0
    from scipy.interpolate import CubicSpline  # imported late: few records need it

    fine = np.linspace(pulse.start, pulse.stop - 1, _FINE * len(inside))
    between = float(np.max(CubicSpline(np.arange(len(force)), force)(fine)))
    return between, _BETWEEN * (between - largest) + _COARSE * between / len(inside) ** 2


def _margin(begin: int, end: int, part: float) -> int:
    """Return the samples on either side of a pulse that was detected where it exceeds a part of its
    largest force.

    Of a small pulse much of its duration lies below, as of Hertz's force.
    """
    below = float(hertz_rise(np.array(min(part, 0.5)))[0])
    return int(max(_MARGIN, below / (1.0 - 2.0 * below)) * (end - begin)) + 1


def _joined(runs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return the index ranges, merged where the gap between them is short compared with
    their length.
    """
    joined: list[tuple[int, int]] = []
    for begin, end in runs:
        if joined and begin - joined[-1][1] < _MARGIN * max(
            end - begin, joined[-1][1] - joined[-1][0]
        ):
            joined[-1] = (joined[-1][0], end)
        else:
            joined.append((begin, end))
    return joined


def _runs(above: Bools) -> list[tuple[int, int]]:
    """Return the half-open index ranges of consecutive samples above the threshold."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], above, [False]]).astype(int)))
    return [(int(begin), int(end)) for begin, end in edges.reshape(-1, 2)]
