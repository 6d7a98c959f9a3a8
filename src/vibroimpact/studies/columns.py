"""What a study keeps of each drop beside its impact table: the peaks, with unit and meaning."""

from __future__ import annotations

PEAKS: dict[str, tuple[str, str]] = {
    "number_of_impacts": ("1", "number of impacts"),
    "end_time_s": ("s", "time at which the run ended"),
    "first_approach_speed_m_s": ("m/s", "speed at first touch of the first impact"),
    "first_restitution_asked": ("1", "restitution asked of the contact law at the first impact"),
    "first_restitution_achieved": ("1", "restitution achieved at the first impact"),
    "first_duration_s": ("s", "duration of the first contact"),
    "first_rebound_height_m": ("m", "height of the sphere's centre at the top of the first rebound"),
    "largest_force_N": ("N", "largest contact force of all impacts"),
    "largest_indentation_m": ("m", "largest indentation of all impacts"),
    "largest_acceleration_m_s2": ("m/s2", "largest magnitude of the sphere's acceleration in all impacts"),
    "total_energy_lost_J": ("J", "mechanical energy lost in all contacts"),
    "closure_relative": ("1", "what is missing in the energy ledger, as a part of the energy put in"),
}
"""One value a drop: unit and meaning."""

FIRST = {name: name.removeprefix("first_") for name in PEAKS if name.startswith("first_")}
"""Peaks that are a column of the first impact, and which."""

LARGEST = {
    "largest_force_N": "max_force_N",
    "largest_indentation_m": "max_indentation_m",
    "largest_acceleration_m_s2": "max_acceleration_m_s2",
}
"""Peaks that are the largest of a column, and of which."""

OUTCOME = "outcome"
"""Why the run of a drop ended: its place among the values of `Outcome`."""

SENSOR_PEAK = "_max_magnitude"
"""How the largest magnitude in the signal of a sensor is called: the name of the sensor, and this."""

SIGNAL = "signal_"
"""How the signal of a sensor is called: this, and the name of the sensor."""
