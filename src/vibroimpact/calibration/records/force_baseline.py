"""Drifting baseline of a force sensor: over a record, and under one impact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices

_MOST_BLOCKS = 20
_FEWEST_IN_BLOCK = 25
"""Maximum number of blocks of a record with a level each, and the minimum number of samples of a
block.
"""

_WIDTHS = (3.0, 1.5, 0.75)
"""Widths of the intervals beside an impact from which its baseline is estimated, in durations of
the impact; the widest at which the residuals are consistent with noise is used.
"""

_ENOUGH_FOR_PARABOLA = 0.5
"""Least width for a parabola, in durations of the impact."""

_FEWEST = 5
"""Least number of samples beside an impact."""

_NOT_NOISE = 0.999
"""Quantile of the residuals of white noise, above which they are a drift."""


class Baseline(NamedTuple):
    """The baseline under an impact.

    Its values at the samples [N]; its contribution to the impulse and the standard deviation of
    that [N s]; its standard deviation in the middle [N]; the scatter about the fitted curve [N], 0
    if consistent with noise.
    """

    values: Floats
    impulse: float
    impulse_deviation: float
    deviation: float
    excess_scatter: float


def record_baseline(time: Floats, force: Floats, quiet: Bools) -> Floats:
    """Return the baseline of a record at its times.

    It is linear between the medians of blocks of samples outside the impacts.

    Examples
    --------
    >>> time = np.linspace(0.0, 1.0, 1001)
    >>> baseline = record_baseline(time, 3.0 * time, np.ones(1001, dtype=bool))
    >>> float(np.abs(baseline - 3.0 * time).max()) < 1e-9
    True
    """
    quiet_samples = np.flatnonzero(quiet)
    block_count = min(_MOST_BLOCKS, len(quiet_samples) // _FEWEST_IN_BLOCK)
    block_count = max(1, block_count)
    blocks = np.array_split(quiet_samples, block_count)
    block_times = np.array([np.median(time[block]) for block in blocks])
    levels = np.array([np.median(force[block]) for block in blocks])
    baseline = np.asarray(np.interp(time, block_times, levels))
    if block_count == 1:
        return baseline
    # beyond the first and the last block, the line through it and its neighbour
    for outside, end, neighbour in (
        (time < block_times[0], 0, 1),
        (time > block_times[-1], -1, -2),
    ):
        rise = levels[neighbour] - levels[end]
        slope = rise / (block_times[neighbour] - block_times[end])
        baseline[outside] = levels[end] + slope * (time[outside] - block_times[end])
    return baseline


def baseline_under_impact(
    time: Floats,
    force: Floats,
    quiet: Bools,
    pulse: slice,
    segment: tuple[int, int],
    contact_samples: int,
    noise: float,
) -> Baseline:
    """Return the baseline under an impact, fitted to the samples on either side.

    It is a parabola, or a line if there are few samples. A parabola uses as many samples before as
    after the impact. The undershoot of a charge amplifier, a lower level after the impact than
    before, is then halved under the impact, as it should be.

    Parameters
    ----------
    time, force : array
        The record.
    quiet : array of bool
        Mask of the samples outside all impacts.
    pulse : slice
        The samples over which the impulse is integrated.
    segment : (int, int)
        Half-open index range of the samples nearer to this impact than to its neighbours.
    contact_samples : int
        Number of samples in contact.
    noise : float
        Standard deviation of one sample [N].
    """

    def with_width(width: float) -> Baseline:
        most = int(width * contact_samples) + 1
        before, after = _samples_beside(quiet, pulse, segment, most)
        return _fitted_baseline(time, force, quiet, pulse, before, after, contact_samples, noise)

    baseline = with_width(_WIDTHS[0])
    excess_scatter = 0.0
    for width in _WIDTHS[1:]:
        if not baseline.excess_scatter:
            break
        wider = baseline
        baseline = with_width(width)
        excess_scatter = max(excess_scatter, wider.excess_scatter)
        # the effect of the width on the impulse is an uncertainty in addition to noise
        by_width = 0.5 * (baseline.impulse - wider.impulse)
        impulse_deviation = float(np.hypot(baseline.impulse_deviation, by_width))
        baseline = baseline._replace(impulse_deviation=impulse_deviation)
    return baseline._replace(excess_scatter=max(excess_scatter, baseline.excess_scatter))


def _samples_beside(
    quiet: Bools, pulse: slice, segment: tuple[int, int], most: int
) -> tuple[Indices, Indices]:
    """Return the quiet samples nearest to an impact, at most `most` before it and after it."""
    before = np.flatnonzero(quiet[segment[0] : pulse.start])[-most:] + segment[0]
    after = np.flatnonzero(quiet[pulse.stop : segment[1]])[:most] + pulse.stop
    return before, after


def _fitted_baseline(
    time: Floats,
    force: Floats,
    quiet: Bools,
    pulse: slice,
    before: Indices,
    after: Indices,
    contact_samples: int,
    noise: float,
) -> Baseline:
    """Return the polynomial by least squares through the samples before and after an impact."""
    fewer = min(len(before), len(after))
    if fewer >= max(_FEWEST, int(_ENOUGH_FOR_PARABOLA * contact_samples)):
        beside = np.concatenate([before[-fewer:], after[:fewer]])
        degree = 2
    else:
        beside = np.concatenate([before, after])
        degree = 1
    if len(beside) < _FEWEST:  # too few: a constant from all samples outside impacts
        beside = np.flatnonzero(quiet)
        degree = 0
    pulse_time = time[pulse]
    span = float(time[beside].max() - time[beside].min())
    middle = 0.5 * (pulse_time[0] + pulse_time[-1])

    def powers(times: Floats) -> Floats:
        return np.vander((times - middle) / span, degree + 1, increasing=True)

    beside_time = time[beside]
    coefficients, *_ = np.linalg.lstsq(powers(beside_time), force[beside], rcond=None)
    residual = force[beside] - powers(beside_time) @ coefficients
    # covariance of the coefficients by noise of unit variance
    inverse = np.linalg.inv(powers(beside_time).T @ powers(beside_time))
    # the impulse is linear in the coefficients
    weights = np.trapezoid(powers(pulse_time), pulse_time, axis=0)
    excess_scatter = 0.0
    freedom = len(beside) - degree - 1
    if freedom > 0:
        scatter = float(np.sqrt(residual @ residual / freedom))
        if _exceeds_noise(scatter / noise, freedom):
            excess_scatter = scatter
    impulse_by_noise = noise * np.sqrt(weights @ inverse @ weights)
    # what the curve does not follow may be an offset throughout the pulse
    impulse_by_drift = excess_scatter * (pulse_time[-1] - pulse_time[0])
    return Baseline(
        values=powers(pulse_time) @ coefficients,
        impulse=float(weights @ coefficients),
        impulse_deviation=float(np.hypot(impulse_by_noise, impulse_by_drift)),
        deviation=float(np.hypot(noise * np.sqrt(inverse[0, 0]), excess_scatter)),
        excess_scatter=excess_scatter,
    )


def _exceeds_noise(ratio: float, freedom: int) -> bool:
    from scipy.stats import chi2  # imported late: it takes longer to load than a calibration

    return bool(ratio**2 * freedom > chi2.ppf(_NOT_NOISE, freedom))
