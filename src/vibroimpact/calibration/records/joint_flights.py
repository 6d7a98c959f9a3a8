"""Successive flights in a position record, fitted together.

The fit also estimates what the record itself determines: its zero, drift, clock and contacts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_triangular

from vibroimpact.arrays import Floats
from vibroimpact.calibration.observed.flights import Flights
from vibroimpact.errors import ComputationError, InputError

_ZERO, _DRIFT, _CLOCK, _CONTACT, _SHARED = range(5)
"""Columns of the unknowns that all flights share, and their number.

Two columns for each flight follow: the height and the time of its apex.
"""

_CLOCK_DEVIATION = 0.05
"""Prior standard deviation of the clock's ratio; the curvature of a few flights determines it to a
thousandth.
"""

_CONTACT_DEVIATION = 0.8
"""Prior standard deviation of the duration of contact, as a fraction of the expected one: losses
prolong Hertz's by a third, compliant plates double it.
"""

_UNKNOWN_CONTACT = 0.5
"""Prior standard deviation of a duration of contact of which nothing is known, at 1 m/s, per radius
[s/m]: for a rubber ball of 26 mm 6 ms.
"""

_HERTZ_EXPONENT = -0.2
"""Exponent of the approach speed in the duration of Hertz's contact."""

_CONVERGED = 1e-12
"""Relative change of the apex heights at which the Gauss-Newton iteration ends."""

_MOST_ITERATIONS = 50

_MEETING_TOLERANCE = 1e-3
"""Scatter of the level at which successive flights meet where they meet exactly, as a fraction of
the noise of one sample.
"""

_NOT_NOISE = 0.999
"""Quantile of chi squared above which the levels scatter by more than noise."""

_MOST_BISECTIONS = 60

_PASSES = 3
"""Number of times that the noise is estimated, each time from the fit with the previous noise."""

_LEAST_RATIO = 1e-2
_MOST_RATIO = 1e6
_RATIO_COUNT = 81
"""Grid of ratios of a fast sample's variance by its time to that by its position."""

_TIMES_SCATTER = 3.84
"""Twice the logarithm of the likelihood by which times have to explain the scatter better, the
95 % quantile of chi squared.
"""


class Meetings(NamedTuple):
    """What is known of the meetings of successive flights.

    Radius of the sphere, the height at which they meet, and the scatter about it [m]; expected
    duration of contact at 1 m/s and its standard deviation [s].
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
    apex_heights, apex_times : array, shape (n,)
        Height of each apex above the plate [m], and its time on the clock of the record [s].
    zero, drift : float
        Offset of the positions at the reference time [m], and its rate [m/s].
    clock : float
        Seconds of the record per second.
    contact : float
        Duration of a contact at an approach speed of 1 m/s [s]; it changes as Hertz's, with the
        power -1/5 of the speed.
    reference_time : float
        Time on the clock of the record at which the zero is stated [s].
    estimated : tuple of int
        Columns of the k unknowns that are estimated; the others are held.
    covariance_root : array, shape (k, k)
        Contribution of each independent source of unit variance to each estimated unknown.
    noise, scatter : float
        Standard deviation of a sample, and of the level of one impact about the line of the zero
        [m].
    misfit : float
        Sum of squares of the normalized residuals.
    timing : float
        Standard deviation of the time of a sample [s], by which it scatters the more the faster the
        sphere is; 0 where none shows.
    curvature : array, shape (n,), optional
        Offset of the zero from its line at each apex [m], one standard deviation of a zero that
        drifts along a parabola and makes the levels scatter; None where they do not.
    """

    apex_heights: Floats
    apex_times: Floats
    zero: float
    drift: float
    clock: float
    contact: float
    reference_time: float
    estimated: tuple[int, ...] = ()
    covariance_root: Floats | None = None
    noise: float = 1.0
    scatter: float = 0.0
    misfit: float = 0.0
    timing: float = 0.0
    curvature: Floats | None = None

    def offset(self, time: Floats) -> Floats:
        """Return the offset of positions at times of the record [m]."""
        return self.zero + self.drift * (time - self.reference_time)

    def deviation(self, speed: Floats) -> Floats:
        """Return the standard deviation of samples at vertical speeds [m].

        It combines that of positions, and that of times multiplied by the speed [m/s].
        """
        return np.asarray(np.hypot(self.noise, self.timing * speed / self.clock))

    def noise_of_apex_heights(self) -> Floats:
        """Return the contribution of each source to the height of each apex [m], (n, k)."""
        assert self.covariance_root is not None
        rows = [
            self.estimated.index(_SHARED + 2 * flight) for flight in range(len(self.apex_heights))
        ]
        sources = self.covariance_root[rows]
        if self.curvature is None:
            return sources
        return np.column_stack([sources, self.curvature])

    @property
    def shared_deviations(self) -> dict[str, float]:
        """Standard deviations of zero [m], drift [m/s], clock [-] and contact [s].

        They are 0 where one is not estimated.
        """
        assert self.covariance_root is not None
        columns = {"zero": _ZERO, "drift": _DRIFT, "clock": _CLOCK, "contact": _CONTACT}
        deviations = dict.fromkeys(columns, 0.0)
        for name, column in columns.items():
            if column in self.estimated:
                row = self.estimated.index(column)
                deviations[name] = float(np.linalg.norm(self.covariance_root[row]))
        return deviations


