"""Interpolation of the sphere's motion at given times, from a history that is dense in
contact and sparse in flight.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.motion.columns import OBLIQUE_HISTORY_COLUMNS


def motion_at(history: Mapping[str, Floats], times: Floats) -> dict[str, Floats]:
    """Return position, velocity, acceleration and force of the sphere, by column name; also its
    motion along the plate, if it has one.

    Positions and the velocity along the normal are cubic Hermite interpolants, the others are
    interpolated linearly between the points of the history; all are exact in free flight.

    Parameters
    ----------
    history : mapping of str to array
        As in a `Drop`; times do not decrease, and a time occurs twice where a quantity is
        discontinuous.
    times : array, shape (times,)
        Times within the history [s].

    Examples
    --------
    >>> fall = {
    ...     "time_s": [0, 1],
    ...     "position_m": [5, 0],
    ...     "velocity_m_s": [0, -10],
    ...     "acceleration_m_s2": [-10, -10],
    ...     "force_N": [0, 0],
    ... }
    >>> motion_at(
    ...     {name: np.array(values, dtype=float) for name, values in fall.items()}, np.array([0.5])
    ... )["position_m"].tolist()
    [3.75]
    """
    time = history["time_s"]
    before = np.clip(np.searchsorted(time, times, side="right") - 1, 0, len(time) - 2)
    step = time[before + 1] - time[before]
    # a step of zero length is met only at the end, where the value after the jump holds
    part = np.divide(times - time[before], step, out=np.ones_like(times), where=step > 0.0)
    position = history["position_m"]
    velocity = history["velocity_m_s"]
    acceleration = history["acceleration_m_s2"]
    force = history["force_N"]
    motion = {
        "position_m": _cubic(position, velocity, before, step, part),
        "velocity_m_s": _cubic(velocity, acceleration, before, step, part),
        "acceleration_m_s2": _linear(acceleration, before, part),
        "force_N": _linear(force, before, part),
    }
    if "position_x_m" in history:
        motion |= {
            name: _linear(history[name], before, part)
            for name, column in OBLIQUE_HISTORY_COLUMNS.items()
            if not column.in_ledger
        }
        for axis in "xy":
            along = history[f"position_{axis}_m"]
            speed = history[f"velocity_{axis}_m_s"]
            motion[f"position_{axis}_m"] = _cubic(along, speed, before, step, part)
    return motion


def _linear(values: Floats, before: Indices, part: Floats) -> Floats:
    return values[before] + part * (values[before + 1] - values[before])


def _cubic(values: Floats, slopes: Floats, before: Indices, step: Floats, part: Floats) -> Floats:
    """Return the cubic Hermite interpolant of values and slopes at both ends of each step."""
    rise = values[before + 1] - values[before]
    bend = step * slopes[before] - rise
    twist = step * slopes[before + 1] - rise
    return values[before] + part * (rise + (1.0 - part) * ((1.0 - part) * bend - part * twist))
