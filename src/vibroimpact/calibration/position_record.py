"""Impacts in a measured position record."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.flight_samples import (
    SMALL,
    lowest_points,
    release,
    samples_above_impacts,
    samples_of_flights,
    with_enough_samples,
)
from vibroimpact.calibration.flights import Flights, VacuumFlights, vacuum_height
from vibroimpact.calibration.joint_flights import JointFlights, meeting_flights, separate_flights
from vibroimpact.calibration.noise import as_noise, of_the_impact_before, scaled
from vibroimpact.calibration.observations import Correction, Observations, Record
from vibroimpact.calibration.record_noise import record_noise, sample_label
from vibroimpact.contact.roots import find_root
from vibroimpact.errors import InputError
from vibroimpact.units.display import fixed, text

_LEAST = 1e-9  # lower bound of the noise, as a fraction of the range of the record

_SELECTIONS = 3
"""Number of times that the samples of the flights are selected, each time by the flights
that were fitted before.
"""

_FAR = 0.5
"""Tolerance of the height at which successive flights meet, as a fraction of the radius."""

_CLOCK_OFF = 0.1
"""Deviation of the clock from 1 above which unit, time or gravity are wrong."""

_LARGE_ZERO, _LARGE_SCATTER, _LARGE_CLOCK = 0.1, 0.02, 0.005
"""Deviations above which a warning is given: the zero as a fraction of the radius, the scatter of
the level as a fraction of the lowest rebound, and the clock from 1.
"""

_FINEST = 1e-6  # standard deviation below which corrections are printed no finer [mm], [mm/s], [-]

_SURE = 3.0
"""Standard deviations by which the clock has to deviate from 1 for a warning."""


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
    noise, at, flying = (
        record_noise(position),
        sample_label(lines),
        flights or VacuumFlights(gravity),
    )
    lows = lowest_points(position, noise)
    if not len(lows):
        rises = f"out of its noise and by {100.0 * SMALL:g} % of its range"
        raise InputError(
            "the record does not show an impact: nowhere does the sphere stop falling and "
            f"rise again, {rises}"
        )
    ends = [
        release(time, position, int(lows[0]), noise),
        *(int(low) for low in lows),
        len(time) - 1,
    ]
    selected, start = samples_above_impacts(position, ends, noise), None
    least, middle = _LEAST * float(np.ptp(position)), float(time.mean())
    for _ in range(_SELECTIONS):
        kept = with_enough_samples(selected, ends, at)
        pieces = [(time[inside], position[inside]) for inside in kept.values()]
        if start is None:
            start = _started(pieces, flying, middle, max(noise, least))
        elif len(pieces) < len(start.tops):  # the first or the last flight has no samples left
            still = [number in kept for number in selected]
            start = replace(start, tops=start.tops[still], times=start.times[still])
        alone = separate_flights(pieces, start, flying, least)
        _check_clock(alone, gravity)
        met = [ends[number + 1] for number in list(kept)[:-1]]
        places = [at(index) for index in met]
        levels = _levels(alone, places, radius, flying)
        joint = meeting_flights(pieces, alone, flying, radius, levels, contact_duration)
        _check_levels(joint, levels, time[met], places, radius)
        selected = samples_of_flights(joint, kept, time, ends, radius, flying)
        start = replace(joint, tops=joint.tops + joint.level(joint.times))
    labels = tuple(f"impact {number}, {at(ends[number])}" for number in kept if number)
    found = _between_flights(joint, 0 in kept, radius, flying, first_speed, labels)
    return replace(
        found,
        flights=flights,
        record=_corrected_record(joint, len(labels), time, position, radius, flying),
    )


def _between_flights(
    joint: JointFlights,
    shows_fall: bool,
    radius: float,
    flying: Flights,
    first_speed: float,
    labels: tuple[str, ...],
) -> Observations:
    sources = joint.noise_of_tops()
    falls, slopes = flying.speed_after_fall(joint.tops - radius)
    by_fall = scaled(slopes, as_noise(sources))
    if shows_fall:
        first_speed, tops, sources = float(falls[0]), joint.tops[1:], sources[1:]
        speeds, before = falls[:-1], by_fall[:-1]
    else:
        tops = joint.tops
        speeds, before = np.append(first_speed, falls[:-1]), of_the_impact_before(by_fall)
    rises, scales = vacuum_height(flying, tops - radius)
    wanted, noise = (
        {"rebound_height": radius + rises},
        {"rebound_height": scaled(scales, as_noise(sources))},
    )
    doubts, notes = _told(
        joint, tops - radius, radius, flying.gravity, float(speeds[0]), shows_fall
    )
    return Observations(
        speeds,
        wanted,
        before,
        noise,
        deviations_known=True,
        labels=labels,
        noise_from="the scatter of the record",
        doubts=doubts,
        notes=notes,
        corrections=_corrections(joint),
    )


def _corrections(joint: JointFlights) -> dict[str, Correction]:
    deviations, units = joint.shared_deviations, {"zero": "m", "drift": "m/s", "clock": ""}
    return {
        name: Correction(getattr(joint, name), deviations[name], unit)
        for name, unit in units.items()
    }


def _told(
    joint: JointFlights,
    rises: Floats,
    radius: float,
    gravity: float,
    speed: float,
    shows_fall: bool,
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return warnings, and sentences on what the record itself determines."""
    doubts, notes = [], []
    zero, drift, clock = _corrections(joint).values()
    if len(joint.tops) == 1:
        part = 100.0 * 0.5e-3 / float(rises[0])
        doubts.append(
            "the record shows one flight alone, which does not determine the zero of its "
            "positions: it is taken as right, and 1 mm "
            f"changes the restitution by {part:.2g} %; record the fall before the impact as well"
        )
    else:
        moves = (
            f" and drifts by {_known(drift)}"
            if drift.deviation
            else "; one impact does not tell whether it drifts"
        )
        notes.append(
            f"Successive flights meet {_known(zero)} above the radius: the zero of the "
            f"positions is moved there{moves}."
        )
    notes.append(f"By gravity, the clock of the record runs at {_known(clock)} of the true rate.")
    if abs(zero.value) > _LARGE_ZERO * radius:
        doubts.append(
            f"the zero of the positions is off by {text(zero.value, 'm', 3)}, of a radius "
            f"of {text(radius, 'm', 3)}: it is corrected, but "
            "position must be the height of the sphere's centre above the plate; look at "
            "the radius and the zero of the record"
        )
    if abs(clock.value - 1.0) > max(_LARGE_CLOCK, _SURE * clock.deviation):
        off = 100.0 * (clock.value - 1.0)
        # speeds are those of the time that is corrected
        too_fast = 100.0 * (1.0 / clock.value - 1.0)
        besides = (
            ""
            if shows_fall
            else ", but for that of the first impact, whose approach speed is the case's"
        )
        doubts.append(
            f"the flights curve as under {gravity / clock.value**2:.4g} m/s^2, not "
            f"{gravity:.4g} m/s^2: the clock of the record is taken "
            f"to run {abs(off):.2g} % too {'fast' if off > 0.0 else 'slowly'}, which is "
            "corrected; if its lengths are wrong instead, all "
            f"speeds taken from it are {too_fast:+.2g} % off, and "
            f"the restitutions stay right{besides}"
        )
    if joint.scatter > _LARGE_SCATTER * float(rises.min()):
        doubts.append(
            "the levels at which successive flights meet scatter by "
            f"{text(joint.scatter, 'm', 2)} about a line, more than the noise of "
            "the record, which the intervals include; look for a plate that moves, a sphere "
            "that is not round, or distortion by the lens"
        )
    return tuple(doubts), tuple(notes)


