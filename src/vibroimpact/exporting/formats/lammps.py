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
from vibroimpact.dynamics.oblique.statement import Oblique
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import (
    approach_speeds,
    clipped_dashpot,
    first_contact,
    laws_of_impacts,
    linear_or_hertzian,
    shared_notes,
)
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, comment_lines, file_name
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

_MOTION_ALONG_THE_PLATE = """\
print           "impact $(v_impact:%.0f): velocity along the plate $(vx[1]:%.9g) $(vy[1]:%.9g) m/s, &
spin $(C_spin[1][1]:%.9g) $(C_spin[1][2]:%.9g) $(C_spin[1][3]:%.9g) rad/s"
"""

_STEPS = 20_000
"""Steps in the first contact: restitution and peak force are then accurate to 5e-5
(LAMMPS damps half a step late).
"""


@dataclass(frozen=True)
class _Normal:
    """A law in LAMMPS: damping model, its coefficient, whether the force is clipped at
    zero, and whether it is the same law.
    """

    damping: str
    coefficient: float
    clipped: bool
    exact: bool


def _normal(law: ContactLaw, drop: Drop, speed: float) -> _Normal:
    """Return the damping model of a law; if LAMMPS lacks it, the nearest one with the
    same restitution at a speed.
    """
    stiffness, exponent = linear_or_hertzian(drop, "LAMMPS")
    if isinstance(law, Hertz):
        return _Normal("velocity", 0.0, False, True)
    if isinstance(law, KelvinVoigtLaw):
        return _Normal("velocity", float(law.dashpot), False, True)
    if isinstance(law, KuwabaraKono):
        # LAMMPS' damping force is eta m a v with the contact radius a = sqrt(R delta)
        eta = 1.5 * stiffness * float(law.dissipation_time) / (drop.mass * math.sqrt(drop.radius))
        return _Normal("viscoelastic", eta, True, True)
    restitution = float(achieved_restitution(law, drop.mass, speed))
    # its dashpot is constant except over the penetration of full damping (typically 0.1 mm)
    if isinstance(law, AdamsImpact):
        return _Normal(
            "velocity",
            clipped_dashpot(stiffness, exponent, restitution, drop.mass, speed),
            True,
            False,
        )
    return _Normal("coeff_restitution", restitution, False, isinstance(law, Tsuji))


