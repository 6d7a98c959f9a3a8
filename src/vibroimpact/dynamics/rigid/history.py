"""Columns of the history of one drop of rigid bodies."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.rigid.segments import FlightSegment, RestSegment
from vibroimpact.dynamics.rigid.timeline import Timeline
from vibroimpact.dynamics.shaken.ride import RideSegment


def rigid_history(
    problem: Problem, segments: Timeline, number: int, times: Floats, written_off: float
) -> dict[str, Floats]:
    """Return the columns of the motion along the normal, by their names, at times since the start
    of one segment [s] (T,).

    Parameters
    ----------
    problem : Problem
        What was simulated.
    segments : Timeline
        The history.
    number : int
        Number of the segment.
    times : array, shape (T,)
        Times since its start [s].
    written_off : float
        Energy that was written off when the sphere came to rest [J].
    """
    segment, mass, gravity = (
        segments[number],
        float(problem.sphere.mass),
        float(problem.net_gravity),
    )
    gap, velocity, force, stored, lost, plastic = segment.at(times)
    lost_before, plastic_before, drive_before = segments.spent[number]
    resting = isinstance(segment, RestSegment)
    # a hard sphere that rides does not, and the plate moves under it
    indents = not isinstance(segment, FlightSegment | RideSegment)
    found = {
        "time_s": segment.start + times,
        "position_m": float(problem.sphere.contact_offset) + gap,
        "velocity_m_s": velocity,
        "acceleration_m_s2": np.zeros_like(times) if resting else force / mass - gravity,
        "force_N": force,
        "indentation_m": -gap if indents else np.zeros_like(times),
        "kinetic_J": 0.5 * mass * velocity**2,
        "potential_J": mass * gravity * gap,
        "contact_elastic_J": stored,
        "contact_dissipated_J": lost_before + lost,
        "plastic_work_J": plastic_before + plastic,
        "written_off_at_rest_J": np.full_like(times, written_off if resting else 0.0),
    }
    if problem.motion is not None:
        place, surface_velocity, _ = problem.surface(found["time_s"])
        drive = drive_before - (
            segment.drive_work(times) if isinstance(segment, RideSegment) else 0.0 * times
        )
        found |= {"surface_m": place, "surface_velocity_m_s": surface_velocity, "drive_J": drive}
    if isinstance(segment, FlightSegment):
        found["acceleration_m_s2"] = segment.flight.acceleration(segment.flight.start + times)
    return found
