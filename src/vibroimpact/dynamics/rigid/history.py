"""Columns of the history of one drop of rigid bodies."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.ride import RideSegment
from vibroimpact.dynamics.rigid.segments import FlightSegment, RestSegment
from vibroimpact.dynamics.rigid.timeline import Timeline
from vibroimpact.dynamics.statement.problem import Problem


def rigid_history(
    problem: Problem, segments: Timeline, number: int, times: Floats, written_off: float
) -> dict[str, Floats]:
    """Return the columns of the motion along the normal of one segment, by their names.

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
    segment = segments[number]
    mass = float(problem.sphere.mass)
    gravity = float(problem.net_gravity)
    gap, velocity, force, stored, dissipated, plastic = segment.at(times)
    dissipated_before, plastic_before, drive_before = segments.spent[number]
    zeros = np.zeros_like(times)
    resting = isinstance(segment, RestSegment)
    if isinstance(segment, FlightSegment):
        acceleration = segment.flight.acceleration(segment.flight.start + times)
    elif resting:
        acceleration = zeros
    else:
        acceleration = force / mass - gravity
    # a hard sphere that rides does not indent the plate, which moves under it
    indents = not isinstance(segment, FlightSegment | RideSegment)
    indentation = -gap if indents else zeros
    lost_at_rest = written_off if resting else 0.0
    columns = {
        "time_s": segment.start + times,
        "position_m": float(problem.sphere.contact_offset) + gap,
        "velocity_m_s": velocity,
        "acceleration_m_s2": acceleration,
        "force_N": force,
        "indentation_m": indentation,
        "kinetic_J": 0.5 * mass * velocity**2,
        "potential_J": mass * gravity * gap,
        "contact_elastic_J": stored,
        "contact_dissipated_J": dissipated_before + dissipated,
        "plastic_work_J": plastic_before + plastic,
        "written_off_at_rest_J": np.full_like(times, lost_at_rest),
    }
    if problem.motion is not None:
        surface, surface_velocity, _ = problem.surface(columns["time_s"])
        work = zeros
        if isinstance(segment, RideSegment):
            work = segment.drive_work(times)
        columns["surface_m"] = surface
        columns["surface_velocity_m_s"] = surface_velocity
        columns["drive_J"] = drive_before - work
    return columns
