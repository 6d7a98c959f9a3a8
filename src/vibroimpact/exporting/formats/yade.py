"""YADE: a Python script with one sphere above a wall."""

from __future__ import annotations

import math
from collections.abc import Mapping

from vibroimpact.bodies.ball import mean_density
from vibroimpact.contact.friction.law import CompliantFriction, FrictionLaw
from vibroimpact.contact.kelvin_voigt import KelvinVoigtLaw
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.tsuji import Tsuji
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import (
    approach_speeds,
    first_contact,
    laws_of_impacts,
    linear_or_hertzian,
    shared_notes,
)
from vibroimpact.exporting.deck import render_deck
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, file_name
from vibroimpact.exporting.program_friction import (
    coefficient_of,
    friction_in,
    friction_notes,
    spring_of_overlap,
)
from vibroimpact.exporting.rigid_drop import as_rigid
from vibroimpact.exporting.yade_damping import yade_damping
from vibroimpact.files.plain_names import plain_words

_FRICTION = dict.fromkeys(("mindlin-force", "mindlin", "mindlin-rescale", "mdr"), "mindlin-force")
"""The friction laws that can be written, and which stands for each."""

_STEPS = 10_000
"""Steps in the first contact: accuracy 1e-4 of restitution and peak force, gravity apart,
which the damping is calibrated without.
"""


def _damping(law: ContactLaw, drop: Drop, speed: float) -> float:
    """Return the damping ratio betan of YADE's Mindlin law, or the dashpot of the linear
    law [N s/m], with the law's restitution.
    """
    stiffness, exponent = linear_or_hertzian(drop, "YADE")
    if isinstance(law, Hertz):
        return 0.0
    restitution = float(achieved_restitution(law, drop.mass, speed))
    return yade_damping(stiffness, exponent, restitution, drop.mass, speed)


def _is_linear(drop: Drop) -> bool:
    _, exponent = linear_or_hertzian(drop, "YADE")
    return exponent == 1.0


def _contact_functor(drop: Drop) -> str:
    """Return YADE's name of its contact law."""
    if _is_linear(drop):
        return "Law2_ScGeom_ViscElPhys_Basic"
    return "Law2_ScGeom_MindlinPhys_Mindlin"


def _friction(drop: Drop) -> FrictionLaw | None:
    return friction_in(drop, "YADE", _FRICTION)


def _poissons_ratio(drop: Drop) -> float:
    """Return the Poisson's ratio with which YADE takes the tangential stiffness of the drop from
    the normal one.

    For two equal spheres they have the ratio 3 (1 - nu) / (2 - nu) over the root of the overlap.
    """
    law = _friction(drop)
    stiffness, exponent = linear_or_hertzian(drop, "YADE")
    if not isinstance(law, CompliantFriction):
        return float(drop.sphere_material.poissons_ratio)
    ratio = spring_of_overlap(law, drop, stiffness, exponent) / stiffness
    if exponent != 1.5 or ratio >= 2.0:
        raise InputError(
            f"{law.name} can't be written for YADE unless the spring has the exponent 1.5, and a "
            "stiffness not far below Hertz's of the materials",
            "contact.friction",
        )
    return (3.0 - 2.0 * ratio) / (3.0 - ratio)


def _deck(drop: Drop) -> str:
    laws = laws_of_impacts(drop)
    speeds = approach_speeds(drop)
    stiffness, _ = linear_or_hertzian(drop, "YADE")
    duration, _ = first_contact(laws[0], drop)
    oblique = drop.oblique or Oblique()
    friction_coefficient = coefficient_of(_friction(drop))
    poissons_ratio = _poissons_ratio(drop)
    return render_deck(
        "yade.py.j2",
        case_name=plain_words(drop.name),
        contact_law=laws[0],
        notes=_notes(drop),
        radius=drop.radius,
        mass=drop.mass,
        density=float(mean_density(drop.mass, drop.radius)),  # YADE computes the mass from it
        solid=drop.is_solid,  # as which YADE takes a sphere unless it is given the inertia
        inertia=drop.inertia,
        height=drop.height,
        downward_speed=drop.speed,
        velocity_along_plate=oblique.velocity,
        angular_velocity=oblique.spin,
        oblique=drop.oblique is not None,
        normal_gravity=drop.gravity,
        gravity_along_plate=oblique.gravity,
        impacts=len(speeds),
        contact_duration=duration,
        steps_per_contact=_STEPS,
        max_steps=20 * _STEPS,
        linear=_is_linear(drop),
        contact_functor=_contact_functor(drop),
        contact_stiffness=stiffness,
        # YADE combines the properties of two bodies; sphere and wall get values whose combination
        # is that of the contact: springs in series, or Hertz's contact of two equal spheres
        body_stiffness=2.0 * stiffness,
        youngs_modulus=1.5 * stiffness * (1.0 - poissons_ratio**2) / math.sqrt(0.5 * drop.radius),
        poissons_ratio=poissons_ratio,
        friction_angle=math.atan(friction_coefficient),
        # betan of the Mindlin law [-], or the dashpot of the contact [N s/m]
        dampings=[_damping(law, drop, speed) for law, speed in zip(laws, speeds, strict=False)],
    )


def _write(drop: Drop) -> Mapping[str, bytes]:
    return {file_name(drop, "-yade.py"): _deck(drop).encode()}


def _notes(drop: Drop) -> list[str]:
    law = drop.laws[0]
    friction = _friction(drop)
    notes = [*shared_notes(drop), *friction_notes(drop, "YADE", friction)]
    if friction is not None:
        percent = 100.0 * float(drop.impacts["max_indentation_m"].max()) / drop.radius
        notes.append(
            "YADE's friction has the arm of the radius less the overlap, so that it "
            f"changes the spin by up to {percent:.2g} % less."
        )
    if isinstance(law, Hertz):
        return notes
    several = len(laws_of_impacts(drop)) > 1
    where = "the first impact's speed"
    if several:
        where = "the speed of each impact of this drop"
    difference = "has another damping"
    if isinstance(law, (Tsuji, KelvinVoigtLaw)):
        difference = "differs in that it never pulls"
    notes.append(
        f"YADE's {_contact_functor(drop)} stands for {law.name}; it {difference}, so forces within "
        f"the contact differ. Its restitution is the law's at {where}, and with a given "
        "damping does not depend on the speed."
    )
    if several:
        notes.append(
            "The damping changes from impact to impact in this script; YADE's laws have one "
            "value for all contacts of a material."
        )
    return notes


FORMAT = ExportFormat(
    name="yade",
    program="YADE",
    files="a Python script (.py)",
    tested="run with YADE 2023.02a, compared with vibroimpact's drops between rigid bodies, "
    "oblique ones too",
    write=_write,
    notes=_notes,
    prepare=as_rigid,
)