def _known(one: Correction) -> str:
    """Return a correction with its standard deviation, to two digits of it."""
    factor, unit = (1e3, f" m{one.unit}") if one.unit else (1.0, "")
    deviation = factor * max(one.deviation, _FINEST / factor)
    decimals = max(0, 1 - math.floor(math.log10(deviation)))
    return f"{fixed(factor * one.value, decimals)} ± {fixed(deviation, decimals)}{unit}"


def _corrected_record(
    joint: JointFlights,
    rebounds: int,
    time: Floats,
    position: Floats,
    radius: float,
    flying: Flights,
) -> Record:
    """Return the record over time instead of that of its clock, from its own zero, with
    the times at which rebounds begin.
    """

    def corrected(at: Floats) -> Floats:
        return joint.middle + (at - joint.middle) / joint.clock

    rises = flying.flight(flying.speed_to_rise(joint.tops[-rebounds:] - radius)[0]).rise_time
    begins = corrected(joint.times[-rebounds:]) - rises
    return Record(
        "position", ((corrected(time), position - joint.level(time)),), tuple(begins.tolist())
    )


def _started(
    pieces: Sequence[tuple[Floats, Floats]], flying: Flights, middle: float, noise: float
) -> JointFlights:
    """Return each flight as a parabola by least squares, the initial guess."""
    tops, times = [], []
    for time, position in pieces:
        across = time - time.mean()
        powers = np.vander(across, 2, increasing=True)
        (height, speed), *_ = np.linalg.lstsq(
            powers, position + 0.5 * flying.gravity * across**2, rcond=None
        )
        tops.append(float(height + 0.5 * speed**2 / flying.gravity))
        times.append(float(time.mean() + speed / flying.gravity))
    return JointFlights(np.array(tops), np.array(times), 0.0, 0.0, 1.0, 0.0, middle, noise=noise)


