"""Impacts in a measured force record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.fitting import misfits
from vibroimpact.calibration.observed.flights import EndSpeeds, Flights, VacuumFlights
from vibroimpact.calibration.observed.noise import (
    Noise,
    of_the_impact_before,
    own_noise,
    scaled,
    with_common_source,
)
from vibroimpact.calibration.observed.observations import Observations, Record
from vibroimpact.calibration.records.force_pulses import Pulse, evaluate_pulses, find_pulses
from vibroimpact.calibration.records.record_noise import sample_label
from vibroimpact.errors import InputError

_FEWEST = 5
"""Minimum number of samples of an impact."""

_COARSE = 10
"""Number of samples of a contact below which the largest force is doubted."""

RISE = 0.24
RELEASE = 0.8
_LEAST = 0.01
"""Bounds of what the contact law, which is unknown, may change, as fractions of a contact and of
the part of the speed that is lost.

RISE is of the time between begin and end, which are extrapolated as if the force rose and fell as
Hertz's. RELEASE is of the time by which a contact ends before its indentation has vanished, since a
dent remains or follows late, which lowers the speed of separation and raises that of the next
approach. They hold for restitutions from 0.6 on, and all contacts of a record have them in common:
as deviations they are divided by the root of 3. _LEAST is the deviation of the former without any
loss.
"""

_MOST = 1.2
"""Restitution above which a record is rejected."""

_GAIN = 0.03
"""Deviation of impulses from times of flight above which a warning is given."""

_OTHER_DROP = 0.1
"""Deviation of the first approach speed by its impulse from that of the drop, as a fraction of it,
above which the record is that of another drop.
"""

_SURE = 5.0
"""Standard deviations by which it has to deviate as well."""


class ImpactTimes(NamedTuple):
    """Begins of the impacts and their standard deviations by noise [s].

    There is one more than pulses if the last impact only ends a flight.
    """

    begins: Floats
    deviations: Floats


class Edges(NamedTuple):
    """Standard deviations of the ends of contacts, and of the begins [s].

    There may be one begin more.
    """

    ends: Floats
    begins: Floats


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
    more accurately, from the time to the next impact: :math:`v^+ = g\,\Delta t / 2` in a vacuum.
    Where both are known, their ratio calibrates the scale of the force, by which the last impulse
    is corrected. The baseline of the force may drift: it is estimated beside each impact, and the
    uncertainty of its contribution to the impulse is part of the standard deviations. An impact
    that is cut off at the end of the record only ends the flight before it.

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
    >>> impacts = impacts_in_force(t, pulse, mass=0.01, gravity=0.0, first_speed=2.0)
    >>> (
    ...     impacts.wanted["separation_speed"].round(2).tolist(),
    ...     impacts.wanted["max_force"].round(0).tolist(),
    ... )
    ([1.18], [100.0])
    """
    label_of = sample_label(lines)
    step = float(np.median(np.diff(time)))
    detected = find_pulses(time, force)
    runs = list(detected.runs)
    cut_off = None
    if len(runs) > 1 and runs[-1][1] == len(force):
        # cut off by the end of the record; its start still ends a flight
        cut_off = runs.pop()
    _check_runs(runs, len(force), label_of)
    pulses = evaluate_pulses(time, detected, runs)
    impact_times = _impact_times(time, pulses, runs, cut_off, step)
    clipped = [
        label_of(begin) for pulse, (begin, _) in zip(pulses, runs, strict=True) if pulse.clipped
    ]
    if clipped and cut_off is None:
        # the impulse of the last one is not known; its start still ends a flight
        del pulses[-1], runs[-1]
    if clipped and not pulses:
        raise _all_clipped(clipped[0], gravity)
    flight_speeds = _flight_speeds(impact_times.begins, pulses, gravity, flights)
    timed = len(flight_speeds.start)
    speeds = np.append(first_speed, flight_speeds.end)[: len(pulses)]
    lost = 1.0 - flight_speeds.start / speeds[:timed]
    by_law = np.hypot(RISE / np.sqrt(3.0) * lost, _LEAST)
    # of one edge a part of a step, whose place on the flank differs from contact to contact
    sampling = step * float(by_law.max(initial=_LEAST))
    edges = Edges(
        ends=np.hypot(sampling, [pulse.end_deviation for pulse in pulses]),
        begins=np.hypot(sampling, impact_times.deviations),
    )
    # a first impact of another drop only begins the first flight
    other_drop = _of_another_drop(pulses, flight_speeds, mass, gravity, first_speed)
    first_kept = 1 if other_drop else 0
    separation, deviation, doubts = _separations(
        pulses, flight_speeds, edges, mass, gravity, first_speed, scaled_from=first_kept
    )
    labels = [label_of(begin) for begin, _ in runs]
    _check_speeds(speeds, separation, labels, timed)
    doubts += _sampling_doubts(pulses, clipped)
    if other_drop:
        doubts = (other_drop, *doubts)
    per_contact = flight_speeds.start_slope * [pulse.duration for pulse in pulses[:timed]]
    speed_noise, noise = _noise(pulses, flight_speeds, deviation, by_law, lost, per_contact)
    wanted = {"separation_speed": separation}
    if clipped:
        del noise["max_force"]
    else:
        wanted["max_force"] = np.array([pulse.largest for pulse in pulses])
    kept = slice(first_kept, None)
    numbered = [f"impact {number}, {label}" for number, label in enumerate(labels, 1)]
    return Observations(
        speeds[kept],
        {name: values[kept] for name, values in wanted.items()},
        speed_noise[kept],
        {name: sources[kept] for name, sources in noise.items()},
        deviations_known=True,
        labels=tuple(numbered[kept]),
        of_the_drop=not other_drop,
        noise_from="the noise of the record",
        doubts=doubts,
        flights=flights,
        record=Record("force", tuple(pulse.samples for pulse in pulses[kept])),
    )


