"""Drifting baseline of a force sensor: over a record, and under one impact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats

_BLOCKS, _IN_BLOCK = 20, 25
"""Maximum number of blocks of a record with a level each, and the minimum number of
samples of a block.
"""

_WIDTHS, _ENOUGH = (3.0, 1.5, 0.75), 0.5
"""Widths of the intervals beside an impact from which its baseline is estimated, in durations of
the impact; the widest at which the residuals are consistent with noise is used. Then the minimum
width for a parabola.
"""

_FEWEST = 5
_NOT_NOISE = 0.999  # quantile of the residuals of white noise, above which they are a drift


class Baseline(NamedTuple):
    """The baseline under an impact: values at its samples [N]; its contribution to the impulse and
    the standard deviation of that [N s]; its standard deviation in the middle [N]; the scatter
    about the fitted curve [N], 0 if consistent with noise.
    """

    values: Floats
    impulse: float
    impulse_deviation: float
    deviation: float
    excess_scatter: float


def record_baseline(time: Floats, force: Floats, quiet: Bools) -> Floats:
    """Return the baseline of a record at its times, linear between the medians of blocks of samples
    outside the impacts.

    Examples
    --------
    >>> time = np.linspace(0.0, 1.0, 1001)
    >>> level = record_baseline(time, 3.0 * time, np.ones(1001, dtype=bool))
    >>> float(np.abs(level - 3.0 * time).max()) < 1e-9
    True
    """
    places = np.flatnonzero(quiet)
    pieces = np.array_split(places, max(1, min(_BLOCKS, len(places) // _IN_BLOCK)))
    at, levels = (
        np.array([np.median(values[piece]) for piece in pieces]) for values in (time, force)
    )
    found = np.asarray(np.interp(time, at, levels))
    if len(at) == 1:
        return found
    for outside, (one, other) in ((time < at[0], (0, 1)), (time > at[-1], (-1, -2))):
        slope = (levels[other] - levels[one]) / (at[other] - at[one])
        found[outside] = levels[one] + slope * (time[outside] - at[one])
    return found


def baseline_under_impact(
    time: Floats,
    force: Floats,
    quiet: Bools,
    part: slice,
    segment: tuple[int, int],
    length: int,
    noise: float,
) -> Baseline:
    """Return the baseline under an impact from the samples on either side: a parabola, or a line if
    there are few.

    A parabola uses as many samples before as after the impact. The undershoot of a charge
    amplifier, a lower level after the impact than before, is then halved under the impact, as it
    should be.

    Parameters
    ----------
    time, force : array
        The record.
    quiet : array of bool
        Mask of the samples outside all impacts.
    part : slice
        The samples over which the impulse is integrated.
    segment : (int, int)
        Half-open index range of the samples nearer to this impact than to its neighbours.
    length : int
        Number of samples in contact.
    noise : float
        Standard deviation of one sample [N].
    """
    level, excess_scatter = (
        _baseline(time, force, quiet, part, segment, length, noise, _WIDTHS[0]),
        0.0,
    )
    for width in _WIDTHS[1:]:
        if not level.excess_scatter:
            break
        wider, level = level, _baseline(time, force, quiet, part, segment, length, noise, width)
        excess_scatter = max(excess_scatter, wider.excess_scatter)
        # the effect of the width on the impulse is an uncertainty in addition to noise
        unsure = float(np.hypot(level.impulse_deviation, 0.5 * (level.impulse - wider.impulse)))
        level = level._replace(impulse_deviation=unsure)
    return level._replace(excess_scatter=max(excess_scatter, level.excess_scatter))


def _baseline(
    time: Floats,
    force: Floats,
    quiet: Bools,
    part: slice,
    segment: tuple[int, int],
    length: int,
    noise: float,
    width: float,
) -> Baseline:
    most = int(width * length) + 1
    before = np.flatnonzero(quiet[segment[0] : part.start])[-most:] + segment[0]
    after = np.flatnonzero(quiet[part.stop : segment[1]])[:most] + part.stop
    both, degree = min(len(before), len(after)), 1
    if both >= max(_FEWEST, int(_ENOUGH * length)):
        before, after, degree = before[-both:], after[:both], 2
    beside = np.concatenate([before, after])
    if len(beside) < _FEWEST:  # too few: a constant from all samples outside impacts
        beside, degree = np.flatnonzero(quiet), 0
    inside, span = time[part], float(time[beside].max() - time[beside].min())
    middle = 0.5 * (inside[0] + inside[-1])

    def powers(at: Floats) -> Floats:
        return np.vander((at - middle) / span, degree + 1, increasing=True)

    coefficients, *_ = np.linalg.lstsq(powers(time[beside]), force[beside], rcond=None)
    left = force[beside] - powers(time[beside]) @ coefficients
    freedom = len(beside) - degree - 1
    inverse = np.linalg.inv(powers(time[beside]).T @ powers(time[beside]))
    weights = np.trapezoid(powers(inside), inside, axis=0)
    scatter = float(np.sqrt(left @ left / freedom)) if freedom > 0 else 0.0
    excess_scatter = scatter if freedom > 0 and _exceeds_noise(scatter / noise, freedom) else 0.0
    return Baseline(
        values=powers(inside) @ coefficients,
        impulse=float(weights @ coefficients),
        impulse_deviation=float(
            np.hypot(
                noise * np.sqrt(weights @ inverse @ weights),
                excess_scatter * (inside[-1] - inside[0]),
            )
        ),
        deviation=float(np.hypot(noise * np.sqrt(inverse[0, 0]), excess_scatter)),
        excess_scatter=excess_scatter,
    )


def _exceeds_noise(ratio: float, freedom: int) -> bool:
    from scipy.stats import chi2  # imported late: it takes longer to load than a calibration

    return bool(ratio**2 * freedom > chi2.ppf(_NOT_NOISE, freedom))
