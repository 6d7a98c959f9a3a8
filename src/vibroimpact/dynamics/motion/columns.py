"""The columns of impact tables and histories, for files, terminal, pages and figures."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Literal, NamedTuple


class Column(NamedTuple):
    """A column of the impact table or of a history.

    `unit` (SI), `meaning`: as files tell them. `label`: its header on a page, which one that is
    shown there has; of an energy, its entry in the ledger. `short`: its header in a terminal; of an
    energy, its name in a legend. `values`: what kind they are, which sets how they are written.
    `certain_as`: the outcome of the impact, the arrival, which the previous outcome sets, or exact,
    unaffected by a perturbation of the drop. `shown_before`: the column that it is shown before,
    where it does not follow those above it. `in_ledger`: does it share the energy put in?
    `is_loss`: is that energy gone?
    """

    unit: str
    meaning: str
    label: str = ""
    short: str = ""
    values: Literal["quantity", "time", "ratio", "count", "factor"] = "quantity"
    certain_as: Literal["outcome", "arrival", "exact"] = "outcome"
    shown_before: str = ""
    in_ledger: bool = False
    is_loss: bool = False


def _held(meaning: str, label: str, short: str = "") -> Column:
    """Return a column of the ledger for energy that is not lost.

    It is kinetic, potential, stored, or written off.
    """
    return Column("J", meaning, label, short, in_ledger=True)


def _lost(meaning: str, label: str, short: str) -> Column:
    """Return a column of the ledger for energy lost so far."""
    return Column("J", meaning, label, short, in_ledger=True, is_loss=True)


IMPACT_COLUMNS: dict[str, Column] = {
    "impact": Column("1", "number of the impact, from 1", "Impact", "#", "count", "exact"),
    "time_s": Column("s", "time of first touch", "First touch", "time", "time", "arrival"),
    "duration_s": Column("s", "duration of contact", "Contact duration", "contact"),
    "approach_speed_m_s": Column(
        "m/s",
        "speed at first touch, downwards; relative to a plate that is free or shaken",
        "Approach speed",
        "approach",
        certain_as="arrival",
    ),
    "separation_speed_m_s": Column(
        "m/s",
        "speed at release, upwards; relative to a plate that is free or shaken",
        "Separation speed",
        "separation",
    ),
    "restitution_achieved": Column(
        "1", "separation speed over approach speed", "Restitution achieved", "e achieved", "ratio"
    ),
    "max_indentation_m": Column("m", "largest indentation", "Largest indentation", "indentation"),
    "max_force_N": Column("N", "largest contact force", "Largest force", "force"),
    "max_acceleration_m_s2": Column(
        "m/s2",
        "largest upward acceleration of the sphere's centre in the impact, or "
        "that of its fall if larger",
        "Largest acceleration",
        "acceleration",
    ),
    "rebound_height_m": Column(
        "m",
        "height of the sphere's centre above the plate at rest, if shaken above its mean "
        "position, at the top of the rebound",
        "Rebound height",
        "rebound",
    ),
    "energy_lost_J": Column(
        "J",
        "energy dissipated in the contact, without friction and without the energy of vibration",
        "Energy lost",
        "lost",
    ),
    "plastic_work_J": Column(
        "J", "part of the energy lost that was dissipated by plastic deformation"
    ),
    "restitution_asked": Column(
        "1",
        "restitution parameter of the contact law, if it has one; in a liquid "
        "what the film leaves of it",
        "Restitution asked",
        "e\u00a0asked",
        "ratio",
        "exact",
        shown_before="restitution_achieved",
    ),
    "time_of_max_indentation_s": Column("s", "time of the largest indentation"),
    "time_of_max_force_s": Column("s", "time of the largest contact force"),
}
"""Columns of the impact table, one row an impact."""

FIRST_IMPACT_COLUMNS = tuple(IMPACT_COLUMNS)[:11]
"""Those that every version has written: the fixed header of `impacts.csv`, from `impact`
to `energy_lost_J`.
"""

VIBRATION_IMPACT_COLUMNS: dict[str, Column] = {
    "closing_speed_m_s": Column("m/s", "relative normal velocity of the surfaces at first touch"),
    "contacts": Column(
        "1",
        "number of contacts between first touch and last release",
        "Contacts in the impact",
        "contacts",
        "count",
        "exact",
    ),
    "energy_to_vibration_J": Column(
        "J",
        "energy transferred to vibration, including its dissipation by modal damping up to "
        "the last release",
    ),
    "sensitivity": Column(
        "1",
        "relative change of the impact over the small relative change of the drop's height "
        "or speed that causes it",
        "Sensitivity",
        "sensitivity",
        "factor",
        "exact",
    ),
}
"""Further columns of the impact table, where a body vibrates."""

HISTORY_COLUMNS: dict[str, Column] = {
    "time_s": Column("s", "time since the start"),
    "position_m": Column(
        "m",
        "height of the sphere's centre above the plate's upper surface at rest, if shaken "
        "above its mean position",
    ),
    "velocity_m_s": Column("m/s", "velocity of the sphere, upwards"),
    "acceleration_m_s2": Column("m/s2", "acceleration of the sphere, upwards"),
    "force_N": Column("N", "contact force on the sphere, upwards"),
    "indentation_m": Column(
        "m", "indentation, zero without contact; negative where an adhesive contact is stretched"
    ),
    "kinetic_J": _held(
        "kinetic energy of the sphere's centre, and of a liquid that moves along",
        "Kinetic energy of the sphere",
        "kinetic",
    ),
    "potential_J": _held(
        "potential energy of the sphere by its weight less buoyancy, zero where it touches "
        "the undeformed plate in its mean position, "
        "if inclined at its place at the start",
        "Potential energy of the sphere, zero where it touches the undeformed plate",
        "potential",
    ),
    "contact_elastic_J": _held(
        "energy stored in the contact", "Stored in the contact", "stored in the contact"
    ),
    "contact_dissipated_J": _lost(
        "energy lost so far in the contact: by its damping, when an adhesive contact "
        "breaks, and by a law without a force",
        "Lost in the contact: by damping, when adhesion broke, or by a law without a force",
        "loss in the contact",
    ),
    "plastic_work_J": _lost(
        "energy lost so far in plastic deformation", "Lost in plastic deformation", "plastic work"
    ),
    "written_off_at_rest_J": _held(
        "energy written off when the sphere was found to be at rest",
        "Written off when the sphere was found to be at rest",
        "written off at rest",
    ),
}
"""Columns of a history."""

VIBRATION_HISTORY_COLUMNS: dict[str, Column] = {
    "sphere_vibration_J": _held(
        "kinetic energy of the sphere's vibration, in addition to that of its centre",
        "Kinetic energy of the sphere's vibration, in addition to that of its centre",
    ),
    "sphere_strain_J": _held(
        "strain energy of the sphere's modes", "Strain energy of the sphere's modes"
    ),
    "sphere_damping_J": _lost(
        "energy lost so far in the damping of the sphere's modes",
        "Lost in the damping of the sphere's modes",
        "damping of the sphere",
    ),
    "sphere_rotational_J": Column(
        "J", "part of sphere_vibration_J in rigid-body rotation of the sphere by its modes"
    ),
    "plate_kinetic_J": _held(
        "kinetic energy of the plate, if shaken of the motion that impacts excite",
        "Kinetic energy of the plate",
    ),
    "plate_strain_J": _held(
        "strain energy of the plate's modes, from its rest position under its own weight, "
        "if shaken of the motion that impacts excite",
        "Strain energy of the plate's modes, from its rest position",
    ),
    "plate_damping_J": _lost(
        "energy lost so far in the damping of the plate's modes, if shaken of the motion "
        "that impacts excite",
        "Lost in the damping of the plate's modes",
        "damping of the plate",
    ),
    "plate_rotational_J": Column(
        "J", "part of the plate's kinetic energy in its rigid-body rotation"
    ),
    "plate_potential_J": Column(
        "J",
        "change of the plate's potential energy by the motion that impacts excite, balanced "
        "by the strain energy of its own weight",
    ),
    "plate_displacement_m": Column("m", "displacement of the plate's centre of mass, upwards"),
    "plate_velocity_m_s": Column("m/s", "velocity of the plate's centre of mass, upwards"),
    "plate_acceleration_m_s2": Column(
        "m/s2", "acceleration of the plate's centre of mass, upwards"
    ),
    "plate_deflection_m": Column("m", "displacement of the plate at the contact point, upwards"),
}
"""Further columns of a history, where a body vibrates."""

SHAKEN_IMPACT_COLUMNS: dict[str, Column] = {
    "plate_velocity_m_s": Column(
        "m/s",
        "velocity of the plate's surface at first touch, upwards, as its supports alone move it",
    ),
    "plate_work_J": Column(
        "J",
        "work of the prescribed motion of the plate by the contact force, "
        "from first touch to release",
    ),
}
"""Further columns of the impact table, where the plate is shaken."""

SHAKEN_HISTORY_COLUMNS: dict[str, Column] = {
    "surface_m": Column(
        "m",
        "position of the plate's surface at the contact point as its supports alone move "
        "it, upwards from its mean",
    ),
    "surface_velocity_m_s": Column(
        "m/s",
        "velocity of the plate's surface at the contact point as its "
        "supports alone move it, upwards",
    ),
    "drive_J": _held(
        "minus the work that the moving plate has done so far: energy from its drive is negative",
        "Energy to the drive of the plate, negative from it",
        "drive of the plate",
    ),
}
"""Further columns of a history, where the plate is shaken."""

OBLIQUE_IMPACT_COLUMNS: dict[str, Column] = {
    "position_x_m": Column(
        "m",
        "position of the sphere's centre at first touch, along x, from the mean position of "
        "the plate's centre",
    ),
    "position_y_m": Column(
        "m",
        "position of the sphere's centre at first touch, along y, from the mean position of "
        "the plate's centre",
    ),
    "approach_velocity_x_m_s": Column("m/s", "velocity of the centre at first touch, along x"),
    "approach_velocity_y_m_s": Column("m/s", "velocity of the centre at first touch, along y"),
    "separation_velocity_x_m_s": Column("m/s", "velocity of the centre at release, along x"),
    "separation_velocity_y_m_s": Column("m/s", "velocity of the centre at release, along y"),
    "spin_x_before_rad_s": Column("rad/s", "angular velocity at first touch, about x"),
    "spin_y_before_rad_s": Column("rad/s", "angular velocity at first touch, about y"),
    "spin_z_before_rad_s": Column("rad/s", "angular velocity at first touch, about the normal"),
    "spin_x_after_rad_s": Column("rad/s", "angular velocity at release, about x"),
    "spin_y_after_rad_s": Column("rad/s", "angular velocity at release, about y"),
    "spin_z_after_rad_s": Column("rad/s", "angular velocity at release, about the normal"),
    "tangential_restitution": Column(
        "1",
        "velocity of the centre along the plate after over before impact, "
        "in the direction of that before",
        "Tangential restitution",
        "e\u00a0tangential",
        "ratio",
    ),
    "rebound_angle_deg": Column(
        "deg",
        "angle of the rebound from the normal, positive in the direction of motion",
        "Rebound angle",
        "rebound angle",
    ),
    "friction_lost_J": Column("J", "energy dissipated by friction", "Lost by friction", "friction"),
    "microslip_lost_J": Column(
        "J",
        "the part of friction_lost_J that was lost during partial slip of the contact",
        "of that in microslip",
        "in\u00a0microslip",
    ),
    "gross_slip_lost_J": Column(
        "J",
        "the other part of friction_lost_J: in slip of the whole contact, "
        "and in twisting and rolling",
    ),
}
"""Further columns of the impact table, where motion is not along the normal alone."""

CARRIED_IMPACT_COLUMNS: dict[str, Column] = {
    "place_on_plate_x_m": Column(
        "m", "place of first touch on the moving plate, along x from the plate's centre then"
    ),
    "place_on_plate_y_m": Column(
        "m", "place of first touch on the moving plate, along y from the plate's centre then"
    ),
}
"""Further columns of the impact table, where motion is not along the normal alone and the
plate is shaken.
"""

FLUID_IMPACT_COLUMNS: dict[str, Column] = {
    "air_lost_J": Column(
        "J", "energy lost to air drag in the flight before the impact", "Lost to the air", "air"
    ),
    "liquid_lost_J": Column(
        "J",
        "energy lost to the drag of the liquid in the flight before the impact",
        "Lost to the liquid",
        "liquid",
    ),
}
"""Further columns of the impact table, one of which it has where the sphere flies through
air or a liquid.
"""

VIBRATING_IMPACT_COLUMNS = {**IMPACT_COLUMNS, **VIBRATION_IMPACT_COLUMNS}
ALL_IMPACT_COLUMNS = {
    **VIBRATING_IMPACT_COLUMNS,
    **SHAKEN_IMPACT_COLUMNS,
    **OBLIQUE_IMPACT_COLUMNS,
    **CARRIED_IMPACT_COLUMNS,
    **FLUID_IMPACT_COLUMNS,
}


def _shown() -> tuple[str, ...]:
    """Return the columns with a label: of every run, of motion along the plate, of fluids, of
    vibration.
    """
    columns = {
        **IMPACT_COLUMNS,
        **OBLIQUE_IMPACT_COLUMNS,
        **FLUID_IMPACT_COLUMNS,
        **VIBRATION_IMPACT_COLUMNS,
        **ALL_IMPACT_COLUMNS,
    }
    names = [name for name, column in columns.items() if column.label and not column.shown_before]
    for name, column in columns.items():
        if column.shown_before:
            names.insert(names.index(column.shown_before), name)
    return tuple(names)


SHOWN_IMPACT_COLUMNS = _shown()
"""Columns of the impact table that tables show, in their order."""

OBLIQUE_HISTORY_COLUMNS: dict[str, Column] = {
    "position_x_m": Column(
        "m", "position of the sphere's centre along x, from the mean position of the plate's centre"
    ),
    "position_y_m": Column(
        "m", "position of the sphere's centre along y, from the mean position of the plate's centre"
    ),
    "velocity_x_m_s": Column("m/s", "velocity of the centre along x"),
    "velocity_y_m_s": Column("m/s", "velocity of the centre along y"),
    "spin_x_rad_s": Column("rad/s", "angular velocity about x"),
    "spin_y_rad_s": Column("rad/s", "angular velocity about y"),
    "spin_z_rad_s": Column("rad/s", "angular velocity about the normal"),
    "friction_x_N": Column("N", "friction force on the sphere along x"),
    "friction_y_N": Column("N", "friction force on the sphere along y"),
    "rotation_J": _held(
        "kinetic energy of the sphere's rotation",
        "Kinetic energy of the sphere's rotation",
        "rotation",
    ),
    "friction_J": _lost(
        "energy dissipated by friction so far; within a contact also the energy of its "
        "tangential deformation",
        "Lost by friction",
        "friction",
    ),
}
"""Further columns of a history, where motion is not along the normal alone."""

FRICTION_PARTS: dict[str, Column] = {
    "microslip_J": _lost(
        "the part of friction_J that was lost during partial slip of a contact",
        "Lost in microslip",
        "microslip",
    ),
    "gross_slip_J": _lost(
        "the other part of friction_J: in slip of whole contacts, and in twisting and rolling",
        "Lost in gross slip",
        "gross slip",
    ),
}
"""Two parts of `friction_J`, which are known at the end of a run."""

FLUID_HISTORY_COLUMNS: dict[str, Column] = {
    "air_J": _lost("energy lost so far to the drag of air", "Lost to the drag of air", "air"),
    "liquid_J": _lost(
        "energy lost so far to the liquid: by drag, and of the liquid that moves along as "
        "impacts turn the sphere",
        "Lost to the liquid",
        "liquid",
    ),
}
"""Further columns of a history, one of which it has where the sphere flies through air or
a liquid.
"""

ALL_HISTORY_COLUMNS = {
    **HISTORY_COLUMNS,
    **VIBRATION_HISTORY_COLUMNS,
    **SHAKEN_HISTORY_COLUMNS,
    **OBLIQUE_HISTORY_COLUMNS,
    **FLUID_HISTORY_COLUMNS,
}

LEDGER_COLUMNS = {**ALL_HISTORY_COLUMNS, **FRICTION_PARTS}
"""Columns of a history, and entries of the ledger beside them."""

MOTION_COLUMNS = (*tuple(HISTORY_COLUMNS)[:8], "plate_deflection_m")
"""Those of motion and force, from `time_s` to `potential_J`, which are found from the
state without the losses so far.
"""

LEDGER = tuple(name for name, column in HISTORY_COLUMNS.items() if column.in_ledger)
"""The columns of a history that share the energy put in; their sum is constant."""

VIBRATION_LEDGER = tuple(
    name for name, column in VIBRATION_HISTORY_COLUMNS.items() if column.in_ledger
)
"""The further columns that share it, where a body vibrates."""

SHAKEN_LEDGER = tuple(name for name, column in SHAKEN_HISTORY_COLUMNS.items() if column.in_ledger)
"""The further columns that share it, where the plate is shaken."""

OBLIQUE_LEDGER = tuple(name for name, column in OBLIQUE_HISTORY_COLUMNS.items() if column.in_ledger)
"""The further columns that share it, where motion is not along the normal alone."""

FLUID_LEDGER = tuple(name for name, column in FLUID_HISTORY_COLUMNS.items() if column.in_ledger)
"""The further columns that share it, one where the sphere flies through air, the other in
a liquid.
"""


def impact_columns(impacts: Iterable[str]) -> dict[str, Column]:
    """Return the columns of an impact table, which has more where a body vibrates."""
    has = set(impacts)
    return {name: column for name, column in ALL_IMPACT_COLUMNS.items() if name in has}


def history_columns(history: Iterable[str]) -> dict[str, Column]:
    """Return the columns of a history, which has more where a body vibrates."""
    has = set(history)
    return {name: column for name, column in ALL_HISTORY_COLUMNS.items() if name in has}


def meanings(columns: Mapping[str, Column]) -> dict[str, tuple[str, str]]:
    """Return unit and meaning of columns."""
    return {name: (column.unit, column.meaning) for name, column in columns.items()}
