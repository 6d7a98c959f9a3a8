"""Impacts in a measured position record."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.observed.flights import Flights, VacuumFlights, vacuum_height
from vibroimpact.calibration.observed.noise import as_noise, of_the_impact_before, scaled
from vibroimpact.calibration.observed.observations import Correction, Observations, Record
from vibroimpact.calibration.records.flight_samples import (
    SMALL,
    lowest_points,
    release,
    samples_above_impacts,
    samples_of_flights,
    with_enough_samples,
)
from vibroimpact.calibration.records.joint_flights import (
    JointFlights,
    meeting_flights,
    separate_flights,
)
from vibroimpact.calibration.records.record_noise import record_noise, sample_label
from vibroimpact.contact.roots import find_root
from vibroimpact.errors import InputError
from vibroimpact.units.display import fixed, text

_LEAST_NOISE = 1e-9
"""Lower bound of the noise, as a fraction of the range of the record."""

_SELECTIONS = 3
"""Number of times that the samples of the flights are selected, each time by the flights that were
fitted before.
"""

_FAR = 0.5
"""Tolerance of the height at which successive flights meet, as a fraction of the radius."""

_CLOCK_OFF = 0.1
"""Deviation of the clock from 1 above which unit, time or gravity are wrong."""

_LARGE_ZERO = 0.1
"""Zero above which a warning is given, as a fraction of the radius."""

_LARGE_SCATTER = 0.002
"""Scatter of the level above which a warning is given, as a fraction of the lowest rebound."""

_LARGE_CLOCK = 0.005
"""Deviation of the clock from 1 above which a warning is given."""

_SURE = 3.0
"""Standard deviations by which the clock has to deviate from 1 for a warning."""

_FINEST = 1e-6
"""Standard deviation below which corrections are printed no finer [mm], [mm/s], [-]."""


def impacts_in_position(
    time: Floats,
    position: Floats,
    *,
    radius: float,
    gravity: float,
    first_speed: float,
    lines: Sequence[int] | None = None,
    flights: Flights | None = None,
    contact_duration: float | None = None,
) -> Observations:
    """Return the impacts of a sphere whose height was recorded.

    Free flights under the given gravity (parabolas in a vacuum) are fitted to the record between
    its impacts by least squares, all together, with what the record itself determines: its zero and
    the drift of it, since one flight begins where the one before has ended, and the ratio of its
    clock, since gravity is known. The speeds follow from the apexes. Samples near an impact are
    omitted, so that the contact need not be resolved.

    Parameters
    ----------
    time, position : array, shape (n,)
        Time [s], and height of the sphere's centre above the plate [m].
    radius, gravity : float
        Radius of the sphere [m], and acceleration of gravity [m/s^2], > 0.
    first_speed : float
        Approach speed of the first impact [m/s]; used if the record does not show the fall before
        it.
    lines : sequence of int, optional
        The line of each sample in the file, for messages.
    flights : Flights, optional
        Model of the flights; a vacuum by default.
    contact_duration : float, optional
        Expected duration of a contact at an approach speed of 1 m/s [s], known to 80 % of it; 0 if
        impacts take no time. It separates successive flights. By default nothing is known of it,
        which widens the intervals.

    Returns
    -------
    Observations
        With standard deviations from the residuals of the fitted flights, and the zero, drift and
        clock as corrections.

    Raises
    ------
    InputError
        If the record does not show an impact, or a flight has too few samples.

    Examples
    --------
    >>> t = np.linspace(0.0, 1.2, 601)
    >>> y = np.where(
    ...     t < 0.5,
    ...     0.025 + 4.9 * (0.25 - t**2),
    ...     0.025 + np.maximum(3.0 * (t - 0.5) - 4.9 * (t - 0.5) ** 2, 0.0),
    ... )
    >>> found = impacts_in_position(
    ...     t, y + 0.001, radius=0.025, gravity=9.8, first_speed=4.9, contact_duration=0.0
    ... )
    >>> found.wanted["rebound_height"].round(4).tolist(), round(found.corrections["zero"].value, 6)
    ([0.4842], 0.001)
    """
    noise = record_noise(position)
    label_of = sample_label(lines)
    flight_model = flights or VacuumFlights(gravity)
    minima = lowest_points(position, noise)
    if not len(minima):
        rises = f"out of its noise and by {100.0 * SMALL:g} % of its range"
        raise InputError(
            "the record does not show an impact: nowhere does the sphere stop falling and "
            f"rise again, {rises}"
        )
    boundaries = [
        release(time, position, int(minima[0]), noise),
        *(int(index) for index in minima),
        len(time) - 1,
    ]
    joint, kept = _fitted_flights(
        time,
        position,
        boundaries,
        noise,
        label_of,
        flight_model,
        radius=radius,
        gravity=gravity,
        contact_duration=contact_duration,
    )
    labels = tuple(f"impact {number}, {label_of(boundaries[number])}" for number in kept if number)
    observations = _between_flights(joint, 0 in kept, radius, flight_model, first_speed, labels)
    record = _corrected_record(joint, len(labels), time, position, radius, flight_model)
    return replace(observations, flights=flights, record=record)


def _fitted_flights(
    time: Floats,
    position: Floats,
    boundaries: Sequence[int],
    noise: float,
    label_of: Callable[[int], str],
    flight_model: Flights,
    *,
    radius: float,
    gravity: float,
    contact_duration: float | None,
) -> tuple[JointFlights, dict[int, Indices]]:
    """Return the flights fitted together, and the samples of each by its number in the record.

    Which samples show flights above the plate is known only with the flights themselves: selection
    and fit are repeated.
    """
    least_noise = _LEAST_NOISE * float(np.ptp(position))
    reference_time = float(time.mean())
    selected = samples_above_impacts(position, boundaries, noise)
    start = None
    for _ in range(_SELECTIONS):
        kept = with_enough_samples(selected, boundaries, label_of)
        samples = [(time[indices], position[indices]) for indices in kept.values()]
        if start is None:
            start = _parabolas(samples, flight_model, reference_time, max(noise, least_noise))
        elif len(samples) < len(start.apex_heights):
            # the first or the last flight has no samples any more
            still_kept = [number in kept for number in selected]
            start = replace(
                start,
                apex_heights=start.apex_heights[still_kept],
                apex_times=start.apex_times[still_kept],
            )
        separate = separate_flights(samples, start, flight_model, least_noise)
        _check_clock(separate, gravity)
        impacts = [boundaries[number + 1] for number in list(kept)[:-1]]
        labels = [label_of(index) for index in impacts]
        levels = _levels(separate, labels, radius, flight_model)
        joint = meeting_flights(samples, separate, flight_model, radius, levels, contact_duration)
        _check_levels(joint, levels, time[impacts], labels, radius)
        selected = samples_of_flights(joint, kept, time, boundaries, radius, flight_model)
        # separate flights have heights as in the record
        start = replace(joint, apex_heights=joint.apex_heights + joint.offset(joint.apex_times))
    return joint, kept


def _between_flights(
    joint: JointFlights,
    shows_fall: bool,
    radius: float,
    flight_model: Flights,
    first_speed: float,
    labels: tuple[str, ...],
) -> Observations:
    """Return the impacts between flights.

    Each approach speed follows from the flight before, and each rebound height, as in a vacuum,
    from the flight after.
    """
    apex_heights = joint.apex_heights
    sources = joint.noise_of_apex_heights()
    fall_speeds, fall_slopes = flight_model.speed_after_fall(apex_heights - radius)
    fall_noise = scaled(fall_slopes, as_noise(sources))
    if shows_fall:
        # the first flight is the fall, and no rebound
        apex_heights = apex_heights[1:]
        sources = sources[1:]
        speeds = fall_speeds[:-1]
        speed_noise = fall_noise[:-1]
    else:
        speeds = np.append(first_speed, fall_speeds[:-1])
        speed_noise = of_the_impact_before(fall_noise)
    rises, rise_slopes = vacuum_height(flight_model, apex_heights - radius)
    return Observations(
        speeds,
        {"rebound_height": radius + rises},
        speed_noise,
        {"rebound_height": scaled(rise_slopes, as_noise(sources))},
        deviations_known=True,
        labels=labels,
        noise_from="the scatter of the record",
        doubts=_doubts(joint, apex_heights - radius, radius, flight_model.gravity, shows_fall),
        notes=_notes(joint),
        corrections=_corrections(joint),
    )


def _corrections(joint: JointFlights) -> dict[str, Correction]:
    deviations = joint.shared_deviations
    return {
        "zero": Correction(joint.zero, deviations["zero"], "m"),
        "drift": Correction(joint.drift, deviations["drift"], "m/s"),
        "clock": Correction(joint.clock, deviations["clock"], ""),
    }


def _notes(joint: JointFlights) -> tuple[str, ...]:
    """Return sentences on what the record itself determines."""
    corrections = _corrections(joint)
    notes = []
    if len(joint.apex_heights) > 1:
        drift = corrections["drift"]
        if drift.deviation:
            drifts = f" and drifts by {_with_deviation(drift)}"
        else:
            drifts = "; one impact does not tell whether it drifts"
        notes.append(
            f"Successive flights meet {_with_deviation(corrections['zero'])} above the radius: "
            f"the zero of the positions is moved there{drifts}."
        )
    notes.append(
        "By gravity, the clock of the record runs at "
        f"{_with_deviation(corrections['clock'])} of the true rate."
    )
    return tuple(notes)


def _doubts(
    joint: JointFlights, rises: Floats, radius: float, gravity: float, shows_fall: bool
) -> tuple[str, ...]:
    """Return warnings; `rises` are the heights of the rebounds above touch [m]."""
    doubts = []
    if len(joint.apex_heights) == 1:
        # the restitution goes with the root of the height
        per_millimetre = 100.0 * 0.5e-3 / float(rises[0])
        doubts.append(
            "the record shows one flight alone, which does not determine the zero of its "
            "positions: it is taken as right, and 1 mm "
            f"changes the restitution by {per_millimetre:.2g} %; record the fall before the "
            "impact as well"
        )
    if abs(joint.zero) > _LARGE_ZERO * radius:
        doubts.append(
            f"the zero of the positions is off by {text(joint.zero, 'm', 3)}, of a radius "
            f"of {text(radius, 'm', 3)}: it is corrected, but "
            "position must be the height of the sphere's centre above the plate; look at "
            "the radius and the zero of the record"
        )
    clock_deviation = joint.shared_deviations["clock"]
    if abs(joint.clock - 1.0) > max(_LARGE_CLOCK, _SURE * clock_deviation):
        doubts.append(_clock_doubt(joint.clock, gravity, shows_fall))
    if joint.scatter > _LARGE_SCATTER * float(rises.min()):
        doubts.append(
            "the levels at which successive flights meet scatter by "
            f"{text(joint.scatter, 'm', 2)} about a line, more than the noise of "
            "the record, which the intervals include; look for a plate that moves, a sphere "
            "that is not round, or distortion by the lens"
        )
    return tuple(doubts)


def _clock_doubt(clock: float, gravity: float, shows_fall: bool) -> str:
    percent_off = 100.0 * (clock - 1.0)
    # Flights that curve by another gravity have a wrong clock or a wrong length. The clock is
    # corrected; if the length is wrong, the speeds of the corrected time are wrong.
    speed_percent = 100.0 * (1.0 / clock - 1.0)
    if shows_fall:
        exception = ""
    else:
        exception = ", but for that of the first impact, whose approach speed is the case's"
    pace = "fast" if percent_off > 0.0 else "slowly"
    return (
        f"the flights curve as under {gravity / clock**2:.4g} m/s^2, not "
        f"{gravity:.4g} m/s^2: the clock of the record is taken "
        f"to run {abs(percent_off):.2g} % too {pace}, "
        "which is corrected; if its lengths are wrong instead, all "
        f"speeds taken from it are {speed_percent:+.2g} % off, and "
        f"the restitutions stay right{exception}"
    )


def _with_deviation(correction: Correction) -> str:
    """Return a correction with its standard deviation, to two digits of it."""
    if correction.unit:
        factor = 1e3
        unit = f" m{correction.unit}"
    else:
        factor = 1.0
        unit = ""
    deviation = factor * max(correction.deviation, _FINEST / factor)
    decimals = max(0, 1 - math.floor(math.log10(deviation)))
    return f"{fixed(factor * correction.value, decimals)} ± {fixed(deviation, decimals)}{unit}"


def _corrected_record(
    joint: JointFlights,
    rebound_count: int,
    time: Floats,
    position: Floats,
    radius: float,
    flight_model: Flights,
) -> Record:
    """Return the record over true time and from its own zero, with the times of the rebounds.

    The time is that of the record corrected by its clock.
    """

    def true_time(clock_time: Floats) -> Floats:
        return joint.reference_time + (clock_time - joint.reference_time) / joint.clock

    rebound_heights = joint.apex_heights[-rebound_count:] - radius
    initial_speed, _ = flight_model.speed_to_rise(rebound_heights)
    rise_time = flight_model.flight(initial_speed).rise_time
    begins = true_time(joint.apex_times[-rebound_count:]) - rise_time
    height = position - joint.offset(time)
    return Record("position", ((true_time(time), height),), tuple(begins.tolist()))


def _parabolas(
    samples: Sequence[tuple[Floats, Floats]],
    flight_model: Flights,
    reference_time: float,
    noise: float,
) -> JointFlights:
    """Return each flight as a parabola by least squares, the initial guess."""
    apex_heights = []
    apex_times = []
    for time, position in samples:
        # with the fall by gravity added to the positions, the flight is a straight line
        from_mean = time - time.mean()
        powers = np.vander(from_mean, 2, increasing=True)
        (height, speed), *_ = np.linalg.lstsq(
            powers, position + 0.5 * flight_model.gravity * from_mean**2, rcond=None
        )
        apex_heights.append(float(height + 0.5 * speed**2 / flight_model.gravity))
        apex_times.append(float(time.mean() + speed / flight_model.gravity))
    return JointFlights(
        np.array(apex_heights),
        np.array(apex_times),
        zero=0.0,
        drift=0.0,
        clock=1.0,
        contact=0.0,
        reference_time=reference_time,
        noise=noise,
    )


def _check_clock(flights: JointFlights, gravity: float) -> None:
    """Check that the flights curve about as they do under gravity."""
    if abs(flights.clock - 1.0) > _CLOCK_OFF:
        raise InputError(
            f"the flights curve as under {gravity / flights.clock**2:.4g} m/s^2, and gravity "
            f"is {gravity:.4g} m/s^2; position must be the "
            "height of the sphere's centre above the plate, and its unit, time and gravity "
            "those of the record"
        )


def _levels(
    separate: JointFlights, labels: Sequence[str], radius: float, flight_model: Flights
) -> Floats:
    """Return the heights at which successive flights meet [m]; `labels` name the impacts."""
    levels = np.array(
        [_meeting_height(separate, flight, flight_model) for flight in range(len(labels))]
    )
    for level, label in zip(levels, labels, strict=True):
        if not np.isfinite(level):
            raise InputError(
                f"the flights before and after {label} do not meet, {_touches_at(radius)}"
            )
    return levels


def _check_levels(
    joint: JointFlights,
    levels: Floats,
    impact_times: Floats,
    labels: Sequence[str],
    radius: float,
) -> None:
    """Check that successive flights meet near the height at which the sphere touches the plate.

    Each level by itself is as uncertain as a short flight between noisy samples; a line through
    them is better known.
    """
    if joint.scatter <= _FAR * radius:
        levels = radius + joint.offset(impact_times)
    for level, label in zip(levels, labels, strict=True):
        if abs(level - radius) > _FAR * radius:
            raise InputError(
                f"the flights before and after {label} meet at {level:.4g} m, {_touches_at(radius)}"
            )


def _touches_at(radius: float) -> str:
    return (
        f"and the sphere touches at its radius, {radius:g} m; position must be the height "
        "of its centre above the plate, and its unit, "
        "time and gravity those of the record"
    )


def _meeting_height(flights: JointFlights, flight: int, flight_model: Flights) -> float:
    """Return the height at which a flight crosses the following one between their apexes [m].

    It is NaN if they do not cross.
    """

    def height(which: int, time: Floats) -> Floats:
        since_apex = (time - flights.apex_times[which]) / flights.clock
        depth, _ = flight_model.depth_at(since_apex)
        return np.asarray(flights.apex_heights[which] - depth)

    def height_difference(time: Floats) -> Floats:
        return height(flight + 1, time) - height(flight, time)

    apex = flights.apex_times[[flight]]
    next_apex = flights.apex_times[[flight + 1]]
    # at its own apex each is the higher one, so that they cross between the two
    if not (height_difference(apex)[0] < 0.0 < height_difference(next_apex)[0]):
        return float("nan")
    meeting_time = find_root(height_difference, apex, next_apex)
    return float(height(flight, meeting_time)[0])