def separate_flights(
    samples: Sequence[tuple[Floats, Floats]],
    start: JointFlights,
    flight_model: Flights,
    least_noise: float,
) -> JointFlights:
    """Return flights that share the clock alone, and the noise of their samples.

    Their heights are as in the record.

    Parameters
    ----------
    samples : sequence of (array, array)
        Times [s] and positions [m] of the samples of each flight, one flight after the other.
    start : JointFlights
        Initial guess.
    flight_model : Flights
        Model of the flights.
    least_noise : float
        Lower bound of the noise [m].
    """
    sample_count = sum(len(time) for time, _ in samples)
    # the unknowns are two per flight, and the clock
    freedom = max(sample_count - 2 * len(samples) - 1, 1)
    flights = replace(start, zero=0.0, drift=0.0, timing=0.0, scatter=0.0, curvature=None)
    noise = start.noise
    for _ in range(_PASSES):  # the weight of what is known of the clock depends on the noise
        flights = _solved(samples, flights, flight_model, (_CLOCK,), noise)
        noise = float(np.hypot(noise * np.sqrt(flights.misfit / freedom), least_noise))
    flights = _solved(samples, flights, flight_model, (_CLOCK,), noise)
    for _ in range(_PASSES):
        noise, timing = _noise_and_timing(samples, flights, flight_model)
        if not timing:
            break
        flights = replace(flights, timing=timing)
        flights = _solved(samples, flights, flight_model, (_CLOCK,), max(noise, least_noise))
    return flights


def _noise_and_timing(
    samples: Sequence[tuple[Floats, Floats]], flights: JointFlights, flight_model: Flights
) -> tuple[float, float]:
    """Return the standard deviations of positions [m] and of times [s] by maximum likelihood.

    The variance of a sample is that of positions, and that of times by the square of the speed.
    Where that is not significantly better than positions alone, the times are exact.
    """
    residuals_of_flights = []
    speeds_of_flights = []
    for flight, (time, position) in enumerate(samples):
        depth, downward_speed = flight_model.depth_at(
            (time - flights.apex_times[flight]) / flights.clock
        )
        # Derivatives by the height and the time of the apex. The fit of these two takes from each
        # sample a part of its variance, its leverage: the diagonal of the hat matrix Q Q^T.
        design = np.stack([np.ones_like(time), downward_speed], axis=1)
        deviation = flights.deviation(downward_speed)
        orthonormal, _ = np.linalg.qr(design / deviation[:, None])
        leverage = (orthonormal**2).sum(axis=1)
        computed = flights.offset(time) + flights.apex_heights[flight] - depth
        residual = position - computed
        residuals_of_flights.append(residual**2 / np.maximum(1.0 - leverage, 0.1))
        speeds_of_flights.append((downward_speed / flights.clock) ** 2)
    squared_residual = np.concatenate(residuals_of_flights)
    squared_speed = np.concatenate(speeds_of_flights)

    def deviance(ratio: float) -> float:
        """Return minus twice the logarithm of the likelihood.

        The variance of positions is the one that is most likely; `ratio` is the variance of times
        over it [s^2/m^2].
        """
        relative_variance = 1.0 + ratio * squared_speed
        return float(
            len(squared_residual) * np.log(np.mean(squared_residual / relative_variance))
            + np.log(relative_variance).sum()
        )

    ratios = np.geomspace(_LEAST_RATIO, _MOST_RATIO, _RATIO_COUNT) / squared_speed.max()
    ratio = float(ratios[int(np.argmin([deviance(ratio) for ratio in ratios]))])
    if not deviance(0.0) - deviance(ratio) > _TIMES_SCATTER:
        return flights.noise, 0.0
    variance = float(np.mean(squared_residual / (1.0 + ratio * squared_speed)))
    timing = float(np.sqrt(ratio * variance))
    # to second order a time that is off moves the apex, too
    noise = float(np.hypot(np.sqrt(variance), flight_model.gravity * timing**2 / np.sqrt(2.0)))
    return noise, timing


