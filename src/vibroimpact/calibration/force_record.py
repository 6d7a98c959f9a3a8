"""Impacts in a measured record of force."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.calibration.observations import Floats, Observations
from vibroimpact.calibration.record_noise import ABOVE_NOISE, named_samples, record_noise
from vibroimpact.errors import InputError

_FEWEST = 5
"""Samples of an impact, at least."""

_MOST, _GAIN = 1.2, 0.03
"""Restitution above which a record can't be right, and by how much impulses may be off from times of flight."""

_SMALL, _LEAST = 0.02, 1e-9
"""Parts of the largest force: what is no impact, and the least noise that a record has."""

_UPSIDE_DOWN = 3.0  # how much farther down than up a force goes whose sign is wrong

_SIGHTS, _MARGIN = 3, 0.25
"""How often the force at rest is told anew, and the part of an impact's time that goes to it on either side."""

_EDGE, _PEAK, _TOP = 0.03, 0.003, 0.8
"""How well the ends of an impact are told, as a part of its time, and its largest force, from what is above so much of it."""


def impacts_in_force(
    time: Floats, force: Floats, *, mass: float, gravity: float, first_speed: float, lines: Sequence[int] | None = None
) -> Observations:
    r"""Return the impacts of a sphere whose contact force was recorded.

    The impulse tells by how much the speed changes, :math:`m (v^+ + v^-) = \int F\,dt - m g T`, and the time to the next impact
    tells it better: :math:`v^+ = g\,\Delta t / 2`. Where both are known they also tell the scale of the force, by which the last
    impulse is corrected.

    Parameters
    ----------
    time, force : array, shape (n,)
        Time [s] and contact force [N], positive where it pushes.
    mass, gravity : float
        Of the sphere [kg], and acceleration [m/s^2], >= 0.
    first_speed : float
        Of the first touch [m/s].
    lines : sequence of int, optional
        The line of a file that each sample stands on, for messages.

    Returns
    -------
    Observations
        Separation speeds and largest forces, with standard deviations from noise and sampling.

    Raises
    ------
    InputError
        If the record does not show an impact, or does not resolve it.

    Examples
    --------
    >>> t = np.arange(0.0, 2e-3, 1e-5)
    >>> pulse = np.where((t > 5e-4) & (t < 1e-3), 100.0 * np.sin(np.pi * (t - 5e-4) / 5e-4), 0.0)
    >>> found = impacts_in_force(t, pulse, mass=0.01, gravity=0.0, first_speed=2.0)
    >>> found.wanted["separation_speed"].round(2).tolist(), found.wanted["max_force"].round(0).tolist()
    ([1.18], [100.0])
    """
    at, step = named_samples(lines), float(np.median(np.diff(time)))
    force, noise, runs = _pushes(force)
    for begin, end in runs:
        if begin == 0 or end == len(force):
            raise InputError(f"the record {'begins' if begin == 0 else 'ends'} in the middle of an impact, at {at(begin)}")
        if end - begin < _FEWEST:
            raise InputError(
                f"the impact at {at(begin)} has only {end - begin} samples, and it takes {_FEWEST}; sample faster, or smooth less"
            )
    between = [0, *((end + begin) // 2 for (_, end), (begin, _) in itertools.pairwise(runs)), len(force)]
    rooms = itertools.pairwise(between)
    pulses = [_pulse(time, force, run, room, noise, step) for run, room in zip(runs, rooms, strict=True)]
    separation, deviation, doubts = _separations(pulses, mass, gravity, first_speed, step)
    speeds = np.append(first_speed, separation[:-1])
    for number, (before, after) in enumerate(zip(speeds, separation, strict=True)):
        if not 0.0 < after <= _MOST * before:
            raise InputError(
                f"the impact at {at(runs[number][0])}: from {before:.4g} m/s the sphere would leave at {after:.4g} m/s; the force, "
                "the mass or the drop can't be right"
            )
    number = len(pulses)
    nothing = np.zeros((number, number))
    noises = {
        "separation_speed": np.hstack([np.diag(deviation), nothing]),
        "max_force": np.hstack([nothing, np.diag([pulse.largest_deviation for pulse in pulses])]),
    }
    before_noise = np.vstack([np.zeros(2 * number), noises["separation_speed"][:-1]])
    wanted = {"separation_speed": separation, "max_force": np.array([pulse.largest for pulse in pulses])}
    labels = tuple(f"impact {number + 1}, {at(begin)}" for number, (begin, _) in enumerate(runs))
    return Observations(speeds, wanted, before_noise, noises, True, labels, noise_from="the noise of the record", doubts=doubts)


def _separations(
    pulses: list[_Pulse], mass: float, gravity: float, first_speed: float, step: float
) -> tuple[Floats, Floats, tuple[str, ...]]:
    """Return separation speeds [m/s] and their standard deviations, and what to doubt of them.

    Those before another impact follow from the time of flight, the last one from its impulse.
    """
    flights = [0.5 * gravity * (after.begin - before.begin - before.duration) for before, after in itertools.pairwise(pulses)]
    if gravity == 0.0 and flights:
        raise InputError(f"without gravity the sphere does not come back, and the record shows {len(pulses)} impacts")
    before = np.append(first_speed, flights)
    expected = np.array(
        [mass * (came + left + gravity * pulse.duration) for pulse, came, left in zip(pulses, before, flights, strict=False)]
    )
    last, doubts = pulses[-1], []
    scale, unsure = 1.0, 0.0
    if flights:
        scales = expected / np.array([pulse.impulse for pulse in pulses[:-1]])
        scale = float(scales.mean())
        unsure = float(scales.std(ddof=1)) / np.sqrt(len(scales)) if len(scales) > 1 else 0.0
        if abs(scale - 1.0) > _GAIN:
            words = f"the impulses are {100.0 * (1.0 / scale - 1.0):+.1f} % off from what the times of flight say"
            doubts.append(
                f"{words}: the scale of the force, the mass or gravity can't be right (the rebound of the last impact is corrected)"
            )
    else:
        per_cent = 0.01 * last.impulse / mass
        doubts.append(
            f"one impact alone: its rebound follows from the impulse, and 1 % in the scale of the force makes {per_cent:.2g} m/s of it"
        )
    after = scale * last.impulse / mass - gravity * last.duration - before[-1]
    of_last = float(np.hypot(last.impulse_deviation, unsure * last.impulse)) / mass
    edges = np.array([gravity * np.hypot(0.5 * step, _EDGE * pulse.duration) for pulse in pulses])
    deviation = np.append(edges[:-1], np.hypot(of_last, edges[-1]))
    return np.append(flights, after), deviation, tuple(doubts)


class _Pulse(NamedTuple):
    begin: float
    duration: float
    largest: float
    largest_deviation: float
    impulse: float
    impulse_deviation: float


def _pushes(force: Floats) -> tuple[Floats, float, list[tuple[int, int]]]:
    """Return the force from its rest, its noise, and where it pushes: samples in a row, as first and behind the last."""
    noise = max(record_noise(force), _LEAST * float(np.ptp(force)))
    low, high = float(force.min()), float(force.max())
    quiet = force < 0.5 * (low + high)  # what belongs to no impact, at first sight
    if not high > low:
        raise InputError("the record does not show an impact: the force is the same throughout")
    middle = float(np.median(force))
    if middle - low > max(_UPSIDE_DOWN * (high - middle), 2.0 * ABOVE_NOISE * noise):
        raise InputError("the force is negative; it must be positive where it pushes the sphere up")
    runs: list[tuple[int, int]] = []
    for _ in range(_SIGHTS):
        rest = float(np.median(force[quiet]))
        threshold = max(ABOVE_NOISE * noise, _SMALL * (high - rest))
        runs = _joined(_runs(force - rest > threshold))
        runs = [(begin, end) for begin, end in runs if force[begin:end].max() - rest > 2.0 * threshold]
        if not runs:
            raise InputError("the record does not show an impact: no force stands out from the noise")
        quiet = np.ones(len(force), dtype=bool)
        for begin, end in runs:
            margin = int(_MARGIN * (end - begin)) + 1
            quiet[max(begin - margin, 0) : end + margin] = False
        if np.count_nonzero(quiet) < _FEWEST:
            raise InputError("the record shows nothing but the impact; it takes some time before or after it, to tell the force at rest")
    return force - rest, noise, runs


def _joined(runs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return runs, with those as one between which noise alone makes a gap."""
    joined: list[tuple[int, int]] = []
    for begin, end in runs:
        if joined and begin - joined[-1][1] < _MARGIN * max(end - begin, joined[-1][1] - joined[-1][0]):
            joined[-1] = (joined[-1][0], end)
        else:
            joined.append((begin, end))
    return joined


def _pulse(time: Floats, force: Floats, run: tuple[int, int], room: tuple[int, int], noise: float, step: float) -> _Pulse:
    """Return one pulse of force, integrated with some time on either side, within its room."""
    begin, end = run
    margin = int(_MARGIN * (end - begin)) + 1
    part = slice(max(begin - margin, room[0]), min(end + margin, room[1]))
    impulse = float(np.trapezoid(force[part], time[part]))
    # what every other sample would tell says how much there is between the samples
    coarse = [np.trapezoid(force[part][first::2], time[part][first::2]) for first in (0, 1)]
    unsure = float(np.hypot(noise * step * np.sqrt(part.stop - part.start), 0.5 * np.abs(impulse - np.array(coarse)).max()))
    largest = float(force[begin:end].max())
    top = begin + np.flatnonzero(force[begin:end] > _TOP * largest)
    middle = float(time[top].mean())
    if len(top) > _FEWEST:
        across = (time[top] - middle) / step
        powers = np.vander(across, 3)
        a, b, c = np.linalg.lstsq(powers, force[top], rcond=None)[0]
        largest = float(c - b * b / (4.0 * a)) if a < 0.0 else largest
    deviation = float(np.hypot(noise, _PEAK * largest))
    return _Pulse(float(time[begin]), float(time[end - 1] - time[begin]), largest, deviation, impulse, unsure)


def _runs(above: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return where samples in a row are above, as first and behind the last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], above, [False]]).astype(int)))
    return [(int(begin), int(end)) for begin, end in edges.reshape(-1, 2)]
