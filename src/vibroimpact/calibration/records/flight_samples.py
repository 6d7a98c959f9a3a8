"""Samples of a position record that show flights: impacts, release, landing, and flights between.

A record of n impacts has n + 2 boundaries: the indices of the release, of the impacts and of the
last sample. The flight of number k lies between boundaries k and k + 1; number 0 is the fall.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.observed.flights import Flights
from vibroimpact.calibration.records.joint_flights import JointFlights
from vibroimpact.calibration.records.record_noise import ABOVE_NOISE
from vibroimpact.errors import InputError

SMALL = 0.02
"""Fraction of the range of the record, the least prominence of an impact."""

_FEWEST = 5
"""Minimum number of samples of a fitted flight."""

_BESIDE = 2
"""Samples that are omitted on either side of an impact."""

_LANDED = 0.25
"""Fraction of the height of the last flight below which its samples are omitted at first: the
sphere may rebound a little or rest then.
"""

_LEFT_TOP = 0.9
"""Fraction of the height of the first fall below which a sphere that was held has been released."""

_HELD = 1e-4
_HELD_NOISE = 1.5
"""Scatter of the record about a parabola above which the sphere was held: a fraction of the height
of the first fall, and a multiple of the noise.
"""


def lowest_points(position: Floats, noise: float) -> Indices:
    """Return the indices of the local minima of the position, the impacts."""
    from scipy.signal import find_peaks

    rise = float(position.max() - position.min())
    prominence = max(SMALL * rise, ABOVE_NOISE * noise)
    minima, _ = find_peaks(-position, prominence=prominence, plateau_size=1)
    return np.asarray(minima)


def release(time: Floats, position: Floats, first_impact: int, noise: float) -> int:
    """Return the index at which the first fall begins.

    It is 0, or if a parabola does not follow the fall from there, where the fall has left the top:
    the sphere is held before it falls.
    """
    falling = position[:first_impact]
    lowest = float(position[first_impact])
    fall_height = float(np.ptp(position[: first_impact + 1]))
    at_top = np.flatnonzero(falling > lowest + _LEFT_TOP * fall_height)
    released = 0
    if at_top.size:
        released = int(at_top[-1]) + 1
    # a sphere that is held first leaves the parabola of a fall, and follows it once it is released
    scatter_from_start = _scatter_about_parabola(time[:first_impact], falling)
    scatter_from_release = _scatter_about_parabola(time[released:first_impact], falling[released:])
    held = (
        scatter_from_start > np.hypot(_HELD_NOISE * noise, _HELD * fall_height)
        and scatter_from_release < 0.5 * scatter_from_start
    )
    return released if held else 0


def _scatter_about_parabola(time: Floats, position: Floats) -> float:
    if len(time) < _FEWEST:
        return float("inf")
    powers = np.vander(time - time.mean(), 3)
    residual = position - powers @ np.linalg.lstsq(powers, position, rcond=None)[0]
    return float(np.sqrt(residual @ residual / (len(time) - 3)))


def samples_above_impacts(
    position: Floats, boundaries: Sequence[int], noise: float
) -> dict[int, Indices]:
    """Return the samples of each flight above the lowest impact.

    Of the last flight they are those before it comes near the plate again.
    """
    lowest_impact = float(position[boundaries[1:-1]].min())
    selected = {}
    for number, indices in _between_impacts(boundaries).items():
        selected[number] = indices[position[indices] > lowest_impact + ABOVE_NOISE * noise]
    last_flight = len(boundaries) - 2
    indices = selected[last_flight]
    if len(indices):
        height = position[indices] - lowest_impact
        apex = int(np.argmax(height))
        lowest_so_far = np.minimum.accumulate(height[apex:])
        landed = np.flatnonzero(
            (lowest_so_far < _LANDED * height[apex])
            | (height[apex:] > lowest_so_far + ABOVE_NOISE * noise)  # it rises again
        )
        if landed.size:
            selected[last_flight] = indices[: max(apex + int(landed[0]) - _BESIDE, 0)]
    return selected


def samples_of_flights(
    joint: JointFlights,
    kept: Mapping[int, Indices],
    time: Floats,
    boundaries: Sequence[int],
    radius: float,
    flight_model: Flights,
) -> dict[int, Indices]:
    """Return the samples at which each fitted flight is above the plate, whatever their noise."""
    between_impacts = _between_impacts(boundaries)
    selected = {}
    for flight, number in enumerate(kept):
        indices = between_impacts[number]
        depth, downward_speed = flight_model.depth_at(
            (time[indices] - joint.apex_times[flight]) / joint.clock
        )
        least_height = radius + ABOVE_NOISE * joint.deviation(downward_speed)
        selected[number] = indices[joint.apex_heights[flight] - depth > least_height]
    return selected


def _between_impacts(boundaries: Sequence[int]) -> dict[int, Indices]:
    """Return the samples of each flight but those beside its impacts.

    The record may cut the first and the last flight short; nothing is omitted at those ends.
    """
    last_flight = len(boundaries) - 2
    samples = {}
    for number, (begin, end) in enumerate(itertools.pairwise(boundaries)):
        after_impact = _BESIDE if number else 0
        before_impact = _BESIDE if number < last_flight else 0
        samples[number] = np.arange(begin + after_impact, end + 1 - before_impact)
    return samples


def with_enough_samples(
    selected: Mapping[int, Indices], boundaries: Sequence[int], label_of: Callable[[int], str]
) -> dict[int, Indices]:
    """Return the flights that have enough samples, which only the first and the last may lack."""
    kept = {}
    for number, indices in selected.items():
        if len(indices) >= _FEWEST:
            kept[number] = indices
        elif 0 < number < len(boundaries) - 2:
            few = {0: "no sample shows", 1: "only one sample shows"}.get(
                len(indices), f"only {len(indices)} samples show"
            )
            raise InputError(
                f"between the impacts at {label_of(boundaries[number])} and "
                f"{label_of(boundaries[number + 1])} "
                f"{few} the sphere above the plate, but {_FEWEST} are "
                "needed; sample faster, end the record before, or look at sign "
                "and unit of the position"
            )
    if 1 not in kept:
        raise InputError(
            "the record shows too little of the rebound from the first impact, of which "
            f"at least {_FEWEST} samples above the plate are "
            "needed; record longer, or sample faster"
        )
    return kept