def meeting_flights(
    samples: Sequence[tuple[Floats, Floats]],
    separate: JointFlights,
    flight_model: Flights,
    radius: float,
    levels: Floats,
    contact_duration: float | None,
) -> JointFlights:
    """Return the fit of successive flights that meet where the sphere touches the plate.

    With one meeting the zero is estimated, with more its drift as well; without any, both are zero.
    Where the levels at which the flights meet scatter about a line by more than the noise, that
    scatter is estimated too, and widens all deviations: those of the meetings, as of a sphere that
    is not round, and those of the apexes, as of a zero that drifts along a parabola.

    Parameters
    ----------
    samples : sequence of (array, array)
        Times [s] and positions [m] of the samples of each flight, one flight after the other.
    separate : JointFlights
        The flights fitted separately.
    flight_model : Flights
        Model of the flights.
    radius : float
        Radius of the sphere [m], the height of its centre in touch.
    levels : array, shape (n - 1,)
        Height at which each flight meets the next [m], for the initial guess.
    contact_duration : float, optional
        Expected duration of a contact at an approach speed of 1 m/s [s].

    Raises
    ------
    InputError
        If a flight does not rise above the plate.
    """
    meeting_count = len(levels)
    if not meeting_count:
        return separate
    if contact_duration is None:
        expected_contact = 0.0
        contact_deviation = _UNKNOWN_CONTACT * radius
    else:
        expected_contact = contact_duration
        contact_deviation = _CONTACT_DEVIATION * contact_duration
    shared = [_ZERO, _DRIFT, _CLOCK]
    if meeting_count == 1:  # which tells no drift of the zero
        shared.remove(_DRIFT)
    if contact_duration is None or contact_duration > 0.0:
        shared.append(_CONTACT)
    zero = float(np.median(levels)) - radius
    start = replace(
        separate,
        apex_heights=separate.apex_heights - zero,
        zero=zero,
        contact=expected_contact,
    )

    def fit_with(scatter: float) -> JointFlights:
        meetings = Meetings(radius, scatter, expected_contact, contact_deviation)
        return _solved(samples, start, flight_model, tuple(shared), separate.noise, meetings)

    joint = fit_with(_MEETING_TOLERANCE * separate.noise)
    # the meetings beyond the two that determine a line, its zero and drift
    freedom = meeting_count - min(meeting_count, 2)
    if not freedom or not _exceeds(joint.misfit - separate.misfit, freedom):
        return joint
    # The scatter with which the meetings add as much misfit as there are degrees of freedom, which
    # is what chi-squared is expected to be; by bisection of its logarithm, as the misfit falls with
    # the scatter.
    low = _MEETING_TOLERANCE * separate.noise
    high = max(radius, separate.noise)
    for _ in range(_MOST_BISECTIONS):
        middle = float(np.sqrt(low * high))
        joint = fit_with(middle)
        if joint.misfit - separate.misfit > freedom:
            low = middle
        else:
            high = middle
        if high < 1.01 * low:
            break
    return replace(joint, scatter=high, curvature=high * _parabola_at_apexes(joint, radius))


