"""LAMMPS: an input file with one sphere above a granular wall."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from vibroimpact.bodies.ball import mean_density
from vibroimpact.contact.friction.law import CompliantFriction, FrictionLaw
from vibroimpact.contact.kelvin_voigt import KelvinVoigtLaw
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.laws.kuwabara_kono import KuwabaraKono
from vibroimpact.contact.laws.tsuji import Tsuji
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import (
    approach_speeds,
    clipped_dashpot,
    first_contact,
    laws_of_impacts,
    linear_or_hertzian,
    shared_notes,
)
from vibroimpact.exporting.deck import render_deck
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, file_name
from vibroimpact.exporting.program_friction import friction_in, friction_notes, spring_of_overlap
from vibroimpact.exporting.rigid_drop import as_rigid
from vibroimpact.files.plain_names import plain_words

_TANGENTIAL = {
    "mindlin": "mindlin",
    "mindlin-rescale": "mindlin_rescale",
    "mindlin-force": "mindlin/force",
}
"""Friction laws that LAMMPS has, and what it calls them."""
_FRICTION = {**{name: name for name in _TANGENTIAL}, "mdr": "mindlin-rescale"}
"""The friction laws that can be written, and which stands for each."""

_STEPS = 20_000
"""Steps in the first contact: restitution and peak force are then accurate to 5e-5
(LAMMPS damps half a step late).
"""


@dataclass(frozen=True)
class _Damping:
    """The damping of a law in LAMMPS: model, its coefficient, whether the force is clipped at
    zero, and whether it is the same law.
    """

    model: str
    coefficient: float
    limited: bool
    exact: bool


def _damping(law: ContactLaw, drop: Drop, speed: float) -> _Damping:
    """Return the damping of a law; if LAMMPS lacks it, the nearest model with the same
    restitution at a speed.
    """
    stiffness, exponent = linear_or_hertzian(drop, "LAMMPS")
    if isinstance(law, Hertz):
        return _Damping("velocity", 0.0, limited=False, exact=True)
    if isinstance(law, KelvinVoigtLaw):
        return _Damping("velocity", float(law.dashpot), limited=False, exact=True)
    if isinstance(law, KuwabaraKono):
        # LAMMPS' damping force is eta m a v with the contact radius a = sqrt(R delta)
        eta = 1.5 * stiffness * float(law.dissipation_time) / (drop.mass * math.sqrt(drop.radius))
        return _Damping("viscoelastic", eta, limited=True, exact=True)
    restitution = float(achieved_restitution(law, drop.mass, speed))
    # its dashpot is constant except over the penetration of full damping (typically 0.1 mm)
    if isinstance(law, AdamsImpact):
        dashpot = clipped_dashpot(stiffness, exponent, restitution, drop.mass, speed)
        return _Damping("velocity", dashpot, limited=True, exact=False)
    return _Damping("coeff_restitution", restitution, limited=False, exact=isinstance(law, Tsuji))


def _dampings(drop: Drop) -> list[_Damping]:
    """Return the damping of each impact; one if it is the same for all."""
    return [
        _damping(law, drop, speed)
        for law, speed in zip(laws_of_impacts(drop), approach_speeds(drop), strict=False)
    ]


def _friction(drop: Drop) -> FrictionLaw | None:
    law = friction_in(drop, "LAMMPS", _FRICTION)
    if law is not None and not drop.is_solid:
        raise InputError(
            f"{drop.inertia:.4g} kg m^2 can't be written for LAMMPS, whose spheres turn "
            "like solid ones, with 2/5 of the mass times the "
            "square of the radius; a drop without friction can",
            "sphere.inertia",
        )
    return law


def _deck(drop: Drop) -> str:
    contact_law = laws_of_impacts(drop)[0]
    dampings = _dampings(drop)
    speeds = approach_speeds(drop)
    stiffness, exponent = linear_or_hertzian(drop, "LAMMPS")
    normal_stiffness = stiffness
    if exponent != 1.0:
        normal_stiffness /= math.sqrt(drop.radius)  # by which LAMMPS multiplies that of "hertz"
    duration, _ = first_contact(contact_law, drop)
    oblique = drop.oblique or Oblique()
    gravity = [*map(float, oblique.gravity), -drop.gravity]
    friction = _friction(drop)
    tangential_model = ""  # without friction
    tangential_stiffness = 0.0
    friction_coefficient = 0.0
    if isinstance(friction, CompliantFriction):
        tangential_model = _TANGENTIAL[friction.name]
        spring = spring_of_overlap(friction, drop, stiffness, exponent)
        tangential_stiffness = spring / math.sqrt(drop.radius)  # times the radius of the contact
        friction_coefficient = float(friction.coefficient)
    # LAMMPS takes a coefficient for every impact of the loop, we the last one for all that follow
    coefficients = [damping.coefficient for damping in dampings]
    coefficients += coefficients[-1:] * (len(speeds) - len(coefficients))
    highest_centre = max(drop.height, drop.radius + max(speeds) ** 2 / (2.0 * drop.gravity))
    return render_deck(
        "lammps.in.j2",
        case_name=plain_words(drop.name),
        contact_law=contact_law,
        notes=_notes(drop),
        radius=drop.radius,
        diameter=2.0 * drop.radius,
        mass=drop.mass,
        density=float(mean_density(drop.mass, drop.radius)),  # LAMMPS computes the mass from it
        height=drop.height,
        velocity=[*oblique.velocity, -drop.speed],  # ours is the speed downwards
        angular_velocity=oblique.spin,
        oblique=drop.oblique is not None,
        normal_gravity=drop.gravity,
        gravity_magnitude=math.hypot(*gravity),
        gravity=gravity,
        ghost_cutoff=4.0 * drop.radius,
        # contains the sphere at its largest height; along the plate the box is periodic
        box_extent=2.0 * (highest_centre + drop.radius),
        impacts=len(speeds),
        time_step=duration / _STEPS,
        steps_per_contact=_STEPS,
        max_steps=20 * _STEPS,
        normal_model=_normal_model(drop),
        normal_stiffness=normal_stiffness,
        damping_model=dampings[0].model,
        damping_coefficients=coefficients,
        limit_damping=dampings[0].limited,
        tangential_model=tangential_model,
        tangential_stiffness=tangential_stiffness,
        friction_coefficient=friction_coefficient,
    )


def _normal_model(drop: Drop) -> str:
    """Return LAMMPS' name of the spring."""
    _, exponent = linear_or_hertzian(drop, "LAMMPS")
    return "hooke" if exponent == 1.0 else "hertz"


