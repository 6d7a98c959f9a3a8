"""Measured modes beside those of the case."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.signals.decay.find import DecayMode

_FAR = 0.05
"""Relative difference of frequencies from which on two modes are not one."""

FEWEST = 3
"""Least number of modes whose frequencies have anything in common."""

_SHIFTS = np.arange(-0.1, 0.1001, 0.005)
"""Logarithms of factors between the frequencies of both, from which on what all have in common is
sought.
"""

_CLOSE = 0.1
_BETTER = 0.6
"""What the mean difference that a shift of more than a little leaves must be below: a fraction of
the mean distance of modes, of which anything leaves a quarter; and a fraction of the sum without
it.
"""

_DETECTABLE = 1e-3
"""Response of a mode, relative to the strongest in the band, from which on it may be found in the
records.
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
    >>> pair = vi.test_analysis.ModePair(
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
        if self.measured is None:
            return float("nan")
        return self.measured.frequency.value / self.frequency - 1.0

    @property
    def damping_measured(self) -> bool:
        """Whether its damping was measured, at a mode of the case."""
        return self.number is not None and self.measured is not None and not self.measured.doubt


def pairs_of(
    problem: Problem,
    sensors: Sequence[Sensor],
    decay_modes: Sequence[DecayMode],
    band: tuple[float, float],
) -> tuple[ModePair, ...]:
    """Return the modes of a plate within a band beside measured ones, by frequency.

    Pairs are those whose relative differences of frequency have the least sum, aside from what all
    have in common where that makes it less; modes that no sensor hears have none.
    """
    modes = problem.plate.modes
    assert modes is not None  # `plate_problem` has seen to it
    return paired(
        modes.frequencies, modes.damping_ratios, _responses(problem, sensors), decay_modes, band
    )


def paired(
    frequencies: Floats,
    ratios: Floats,
    response: Floats,
    modes: Sequence[DecayMode],
    band: tuple[float, float],
) -> tuple[ModePair, ...]:
    """Return modes within a band beside measured ones, as `pairs_of`.

    `frequencies`, damping `ratios` and `response` are those of each mode, (modes,).
    """
    inside = np.flatnonzero((frequencies >= band[0]) & (frequencies <= band[1]))
    response = response[inside]
    response = response / max(float(response.max(initial=0.0)), 1e-300)
    measured_frequencies = [mode.frequency.value for mode in modes]
    partners = _partners(frequencies[inside], response, measured_frequencies)
    pairs = []
    for row, index in enumerate(inside.tolist()):
        frequency = float(frequencies[index])
        ratio = float(ratios[index])
        share = float(response[row])
        if row in partners:
            measured = modes[partners[row]]
            remark = measured.doubt
        else:
            measured = None
            remark = _why_not_found(frequency, ratio, share, measured_frequencies)
        pairs.append(ModePair(index + 1, frequency, ratio, share, measured, remark))
    paired_rows = set(partners.values())
    nan = float("nan")
    for row, mode in enumerate(modes):
        if row not in paired_rows:
            pairs.append(ModePair(None, nan, nan, nan, mode, "no mode of the case nearby"))
    return tuple(sorted(pairs, key=_sorting_frequency))


def _sorting_frequency(pair: ModePair) -> float:
    """Return the frequency by which modes are sorted: that of the case, if it has one."""
    if pair.number is None and pair.measured is not None:
        return pair.measured.frequency.value
    return pair.frequency


def _responses(problem: Problem, sensors: Sequence[Sensor]) -> Floats:
    """Return the amplitude of each mode after an impulse at the contact point, (modes,).

    It is that at the sensor with the largest one.
    """
    modes = problem.plate.modes
    assert modes is not None
    shapes = np.stack(
        [np.abs(modes.points[sensor.name] @ np.asarray(sensor.components)) for sensor in sensors]
    )
    # an impulse gives each mode a velocity; a sensor of order k sees omega^(k - 1) times it
    # in the vibration that follows
    orders = np.array([[sensor.order - 1] for sensor in sensors])
    amplitudes = np.abs(modes.contact) * shapes * modes.angular_frequencies**orders
    return np.asarray(amplitudes.max(axis=0))


def _partners(frequencies: Floats, response: Floats, measured: Sequence[float]) -> dict[int, int]:
    """Return the measured mode of each mode of the case that has one."""
    detectable = np.flatnonzero(response >= _DETECTABLE)
    if not len(detectable) or not len(measured):
        return {}
    differences = np.log(np.asarray(measured)[None] / frequencies[detectable][:, None])
    pairs, least_sum = _nearest(differences)
    if len(pairs) >= FEWEST:
        # a wrong modulus moves all: where modes are dense, some are nearer to a neighbour than to
        # their own
        shifted_pairs, shifted_sum = _nearest_shifted(differences, pairs)
        if shifted_sum < least_sum:
            pairs = shifted_pairs
            least_sum = shifted_sum
    fewer = min(differences.shape)
    if fewer >= FEWEST:
        # a shift that pairs dense modes at random must not count as something in common
        shifted_pairs, shifted_sum = _best_shifted(differences, pairs, least_sum)
        lowest = frequencies[detectable[0]]
        highest = frequencies[detectable[-1]]
        mean_distance = float(np.log(highest / lowest)) / (len(detectable) - 1)
        if shifted_sum < min(_CLOSE * mean_distance * fewer, _BETTER * least_sum):
            pairs = shifted_pairs
    return {int(detectable[row]): column for row, column in pairs}


def _best_shifted(
    differences: Floats, pairs: list[tuple[int, int]], least_sum: float
) -> tuple[list[tuple[int, int]], float]:
    """Return the pairs of the least sum aside from a shift that all have in common, and this sum.

    Without enough pairs at any shift, they are those that are given.
    """
    best: tuple[list[tuple[int, int]], float] | None = None
    for shift in _SHIFTS:
        start_pairs, _ = _nearest(differences - shift)
        if len(start_pairs) >= FEWEST:
            candidate = _nearest_shifted(differences, start_pairs)
            if best is None or candidate[1] < best[1]:
                best = candidate
    return (pairs, least_sum) if best is None else best


def _nearest_shifted(
    differences: Floats, pairs: Sequence[tuple[int, int]]
) -> tuple[list[tuple[int, int]], float]:
    """Return pairs of the least sum aside from the median difference of `pairs`, and this sum."""
    return _nearest(differences - float(np.median([differences[pair] for pair in pairs])))


def _nearest(differences: Floats) -> tuple[list[tuple[int, int]], float]:
    """Return the pairs, (row, column), of the least sum of magnitudes of differences, and the sum.

    `differences` have the shape (rows, columns).
    """
    # to leave both alone costs as much as a pair that is too far
    cost = np.minimum(np.abs(differences), _FAR)
    rows, columns = linear_sum_assignment(cost)
    near = cost[rows, columns] < _FAR
    pairs = list(zip(rows[near].tolist(), columns[near].tolist(), strict=True))
    return pairs, float(cost[rows, columns].sum())


def _why_not_found(
    frequency: float, ratio: float, share: float, measured_frequencies: Sequence[float]
) -> str:
    """Return why a mode was not found; `share` is its response over that of the strongest."""
    if share < WEAK:
        return f"weak: {100.0 * share:.2g} % of the strongest"
    half_power_width = 2.0 * ratio * frequency
    for measured in measured_frequencies:
        if abs(measured - frequency) < half_power_width:
            return f"not separated from the mode at {measured:.5g} Hz"
    return "not found"


def damping_field(pairs: Sequence[ModePair]) -> str:
    """Return the measured damping as it is written in a case; empty if none was measured.

    It is stated at the frequencies of the case's modes.
    """
    ratios = {
        pair.frequency: pair.measured.damping_ratio.value
        for pair in pairs
        if pair.damping_measured and pair.measured is not None
    }
    if not ratios:
        return ""
    frequencies = sorted(ratios)
    frequency_list = ", ".join(f"{frequency:.6g}" for frequency in frequencies)
    ratio_list = ", ".join(f"{ratios[frequency]:.6g}" for frequency in frequencies)
    return f"damping = {{ frequencies = [{frequency_list}], ratios = [{ratio_list}] }}"
