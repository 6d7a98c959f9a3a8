"""What a study keeps of each drop beside its impact table: the peaks."""

from __future__ import annotations

from typing import Literal, NamedTuple


class Peak(NamedTuple):
    """One value a drop.

    Attributes
    ----------
    unit, meaning : str
        SI, and a sentence without its end.
    title, short : str
        As people say it, and what has room over a narrow figure.
    column : str
        The column of the impact table that it is taken from; "" if there is none.
    taken : {"first", "largest", "total", ""}
        How: the value of the first impact, the largest or the sum of all.
    is_drawn : bool
        Does it say something of how the bodies behave? The others are as good as an input, or of the run.
    """

    unit: str
    meaning: str
    title: str
    short: str
    column: str = ""
    taken: Literal["first", "largest", "total", ""] = ""
    is_drawn: bool = True


PEAK_TABLE: dict[str, Peak] = {
    "largest_force_N": Peak("N", "largest contact force of all impacts", "Largest force", "Largest force", "max_force_N", "largest"),
    "largest_indentation_m": Peak(
        "m", "largest indentation of all impacts", "Largest indentation", "Largest indentation", "max_indentation_m", "largest"
    ),
    "first_restitution_achieved": Peak(
        "1",
        "restitution achieved at the first impact",
        "Restitution achieved, first impact",
        "Restitution achieved",
        "restitution_achieved",
        "first",
    ),
    "first_duration_s": Peak(
        "s", "duration of the first contact", "Duration of the first contact", "Duration of contact", "duration_s", "first"
    ),
    "total_energy_lost_J": Peak(
        "J", "mechanical energy lost in all contacts", "Energy lost in all contacts", "Energy lost", "energy_lost_J", "total"
    ),
    "first_rebound_height_m": Peak(
        "m",
        "height of the sphere's centre at the top of the first rebound",
        "Height of the first rebound",
        "Rebound height",
        "rebound_height_m",
        "first",
    ),
    "largest_acceleration_m_s2": Peak(
        "m/s2",
        "largest magnitude of the sphere's acceleration in all impacts",
        "Largest acceleration",
        "Largest acceleration",
        "max_acceleration_m_s2",
        "largest",
    ),
    "first_approach_speed_m_s": Peak(
        "m/s", "speed at first touch of the first impact", "Speed at first touch", "Approach speed", "approach_speed_m_s", "first", False
    ),
    "first_restitution_asked": Peak(
        "1",
        "restitution asked of the contact law at the first impact",
        "Restitution asked, first impact",
        "Restitution asked",
        "restitution_asked",
        "first",
        False,
    ),
    "number_of_impacts": Peak("1", "number of impacts", "Number of impacts", "Impacts", is_drawn=False),
    "end_time_s": Peak("s", "time at which the run ended", "Time at the end of the run", "Time at the end", is_drawn=False),
    "left_in_vibration_J": Peak(
        "J",
        "energy left in vibration where the sphere came to rest, or rides, on what vibrates",
        "Energy left in vibration",
        "Left in vibration",
        is_drawn=False,
    ),
    "closure_relative": Peak(
        "1",
        "what is missing in the energy ledger, as a part of the energy put in",
        "Closure of the energy, relative",
        "Closure of the energy",
        is_drawn=False,
    ),
}
"""The peaks; those that matter most come first."""

PEAKS: dict[str, tuple[str, str]] = {name: (peak.unit, peak.meaning) for name, peak in PEAK_TABLE.items()}
"""One value a drop: unit and meaning."""

FIRST = {name: peak.column for name, peak in PEAK_TABLE.items() if peak.taken == "first"}
"""Peaks that are a column of the first impact, and which."""

LARGEST = {name: peak.column for name, peak in PEAK_TABLE.items() if peak.taken == "largest"}
"""Peaks that are the largest of a column, and of which."""

OUTCOME = "outcome"
"""Why the run of a drop ended: its place among the values of `Outcome`."""

SENSOR_PEAK = "_max_magnitude"
"""How the largest magnitude in the signal of a sensor is called: the name of the sensor, and this."""

SIGNAL = "signal_"
"""How the signal of a sensor is called: this, and the name of the sensor."""

DOUBTS = "doubts"
"""Which limits of the theory a drop is beyond: a bit each."""

LIMIT = "limit_"
"""How the number of a limit is called: this, and the name of the limit."""
