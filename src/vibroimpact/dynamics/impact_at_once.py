"""Impacts of laws without a force: a velocity changes at an instant, or a sphere comes to ride."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import InstantaneousLaw
from vibroimpact.dynamics.bounce import Bounce
from vibroimpact.dynamics.outcome import Outcome
from vibroimpact.dynamics.run_state import RunState


def collide_at_once(
    run: RunState,
    bounce: Bounce,
    law: InstantaneousLaw,
    touch: Floats,
    speed: Floats,
    row: dict[str, Floats],
) -> tuple[Bounce, Floats]:
    """Let the drops of a bounce rebound at their touches, and write their row.

    Return the bounce and the energy lost [J].

    Parameters
    ----------
    run : RunState
        The run of the drops.
    bounce : Bounce
        Their flights.
    law : InstantaneousLaw
        Of these impacts.
    touch, speed : array, shape (b,)
        Times [s] and approach speeds [m/s] of `bounce.contact_drops`.
    row : dict of str to array
        The row of the impact table.
    """
    drops = bounce.contact_drops
    surface, surface_velocity, _ = run.problem.surface(touch)
    separation = law.separation_speed(speed, run.mass[drops])
    run.time[drops] = touch
    run.gap[drops] = surface
    run.velocity[drops] = surface_velocity + separation
    row["separation_speed_m_s"][drops] = separation
    for name in ("duration_s", "max_indentation_m", "plastic_work_J"):
        row[name][drops] = 0.0
    lost = 0.5 * run.mass[drops] * (speed**2 - separation**2)
    work_of_friction = np.zeros(len(drops))  # of that of the plate, as it moves along itself
    if run.oblique is not None:
        contacts, work_of_friction = run.oblique.collide_at_once(
            drops, touch, run.mass[drops] * (speed + separation), row
        )
        bounce = replace(bounce, oblique_contacts=contacts)
    if not run.problem.shaken:
        return bounce, lost
    return _ride(run, bounce, touch, speed, (lost, work_of_friction), row)


def _ride(
    run: RunState,
    bounce: Bounce,
    touch: Floats,
    speed: Floats,
    energies: tuple[Floats, Floats],
    row: dict[str, Floats],
) -> tuple[Bounce, Floats]:
    """Let drops that hardly rebound from a shaken plate ride on it.

    Return the bounce with the rides, and the energy lost [J]. `energies`: lost in the impact
    without what is lost as they come to ride, and the work of friction by the plate [J]. A sphere
    that moves along the plate is not followed any further where it rides.
    """
    from vibroimpact.dynamics.shaken.shaken_bodies import ShakenBodies

    assert isinstance(run.bodies, ShakenBodies)
    drops = bounce.contact_drops
    lost, work_of_friction = energies
    separation = row["separation_speed_m_s"][drops]
    ride = run.bodies.ride(drops, touch, separation, run.rest_speed[drops])
    if run.oblique is not None:
        rides = ride.end > touch
        run.stop(drops[rides], Outcome.RIDING, touch[rides])
        ride = replace(ride, end=touch)
    rides = ride.end > touch
    end = np.where(np.isfinite(ride.end), ride.end, touch)
    # the plate works on the impulse of the impact, and on the sphere that it carries
    impulse = ride.mass * (speed + np.where(rides, 0.0, separation))
    _, surface_velocity, _ = ride.surface(touch)
    work = work_of_friction + impulse * surface_velocity + ride.energy(end) - ride.energy(touch)
    run.bodies.work[drops] += work
    row["plate_work_J"][drops] = work
    carried = drops[rides]
    run.time[carried] = end[rides]
    run.gap[carried], run.velocity[carried], _ = ride.surface(end[rides])
    lost_to_ride = np.where(rides, 0.5 * ride.mass * separation**2, 0.0)
    return replace(bounce, ride=ride), lost + lost_to_ride
