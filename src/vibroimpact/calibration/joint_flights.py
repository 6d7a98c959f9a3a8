"""Successive flights in a position record, fitted together with what the record itself
determines: its zero, drift, clock and contacts.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_triangular

from vibroimpact.arrays import Floats
from vibroimpact.calibration.flights import Flights
from vibroimpact.errors import ComputationError, InputError

_ZERO, _DRIFT, _CLOCK, _CONTACT, _SHARED = range(5)
"""Places of the unknowns that all flights share, and their number; height and time of
each apex follow.
"""

_CLOCK_DEVIATION = 0.05
"""Standard deviation of the clock's ratio before the record is seen; the curvature of a
few flights determines it to a thousandth.
"""

_CONTACT_DEVIATION = 0.8
"""That of the duration of contact, as a fraction of the expected one: losses prolong
Hertz's by a third, compliant plates double it.
"""

_UNKNOWN_CONTACT = 0.5
"""That of a duration of which nothing is known, at 1 m/s, per radius [s/m]: for a rubber
ball of 26 mm 6 ms.
"""

_SLOWER = -0.2  # exponent of the speed in the duration of Hertz's contact
_SETTLED, _ROUNDS = 1e-12, 50
# tolerance with which successive flights meet, as a fraction of the noise of one sample
_HARD = 1e-3
_NOT_NOISE = 0.999  # quantile of chi squared above which the levels scatter by more than noise
_HALVINGS, _PASSES = 60, 3

_LEAST_RATIO, _MOST_RATIO, _RATIOS = 1e-2, 1e6, 81
"""Variance of a fast sample by its time over that by its position: what is tried."""

_TIMES_SCATTER = 3.84
"""Twice the logarithm of the likelihood by which times have to explain the scatter
better, the 95 % quantile of chi squared.
"""


class Meetings(NamedTuple):
    """What is known of the meetings of successive flights: radius of the sphere, the height at
    which they meet, and the scatter about it [m]; expected duration of contact at 1 m/s and its
    standard deviation [s].
    """

    radius: float
    scatter: float
    contact: float
    contact_deviation: float


@dataclass(frozen=True)
class JointFlights:
    """Flights fitted together.

    The record shows the height above the plate, plus the zero and its drift, over the time of its
    own clock.

    Parameters
    ----------
    tops, times : array, shape (n,)
        Height of each apex above the plate [m], and its time on the clock of the record [s].
    zero, drift : float
        Offset of the positions at the time `middle` [m], and its rate [m/s].
    clock : float
        Seconds of the record per second.
    contact : float
        Duration of a contact at an approach speed of 1 m/s [s]; it changes as Hertz's, with the
        power -1/5 of the speed.
    middle : float
        Time on the clock of the record at which the zero is stated [s].
    free : tuple of int
        The unknowns that are determined, as columns of `root`.
    root : array, shape (k, k)
        Contribution of each independent source of unit variance to each free unknown.
    noise, scatter : float
        Standard deviation of a sample, and of the level of one impact about the line of the zero
        [m].
    timing : float
        Standard deviation of the time of a sample [s], by which it scatters the more the faster the
        sphere is; 0 where none shows.
    misfit : float
        Sum of squares of the normalized residuals.
    """

    tops: Floats
    times: Floats
    zero: float
    drift: float
    clock: float
    contact: float
    middle: float
    free: tuple[int, ...] = ()
    root: Floats | None = None
    noise: float = 1.0
    scatter: float = 0.0
    misfit: float = 0.0
    timing: float = 0.0

    def level(self, time: Floats) -> Floats:
        """Return the offset of positions at times of the record [m]."""
        return self.zero + self.drift * (time - self.middle)

    def deviation(self, speed: Floats) -> Floats:
        """Return the standard deviation of samples at vertical speeds [m/s]: that of
        positions, and that of times.
        """
        return np.asarray(np.hypot(self.noise, self.timing * speed / self.clock))

    def noise_of_tops(self) -> Floats:
        """Return the contribution of each source to the height of each apex [m], (n, m)."""
        assert self.root is not None
        return self.root[
            [self.free.index(_SHARED + 2 * flight) for flight in range(len(self.tops))]
        ]

    @property
    def shared_deviations(self) -> dict[str, float]:
        """Standard deviations of zero [m], drift [m/s], clock [-] and contact [s]; 0 of
        one that is not estimated.
        """
        assert self.root is not None
        names = {"zero": _ZERO, "drift": _DRIFT, "clock": _CLOCK, "contact": _CONTACT}
        rows = {
            name: self.free.index(place) if place in self.free else None
            for name, place in names.items()
        }
        return {
            name: 0.0 if row is None else float(np.linalg.norm(self.root[row]))
            for name, row in rows.items()
        }


def separate_flights(
    pieces: Sequence[tuple[Floats, Floats]], start: JointFlights, flying: Flights, least: float
) -> JointFlights:
    """Return flights that share the clock alone, with heights as in the record, and the noise of
    its samples.

    Parameters
    ----------
    pieces : sequence of (array, array)
        Times [s] and positions [m] of the samples of each flight, one flight after the other.
    start : JointFlights
        Initial guess.
    flying : Flights
        Model of the flights.
    least : float
        Lower bound of the noise [m].
    """
    freedom = max(sum(len(time) for time, _ in pieces) - 2 * len(pieces) - 1, 1)
    found, noise = replace(start, zero=0.0, drift=0.0, timing=0.0), start.noise
    for _ in range(_PASSES):  # the weight of what is known of the clock depends on the noise
        found = _solved(pieces, found, flying, (_CLOCK,), noise)
        noise = float(np.hypot(noise * np.sqrt(found.misfit / freedom), least))
    found = _solved(pieces, found, flying, (_CLOCK,), noise)
    for _ in range(_PASSES):
        noise, timing = _noise_and_timing(pieces, found, flying)
        if not timing:
            break
        found = _solved(pieces, replace(found, timing=timing), flying, (_CLOCK,), max(noise, least))
    return found


def _noise_and_timing(
    pieces: Sequence[tuple[Floats, Floats]], at: JointFlights, flying: Flights
) -> tuple[float, float]:
    """Return the standard deviations of positions [m] and of times [s] by which the samples scatter
    about the flights.

    By maximum likelihood: the variance of a sample is that of positions, and that of times by the
    square of the speed. Where that is not significantly better than positions alone, the times are
    exact.
    """
    squares, speeds = [], []
    for flight, (time, position) in enumerate(pieces):
        fallen, downwards = flying.depth_at((time - at.times[flight]) / at.clock)
        own = np.stack([np.ones_like(time), downwards], axis=1) / at.deviation(downwards)[:, None]
        # part of its variance that the fit takes from a sample
        fitted = (np.linalg.qr(own)[0] ** 2).sum(axis=1)
        left = position - (at.level(time) + at.tops[flight] - fallen)
        squares.append(left**2 / np.maximum(1.0 - fitted, 0.1))
        speeds.append((downwards / at.clock) ** 2)
    square, speed = np.concatenate(squares), np.concatenate(speeds)

    def cost(ratio: float) -> float:
        """Return minus twice the logarithm of the likelihood, with the variance of
        positions that is most likely.
        """
        shape = 1.0 + ratio * speed
        return float(len(square) * np.log(np.mean(square / shape)) + np.log(shape).sum())

    ratios = np.geomspace(_LEAST_RATIO, _MOST_RATIO, _RATIOS) / speed.max()
    ratio = float(ratios[int(np.argmin([cost(one) for one in ratios]))])
    if not cost(0.0) - cost(ratio) > _TIMES_SCATTER:
        return at.noise, 0.0
    variance = float(np.mean(square / (1.0 + ratio * speed)))
    timing = float(np.sqrt(ratio * variance))
    # to second order a time that is off moves the apex, too
    return float(np.hypot(np.sqrt(variance), flying.gravity * timing**2 / np.sqrt(2.0))), timing


def meeting_flights(
    pieces: Sequence[tuple[Floats, Floats]],
    alone: JointFlights,
    flying: Flights,
    radius: float,
    levels: Floats,
    contact: float | None,
) -> JointFlights:
    """Return the fit of successive flights that meet at the height at which the sphere touches the
    plate.

    With one meeting the zero is estimated, with more its drift as well; without any, both are zero.
    Where the levels at which the flights meet scatter about a line by more than the noise, that
    scatter is estimated too, and widens all deviations.

    Parameters
    ----------
    pieces : sequence of (array, array)
        Times [s] and positions [m] of the samples of each flight, one flight after the other.
    alone : JointFlights
        The flights fitted separately.
    flying : Flights
        Model of the flights.
    radius : float
        Radius of the sphere [m], the height of its centre in touch.
    levels : array, shape (n - 1,)
        Height at which each flight meets the next [m], for the initial guess.
    contact : float, optional
        Expected duration of a contact at an approach speed of 1 m/s [s].

    Raises
    ------
    InputError
        If a flight does not rise above the plate.
    """
    meetings = len(levels)
    if not meetings:
        return alone
    expected = (
        (0.0, _UNKNOWN_CONTACT * radius)
        if contact is None
        else (contact, _CONTACT_DEVIATION * contact)
    )
    shared = [_ZERO, _CLOCK] if meetings == 1 else [_ZERO, _DRIFT, _CLOCK]
    shared += [_CONTACT] if contact is None or contact > 0.0 else []
    zero = float(np.median(levels)) - radius
    begun = replace(alone, tops=alone.tops - zero, zero=zero, contact=expected[0])

    def met(scatter: float) -> JointFlights:
        return _solved(
            pieces, begun, flying, tuple(shared), alone.noise, Meetings(radius, scatter, *expected)
        )

    found, spare = met(_HARD * alone.noise), meetings - min(meetings, 2)
    if spare and _exceeds(found.misfit - alone.misfit, spare):
        low, high = _HARD * alone.noise, max(radius, alone.noise)
        for _ in range(_HALVINGS):
            middle = float(np.sqrt(low * high))
            found = met(middle)
            low, high = (middle, high) if found.misfit - alone.misfit > spare else (low, middle)
            if high < 1.01 * low:
                break
        return replace(found, scatter=high)
    return found


def _exceeds(squares: float, freedom: int) -> bool:
    from scipy.stats import chi2  # imported late: it takes longer to load than a calibration

    return bool(squares > chi2.ppf(_NOT_NOISE, freedom))


def _solved(
    pieces: Sequence[tuple[Floats, Floats]],
    start: JointFlights,
    flying: Flights,
    shared: tuple[int, ...],
    noise: float,
    meetings: Meetings | None = None,
) -> JointFlights:
    """Return the least-squares fit by the Gauss-Newton method."""
    number = len(pieces)
    free = (*shared, *range(_SHARED, _SHARED + 2 * number))
    at = start
    for _ in range(_ROUNDS):
        rows = [
            _sample_rows(piece, flight, at, flying, number, noise)
            for flight, piece in enumerate(pieces)
        ]
        rows.append(_prior_row(_CLOCK, 1.0 - at.clock, _CLOCK_DEVIATION, number))
        if meetings is not None:
            if np.any(at.tops <= meetings.radius):
                raise InputError(
                    "in a flight the centre of the sphere does not rise above its place in "
                    "touch, at the radius; position must be the "
                    "height of the centre above the plate; look at its unit and at the radius"
                )
            rows.append(_meeting_rows(at, flying, meetings))
        if _CONTACT in shared and meetings is not None:
            rows.append(
                _prior_row(
                    _CONTACT, meetings.contact - at.contact, meetings.contact_deviation, number
                )
            )
        every = np.concatenate(rows)
        sizes = np.linalg.norm(every[:, list(free)], axis=0)
        # the last column, of what is left, ends in the norm of the residuals
        triangle = np.asarray(
            np.linalg.qr(np.column_stack([every[:, list(free)] / sizes, every[:, -1]]), mode="r")
        )
        square = triangle[: len(free), : len(free)]
        step = np.zeros(_SHARED + 2 * number)
        step[list(free)] = solve_triangular(square, triangle[: len(free), -1]) / sizes
        tops, moved = at.tops + step[_SHARED::2], step[_SHARED::2]
        at = replace(
            at,
            tops=tops,
            times=at.times + step[_SHARED + 1 :: 2],
            zero=at.zero + float(step[_ZERO]),
            drift=at.drift + float(step[_DRIFT]),
            clock=at.clock + float(step[_CLOCK]),
            contact=at.contact + float(step[_CONTACT]),
        )
        if not (np.all(np.isfinite(step)) and at.clock > 0.0):
            break
        if np.all(np.abs(moved) <= _SETTLED * np.abs(tops)):
            root = solve_triangular(square, np.eye(len(free))) / sizes[:, None]
            return replace(
                at, free=free, root=root, noise=noise, misfit=float(triangle[-1, -1] ** 2)
            )
    raise ComputationError(
        "the flights in the record can't be fitted together; look at the unit "
        "of its time and position"
    )


def _sample_rows(
    piece: tuple[Floats, Floats],
    flight: int,
    at: JointFlights,
    flying: Flights,
    number: int,
    noise: float,
) -> Floats:
    """Return the equations of the samples of a flight, reduced to as many as there are
    unknowns and one for what is left.
    """
    time, position = piece
    since = (time - at.times[flight]) / at.clock
    fallen, downwards = flying.depth_at(since)
    left = position - (at.level(time) + at.tops[flight] - fallen)
    own = [
        np.ones_like(time),
        time - at.middle,
        downwards * since / at.clock,
        np.ones_like(time),
        downwards / at.clock,
        left,
    ]
    deviation = np.hypot(noise, at.timing * downwards / at.clock)
    reduced = np.linalg.qr(np.stack(own, axis=1) / deviation[:, None], mode="r")
    rows = np.zeros((len(reduced), _SHARED + 2 * number + 1))
    apex = _SHARED + 2 * flight
    rows[:, [_ZERO, _DRIFT, _CLOCK, apex, apex + 1, -1]] = reduced
    return rows


def _meeting_rows(at: JointFlights, flying: Flights, meetings: Meetings) -> Floats:
    """Return the equations by which each flight begins when the contact after the one
    before has ended, as differences of height.
    """
    number = len(at.tops)
    rows = np.zeros((number - 1, _SHARED + 2 * number + 1))
    rise = at.tops - meetings.radius
    up, _ = flying.speed_to_rise(rise)
    flown = flying.flight(up)
    down, falling = flown.return_speed, flown.duration - flown.rise_time
    for row, (one, other) in enumerate(itertools.pairwise(range(number))):
        contact = at.contact * down[one] ** _SLOWER
        gap = (
            at.times[other]
            - at.times[one]
            - at.clock * (flown.rise_time[other] + falling[one] + contact)
        )
        height = down[one] * up[other] / (down[one] + up[other]) / meetings.scatter
        rows[row, _SHARED + 2 * one : _SHARED + 2 * one + 2] = -at.clock / down[one], -1.0
        rows[row, _SHARED + 2 * other : _SHARED + 2 * other + 2] = -at.clock / up[other], 1.0
        rows[row, _CLOCK] = -(flown.rise_time[other] + falling[one] + contact)
        rows[row, _CONTACT] = -at.clock * down[one] ** _SLOWER
        rows[row, -1] = -gap
        rows[row] *= height
    return rows


def _prior_row(place: int, left: float, deviation: float, number: int) -> Floats:
    row = np.zeros((1, _SHARED + 2 * number + 1))
    row[0, place], row[0, -1] = 1.0 / deviation, left / deviation
    return row
