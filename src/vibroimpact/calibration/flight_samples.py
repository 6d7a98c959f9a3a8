"""Samples of a position record that show flights: impacts, release, landing, and what
lies between.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.flights import Flights
from vibroimpact.calibration.joint_flights import JointFlights
from vibroimpact.calibration.record_noise import ABOVE_NOISE
from vibroimpact.errors import InputError

SMALL = 0.02
"""Fraction of the range of the record, the least prominence of an impact."""

_FEWEST = 5
"""Minimum number of samples of a fitted flight."""

_BESIDE = 2
"""Samples that are omitted on either side of an impact."""

_LANDED = 0.25
"""Fraction of the height of the last flight below which its samples are omitted at first:
the sphere may rebound a little or rest then.
"""

_LEFT_TOP, _HELD, _HELD_NOISE = 0.9, 1e-4, 1.5
"""Fraction of the height of the first fall below which a sphere that was held has been released;
scatter of the record about a parabola above which it was held: a fraction of that height, and a
multiple of the noise.
"""


def lowest_points(position: Floats, noise: float) -> Indices:
    """Return the indices of the local minima of the position, the impacts."""
    from scipy.signal import find_peaks

    rise = float(position.max() - position.min())
    found, _ = find_peaks(
        -position, prominence=max(SMALL * rise, ABOVE_NOISE * noise), plateau_size=1
    )
    return np.asarray(found)


def release(time: Floats, position: Floats, low: int, noise: float) -> int:
    """Return the index at which the first fall begins: 0, or if a parabola does not follow it from
    there, where it has left the top.

    The sphere is held before it falls.
    """
    falling, lowest, fallen = (
        position[:low],
        float(position[low]),
        float(np.ptp(position[: low + 1])),
    )
    below = np.flatnonzero(falling > lowest + _LEFT_TOP * fallen)
    begin = int(below[-1]) + 1 if below.size else 0
    whole, rest = (
        _scatter_about_parabola(time[:low], falling),
        _scatter_about_parabola(time[begin:low], falling[begin:]),
    )
    held = whole > np.hypot(_HELD_NOISE * noise, _HELD * fallen) and rest < 0.5 * whole
    return begin if held else 0


def _scatter_about_parabola(time: Floats, position: Floats) -> float:
    if len(time) < _FEWEST:
        return float("inf")
    powers = np.vander(time - time.mean(), 3)
    left = position - powers @ np.linalg.lstsq(powers, position, rcond=None)[0]
    return float(np.sqrt(left @ left / (len(time) - 3)))


def samples_above_impacts(
    position: Floats, ends: Sequence[int], noise: float
) -> dict[int, Indices]:
    """Return the samples of each flight above the lowest impact; of the last one, those
    before it comes near the plate again.
    """
    level, selected = float(position[ends[1:-1]].min()), {}
    for number, inside in _beside_impacts(ends).items():
        selected[number] = inside[position[inside] > level + ABOVE_NOISE * noise]
    last = selected[len(ends) - 2]
    if len(last):
        height = position[last] - level
        top = int(np.argmax(height))
        falling = np.minimum.accumulate(height[top:])
        landed = np.flatnonzero(
            (falling < _LANDED * height[top]) | (height[top:] > falling + ABOVE_NOISE * noise)
        )
        selected[len(ends) - 2] = (
            last[: max(top + int(landed[0]) - _BESIDE, 0)] if landed.size else last
        )
    return selected


def samples_of_flights(
    joint: JointFlights,
    kept: Mapping[int, Indices],
    time: Floats,
    ends: Sequence[int],
    radius: float,
    flying: Flights,
) -> dict[int, Indices]:
    """Return the samples of each fitted flight at which it is above the plate, whatever
    their noise.
    """
    every, selected = _beside_impacts(ends), {}
    for number, top, when in zip(kept, joint.tops, joint.times, strict=True):
        inside = every[number]
        fallen, downwards = flying.depth_at((time[inside] - when) / joint.clock)
        selected[number] = inside[top - fallen > radius + ABOVE_NOISE * joint.deviation(downwards)]
    return selected


def _beside_impacts(ends: Sequence[int]) -> dict[int, Indices]:
    """Return the samples between successive impacts; the record may cut the first and the
    last flight short.
    """
    last, found = len(ends) - 2, {}
    for number, (begin, end) in enumerate(itertools.pairwise(ends)):
        found[number] = np.arange(
            begin + (_BESIDE if number else 0), end + 1 - (_BESIDE if number < last else 0)
        )
    return found


def with_enough_samples(
    selected: Mapping[int, Indices], ends: Sequence[int], at: Callable[[int], str]
) -> dict[int, Indices]:
    """Return the flights that have enough samples, which only the first and the last may lack."""
    found = {}
    for number, inside in selected.items():
        if len(inside) >= _FEWEST:
            found[number] = inside
        elif 0 < number < len(ends) - 2:
            few = {0: "no sample shows", 1: "only one sample shows"}.get(
                len(inside), f"only {len(inside)} samples show"
            )
            raise InputError(
                f"between the impacts at {at(ends[number])} and {at(ends[number + 1])} "
                f"{few} the sphere above the plate, but {_FEWEST} are "
                "needed; sample faster, end the record before, or look at sign "
                "and unit of the position"
            )
    if 1 not in found:
        raise InputError(
            "the record shows too little of the rebound from the first impact, of which "
            f"at least {_FEWEST} samples above the plate are "
            "needed; record longer, or sample faster"
        )
    return found
