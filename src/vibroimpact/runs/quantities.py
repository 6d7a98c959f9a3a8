"""The quantities drawn over time, and what is marked in each."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.results.result import Result
from vibroimpact.runs.histories import Quantity
from vibroimpact.runs.tables import entry_text
from vibroimpact.runs.windows import gravity, touch_height

Points = tuple[Floats, Floats]


def _nothing(result: Result) -> Points:
    return np.empty(0), np.empty(0)


def tops_of_rebounds(result: Result) -> Points:
    """Return when [s] and how high [m] the sphere's centre is at the top of each rebound within the run."""
    impacts, down = result.impacts, gravity(result)
    if down <= 0.0:
        return _nothing(result)
    top = impacts["time_s"] + impacts["duration_s"] + impacts["separation_speed_m_s"] / down
    # the bounce in which a run ends, or comes to rest, is not followed up to its top
    reached = np.interp(top, result.history["time_s"], result.history["position_m"], right=np.nan)
    height = impacts["rebound_height_m"]
    seen = np.abs(reached - height) < 0.01 * (height - touch_height(result))
    return top[seen], impacts["rebound_height_m"][seen]


def _deepest(result: Result) -> Points:
    when = result.impacts["time_of_max_indentation_s"]
    if result.vibrates:  # then the sphere and what it presses on both move
        return when, np.interp(when, result.history["time_s"], result.history["position_m"])
    return when, touch_height(result) - result.impacts["max_indentation_m"]


def _force_peaks(result: Result) -> Points:
    found = np.isfinite(result.impacts["max_force_N"])
    return result.impacts["time_of_max_force_s"][found], result.impacts["max_force_N"][found]


def _acceleration_peaks(result: Result) -> Points:
    # a contact gentler than gravity has its largest magnitude in flight, not at its largest force
    found = result.impacts["max_acceleration_m_s2"] > gravity(result)
    return result.impacts["time_of_max_force_s"][found], result.impacts["max_acceleration_m_s2"][found]


def _touch_and_release(result: Result) -> Points:
    impacts = result.impacts
    times = np.concatenate([impacts["time_s"], impacts["time_s"] + impacts["duration_s"]])
    return times, np.concatenate([-impacts["approach_speed_m_s"], impacts["separation_speed_m_s"]])


def _indentation(result: Result, impact: int) -> str:
    return entry_text(result, impact, "max_indentation_m", "m")


def _force(result: Result, impact: int) -> str:
    return entry_text(result, impact, "max_force_N", "N")


def _restitution(result: Result, impact: int) -> str:
    return f"e = {entry_text(result, impact, 'restitution_achieved', '')}"


def _acceleration(result: Result, impact: int) -> str:
    return entry_text(result, impact, "max_acceleration_m_s2", "m/s2")


POSITION = Quantity(
    column="position_m",
    title="Height of the sphere's centre above the plate",
    label="Height of centre",
    enlarged_label="From first touch",
    run_marks=tops_of_rebounds,
    run_meaning="circle: top of a rebound",
    contact_marks=_deepest,
    contact_meaning="circle: largest indentation",
    headline=_indentation,
    from_touch=True,
)

FORCE = Quantity(
    column="force_N",
    title="Contact force on the sphere",
    label="Force",
    enlarged_label="Force",
    run_marks=_force_peaks,
    run_meaning="circle: largest force of a contact",
    contact_marks=_force_peaks,
    contact_meaning="circle: largest force",
    headline=_force,
)

VELOCITY = Quantity(
    column="velocity_m_s",
    title="Velocity of the sphere, upwards",
    label="Velocity",
    enlarged_label="Velocity",
    run_marks=_nothing,
    run_meaning="",
    contact_marks=_touch_and_release,
    contact_meaning="circles: first touch and release",
    headline=_restitution,
)

ACCELERATION = Quantity(
    column="acceleration_m_s2",
    title="Acceleration of the sphere, upwards",
    label="Acceleration",
    enlarged_label="Acceleration",
    run_marks=_acceleration_peaks,
    run_meaning="circle: largest of a contact",
    contact_marks=_acceleration_peaks,
    contact_meaning="circle: largest acceleration",
    headline=_acceleration,
)