def _normals(drop: Drop) -> list[_Normal]:
    return [
        _normal(law, drop, speed)
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


def _tangential(drop: Drop) -> str:
    """Return the tangential model of the wall; without friction one that exerts no force."""
    law = _friction(drop)
    if not isinstance(law, CompliantFriction):
        return "linear_nohistory 0.0 0.0"
    # LAMMPS multiplies by the radius of the contact
    stiffness = spring_of_overlap(law, drop, *linear_or_hertzian(drop, "LAMMPS")) / math.sqrt(
        drop.radius
    )
    return f"{_TANGENTIAL[law.name]} {stiffness!r} 0.0 {float(law.coefficient)!r}"


def _write(drop: Drop) -> Mapping[str, bytes]:
    laws, normals, speeds = laws_of_impacts(drop), _normals(drop), approach_speeds(drop)
    stiffness, exponent = linear_or_hertzian(drop, "LAMMPS")
    # the stiffness of "hertz" is multiplied by sqrt(R) in LAMMPS
    model, spring = (
        ("hooke", stiffness) if exponent == 1.0 else ("hertz", stiffness / math.sqrt(drop.radius))
    )
    duration, _ = first_contact(laws[0], drop)
    coefficients = [normal.coefficient for normal in normals]
    coefficients += coefficients[-1:] * (len(speeds) - len(coefficients))
    clip = " limit_damping" if normals[0].clipped else ""
    # the box must contain the sphere at its largest height; along the plate it goes on periodically
    top = max(drop.height, drop.radius + max(speeds) ** 2 / (2.0 * drop.gravity)) + drop.radius
    oblique = drop.oblique or Oblique()
    velocity, spin = (
        " ".join(repr(float(part)) for part in parts) for parts in (oblique.velocity, oblique.spin)
    )
    pull = (*map(float, oblique.gravity), -drop.gravity)
    density = float(mean_density(drop.mass, drop.radius))
    text = f"""\
# The case "{plain_words(drop.name)}"
# A sphere that falls on a plate, for LAMMPS with its package GRANULAR: lmp -in FILE. Units: m, kg, s, N.
# The contact law is {laws[0].name}: {laws[0].equation}
{comment_lines(_notes(drop))}
units           si
atom_style      sphere
atom_modify     map array
boundary        p p f
comm_modify     cutoff {4.0 * drop.radius!r}

variable        radius equal {drop.radius!r}
variable        gravity equal {drop.gravity!r}
region          space block {-2.0 * top!r} {2.0 * top!r} {-2.0 * top!r} {2.0 * top!r} 0.0 {2.0 * top!r}
create_box      1 space
create_atoms    1 single 0.0 0.0 {drop.height!r}
set             group all diameter {2.0 * drop.radius!r}
set             group all density {density!r}  # a mass of {drop.mass!r} kg
set             group all omega {spin}
velocity        all set {velocity} {-drop.speed!r}
fix             motion all nve/sphere
fix             weight all gravity {math.hypot(*pull)!r} vector {" ".join(map(repr, pull))}

# of each impact; the unit is that of the damping model
variable        coefficient vector [{",".join(map(repr, coefficients))}]
variable        gap equal z[1]-v_radius
variable        rate equal vz[1]
variable        speed_at_touch equal sqrt(v_rate*v_rate+2.0*v_gravity*v_gap)
variable        contact_force equal fz[1]+mass[1]*v_gravity
variable        apart equal (v_gap>0.0)&&(v_rate>0.0)
compute         spin all property/atom omegax omegay omegaz
thermo          1000000

variable        impact loop {len(speeds)}
label           next_impact

# the flight: its end is known, and constant acceleration is integrated without error
if "$(v_gap) > 0.0" then &
  "variable step equal $((v_rate+v_speed_at_touch)/v_gravity/1000)" &
  "timestep ${{step}}" &
  "run 1000"
variable        approach equal $(v_speed_at_touch)

# the contact
timestep        {duration / _STEPS!r}  # {_STEPS} steps in the first
fix             plate all wall/gran granular {model} {spring!r} $(v_coefficient[v_impact]) damping {normals[0].damping}{clip} &
                tangential {_tangential(drop)} zplane 0.0 NULL
fix             forces all vector 1 v_contact_force
fix             until all halt 1 v_apart > 0.5 error continue message no
run             {20 * _STEPS}
print           "impact $(v_impact:%.0f): approach speed $(v_approach:%.9g) m/s, restitution $(v_speed_at_touch/v_approach:%.9g), &
rebound height $(v_radius+v_speed_at_touch*v_speed_at_touch/(2.0*v_gravity):%.9g) m, largest force $(max(f_forces):%.9g) N"
{_MOTION_ALONG_THE_PLATE if drop.oblique else ""}\
unfix           until
unfix           forces
unfix           plate
if "$(v_apart) < 0.5" then "print 'the sphere stays in contact'" quit
next            impact
jump            SELF next_impact
"""
    return {file_name(drop, ".in"): text.encode()}


def _notes(drop: Drop) -> list[str]:
    law, normals, speeds = laws_of_impacts(drop)[0], _normals(drop), approach_speeds(drop)
    notes = [*shared_notes(drop), *friction_notes(drop, "LAMMPS", _friction(drop))]
    if not drop.is_solid:
        notes.append(
            "LAMMPS has the moment of inertia of a solid sphere, which does not matter "
            "without friction."
        )
    where = (
        f"{speeds[0]:.6g} m/s, the speed of the first impact"
        if len(normals) == 1
        else "the speed of each impact of this drop"
    )
    if not normals[0].exact:
        spring = "hooke" if linear_or_hertzian(drop, "LAMMPS")[1] == 1.0 else "hertz"
        notes.append(
            f"LAMMPS has no {law.name}; its {spring} with damping {normals[0].damping} "
            "stands for it, so forces within the contact differ."
        )
        if normals[0].damping == "velocity":
            notes.append(f"Its restitution is the law's at {where}; at others it differs somewhat.")
    if isinstance(law, HuntCrossley) and law.dissipation is not None:
        notes.append(
            f"Its restitution is the law's at {where}, and at others stays the same; that "
            "of the law rises to 1 where it slows down."
        )
    if _friction(drop) is not None and normals[0].coefficient and not normals[0].clipped:
        notes.append(
            "Where LAMMPS' normal force pulls, at the end of a "
            "contact, friction follows its magnitude."
        )
    if len(normals) > 1:
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
