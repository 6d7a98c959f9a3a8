"""The peaks of a drop in a study, and the names of the other variables of its dataset."""

from __future__ import annotations

from typing import Literal, NamedTuple

from vibroimpact.dynamics.motion.columns import ALL_IMPACT_COLUMNS


class PeakVariable(NamedTuple):
    """A scalar result of a drop.

    Attributes
    ----------
    unit, meaning : str
        SI unit, and a sentence without a full stop.
    title, short : str
        The name in tables and titles, and a shorter one for narrow panels.
    column : str
        The column of the impact table from which it is taken; "" if none.
    taken : {"first", "largest", "total", ""}
        How it is taken: value of the first impact, maximum or sum over all impacts.
    is_drawn : bool
        Whether it describes the response of the bodies and is drawn; the others are close to
        inputs, or describe the run.
    """

    unit: str
    meaning: str
    title: str
    short: str
    column: str = ""
    taken: Literal["first", "largest", "total", ""] = ""
    is_drawn: bool = True


def _first(
    column: str, meaning: str, title: str = "", short: str = "", *, is_drawn: bool = True
) -> PeakVariable:
    """Return the value of a column at the first impact.

    Unit and label are those of the column unless given.
    """
    source = ALL_IMPACT_COLUMNS[column]
    return PeakVariable(
        source.unit,
        meaning,
        title or f"{source.label}, first impact",
        short or source.label,
        column,
        "first",
        is_drawn=is_drawn,
    )


def _largest(column: str, scope: str) -> PeakVariable:
    """Return the maximum of a column over all impacts; `scope` completes its meaning."""
    source = ALL_IMPACT_COLUMNS[column]
    return PeakVariable(
        source.unit, f"{source.meaning} {scope}", source.label, source.label, column, "largest"
    )


def _total(column: str, meaning: str, title: str) -> PeakVariable:
    """Return the sum of a column over all impacts."""
    source = ALL_IMPACT_COLUMNS[column]
    return PeakVariable(source.unit, meaning, title, source.label, column, "total")


PEAK_TABLE: dict[str, PeakVariable] = {
    "largest_force_N": _largest("max_force_N", "of all impacts"),
    "largest_indentation_m": _largest("max_indentation_m", "of all impacts"),
    "first_restitution_achieved": _first(
        "restitution_achieved", "restitution achieved at the first impact"
    ),
    "first_tangential_restitution": _first(
        "tangential_restitution",
        "ratio of the velocities of the centre along the plate after and before the first impact",
    ),
    "first_rebound_angle_deg": _first(
        "rebound_angle_deg",
        "angle of the first rebound from the normal, positive in the direction of motion",
    ),
    "first_duration_s": _first(
        "duration_s",
        "duration of the first contact",
        "Duration of the first contact",
        "Duration of contact",
    ),
    "total_energy_lost_J": _total(
        "energy_lost_J",
        "energy dissipated in all contacts, without the energy of vibration",
        "Energy lost in all contacts",
    ),
    "first_rebound_height_m": _first(
        "rebound_height_m",
        "height of the sphere's centre above the plate at the top of the first rebound",
        "Height of the first rebound",
    ),
    "largest_acceleration_m_s2": _largest("max_acceleration_m_s2", "in all impacts"),
    "first_time_s": _first(
        "time_s", "time of the first touch", "Time of the first touch", is_drawn=False
    ),
    "first_approach_speed_m_s": _first(
        "approach_speed_m_s",
        "speed at first touch of the first impact",
        "Speed at first touch",
        is_drawn=False,
    ),
    "first_restitution_asked": _first(
        "restitution_asked",
        "restitution parameter of the contact law at the first impact",
        is_drawn=False,
    ),
    "number_of_impacts": PeakVariable(
        "1", "number of impacts", "Number of impacts", "Impacts", is_drawn=False
    ),
    "end_time_s": PeakVariable(
        "s",
        "time at which the run ended",
        "Time at the end of the run",
        "Time at the end",
        is_drawn=False,
    ),
    "left_in_vibration_J": PeakVariable(
        "J",
        "energy left in vibration where the sphere came to rest, or rides, on a vibrating body",
        "Energy left in vibration",
        "Left in vibration",
        is_drawn=False,
    ),
    "closure_relative": PeakVariable(
        "1",
        "closure error of the energy ledger, relative to the energy put in",
        "Closure of the energy, relative",
        "Closure of the energy",
        is_drawn=False,
    ),
}
"""The peaks by name, the most important first.

Those of a column that the drops have not, as of oblique impacts, are left out.
"""

PEAKS: dict[str, tuple[str, str]] = {
    name: (peak.unit, peak.meaning) for name, peak in PEAK_TABLE.items()
}
"""Unit and meaning of each peak."""

FIRST = {name: peak.column for name, peak in PEAK_TABLE.items() if peak.taken == "first"}
"""The column of each peak that is taken from the first impact."""

LARGEST = {name: peak.column for name, peak in PEAK_TABLE.items() if peak.taken == "largest"}
"""The column of each peak that is the maximum over all impacts."""

TOTAL = {name: peak.column for name, peak in PEAK_TABLE.items() if peak.taken == "total"}
"""The column of each peak that is the sum over all impacts."""

OUTCOME = "outcome"
"""Why the run of a drop ended, as the index of its `Outcome` in `OUTCOMES`."""

SENSOR_PEAK = "_max_magnitude"
"""Suffix of the largest magnitude in the signal of a sensor; the name of the sensor precedes it."""

SIGNAL = "signal_"
"""Prefix of the signal of a sensor; the name of the sensor follows."""

SIGNAL_START = "_start_s"
"""Suffix of the time of the first sample that is kept of the signal of a sensor [s].

The name of the sensor precedes it.
"""

DOUBTS = "doubts"
"""The limits of the theory that a drop exceeds, as a bit mask."""

LIMIT = "limit_"
"""Prefix of the number that is compared with the threshold of a limit.

The name of the limit follows.
"""
