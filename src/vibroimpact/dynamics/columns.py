"""The names of everything a response tells, with unit and meaning: one list for table, file and figure."""

from __future__ import annotations

from collections.abc import Iterable

IMPACT_COLUMNS: dict[str, tuple[str, str]] = {
    "impact": ("1", "number of the impact, from 1"),
    "time_s": ("s", "time of first touch"),
    "duration_s": ("s", "duration of contact"),
    "approach_speed_m_s": ("m/s", "speed at first touch, downwards"),
    "separation_speed_m_s": ("m/s", "speed at release, upwards"),
    "restitution_achieved": ("1", "separation speed over approach speed"),
    "max_indentation_m": ("m", "largest indentation"),
    "max_force_N": ("N", "largest contact force"),
    "max_acceleration_m_s2": ("m/s2", "largest magnitude of the sphere's acceleration"),
    "rebound_height_m": ("m", "height of the sphere's centre above the plate at the top of the rebound"),
    "energy_lost_J": ("J", "mechanical energy lost in the contact"),
    "plastic_work_J": ("J", "the part of the energy lost that went into plastic deformation"),
    "restitution_asked": ("1", "restitution asked of the contact law, where it has one"),
    "time_of_max_indentation_s": ("s", "time of the largest indentation"),
    "time_of_max_force_s": ("s", "time of the largest contact force"),
}
"""Columns of the impact table, one row an impact: unit and meaning."""

VIBRATION_IMPACT_COLUMNS: dict[str, tuple[str, str]] = {
    "closing_speed_m_s": ("m/s", "speed at which the surfaces meet at first touch"),
    "contacts": ("1", "number of contacts between first touch and last release"),
    "energy_to_vibration_J": ("J", "energy that went into vibration, what its damping took by the last release included"),
    "sensitivity": ("1", "relative change of the motion at first touch, for a small relative change of the drop's height or speed"),
}
"""Further columns of the impact table, where a body vibrates."""

HISTORY_COLUMNS: dict[str, tuple[str, str]] = {
    "time_s": ("s", "time since the start"),
    "position_m": ("m", "height of the sphere's centre above the plate's upper surface"),
    "velocity_m_s": ("m/s", "velocity of the sphere, upwards"),
    "acceleration_m_s2": ("m/s2", "acceleration of the sphere, upwards"),
    "force_N": ("N", "contact force on the sphere, upwards"),
    "indentation_m": ("m", "indentation, zero without contact; negative where a sticking contact is drawn out"),
    "kinetic_J": ("J", "kinetic energy of the sphere"),
    "potential_J": ("J", "potential energy of the sphere, zero at first touch of the undeformed plate"),
    "contact_elastic_J": ("J", "energy stored in the contact"),
    "contact_dissipated_J": ("J", "energy lost so far in the damping of the contact, and when a sticking contact breaks"),
    "plastic_work_J": ("J", "energy lost so far in plastic deformation"),
    "written_off_at_rest_J": ("J", "energy written off when the sphere was found to be at rest"),
}
"""Columns of a history: unit and meaning."""

VIBRATION_HISTORY_COLUMNS: dict[str, tuple[str, str]] = {
    "sphere_vibration_J": ("J", "kinetic energy of the sphere's vibration, beside that of its centre"),
    "sphere_strain_J": ("J", "strain energy of the sphere's modes"),
    "sphere_damping_J": ("J", "energy lost so far in the damping of the sphere's modes"),
    "sphere_rotational_J": ("J", "kinetic energy of the sphere's rotation"),
    "plate_kinetic_J": ("J", "kinetic energy of the plate"),
    "plate_strain_J": ("J", "strain energy of the plate's modes, from where it rests under its own weight"),
    "plate_damping_J": ("J", "energy lost so far in the damping of the plate's modes"),
    "plate_rotational_J": ("J", "the part of the plate's kinetic energy in its turning as a whole"),
    "plate_potential_J": ("J", "change of the plate's potential energy, which the strain of its weight makes up for"),
    "plate_displacement_m": ("m", "displacement of the plate's centre of mass, upwards"),
    "plate_velocity_m_s": ("m/s", "velocity of the plate's centre of mass, upwards"),
    "plate_acceleration_m_s2": ("m/s2", "acceleration of the plate's centre of mass, upwards"),
    "plate_deflection_m": ("m", "displacement of the plate at the contact point, upwards"),
}
"""Further columns of a history, where a body vibrates."""

VIBRATION_LEDGER = ("sphere_vibration_J", "sphere_strain_J", "sphere_damping_J", "plate_kinetic_J", "plate_strain_J", "plate_damping_J")
"""The further columns that share the energy put in."""

LEDGER = ("kinetic_J", "potential_J", "contact_elastic_J", "contact_dissipated_J", "plastic_work_J", "written_off_at_rest_J")
"""The columns of a history that share the energy put in; their sum is constant."""

COUNTS = ("impact", "contacts")
"""The columns of the impact table that count."""


def impact_columns(impacts: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Return unit and meaning of the columns that an impact table has: more where a body vibrates."""
    has = set(impacts)
    return {name: told for name, told in {**IMPACT_COLUMNS, **VIBRATION_IMPACT_COLUMNS}.items() if name in has}


def history_columns(history: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Return unit and meaning of the columns that a history has: more where a body vibrates."""
    has = set(history)
    return {name: told for name, told in {**HISTORY_COLUMNS, **VIBRATION_HISTORY_COLUMNS}.items() if name in has}
