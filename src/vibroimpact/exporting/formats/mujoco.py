"""MuJoCo: an MJCF model of a sphere above a plane; its soft contact is a linear spring
and dashpot.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from xml.sax.saxutils import quoteattr

from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import (
    approach_speeds,
    clipped_dashpot,
    first_contact,
    laws_of_impacts,
    power_law_spring,
    shared_notes,
)
from vibroimpact.exporting.deck import render_deck
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, file_name
from vibroimpact.exporting.rigid_drop import as_rigid
from vibroimpact.files.plain_names import plain_words

_STEPS = 1000
"""Steps in the first contact: the error of its restitution is then 1e-3."""

_IMPEDANCE = 0.9999
"""Largest impedance that MuJoCo allows; the remainder to 1 is unconstrained motion."""


def _linear(drop: Drop) -> AdamsImpact:
    """Return the linear spring-dashpot without tension that has the restitution and
    duration of the drop's first contact.
    """
    law = laws_of_impacts(drop)[0]
    speed = approach_speeds(drop)[0]
    power_law_spring(law, "MuJoCo")
    restitution = float(achieved_restitution(law, drop.mass, speed))
    duration, _ = first_contact(law, drop)

    def achieving(stiffness: float) -> AdamsImpact:
        dashpot = clipped_dashpot(stiffness, 1.0, restitution, drop.mass, speed)
        depth = speed * math.sqrt(drop.mass / stiffness)
        return AdamsImpact(
            stiffness=stiffness,
            exponent=1.0,
            damping_max=dashpot,
            full_damping_penetration=1e-7 * depth,
        )

    # the restitution fixes the damping ratio, so the duration is proportional to the period
    trial = drop.mass * (math.pi / duration) ** 2
    return achieving(trial * (first_contact(achieving(trial), drop)[0] / duration) ** 2)


def _check_frictionless(drop: Drop) -> None:
    """Raise InputError if the drop has friction."""
    if drop.oblique is not None and drop.oblique.friction is not None:
        raise InputError(
            f"{drop.oblique.friction.name} can't be written for MuJoCo, whose friction is "
            "viscous up to its cone, and changes the "
            "restitution of what slides; a drop without friction can be",
            "contact.friction",
        )


def _deck(drop: Drop) -> str:
    contact_law = laws_of_impacts(drop)[0]
    spring_dashpot = _linear(drop)
    duration, largest_force = first_contact(spring_dashpot, drop)
    _, largest_force_of_law = first_contact(contact_law, drop)
    _check_frictionless(drop)
    # MuJoCo's planes of size zero have infinite extent
    plate_length, plate_width, _ = drop.plate_size or (0.0, 0.0, 0.0)
    oblique = drop.oblique or Oblique()
    return render_deck(
        "mujoco.xml.j2",
        case_name=plain_words(drop.name),
        quoted_case_name=quoteattr(plain_words(drop.name)),
        contact_law=contact_law,
        notes=_notes(drop),
        radius=drop.radius,
        mass=drop.mass,
        inertia=drop.inertia,
        plate_half_length=0.5 * plate_length,
        plate_half_width=0.5 * plate_width,
        height=drop.height,
        position=[*drop.position, drop.height],
        vertical_velocity=-float(drop.speed),  # ours is the speed downwards
        velocity=[*oblique.velocity, -drop.speed],
        # MuJoCo's is about the axes of the body, at the start those of the plate
        angular_velocity=oblique.spin,
        oblique=drop.oblique is not None,
        normal_gravity=drop.gravity,
        gravity_along_plate=oblique.gravity,
        time_step=duration / _STEPS,
        stiffness=spring_dashpot.stiffness,
        damping=spring_dashpot.damping_max,
        impedance=_IMPEDANCE,
        contact_duration=duration,
        largest_force=largest_force,
        largest_force_of_law=largest_force_of_law,
    )


def _write(drop: Drop) -> Mapping[str, bytes]:
    return {file_name(drop, ".xml"): _deck(drop).encode()}


def _notes(drop: Drop) -> list[str]:
    laws = laws_of_impacts(drop)
    notes = shared_notes(drop)
    _, exponent = power_law_spring(laws[0], "MuJoCo")
    speed = approach_speeds(drop)[0]
    notes.append(
        "MuJoCo's contact is a linear spring and dashpot that does not pull; it stands "
        f"for {laws[0].name} and has its restitution and "
        f"duration at {speed:.6g} m/s, the first impact; the course and the largest force differ."
    )
    if exponent != 1.0:
        notes.append(
            f"The exponent {exponent:g} of the spring can't be represented, so durations "
            "at other speeds differ."
        )
    if len(laws) > 1:
        changing = "; parameters that change from impact to impact can't be represented."
    else:
        changing = "."
    notes.append("Its restitution is the same at every speed" + changing)
    return notes


FORMAT = ExportFormat(
    name="mujoco",
    program="MuJoCo",
    files="a model (.xml, MJCF)",
    tested="run with MuJoCo 3.2.7 and 4.0.0, the first impact compared with vibroimpact's between "
    "rigid bodies, an oblique one without friction too",
    write=_write,
    notes=_notes,
    prepare=as_rigid,
)
