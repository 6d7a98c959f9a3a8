"""Impacts in a record in which a ball is heard to bounce."""

from __future__ import annotations

import numpy as np
from scipy.sparse import diags_array

from vibroimpact.calibration.observed.flights import Flights, VacuumFlights
from vibroimpact.calibration.observed.noise import of_the_impact_before, scaled
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.signals.bounces.find import Bounces

_UNLIKE = 1.25
"""Ratio of the restitution of the first impact to that of the second up to which it is that of the
drop.
"""


def impacts_in_bounces(
    bounces: Bounces, *, gravity: float, first_speed: float, flights: Flights | None = None
) -> Observations:
    r"""Return the impacts of a bouncing sphere from the times of its touches.

    Both speeds of a flight follow from its duration, :math:`g T / 2` in a vacuum. The first impact
    that is heard is that of the drop if its speed of approach gives it a restitution like that of
    the second; otherwise it only begins the first flight.

    Parameters
    ----------
    bounces : Bounces
        The touches.
    gravity : float
        Acceleration of gravity [m/s^2], > 0.
    first_speed : float
        Approach speed of the first impact of the drop [m/s].
    flights : Flights, optional
        Model of the flights; a vacuum by default.

    Returns
    -------
    Observations
        Separation speeds, with standard deviations from those of the times.

    Examples
    --------
    >>> from vibroimpact.signals.record import Record
    >>> microphone = Record("microphone", np.zeros(48000), 48e3, "Pa")
    >>> time = np.array([0.0, 0.4, 0.72, 0.976])
    >>> heard = Bounces(microphone, time, np.full(4, 1e-5), np.ones(4), np.zeros(0), ())
    >>> found = impacts_in_bounces(heard, gravity=10.0, first_speed=2.5)
    >>> found.speeds.round(3).tolist(), found.wanted["separation_speed"].round(3).tolist()
    ([2.5, 2.0, 1.6], [2.0, 1.6, 1.28])
    """
    flight_speeds = (flights or VacuumFlights(gravity)).end_speeds(bounces.flight)
    flight_count = len(bounces.flight)
    # the noise of the durations of the flights, by each touch
    readings = [-bounces.deviation[:-1], bounces.deviation[1:]]
    durations = diags_array(readings, offsets=[0, 1], shape=(flight_count, flight_count + 1))
    separation_noise = scaled(flight_speeds.start_slope, durations)
    approach_noise = of_the_impact_before(scaled(flight_speeds.end_slope, durations))
    speeds = np.append(first_speed, flight_speeds.end[:-1])
    labels = tuple(
        f"impact {number}, {time:.6g} s" for number, time in enumerate(bounces.time[:-1], 1)
    )
    restitution = flight_speeds.start / speeds
    # else the first impact that is heard is not the first one of the drop
    first_is_heard = bool(abs(np.log(restitution[0] / restitution[1])) <= np.log(_UNLIKE))
    first = 0 if first_is_heard else 1
    kept = slice(first, None)
    note = f"{flight_count + 1} touches are detected"
    sounds = len(bounces.others)
    if sounds:
        are = "sounds are" if sounds > 1 else "sound is"
        note += f"; {sounds} other {are} no bounce"
    if not first_is_heard:
        note += (
            f"; the first is not taken for that of the drop, at {first_speed:.4g} m/s, as its "
            f"restitution would be {restitution[0]:.3g} and "
            f"that of the next is {restitution[1]:.3g}: it only begins the first flight"
        )
    return Observations(
        speeds[kept],
        {"separation_speed": flight_speeds.start[kept]},
        approach_noise[kept],
        {"separation_speed": separation_noise[kept]},
        deviations_known=True,
        labels=labels[kept],
        of_the_drop=first_is_heard,
        noise_from="the times of the touches",
        doubts=bounces.doubts,
        flights=flights,
        notes=(f"{note}.",),
    )
