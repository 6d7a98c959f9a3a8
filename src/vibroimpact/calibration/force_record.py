"""Impacts in a measured record of force."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.calibration.observations import Floats, Observations
from vibroimpact.calibration.record_noise import ABOVE_NOISE, record_noise
from vibroimpact.errors import InputError

_FEWEST = 5
"""Samples of an impact, at least."""

_SMALL, _LEAST = 0.02, 1e-9
"""Parts of the largest force: what is no impact, and the least noise that a record has."""


def impacts_in_force(time: Floats, force: Floats, *, mass: float, gravity: float, first_speed: float) -> Observations:
    r"""Return the impacts of a sphere whose contact force was recorded.

    The impulse tells by how much the speed changes, :math:`m (v^+ + v^-) = \int F\,dt - m g T`, and the time to the next impact
    tells it better: :math:`v^+ = g\,\Delta t / 2`.

    Parameters
    ----------
    time, force : array, shape (n,)
        Time [s] and contact force [N], positive where it pushes.
    mass, gravity : float
        Of the sphere [kg], and acceleration [m/s^2], >= 0.
    first_speed : float
        Of the first touch [m/s].

    Returns
    -------
    Observations
        Separation speeds, largest forces and durations, with standard deviations from noise and sampling.

    Raises
    ------
    InputError
        If the record does not show an impact, or does not resolve it.

    Examples
    --------
    >>> t = np.arange(0.0, 2e-3, 1e-5)
    >>> pulse = np.where((t > 5e-4) & (t < 1e-3), 100.0 * np.sin(np.pi * (t - 5e-4) / 5e-4), 0.0)
    >>> found = impacts_in_force(t, pulse, mass=0.01, gravity=0.0, first_speed=2.0)
    >>> found.wanted["separation_speed"].round(2).tolist(), found.wanted["max_force"].round(1).tolist()
    ([1.18], [100.0])
    """
    offset = float(np.median(force))
    force, noise, step = force - offset, max(record_noise(force), _LEAST * float(np.ptp(force))), float(np.median(np.diff(time)))
    threshold = max(ABOVE_NOISE * noise, _SMALL * float(force.max()))
    if not force.max() > max(2.0 * threshold, 0.0) or not force.max() > 0.0:
        raise InputError("the record does not show an impact: no force stands out from the noise")
    runs = _runs(force > threshold)
    for begin, end in runs:
        if begin == 0 or end == len(force):
            raise InputError(f"the record {'begins' if begin == 0 else 'ends'} in the middle of an impact, at row {begin + 1}")
        if end - begin < _FEWEST:
            raise InputError(
                f"the impact at row {begin + 1} has only {end - begin} samples, and it takes {_FEWEST}; sample faster, or smooth less"
            )
    pulses = [_pulse(time, force, begin, end, noise, step) for begin, end in runs]
    speeds, separation, deviation, before = [], [], [], first_speed
    for number, pulse in enumerate(pulses):
        after, unsure = pulse.impulse / mass - gravity * pulse.duration - before, pulse.impulse_deviation / mass
        if number + 1 < len(pulses) and gravity > 0.0:
            after = 0.5 * gravity * (pulses[number + 1].begin - pulse.begin - pulse.duration)
            unsure = 0.5 * gravity * step
        if not 0.0 < after <= 1.2 * before:
            raise InputError(
                f"the impact at row {runs[number][0] + 1}: from {before:.4g} m/s the sphere would leave at {after:.4g} m/s; the force, "
                "the mass or the drop can't be right"
            )
        speeds.append(before)
        separation.append(after)
        deviation.append(unsure)
        before = after
    number = len(pulses)
    shared = np.diag(deviation)
    sources = {
        "separation_speed": np.hstack([shared, np.zeros((number, 2 * number))]),
        "max_force": np.hstack([np.zeros((number, number)), noise * np.eye(number), np.zeros((number, number))]),
        "duration": np.hstack([np.zeros((number, 2 * number)), step * np.eye(number)]),
    }
    before_noise = np.vstack([np.zeros(3 * number), sources["separation_speed"][:-1]])
    wanted = {
        "separation_speed": np.array(separation),
        "max_force": np.array([pulse.largest for pulse in pulses]),
        "duration": np.array([pulse.duration for pulse in pulses]),
    }
    labels = tuple(f"impact {number + 1}, row {begin + 1}" for number, (begin, _) in enumerate(runs))
    return Observations(np.array(speeds), wanted, before_noise, sources, True, labels)


class _Pulse(NamedTuple):
    begin: float
    duration: float
    largest: float
    impulse: float
    impulse_deviation: float


def _pulse(time: Floats, force: Floats, begin: int, end: int, noise: float, step: float) -> _Pulse:
    """Return one pulse of force, from where it rises out of zero to where it is back."""
    first, last = begin, end - 1
    while first > 0 and force[first] > noise and force[first - 1] < force[first]:
        first -= 1
    while last < len(force) - 1 and force[last] > noise and force[last + 1] < force[last]:
        last += 1
    part = slice(first, last + 1)
    middle = begin + int(np.argmax(force[begin:end]))
    around = slice(max(middle - 2, 0), middle + 3)
    a, b, c = np.polyfit(time[around] - time[middle], force[around], 2)
    largest = c - b * b / (4.0 * a) if a < 0.0 else force[middle]
    impulse = float(np.trapezoid(force[part], time[part]))
    return _Pulse(
        float(time[first]), float(time[last] - time[first]), float(largest), impulse, noise * step * float(np.sqrt(last - first + 1))
    )


def _runs(above: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return where samples in a row are above, as first and behind the last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], above, [False]]).astype(int)))
    return [(int(begin), int(end)) for begin, end in edges.reshape(-1, 2)]
