"""The reading of a force sensor at rest, which drifts: over a whole record, and about one impact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats

_BLOCKS, _IN_BLOCK = 20, 25
"""Pieces of a record of which each has a level, at most, and the samples of one, at least."""

_WIDTHS, _ENOUGH = (3.0, 1.5, 0.75), 0.5
"""How much time on either side of an impact tells the level, in times of its own: the widest at which noise explains what a parabola
does not follow; and the least for a parabola.
"""

_FEWEST = 5
_NOT_NOISE = 0.999  # of all records whose noise is white look less like a drift


class Baseline(NamedTuple):
    """The level under an impact: values at its samples, what it adds to the impulse and the standard deviation of that [N s], its standard
    deviation in the middle [N], and how far the level wanders about the curve that was laid through it [N]; 0 where noise explains that.
    """

    values: Floats
    impulse: float
    impulse_deviation: float
    deviation: float
    wanders: float


def record_baseline(time: Floats, force: Floats, quiet: Bools) -> Floats:
    """Return the level of a record at each of its times: straight between the medians of pieces of what is quiet.

    Examples
    --------
    >>> time = np.linspace(0.0, 1.0, 1001)
    >>> level = record_baseline(time, 3.0 * time, np.ones(1001, dtype=bool))
    >>> float(np.abs(level - 3.0 * time).max()) < 1e-9
    True
    """
    places = np.flatnonzero(quiet)
    pieces = np.array_split(places, max(1, min(_BLOCKS, len(places) // _IN_BLOCK)))
    at, levels = (np.array([np.median(values[piece]) for piece in pieces]) for values in (time, force))
    found = np.asarray(np.interp(time, at, levels))
    if len(at) == 1:
        return found
    for outside, (one, other) in ((time < at[0], (0, 1)), (time > at[-1], (-1, -2))):
        slope = (levels[other] - levels[one]) / (at[other] - at[one])
        found[outside] = levels[one] + slope * (time[outside] - at[one])
    return found


def baseline_under_impact(
    time: Floats, force: Floats, quiet: Bools, part: slice, room: tuple[int, int], length: int, noise: float
) -> Baseline:
    """Return the level under an impact, from what is quiet on either side: a parabola, or a line where there is little time.

    As much is taken on one side as on the other. So what a charge amplifier makes of the impact itself, a lower level after it than
    before, is halved under it, as it is in truth.

    Parameters
    ----------
    time, force : array
        The record.
    quiet : array of bool
        Which samples belong to no impact.
    part : slice
        The samples over which the impact is integrated.
    room : (int, int)
        The samples that belong to this impact and not to its neighbours: first and behind the last.
    length : int
        Samples in contact.
    noise : float
        Standard deviation of one sample [N].
    """
    level, wanders = _baseline(time, force, quiet, part, room, length, noise, _WIDTHS[0]), 0.0
    for width in _WIDTHS[1:]:
        if not level.wanders:
            break
        wider, level = level, _baseline(time, force, quiet, part, room, length, noise, width)
        wanders = max(wanders, wider.wanders)
        # what the choice of the width changes is not known, beside what noise does
        unsure = float(np.hypot(level.impulse_deviation, 0.5 * (level.impulse - wider.impulse)))
        level = level._replace(impulse_deviation=unsure)
    return level._replace(wanders=max(wanders, level.wanders))


def _baseline(
    time: Floats,
    force: Floats,
    quiet: Bools,
    part: slice,
    room: tuple[int, int],
    length: int,
    noise: float,
    width: float,
) -> Baseline:
    most = int(width * length) + 1
    before = np.flatnonzero(quiet[room[0] : part.start])[-most:] + room[0]
    after = np.flatnonzero(quiet[part.stop : room[1]])[:most] + part.stop
    both, degree = min(len(before), len(after)), 1
    if both >= max(_FEWEST, int(_ENOUGH * length)):
        before, after, degree = before[-both:], after[:both], 2
    beside = np.concatenate([before, after])
    if len(beside) < _FEWEST:  # too little to tell more than one level of the whole record
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
    wanders = scatter if freedom > 0 and _exceeds_noise(scatter / noise, freedom) else 0.0
    return Baseline(
        values=powers(inside) @ coefficients,
        impulse=float(weights @ coefficients),
        impulse_deviation=float(np.hypot(noise * np.sqrt(weights @ inverse @ weights), wanders * (inside[-1] - inside[0]))),
        deviation=float(np.hypot(noise * np.sqrt(inverse[0, 0]), wanders)),
        wanders=wanders,
    )


def _exceeds_noise(ratio: float, freedom: int) -> bool:
    from scipy.stats import chi2  # which takes longer to load than a calibration

    return bool(ratio**2 * freedom > chi2.ppf(_NOT_NOISE, freedom))