def _parabola_at_apexes(joint: JointFlights, radius: float) -> Floats:
    """Return a parabola at the apexes whose mean square at the meetings about a line is 1, (n,)."""
    # both parts of a flight take as long as the root of its height
    spans = np.sqrt(np.maximum(joint.apex_heights - radius, 0.0))
    parts = spans[:-1] / (spans[:-1] + spans[1:])
    times = (joint.apex_times - joint.reference_time) / np.ptp(joint.apex_times)
    meetings = times[:-1] + parts * np.diff(times)
    line = np.polynomial.Polynomial.fit(meetings, meetings**2, 1)
    residual = meetings**2 - line(meetings)
    size = np.sqrt(residual @ residual / (len(meetings) - 2))
    return np.asarray((times**2 - line(times)) / size)


def _exceeds(squares: float, freedom: int) -> bool:
    from scipy.stats import chi2  # imported late: it takes longer to load than a calibration

    return bool(squares > chi2.ppf(_NOT_NOISE, freedom))


def _solved(
    samples: Sequence[tuple[Floats, Floats]],
    start: JointFlights,
    flight_model: Flights,
    shared: tuple[int, ...],
    noise: float,
    meetings: Meetings | None = None,
) -> JointFlights:
    """Return the least-squares fit by the Gauss-Newton method.

    `shared` are the columns of the shared unknowns that are estimated.
    """
    unknown_count = _SHARED + 2 * len(samples)
    estimated = [*shared, *range(_SHARED, unknown_count)]
    flights = start
    for _ in range(_MOST_ITERATIONS):
        equations = _equations(samples, flights, flight_model, shared, noise, meetings)
        # columns of norm 1 keep the triangle well conditioned whatever the units
        columns = equations[:, estimated]
        column_norms = np.linalg.norm(columns, axis=0)
        with_residuals = np.column_stack([columns / column_norms, equations[:, -1]])
        triangle = np.asarray(np.linalg.qr(with_residuals, mode="r"))
        # the last column, of residuals, ends in their norm after the step
        square = triangle[: len(estimated), : len(estimated)]
        right_side = triangle[: len(estimated), -1]
        step = np.zeros(unknown_count)
        step[estimated] = solve_triangular(square, right_side) / column_norms
        flights = _moved(flights, step)
        if not (np.all(np.isfinite(step)) and flights.clock > 0.0):
            break
        if np.all(np.abs(step[_SHARED::2]) <= _CONVERGED * np.abs(flights.apex_heights)):
            # covariance (R^T R)^-1, of which R^-1 is a root
            root = solve_triangular(square, np.eye(len(estimated))) / column_norms[:, None]
            return replace(
                flights,
                estimated=tuple(estimated),
                covariance_root=root,
                noise=noise,
                misfit=float(triangle[-1, -1] ** 2),
            )
    raise ComputationError(
        "the flights in the record can't be fitted together; look at the unit "
        "of its time and position"
    )


def _moved(flights: JointFlights, step: Floats) -> JointFlights:
    """Return the flights after a step of all unknowns."""
    return replace(
        flights,
        apex_heights=flights.apex_heights + step[_SHARED::2],
        apex_times=flights.apex_times + step[_SHARED + 1 :: 2],
        zero=flights.zero + float(step[_ZERO]),
        drift=flights.drift + float(step[_DRIFT]),
        clock=flights.clock + float(step[_CLOCK]),
        contact=flights.contact + float(step[_CONTACT]),
    )


