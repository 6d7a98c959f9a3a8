"""Pulses in a force record: detection, duration, impulse, largest force and their deviations."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.calibration.records.force_baseline import baseline_under_impact, record_baseline
from vibroimpact.calibration.records.record_noise import ABOVE_NOISE, record_noise
from vibroimpact.errors import InputError
from vibroimpact.signals.inverse.hertz_pulse import hertz_rise

_FEWEST = 5
"""Least number of samples outside all pulses, and of those near the maximum for a parabola."""

_SMALL = 0.02
"""Detection threshold as a fraction of the largest force."""

_LEAST_NOISE = 1e-9
"""Lower bound of the noise as a fraction of the range of the record."""

_UPSIDE_DOWN = 3.0
"""Ratio of negative to positive excursion above which the sign of the force is wrong."""

_PASSES = 3
"""Number of passes of detection and baseline."""

_MARGIN = 0.25
"""Least margin on either side of a pulse as a fraction of its duration."""

_ABOVE_NOISE = 3.0
_FOOT = 0.05
_SHOULDER = 0.8
"""Part of a flank from which the begin is extrapolated: above a multiple of the noise and a
fraction of the largest force, and below another fraction.
"""

_SPLINE_POINTS = 50
_BETWEEN = 0.2
_COARSE = 0.3
"""Points of a spline per sample; standard deviation of its largest value: a fraction of what it is
above the samples, and a multiple of the inverse square of the number of samples.
"""

_FLAT = 3
_FLAT_FRACTION = 0.1
"""Number of successive samples with the same largest value, and fraction of the pulse, from which
it is clipped.
"""

_PEAK_DEVIATION = 0.003
"""Relative standard deviation of the largest force."""

_TOP = 0.8
"""Fraction of the largest force above which samples enter its parabola."""


class DetectedPulses(NamedTuple):
    """Pulses found in a force record.

    The force as recorded, its noise [N], the force above the baseline as it was detected by a
    threshold [N], a mask of the samples outside all pulses (quiet), and the pulses as half-open
    index ranges.
    """

    force: Floats
    noise: float
    above: Floats
    threshold: float
    quiet: Bools
    runs: list[tuple[int, int]]


class Pulse(NamedTuple):
    """A force pulse.

    Start and duration [s], with the standard deviations of start and end by noise. Largest force
    [N] and impulse [N s] with standard deviations, and how far the impulse may be off between
    samples, as a part of it; scatter of the baseline beside it in excess of the noise [N]; times
    and forces above the baseline around it; number of its samples, and whether it is clipped: then
    largest force and impulse are too small.
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
    noise = max(record_noise(force), _LEAST_NOISE * float(np.ptp(force)))
    _check_sign(force, noise)
    # first estimate of the baseline
    middle = 0.5 * (float(force.min()) + float(force.max()))
    baseline = np.full_like(force, np.median(force[force < middle]))
    for pass_number in range(_PASSES):
        above = force - baseline
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
            raise InputError(
                f"fewer than {_FEWEST} samples of the record lie outside impacts, and they "
                "determine the force at rest; record some time before or after the impacts"
            )
        if pass_number < _PASSES - 1:
            baseline = record_baseline(time, force, quiet)
    return DetectedPulses(force, noise, above, threshold, quiet, runs)


def _check_sign(force: Floats, noise: float) -> None:
    """Check that the force changes, and that its pulses are positive."""
    low = float(force.min())
    high = float(force.max())
    if not high > low:
        raise InputError("the record does not show an impact: the force is the same throughout")
    median = float(np.median(force))
    if median - low > max(_UPSIDE_DOWN * (high - median), 2.0 * ABOVE_NOISE * noise):
        raise InputError(
            "the pulses of the force are negative; it must be positive where "
            "it pushes the sphere up"
        )


