"""Impacts in a measured force record."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fitting import misfits
from vibroimpact.calibration.flights import EndSpeeds, Flights, VacuumFlights
from vibroimpact.calibration.force_pulses import Pulse, evaluate_pulses, find_pulses
from vibroimpact.calibration.noise import (
    of_the_impact_before,
    own_noise,
    scaled,
    with_common_source,
)
from vibroimpact.calibration.observations import Observations, Record
from vibroimpact.calibration.record_noise import sample_label
from vibroimpact.errors import InputError

_FEWEST = 5
"""Minimum number of samples of an impact."""

_COARSE = 10
"""Number of samples of a contact below which the largest force is doubted."""

RISE, RELEASE, _LEAST = 0.24, 0.8, 0.01
"""Bounds of what the contact law, which is unknown, may change, as fractions of a contact and of
the part of the speed that is lost: of the time between begin and end, which are extrapolated as if
the force rose and fell as Hertz's; and of the time by which a contact ends before its indentation
has vanished, since a dent remains or follows late, which lowers the speed of separation and raises
that of the next approach. They hold for restitutions from 0.6 on, and all contacts of a record have
them in common: as deviations they are divided by the root of 3. Last the deviation of the former
without any loss.
"""

_MOST, _GAIN = 1.2, 0.03
"""Restitution above which a record is rejected, and the deviation of impulses from times
of flight above which a warning is given.
"""


def impacts_in_force(
    time: Floats,
    force: Floats,
    *,
    mass: float,
    gravity: float,
    first_speed: float,
    lines: Sequence[int] | None = None,
    flights: Flights | None = None,
) -> Observations:
    r"""Return the impacts of a sphere whose contact force was recorded.

    The change of speed follows from the impulse, :math:`m (v^+ + v^-) = \int F\,dt - m g T`, or,
    more accurately, from the time to
    the next impact: :math:`v^+ = g\,\Delta t / 2` in a vacuum. Where both are known, their ratio
    calibrates the scale of the force, by
    which the last impulse is corrected. The baseline of the force may drift: it is estimated beside
    each impact, and the uncertainty of its contribution to the impulse is part of the standard
    deviations. An impact that is cut off at the end of the record only ends the flight before it.

    Parameters
    ----------
    time, force : array
        Time [s] and contact force [N], positive in compression.
    mass, gravity : float
        Effective mass of the pair [kg], that of the sphere if the plate is held, and acceleration
        of gravity [m/s^2], >= 0.
    first_speed : float
        Approach speed of the first impact [m/s].
    lines : sequence of int, optional
        The line of each sample in the file, for messages.
    flights : Flights, optional
        Model of the flights; a vacuum by default.

    Returns
    -------
    Observations
        Separation speeds and largest forces, with standard deviations from noise, drift and
        sampling.

    Raises
    ------
    InputError
        If the record does not show an impact, or does not resolve it.

    Examples
    --------
    >>> t = np.arange(0.0, 2e-3, 1e-5)
    >>> pulse = np.where((t > 5e-4) & (t < 1e-3), 100.0 * np.sin(np.pi * (t - 5e-4) / 5e-4), 0.0)
    >>> found = impacts_in_force(t, pulse, mass=0.01, gravity=0.0, first_speed=2.0)
    >>> (
    ...     found.wanted["separation_speed"].round(2).tolist(),
    ...     found.wanted["max_force"].round(0).tolist(),
    ... )
    ([1.18], [100.0])
    """
    at, step, seen = sample_label(lines), float(np.median(np.diff(time))), find_pulses(time, force)
    runs, cut = list(seen.runs), []
    # cut off by the end of the record; its start still ends a flight
    if len(runs) > 1 and runs[-1][1] == len(force):
        cut = [runs.pop()]
    for begin, end in runs:
        if begin == 0 or end == len(force):
            raise InputError(
                f"the record {'begins' if begin == 0 else 'ends'} in the middle of an "
                f"impact, at {at(begin)}"
            )
        if end - begin < _FEWEST:
            few = f"{end - begin} sample{'s' if end - begin > 1 else ''}"
            raise InputError(
                f"the impact at {at(begin)} has only {few}, but {_FEWEST} are needed; sample faster"
            )
    pulses = evaluate_pulses(time, seen, runs)
    begins = np.array([pulse.begin for pulse in pulses])
    unsure = np.array([pulse.begin_deviation for pulse in pulses])
    if cut:  # its force stands out of the noise as late as that of the impact before
        late = float(time[runs[-1][0]]) - pulses[-1].begin
        begins, unsure = (
            np.append(begins, time[cut[0][0]] - late),
            np.append(unsure, np.hypot(step, 0.5 * late)),
        )
    clipped = [at(begin) for pulse, (begin, _) in zip(pulses, runs, strict=True) if pulse.clipped]
    # the impulse of the last one is not known; its start still ends a flight
    if clipped and len(pulses) == len(begins):
        del pulses[-1], runs[-1]
    if clipped and not pulses:
        up_to = (
            ", or up to the next impact, from whose time the rebound follows"
            if gravity > 0.0
            else ""
        )
        raise InputError(
            f"the force is clipped at {clipped[0]}: its largest value is held, so that "
            "neither it nor the impulse is known; "
            f"record again with a larger range{up_to}"
        )
    gaps = (
        begins[1:] - np.array([pulse.begin + pulse.duration for pulse in pulses])[: len(begins) - 1]
    )
    if gravity == 0.0 and len(gaps):
        raise InputError(
            "without gravity the sphere does not come back, and the record shows "
            f"{len(begins)} impacts"
        )
    flown = (flights or VacuumFlights(gravity)).end_speeds(gaps)
    number = len(pulses)
    speeds = np.append(first_speed, flown.end)[:number]
    lost = 1.0 - flown.start / speeds[: len(flown.start)]
    by_law = np.hypot(RISE / np.sqrt(3.0) * lost, _LEAST)
    # of one edge a part of a step, whose place on the flank differs from contact to contact
    sampling = step * float(by_law.max(initial=_LEAST))
    ends = np.hypot(sampling, [pulse.end_deviation for pulse in pulses])
    edges = Edges(ends, np.hypot(sampling, unsure))
    separation, deviation, doubts = _separations(pulses, flown, edges, mass, gravity, first_speed)
    for row, (before, after) in enumerate(zip(speeds, separation, strict=True)):
        if not 0.0 < after <= _MOST * before:
            raise InputError(
                f"the impact at {at(runs[row][0])}: from {before:.4g} m/s the sphere would "
                f"leave at {after:.4g} m/s; "
                f"{_wrong(row, number, timed=row < len(flown.start))}"
            )
    if clipped:
        doubts += (
            f"the force is clipped in {len(clipped)} "
            f"impact{'s' if len(clipped) > 1 else ''}, first at {clipped[0]}: the largest forces "
            "and the impulses are not known, and rebounds follow from the times of flight "
            "alone; record again with a larger range",
        )
    elif (fewest := min(pulses, key=lambda pulse: pulse.length)).length < _COARSE:
        doubts += (
            f"a contact of {1e3 * fewest.duration:.2g} ms has {fewest.length} samples: the "
            "largest force between them is known to "
            f"{100.0 * fewest.largest_deviation / fewest.largest:.1g} % (one standard "
            "deviation); sample faster",
        )
    wanted = {
        "separation_speed": separation,
        "max_force": np.array([pulse.largest for pulse in pulses]),
    }
    own = own_noise(
        {
            "separation_speed": deviation,
            "max_force": np.array([pulse.largest_deviation for pulse in pulses]),
        }
    )
    per_contact = flown.start_slope * [pulse.duration for pulse in pulses[: len(flown.start)]]
    longer, release = np.zeros(number), np.zeros(number)
    longer[: len(lost)] = by_law * per_contact
    release[: len(lost)] = RELEASE / np.sqrt(3.0) * lost * per_contact
    by_rise = with_common_source(own, {"separation_speed": longer})
    noises = with_common_source(by_rise, {"separation_speed": -release})
    if clipped:
        del wanted["max_force"], noises["max_force"]
    back = np.zeros(number)
    # an error of the duration of a flight changes both of its speeds
    back[:-1] = (flown.end_slope / flown.start_slope)[: number - 1]
    after_release = with_common_source(by_rise, {"separation_speed": release})
    before_noise = of_the_impact_before(scaled(back, after_release["separation_speed"]))
    labels = tuple(f"impact {row + 1}, {at(begin)}" for row, (begin, _) in enumerate(runs))
    record = Record("force", tuple(pulse.samples for pulse in pulses))
    found = Observations(
        speeds,
        wanted,
        before_noise,
        noises,
        True,
        labels,
        noise_from="the noise of the record",
        doubts=doubts,
    )
    return replace(found, flights=flights, record=record)


def _wrong(row: int, number: int, *, timed: bool) -> str:
    """Return what may be wrong with the speeds of an impact, by what they follow from;
    `timed`: that after it from a time of flight.
    """
    if timed:
        given = "the times, the drop or gravity" if row == 0 else "the times"
        return f"{given} can't be right, an impact is missing or is none, or the plate moves"
    return (
        f"the force, the mass{', the drop or gravity' if number > 1 else ' or the drop'} can't "
        "be right"
    )


class Edges(NamedTuple):
    """Standard deviations of the ends of contacts, and of the begins, of which there may
    be one more [s].
    """

    ends: Floats
    begins: Floats


def _separations(
    pulses: list[Pulse],
    flown: EndSpeeds,
    edges: Edges,
    mass: float,
    gravity: float,
    first_speed: float,
) -> tuple[Floats, Floats, tuple[str, ...]]:
    """Return separation speeds [m/s], their standard deviations by noise, and warnings.

    A speed before another impact follows from the time of flight, the last one from its impulse.
    """
    number = len(pulses)
    # equal to the number of impacts if the record ends within a further one
    timed = len(flown.start)
    before, pairs = (
        np.append(first_speed, flown.end)[:number],
        list(zip(pulses, flown.start, strict=False)),
    )
    expected = np.array(
        [
            mass * (came + left + gravity * pulse.duration)
            for (pulse, left), came in zip(pairs, before, strict=False)
        ]
    )
    ends, begins = edges
    doubts, scale, unsure = [], 1.0, 0.0
    if timed:
        scale, unsure = _scale(
            [
                (come, pulse)
                for come, (pulse, _) in zip(expected, pairs, strict=True)
                if not pulse.clipped
            ]
        )
        if abs(scale - 1.0) > _GAIN:
            words = (
                f"the impulses are {100.0 * (1.0 / scale - 1.0):+.1f} % off from those "
                "computed from the times of flight"
            )
            more = "" if timed == number else " (the rebound of the last impact is corrected)"
            causes = (
                "the scale of the force, the mass, the drop, gravity or the "
                "drag in flight can't be right"
            )
            doubts.append(f"{words}: {causes}{more}")
    else:
        per_cent = 0.01 * pulses[-1].impulse / mass
        doubts.append(
            "one impact alone: its rebound follows from the impulse, and 1 % in the scale "
            f"of the force changes its separation speed by {per_cent:.2g} m/s"
        )
    # the start of a flight and its end are both uncertain; in a vacuum the derivative of the
    # initial speed is g / 2
    deviation = flown.start_slope * np.hypot(ends[:timed], begins[1 : timed + 1])
    if timed == number:
        return flown.start, deviation, tuple(doubts)
    last = pulses[-1]
    after = scale * last.impulse / mass - gravity * last.duration - before[-1]
    of_last = float(np.hypot(last.impulse_deviation, unsure * last.impulse)) / mass
    if last.excess_scatter:
        part = 100.0 * last.excess_scatter / last.largest
        doubts.append(
            f"the force at rest wanders by {part:.2g} % of the largest force beside the "
            "last impact, more than by its noise; "
            f"its impulse contributes {last.impulse_deviation / mass:.2g} m/s to the "
            "standard deviation of its separation speed"
        )
    return (
        np.append(flown.start, after),
        np.append(deviation, np.hypot(of_last, gravity * ends[-1])),
        tuple(doubts),
    )


def _scale(pairs: list[tuple[float, Pulse]]) -> tuple[float, float]:
    """Return the factor between impulses and those expected from the times of flight, and its
    standard deviation; 1 without any.

    It is the mean, weighted by what is known of each impulse. Where they differ by more than that,
    their scatter is its deviation.
    """
    if not pairs:
        return 1.0, 0.0
    scales = np.array([expected / pulse.impulse for expected, pulse in pairs])
    deviations = scales * np.array([pulse.impulse_deviation / pulse.impulse for _, pulse in pairs])
    weights = deviations**-2.0
    scale = float(weights @ scales / weights.sum())
    freedom = len(scales) - 1
    scatter = float(np.sqrt(weights @ (scales - scale) ** 2 / freedom)) if freedom else 1.0
    wider = scatter if freedom and misfits(scatter, freedom) else 1.0
    return scale, wider / float(np.sqrt(weights.sum()))