def _equations(
    samples: Sequence[tuple[Floats, Floats]],
    flights: JointFlights,
    flight_model: Flights,
    shared: tuple[int, ...],
    noise: float,
    meetings: Meetings | None,
) -> Floats:
    """Return the normalized linear equations of a Gauss-Newton step.

    A row has the derivatives by all unknowns, and the residual in the last column.
    """
    flight_count = len(samples)
    rows = [
        _sample_rows(samples[flight], flight, flights, flight_model, noise)
        for flight in range(flight_count)
    ]
    rows.append(_prior_row(_CLOCK, 1.0 - flights.clock, _CLOCK_DEVIATION, flight_count))
    if meetings is not None:
        if np.any(flights.apex_heights <= meetings.radius):
            raise InputError(
                "in a flight the centre of the sphere does not rise above its place in "
                "touch, at the radius; position must be the "
                "height of the centre above the plate; look at its unit and at the radius"
            )
        rows.append(_meeting_rows(flights, flight_model, meetings))
        if _CONTACT in shared:
            residual = meetings.contact - flights.contact
            rows.append(_prior_row(_CONTACT, residual, meetings.contact_deviation, flight_count))
    return np.concatenate(rows)


def _sample_rows(
    samples: tuple[Floats, Floats],
    flight: int,
    flights: JointFlights,
    flight_model: Flights,
    noise: float,
) -> Floats:
    """Return the equations of the samples of a flight, reduced to a triangle by QR.

    It has as many rows as there are unknowns in them, and one for the norm of their residuals.
    """
    time, position = samples
    since_apex = (time - flights.apex_times[flight]) / flights.clock
    depth, downward_speed = flight_model.depth_at(since_apex)
    residual = position - (flights.offset(time) + flights.apex_heights[flight] - depth)
    columns = [
        np.ones_like(time),  # by the zero
        time - flights.reference_time,  # by the drift
        downward_speed * since_apex / flights.clock,  # by the clock
        np.ones_like(time),  # by the height of the apex
        downward_speed / flights.clock,  # by its time
        residual,
    ]
    deviation = np.hypot(noise, flights.timing * downward_speed / flights.clock)
    reduced = np.linalg.qr(np.stack(columns, axis=1) / deviation[:, None], mode="r")
    rows = np.zeros((len(reduced), _SHARED + 2 * len(flights.apex_heights) + 1))
    apex = _SHARED + 2 * flight
    rows[:, [_ZERO, _DRIFT, _CLOCK, apex, apex + 1, -1]] = reduced
    return rows


def _meeting_rows(flights: JointFlights, flight_model: Flights, meetings: Meetings) -> Floats:
    """Return the equations by which each flight begins when the contact before it has ended.

    They are equations of time, multiplied by a speed and thus differences of height.
    """
    flight_count = len(flights.apex_heights)
    rows = np.zeros((flight_count - 1, _SHARED + 2 * flight_count + 1))
    initial_speed, _ = flight_model.speed_to_rise(flights.apex_heights - meetings.radius)
    flown = flight_model.flight(initial_speed)
    approach_speed = flown.return_speed
    fall_time = flown.duration - flown.rise_time
    for flight in range(flight_count - 1):
        following = flight + 1
        down = approach_speed[flight]
        up = initial_speed[following]
        contact = flights.contact * down**_HERTZ_EXPONENT
        between_apexes = flown.rise_time[following] + fall_time[flight] + contact
        gap = (
            flights.apex_times[following]
            - flights.apex_times[flight]
            - flights.clock * between_apexes
        )
        # A time of fall or ascent changes with the height by the reciprocal of the speed at its
        # lower end.
        apex = _SHARED + 2 * flight
        next_apex = _SHARED + 2 * following
        rows[flight, apex : apex + 2] = -flights.clock / down, -1.0
        rows[flight, next_apex : next_apex + 2] = -flights.clock / up, 1.0
        rows[flight, _CLOCK] = -between_apexes
        rows[flight, _CONTACT] = -flights.clock * down**_HERTZ_EXPONENT
        rows[flight, -1] = -gap
        # height per gap of time between a path that falls and one that rises, 1/(1/down + 1/up)
        rows[flight] *= down * up / (down + up) / meetings.scatter
    return rows


def _prior_row(column: int, residual: float, deviation: float, flight_count: int) -> Floats:
    """Return the equation by which an unknown is known to a standard deviation."""
    row = np.zeros((1, _SHARED + 2 * flight_count + 1))
    row[0, column] = 1.0 / deviation
    row[0, -1] = residual / deviation
    return row