def _all_clipped(label: str, gravity: float) -> InputError:
    """Return the error that no impact of a record has a known force or time of flight."""
    remedy = "record again with a larger range"
    if gravity > 0.0:
        remedy += ", or up to the next impact, from whose time the rebound follows"
    return InputError(
        f"the force is clipped at {label}: its largest value is held, so that "
        f"neither it nor the impulse is known; {remedy}"
    )


def _check_runs(
    runs: Sequence[tuple[int, int]], sample_count: int, label_of: Callable[[int], str]
) -> None:
    """Check that impacts, as index ranges, lie within the record and have enough samples."""
    for begin, end in runs:
        if begin == 0 or end == sample_count:
            verb = "begins" if begin == 0 else "ends"
            raise InputError(f"the record {verb} in the middle of an impact, at {label_of(begin)}")
        count = end - begin
        if count < _FEWEST:
            few = f"{count} samples" if count > 1 else "1 sample"
            raise InputError(
                f"the impact at {label_of(begin)} has only {few}, but {_FEWEST} are needed; "
                "sample faster"
            )


def _impact_times(
    time: Floats,
    pulses: Sequence[Pulse],
    runs: Sequence[tuple[int, int]],
    cut_off: tuple[int, int] | None,
    step: float,
) -> ImpactTimes:
    """Return the begins of the pulses, and of an impact that is cut off by the end of the record.

    `runs` and `cut_off` are the index ranges; `step` is the time between samples [s].
    """
    begins = np.array([pulse.begin for pulse in pulses])
    deviations = np.array([pulse.begin_deviation for pulse in pulses])
    if cut_off is not None:
        # its force stands out of the noise as late as that of the impact before
        delay = float(time[runs[-1][0]]) - pulses[-1].begin
        begins = np.append(begins, time[cut_off[0]] - delay)
        deviations = np.append(deviations, np.hypot(step, 0.5 * delay))
    return ImpactTimes(begins, deviations)


def _flight_speeds(
    begins: Floats, pulses: Sequence[Pulse], gravity: float, flights: Flights | None
) -> EndSpeeds:
    """Return the speeds of the flights between impacts by their durations."""
    ends = np.array([pulse.begin + pulse.duration for pulse in pulses])
    durations = begins[1:] - ends[: len(begins) - 1]
    if gravity == 0.0 and len(durations):
        raise InputError(
            "without gravity the sphere does not come back, and the record shows "
            f"{len(begins)} impacts"
        )
    return (flights or VacuumFlights(gravity)).end_speeds(durations)


def _check_speeds(speeds: Floats, separation: Floats, labels: Sequence[str], timed: int) -> None:
    """Check that no restitution is negative or too large.

    The first `timed` separation speeds follow from times of flight.
    """
    for impact, label in enumerate(labels):
        if not 0.0 < separation[impact] <= _MOST * speeds[impact]:
            raise InputError(
                f"the impact at {label}: from {speeds[impact]:.4g} m/s the sphere would "
                f"leave at {separation[impact]:.4g} m/s; "
                f"{_wrong(impact, len(labels), timed=impact < timed)}"
            )


