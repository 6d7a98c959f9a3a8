"""Measured modes beside those of the case."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.sensor import Sensor
from vibroimpact.signals.decay.find import DecayMode

_FAR = 0.05
"""Relative difference of frequencies from which on two modes are not one."""
FEWEST = 3
"""Least number of modes whose frequencies have anything in common."""
_SHIFTS = np.arange(-0.1, 0.1001, 0.005)
"""Logarithms of factors between the frequencies of both, from which on what all have in
common is sought.
"""
_CLOSE, _BETTER = 0.1, 0.6
"""What the mean difference that a shift of more than a little leaves must be below: a fraction of
the mean distance of modes, of which anything leaves a quarter; and a fraction of the sum without
it.
"""
_HEARD = 1e-3
"""Response of a mode, relative to the strongest in the band, from which on it may be
found in the records.
"""
WEAK = 0.02
"""Response below which nobody wonders that it is not."""


@dataclass(frozen=True)
class ModePair:
    """A mode of the case, a measured one, or both.

    Parameters
    ----------
    number : int, optional
        Number of the mode of the case's plate, from 1; None if it has none near the measured one.
    frequency, damping_ratio : float
        Natural frequency [Hz] and damping ratio in the case; NaN if it has none.
    response : float
        What the mode contributes to the sensor that hears it best, relative to the strongest mode
        in the band; NaN if the case has none.
    measured : DecayMode, optional
        The measured mode; None if none was found.
    remark : str
        Why it has no partner, or its damping could not be determined.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> pair = vi.ModePair(
    ...     number=1,
    ...     frequency=420.0,
    ...     damping_ratio=0.01,
    ...     response=1.0,
    ...     measured=None,
    ...     remark="not excited",
    ... )
    >>> pair.frequency, pair.measured
    (420.0, None)
    """

    number: int | None
    frequency: float
    damping_ratio: float
    response: float
    measured: DecayMode | None
    remark: str = ""

    @property
    def frequency_difference(self) -> float:
        """How much higher the measured frequency is, relative to that of the case."""
        return (
            self.measured.frequency.value / self.frequency - 1.0
            if self.measured is not None
            else float("nan")
        )

    @property
    def damping_measured(self) -> bool:
        """Whether its damping was measured, at a mode of the case."""
        return self.number is not None and self.measured is not None and not self.measured.doubt


def pairs_of(
    problem: Problem,
    sensors: Sequence[Sensor],
    found: Sequence[DecayMode],
    band: tuple[float, float],
) -> tuple[ModePair, ...]:
    """Return the modes of a plate within a band beside measured ones, in the order of their
    frequencies.

    Pairs are those whose relative differences of frequency have the least sum, aside from what all
    have in common where that makes it less; modes that no sensor hears have none.
    """
    modes = problem.plate.modes
    assert modes is not None  # `plate_problem` has seen to it
    return paired(
        modes.frequencies, modes.damping_ratios, _responses(problem, sensors), found, band
    )


def paired(
    frequencies: Floats,
    ratios: Floats,
    response: Floats,
    found: Sequence[DecayMode],
    band: tuple[float, float],
) -> tuple[ModePair, ...]:
    """Return modes within a band beside measured ones, as `pairs_of`, from frequencies,
    damping ratios and responses of each, (modes,).
    """
    inside = np.flatnonzero((frequencies >= band[0]) & (frequencies <= band[1]))
    places, response = frequencies[inside], response[inside]
    response = response / max(float(response.max(initial=0.0)), 1e-300)
    partner = _partners(places, response, [mode.frequency.value for mode in found])
    rows = [*_of_case(ratios[inside], inside, places, response, found, partner)]
    taken = set(partner.values())
    nan = float("nan")
    rows += [
        ModePair(None, nan, nan, nan, mode, "no mode of the case nearby")
        for number, mode in enumerate(found)
        if number not in taken
    ]
    return tuple(sorted(rows, key=_place))


def _place(pair: ModePair) -> float:
    """Return by which frequency a mode has its place among others: that of the case, if
    it has one.
    """
    return (
        pair.measured.frequency.value
        if pair.number is None and pair.measured is not None
        else pair.frequency
    )


def _responses(problem: Problem, sensors: Sequence[Sensor]) -> Floats:
    """Return the amplitude of each mode after an impulse at the contact point, at the
    sensor that hears it best, (modes,).
    """
    modes = problem.plate.modes
    assert modes is not None
    seen = np.stack(
        [np.abs(modes.points[sensor.name] @ np.asarray(sensor.components)) for sensor in sensors]
    )
    orders = np.array([[sensor.order - 1] for sensor in sensors])
    return np.asarray(
        (np.abs(modes.contact) * seen * modes.angular_frequencies**orders).max(axis=0)
    )


def _partners(places: Floats, response: Floats, measured: Sequence[float]) -> dict[int, int]:
    """Return the measured mode of each mode of the case that has one."""
    heard = np.flatnonzero(response >= _HEARD)
    if not len(heard) or not len(measured):
        return {}
    apart = np.log(np.asarray(measured)[None] / places[heard][:, None])
    found, least = _nearest(apart)
    if len(found) >= FEWEST:
        # a wrong modulus moves all: where modes are dense, some are nearer to a neighbour than to
        # their own
        again, other = _nearest_shifted(apart, found)
        found, least = (again, other) if other < least else (found, least)
    if min(apart.shape) >= FEWEST:
        starts = [
            pairs
            for pairs, _ in (_nearest(apart - shift) for shift in _SHIFTS)
            if len(pairs) >= FEWEST
        ]
        again, other = min(
            (_nearest_shifted(apart, pairs) for pairs in starts),
            key=lambda one: one[1],
            default=(found, least),
        )
        distance = float(np.log(places[heard[-1]] / places[heard[0]])) / (len(heard) - 1)
        if other < min(_CLOSE * distance * min(apart.shape), _BETTER * least):
            found = again
    return {int(heard[row]): column for row, column in found}


def _nearest_shifted(
    apart: Floats, pairs: Sequence[tuple[int, int]]
) -> tuple[list[tuple[int, int]], float]:
    """Return the pairs of the least sum aside from the median difference of given ones,
    and this sum.
    """
    return _nearest(apart - float(np.median([apart[pair] for pair in pairs])))


def _nearest(apart: Floats) -> tuple[list[tuple[int, int]], float]:
    """Return the pairs, (row, column), of the least sum of magnitudes of differences
    (rows, columns), and this sum.
    """
    # to leave both alone costs as much as a pair that is too far
    cost = np.minimum(np.abs(apart), _FAR)
    rows, columns = linear_sum_assignment(cost)
    near = cost[rows, columns] < _FAR
    return list(zip(rows[near].tolist(), columns[near].tolist(), strict=True)), float(
        cost[rows, columns].sum()
    )


def _of_case(
    ratios: Floats,
    inside: Indices,
    places: Floats,
    response: Floats,
    found: Sequence[DecayMode],
    partner: dict[int, int],
) -> Iterator[ModePair]:
    for number, (index, place, ratio, share) in enumerate(
        zip(inside.tolist(), places, ratios, response, strict=True)
    ):
        measured = found[partner[number]] if number in partner else None
        remark = "" if measured is None else measured.doubt
        if measured is None:
            remark = (
                f"weak: {100.0 * share:.2g} % of the strongest"
                if share < WEAK
                else _missing(float(place), float(ratio), found)
            )
        yield ModePair(index + 1, float(place), float(ratio), float(share), measured, remark)


def _missing(place: float, ratio: float, found: Sequence[DecayMode]) -> str:
    """Return why a mode was not found."""
    width = 2.0 * ratio * place
    near = [mode.frequency.value for mode in found if abs(mode.frequency.value - place) < width]
    return f"not separated from the mode at {near[0]:.5g} Hz" if near else "not found"


def damping_field(pairs: Sequence[ModePair]) -> str:
    """Return the measured damping as it is written in a case, at the frequencies of the
    case's modes; empty if none was measured.
    """
    measured = {
        pair.frequency: pair.measured.damping_ratio.value
        for pair in pairs
        if pair.damping_measured and pair.measured is not None
    }
    if not measured:
        return ""
    frequencies, ratios = (
        ", ".join(f"{value:.6g}" for value in part)
        for part in zip(*sorted(measured.items()), strict=True)
    )
    return f"damping = {{ frequencies = [{frequencies}], ratios = [{ratios}] }}"