def _check_clock(alone: JointFlights, gravity: float) -> None:
    """Check that the flights curve about as they do under gravity."""
    if abs(alone.clock - 1.0) > _CLOCK_OFF:
        raise InputError(
            f"the flights curve as under {gravity / alone.clock**2:.4g} m/s^2, and gravity "
            f"is {gravity:.4g} m/s^2; position must be the "
            "height of the sphere's centre above the plate, and its unit, time and gravity "
            "those of the record"
        )


def _levels(alone: JointFlights, places: Sequence[str], radius: float, flying: Flights) -> Floats:
    """Return the heights at which successive flights meet [m]."""
    levels = np.array([_where_they_meet(alone, number, flying) for number in range(len(places))])
    for level, place in zip(levels, places, strict=True):
        if not np.isfinite(level):
            raise InputError(
                f"the flights before and after {place} do not meet, {_touches_at(radius)}"
            )
    return levels


def _check_levels(
    joint: JointFlights, levels: Floats, touches: Floats, places: Sequence[str], radius: float
) -> None:
    """Check that successive flights meet near the height at which the sphere touches the plate.

    Each level by itself is as uncertain as a short flight between noisy samples; a line through
    them is better known.
    """
    stated = radius + joint.level(touches) if joint.scatter <= _FAR * radius else levels
    for level, place in zip(stated, places, strict=True):
        if abs(level - radius) > _FAR * radius:
            raise InputError(
                f"the flights before and after {place} meet at {level:.4g} m, {_touches_at(radius)}"
            )


def _touches_at(radius: float) -> str:
    return (
        f"and the sphere touches at its radius, {radius:g} m; position must be the height "
        "of its centre above the plate, and its unit, "
        "time and gravity those of the record"
    )


def _where_they_meet(alone: JointFlights, number: int, flying: Flights) -> float:
    """Return the height at which a flight crosses the following one between their apexes
    [m]; NaN if it does not.
    """

    def height(which: int, time: Floats) -> Floats:
        return np.asarray(
            alone.tops[which] - flying.depth_at((time - alone.times[which]) / alone.clock)[0]
        )

    def apart(time: Floats) -> Floats:
        return height(number + 1, time) - height(number, time)

    ends = alone.times[number : number + 1], alone.times[number + 1 : number + 2]
    if not (apart(ends[0])[0] < 0.0 < apart(ends[1])[0]):
        return float("nan")
    return float(height(number, find_root(apart, *ends))[0])