def _wrong(impact: int, impact_count: int, *, timed: bool) -> str:
    """Return what may be wrong with the speeds of an impact.

    `timed`: whether the speed after it follows from a time of flight, not from the impulse.
    """
    if timed:
        # the speed before the first impact is that of the drop
        inputs = "the times"
        if impact == 0:
            inputs = "the times, the drop or gravity"
        return f"{inputs} can't be right, an impact is missing or is none, or the plate moves"
    inputs = "the force, the mass or the drop"
    if impact_count > 1:
        inputs = "the force, the mass, the drop or gravity"
    return f"{inputs} can't be right"


def _sampling_doubts(pulses: Sequence[Pulse], clipped: Sequence[str]) -> tuple[str, ...]:
    """Return a warning if impacts are clipped, whose labels are `clipped`, or coarsely sampled."""
    if clipped:
        impacts = "impacts" if len(clipped) > 1 else "impact"
        return (
            f"the force is clipped in {len(clipped)} "
            f"{impacts}, first at {clipped[0]}: the largest forces "
            "and the impulses are not known, and rebounds follow from the times of flight "
            "alone; record again with a larger range",
        )
    coarsest = min(pulses, key=lambda pulse: pulse.length)
    if coarsest.length >= _COARSE:
        return ()
    percent = 100.0 * coarsest.largest_deviation / coarsest.largest
    return (
        f"a contact of {1e3 * coarsest.duration:.2g} ms has {coarsest.length} samples: the "
        f"largest force between them is known to {percent:.1g} % (one standard "
        "deviation); sample faster",
    )


def _noise(
    pulses: Sequence[Pulse],
    flight_speeds: EndSpeeds,
    deviation: Floats,
    by_law: Floats,
    lost: Floats,
    per_contact: Floats,
) -> tuple[Noise, dict[str, Noise]]:
    """Return the noise of the approach speeds, and of separation speeds and largest forces.

    Parameters
    ----------
    pulses : sequence of Pulse, length n
        The impacts.
    flight_speeds : EndSpeeds
        Those of the flights that end with an impact.
    deviation : array, shape (n,)
        Standard deviations of the separation speeds by noise [m/s].
    by_law, lost : array
        Deviation of the duration of each contact before such a flight by its law, as a fraction of
        it; and the part of the speed that is lost.
    per_contact : array
        Change of its separation speed by a time of flight that is off by a contact [m/s].
    """
    impact_count = len(pulses)
    timed = len(flight_speeds.start)
    duration_effect = np.zeros(impact_count)
    release_effect = np.zeros(impact_count)
    duration_effect[:timed] = by_law * per_contact
    release_effect[:timed] = RELEASE / np.sqrt(3.0) * lost * per_contact
    independent = own_noise(
        {
            "separation_speed": deviation,
            "max_force": np.array([pulse.largest_deviation for pulse in pulses]),
        }
    )
    by_duration = with_common_source(independent, {"separation_speed": duration_effect})
    noise = with_common_source(by_duration, {"separation_speed": -release_effect})
    # an error of the duration of a flight changes both of its speeds, but an early release lowers
    # the first and raises the second
    at_return = with_common_source(by_duration, {"separation_speed": release_effect})
    end_per_start = np.zeros(impact_count)
    end_per_start[:-1] = (flight_speeds.end_slope / flight_speeds.start_slope)[: impact_count - 1]
    speed_noise = of_the_impact_before(scaled(end_per_start, at_return["separation_speed"]))
    return speed_noise, noise