def _write(drop: Drop) -> Mapping[str, bytes]:
    return {file_name(drop, ".in"): _deck(drop).encode()}


def _notes(drop: Drop) -> list[str]:
    law = laws_of_impacts(drop)[0]
    dampings = _dampings(drop)
    first_speed = approach_speeds(drop)[0]
    notes = [*shared_notes(drop), *friction_notes(drop, "LAMMPS", _friction(drop))]
    if not drop.is_solid:
        notes.append(
            "LAMMPS has the moment of inertia of a solid sphere, which does not matter "
            "without friction."
        )
    if len(dampings) == 1:
        where = f"{first_speed:.6g} m/s, the speed of the first impact"
    else:
        where = "the speed of each impact of this drop"
    if not dampings[0].exact:
        notes.append(
            f"LAMMPS has no {law.name}; its {_normal_model(drop)} with damping {dampings[0].model} "
            "stands for it, so forces within the contact differ."
        )
        if dampings[0].model == "velocity":
            notes.append(f"Its restitution is the law's at {where}; at others it differs somewhat.")
    if isinstance(law, HuntCrossley) and law.dissipation is not None:
        notes.append(
            f"Its restitution is the law's at {where}, and at others stays the same; that "
            "of the law rises to 1 where it slows down."
        )
    if _friction(drop) is not None and dampings[0].coefficient and not dampings[0].limited:
        notes.append(
            "Where LAMMPS' normal force pulls, at the end of a "
            "contact, friction follows its magnitude."
        )
    if len(dampings) > 1:
        notes.append(
            "The damping changes from impact to impact in this one sphere's run; a wall has "
            "one value for all spheres at a time."
        )
    return notes


FORMAT = ExportFormat(
    name="lammps",
    program="LAMMPS, package GRANULAR",
    files="an input file (.in)",
    tested="run with LAMMPS 22 Jul 2025, update 4, compared with vibroimpact's drops between rigid "
    "bodies, oblique ones too",
    write=_write,
    notes=_notes,
    prepare=as_rigid,
)