def evaluate_pulses(
    time: Floats, detected: DetectedPulses, runs: list[tuple[int, int]]
) -> list[Pulse]:
    """Return the evaluated pulses of the selected index ranges."""
    # each pulse has a segment of the record, up to the middle between it and the next one
    limits = [0]
    for (_, end), (next_begin, _) in itertools.pairwise(detected.runs):
        limits.append((end + next_begin) // 2)
    limits.append(len(time))
    pulses = [
        _pulse(time, detected, run, segment)
        for run, segment in zip(detected.runs, itertools.pairwise(limits), strict=True)
        if run in runs
    ]
    # one pulse shows what lies between its samples or not, by their place in it: all have it in the
    # mean
    between_samples = float(np.sqrt(np.mean([pulse.between_samples**2 for pulse in pulses])))
    return [
        pulse._replace(
            impulse_deviation=float(
                np.hypot(pulse.impulse_deviation, between_samples * pulse.impulse)
            ),
            between_samples=between_samples,
        )
        for pulse in pulses
    ]


def _pulse(
    time: Floats, detected: DetectedPulses, run: tuple[int, int], segment: tuple[int, int]
) -> Pulse:
    """Return one pulse, integrated above its baseline within its own segment of the record.

    The integral has a margin on either side.
    """
    begin, end = run
    margin = _margin(begin, end, detected.threshold / float(detected.above[begin:end].max()))
    integrated = slice(max(begin - margin, segment[0]), min(end + margin, segment[1]))
    baseline = baseline_under_impact(
        time, detected.force, detected.quiet, integrated, segment, end - begin, detected.noise
    )
    pulse_time = time[integrated]
    force = detected.force[integrated] - baseline.values
    impulse = float(np.trapezoid(force, pulse_time))
    step = float(np.median(np.diff(time)))
    impulse_noise = detected.noise * step * np.sqrt(integrated.stop - integrated.start)
    # sampling error: the change of the impulse at half the sampling rate, beyond that expected from
    # noise
    of_even_samples = float(np.trapezoid(force[::2], pulse_time[::2]))
    of_odd_samples = float(np.trapezoid(force[1::2], pulse_time[1::2]))
    change = max(abs(impulse - of_even_samples), abs(impulse - of_odd_samples))
    between = 0.5 * max(0.0, change - 2.0 * impulse_noise)
    contact = slice(begin - integrated.start, end - integrated.start)
    force_deviation = np.hypot(detected.noise, baseline.deviation)
    largest, largest_by_sampling = _largest(force, contact)
    top = int(np.argmax(force[contact])) + contact.start
    duration = _duration_at_half(pulse_time, force, largest, top)
    start, start_deviation = _begin_of_rise(
        pulse_time[: top + 1], force[: top + 1], largest, force_deviation, duration
    )
    # the end of the pulse is the begin of its rise in reversed time
    reversed_end, end_deviation = _begin_of_rise(
        -pulse_time[top:][::-1], force[top:][::-1], largest, force_deviation, duration
    )
    largest_deviations = [force_deviation, _PEAK_DEVIATION * largest, largest_by_sampling]
    return Pulse(
        begin=start,
        begin_deviation=start_deviation,
        duration=-reversed_end - start,
        end_deviation=end_deviation,
        largest=largest,
        largest_deviation=float(np.linalg.norm(largest_deviations)),
        impulse=impulse,
        impulse_deviation=float(np.hypot(impulse_noise, baseline.impulse_deviation)),
        between_samples=between / impulse,
        excess_scatter=baseline.excess_scatter,
        samples=(pulse_time, force),
        length=end - begin,
        clipped=_clipped(detected.force[begin:end]),
    )


def _clipped(force: Floats) -> bool:
    """Return whether the largest recorded value is held for longer than by steps of a converter."""
    longest = max(end - begin for begin, end in _runs(force >= force.max()))
    return bool(longest >= max(_FLAT, _FLAT_FRACTION * len(force)))


def _duration_at_half(time: Floats, force: Floats, largest: float, top: int) -> float:
    """Return the duration of a Hertzian pulse with the same width at half of its largest force [s].

    `top` is the index of the largest sample.
    """
    half = 0.5 * largest
    low_before = np.flatnonzero(force[: top + 1] < half)
    low_after = np.flatnonzero(force[top:] < half)
    # a pulse that is cut off has no low sample on that side
    before = 0
    if low_before.size:
        before = low_before[-1]
    after = len(force) - 1
    if low_after.size:
        after = top + low_after[0]

    def crossing(first: int) -> float:
        """Return when the line from a sample to the next crosses half of the largest force."""
        rise = force[first + 1] - force[first]
        step = time[first + 1] - time[first]
        fraction = 0.5
        if rise != 0.0:
            fraction = np.clip((half - force[first]) / rise, 0.0, 1.0)
        return float(time[first] + fraction * step)

    width = crossing(after - 1) - crossing(before)
    # Hertz's force takes this fraction of the duration up to half of its largest value
    rise_to_half = hertz_rise(np.array(0.5))[0]
    return width / float(1.0 - 2.0 * rise_to_half)


def _begin_of_rise(
    time: Floats, force: Floats, largest: float, noise: float, duration: float
) -> tuple[float, float]:
    """Return when a force has begun to rise [s], and its standard deviation by noise.

    It rises to its largest value at the end of the samples. The samples of the flank are placed on
    the rise of Hertz's force, over a time that is fitted with the begin. A flank of one sample or
    none lasts as long as of a pulse of the given duration.
    """
    below = np.flatnonzero(force < max(_ABOVE_NOISE * noise, _FOOT * largest))
    first = below[-1] + 1 if below.size else 0
    flank = first + np.flatnonzero(force[first:] < _SHOULDER * largest)
    if len(flank) >= 2:
        return _begin_of_line(time[flank], force[flank] / largest, noise / largest)
    rise, rise_slope = hertz_rise(np.clip(force[first] / largest, 0.0, _SHOULDER))
    begin = float(time[first]) - duration * float(rise)
    by_noise = duration * float(rise_slope) * noise / largest
    by_sampling = 0.0
    if not len(flank):
        # the begin lies anywhere between two samples: the deviation of a uniform distribution
        step = float(np.median(np.diff(time)))
        by_sampling = step / np.sqrt(12.0)
    return begin, float(np.hypot(by_noise, by_sampling))


def _begin_of_line(time: Floats, relative_force: Floats, noise: float) -> tuple[float, float]:
    """Return when the rise of Hertz's force through samples has begun, and the deviation [s].

    Forces and noise are relative to the largest force. The fraction of the duration over time is a
    line, by least squares with the inverse deviations of the fractions as weights.
    """
    fraction, slope = hertz_rise(relative_force)
    weights = 1.0 / slope
    middle = float(time.mean())
    design = np.stack([np.ones(len(time)), time - middle], axis=1)
    normal = (design * weights[:, None] ** 2).T @ design
    inverse = np.linalg.inv(normal)
    intercept, rate = inverse @ (design.T @ (weights**2 * fraction))
    # the line is zero at the begin, middle - shift
    shift = intercept / rate
    gradient = np.array([1.0, -shift])
    deviation = noise / rate * np.sqrt(gradient @ inverse @ gradient)
    return middle - float(shift), float(deviation)


def _largest(force: Floats, contact: slice) -> tuple[float, float]:
    """Return the largest value of a force between its samples, and its deviation by sampling.

    It is the apex of a parabola through the samples near the maximum, or if they are few of a
    spline through all samples.
    """
    contact_force = force[contact]
    largest_sample = float(contact_force.max())
    top = np.flatnonzero(contact_force > _TOP * largest_sample)
    if len(top) > _FEWEST:
        from_middle = top - top.mean()
        a, b, c = np.linalg.lstsq(np.vander(from_middle, 3), contact_force[top], rcond=None)[0]
        # a parabola that opens upwards has no apex: the samples are flat, or noise
        if a < 0.0:
            return float(c - b * b / (4.0 * a)), 0.0
        return largest_sample, 0.0
    from scipy.interpolate import CubicSpline  # imported late: few records need it

    count = len(contact_force)
    spline = CubicSpline(np.arange(len(force)), force)
    between_samples = np.linspace(contact.start, contact.stop - 1, _SPLINE_POINTS * count)
    largest = float(np.max(spline(between_samples)))
    deviation = _BETWEEN * (largest - largest_sample) + _COARSE * largest / count**2
    return largest, deviation


def _margin(begin: int, end: int, fraction: float) -> int:
    """Return the samples on either side of a pulse that was detected above a fraction of its peak.

    Of a small pulse much of its duration lies below, as of Hertz's force.
    """
    below = float(hertz_rise(np.array(min(fraction, 0.5)))[0])
    return int(max(_MARGIN, below / (1.0 - 2.0 * below)) * (end - begin)) + 1


def _joined(runs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return the index ranges, merged where the gap between them is short for their length."""
    joined: list[tuple[int, int]] = []
    for begin, end in runs:
        if joined:
            last_begin, last_end = joined[-1]
            if begin - last_end < _MARGIN * max(end - begin, last_end - last_begin):
                joined[-1] = (last_begin, end)
                continue
        joined.append((begin, end))
    return joined


def _runs(above: Bools) -> list[tuple[int, int]]:
    """Return the half-open index ranges of consecutive samples above the threshold."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], above, [False]]).astype(int)))
    return [(int(begin), int(end)) for begin, end in edges.reshape(-1, 2)]