def _separations(
    pulses: list[Pulse],
    flight_speeds: EndSpeeds,
    edges: Edges,
    mass: float,
    gravity: float,
    first_speed: float,
    scaled_from: int,
) -> tuple[Floats, Floats, tuple[str, ...]]:
    """Return separation speeds [m/s], their standard deviations by noise, and warnings.

    A speed before another impact follows from the time of flight, the last one from its impulse.
    The impulses from impact `scaled_from` on tell the scale of the force.
    """
    impact_count = len(pulses)
    # equal to the number of impacts if the record ends within a further one
    timed = len(flight_speeds.start)
    approach = np.append(first_speed, flight_speeds.end)[:impact_count]
    doubts = []
    scale = 1.0
    scale_deviation = 0.0
    if timed:
        scale, scale_deviation = _force_scale(
            pulses[scaled_from:timed],
            flight_speeds.start[scaled_from:],
            approach[scaled_from:],
            mass,
            gravity,
        )
        if abs(scale - 1.0) > _GAIN:
            corrected = ""
            if timed < impact_count:
                corrected = " (the rebound of the last impact is corrected)"
            doubts.append(
                f"the impulses are {100.0 * (1.0 / scale - 1.0):+.1f} % off from those "
                "computed from the times of flight: the scale of the force, the mass, the drop, "
                f"gravity or the drag in flight can't be right{corrected}"
            )
    else:
        per_cent = 0.01 * pulses[-1].impulse / mass
        doubts.append(
            "one impact alone: its rebound follows from the impulse, and 1 % in the scale "
            f"of the force changes its separation speed by {per_cent:.2g} m/s"
        )
    # the start of a flight and its end are both uncertain; in a vacuum the derivative of the
    # initial speed is g / 2
    deviation = flight_speeds.start_slope * np.hypot(
        edges.ends[:timed], edges.begins[1 : timed + 1]
    )
    if timed == impact_count:
        return flight_speeds.start, deviation, tuple(doubts)
    # m (v+ + v-) = J - m g T
    last = pulses[-1]
    last_separation = scale * last.impulse / mass - gravity * last.duration - approach[-1]
    by_impulse = float(np.hypot(last.impulse_deviation, scale_deviation * last.impulse)) / mass
    last_deviation = np.hypot(by_impulse, gravity * edges.ends[-1])
    if last.excess_scatter:
        percent = 100.0 * last.excess_scatter / last.largest
        doubts.append(
            f"the force at rest wanders by {percent:.2g} % of the largest force beside the "
            "last impact, more than by its noise; "
            f"its impulse contributes {last.impulse_deviation / mass:.2g} m/s to the "
            "standard deviation of its separation speed"
        )
    return (
        np.append(flight_speeds.start, last_separation),
        np.append(deviation, last_deviation),
        tuple(doubts),
    )


def _of_another_drop(
    pulses: Sequence[Pulse],
    flight_speeds: EndSpeeds,
    mass: float,
    gravity: float,
    first_speed: float,
) -> str:
    """Return a warning if the first impact is not that of the drop, by its impulse, else nothing.

    The impacts between two flights tell the scale of the force.
    """
    timed = len(flight_speeds.start)
    first, later = pulses[0], pulses[1:timed]
    if first.clipped or not later or all(pulse.clipped for pulse in later):
        return ""
    scale, deviation = _force_scale(
        later, flight_speeds.start[1:], flight_speeds.end[: timed - 1], mass, gravity
    )
    # J = m (v- + v+ + g T), with v+ by the time of flight
    change = scale * first.impulse / mass
    speed = change - flight_speeds.start[0] - gravity * first.duration
    by_noise = change * np.hypot(deviation / scale, first.impulse_deviation / first.impulse)
    if abs(speed - first_speed) <= max(_OTHER_DROP * first_speed, _SURE * by_noise):
        return ""
    return (
        f"the impulse of the first impact is that of an approach speed of {speed:.3g} m/s, and "
        f"the drop of the case reaches {first_speed:.3g} m/s: the record is taken to be that of "
        "another drop, and the first impact only begins the first flight; look at the height or "
        "speed of the drop"
    )


def _force_scale(
    pulses: Sequence[Pulse], separation: Floats, approach: Floats, mass: float, gravity: float
) -> tuple[float, float]:
    """Return the ratio of impulses expected from times of flight to recorded ones, with deviation.

    They are 1 and 0 if all pulses are clipped. The ratio is the mean, weighted by what is known of
    each impulse. Where they differ by more than that, their scatter is its deviation.
    """
    scales = []
    relative_deviations = []
    for impact, pulse in enumerate(pulses):
        if not pulse.clipped:
            # J = m (v- + v+ + g T)
            expected = mass * (approach[impact] + separation[impact] + gravity * pulse.duration)
            scales.append(expected / pulse.impulse)
            relative_deviations.append(pulse.impulse_deviation / pulse.impulse)
    if not scales:
        return 1.0, 0.0
    deviations = np.array(scales) * np.array(relative_deviations)
    weights = deviations**-2.0
    scale = float(weights @ np.array(scales) / weights.sum())
    freedom = len(scales) - 1
    widening = 1.0
    if freedom:
        scatter = float(np.sqrt(weights @ (np.array(scales) - scale) ** 2 / freedom))
        if misfits(scatter, freedom):
            widening = scatter
    return scale, widening / float(np.sqrt(weights.sum()))
