"""YADE: a Python script with one sphere above a wall."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.bodies.ball import mean_density
from vibroimpact.contact.friction.law import CompliantFriction, FrictionLaw
from vibroimpact.contact.kelvin_voigt import KelvinVoigtLaw, damping_ratio_from_restitution
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.tsuji import Tsuji
from vibroimpact.dynamics.oblique.statement import Oblique
from vibroimpact.dynamics.restitution import achieved_restitution, law_achieving
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

_FRICTION = dict.fromkeys(("mindlin-force", "mindlin", "mindlin-rescale", "mdr"), "mindlin-force")
"""The friction laws that can be written, and which stands for each."""

_PRINT_MOTION = """\
    (x, y, _), (about_x, about_y, about_z) = ball.state.vel, ball.state.angVel
    print(
        f"impact {impact + 1}: velocity along the plate {x:.9g} {y:.9g} m/s, "
        f"spin {about_x:.9g} {about_y:.9g} {about_z:.9g} rad/s"
    )
"""

_STEPS = 10_000
"""Steps in the first contact: accuracy 1e-4 of restitution and peak force, gravity apart,
which the damping is calibrated without.
"""


@dataclass(frozen=True, kw_only=True)
class _Clipped(Tsuji):
    """Tsuji's law as in YADE: without tension."""

    tension = "cut"  # type: ignore[assignment]

    def closed_form_restitution(self, mass: Array, speed: Array) -> None:
        """Return None: no closed form; the law is integrated."""


def _damping(law: ContactLaw, drop: Drop, speed: float) -> float:
    """Return the damping ratio betan of YADE's Mindlin law, or the dashpot of the linear
    law [N s/m], with the law's restitution.
    """
    stiffness, exponent = linear_or_hertzian(drop, "YADE")
    if isinstance(law, Hertz):
        return 0.0
    restitution = float(achieved_restitution(law, drop.mass, speed))
    if exponent == 1.0:
        return clipped_dashpot(stiffness, exponent, restitution, drop.mass, speed)
    clipped = _Clipped(stiffness=stiffness, restitution=restitution, effective_mass=drop.mass)
    # YADE refers the damping ratio to the tangent stiffness 3/2 K sqrt(delta)
    return math.sqrt(5.0 / 6.0) * float(
        damping_ratio_from_restitution(
            law_achieving(clipped, restitution, drop.mass, speed).restitution
        )
    )


def _linear(drop: Drop) -> bool:
    return linear_or_hertzian(drop, "YADE")[1] == 1.0


def _friction(drop: Drop) -> FrictionLaw | None:
    return friction_in(drop, "YADE", _FRICTION)


def _poissons_ratio(drop: Drop) -> float:
    """Return the Poisson's ratio with which YADE takes the tangential stiffness of the drop from
    the normal one.

    For two equal spheres they have the ratio 3 (1 - nu) / (2 - nu) over the root of the overlap.
    """
    law, (stiffness, exponent) = _friction(drop), linear_or_hertzian(drop, "YADE")
    if not isinstance(law, CompliantFriction):
        return float(drop.sphere_material.poissons_ratio)
    ratio = spring_of_overlap(law, drop, stiffness, exponent) / stiffness
    if exponent != 1.5 or ratio >= 2.0:
        words = (
            "can't be written for YADE unless the spring has the exponent 1.5, and a stiffness "
            "not far below Hertz's of the materials"
        )
        raise InputError(f"{law.name} {words}", "contact.friction")
    return (3.0 - 2.0 * ratio) / (3.0 - ratio)


def _inertia(drop: Drop) -> str:
    """Return the line that sets the moment of inertia of a sphere that is not solid, as
    which YADE takes it.
    """
    return (
        "" if drop.is_solid else f"ball.state.inertia = ({', '.join([repr(drop.inertia)] * 3)})\n"
    )


def _write(drop: Drop) -> Mapping[str, bytes]:
    laws, speeds = laws_of_impacts(drop), approach_speeds(drop)
    stiffness, _ = linear_or_hertzian(drop, "YADE")
    dampings = [_damping(law, drop, speed) for law, speed in zip(laws, speeds, strict=False)]
    duration, _ = first_contact(laws[0], drop)
    oblique = drop.oblique or Oblique()
    pull = tuple(map(float, oblique.gravity))
    along, spin = (
        ", ".join(repr(float(part)) for part in parts) for parts in (oblique.velocity, oblique.spin)
    )
    poisson, friction = _poissons_ratio(drop), _friction(drop)
    # YADE computes the mass from the density
    density = float(mean_density(drop.mass, drop.radius))
    # YADE combines the properties of two bodies; sphere and wall get values whose combination is
    # the contact's stiffness and damping
    if _linear(drop):
        comment = (
            "# springs and dashpots of sphere and wall are in series: each is twice the contact's"
        )
        material = (
            f"ViscElMat(kn={2.0 * stiffness!r}, cn=2.0 * DAMPING[0], ks=0.0, cs=0.0, "
            f"density={density!r}, frictionAngle=0.0)"
        )
        physics, law = "Ip2_ViscElMat_ViscElMat_ViscElPhys()", "Law2_ScGeom_ViscElPhys_Basic()"
        new_damping = "material.cn = 2.0 * damping"
    else:
        angle = math.atan(0.0 if friction is None else float(friction.coefficient))
        youngs = 1.5 * stiffness * (1.0 - poisson**2) / math.sqrt(0.5 * drop.radius)
        wall = "# YADE takes a wall as a sphere of the same size, here of the same material"
        comment = f"{wall}: this modulus gives the contact's stiffness, {stiffness:.9g} N/m^1.5"
        material = (
            f"FrictMat(young={youngs!r}, poisson={poisson!r}, density={density!r}, "
            f"frictionAngle={angle!r})"
        )
        physics, law = (
            "Ip2_FrictMat_FrictMat_MindlinPhys(betan=DAMPING[0], betas=0.0)",
            "Law2_ScGeom_MindlinPhys_Mindlin()",
        )
        new_damping = "physics.betan = damping"
    return {
        file_name(drop, "-yade.py"): f'''\
"""A sphere that falls on a plate, for YADE: yade -n -x FILE. Units: m, kg, s, N."""
# The contact law is {laws[0].name}: {laws[0].equation}
# The case "{plain_words(drop.name)}"
{comment_lines(_notes(drop))}
import math

RADIUS, MASS, GRAVITY = {drop.radius!r}, {drop.mass!r}, {drop.gravity!r}
HEIGHT, SPEED = {drop.height!r}, {drop.speed!r}  # of the centre above the plate, and downwards
PULL = {pull!r}  # gravity along the plate
IMPACTS = {len(speeds)}
CONTACT = {duration!r}  # about how long a contact takes, s
# of each impact, the last goes on: {"N s/m" if _linear(drop) else "part of the critical damping"}
DAMPING = {dampings!r}

{comment}
material = {material}
O.materials.append(material)
O.bodies.append(wall(0, axis=2, sense=1, material=material))
O.bodies.append(sphere((0, 0, HEIGHT), RADIUS, material=material))
ball = O.bodies[1]  # its mass is that of the density
{_inertia(drop)}physics = {physics}
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=RADIUS),
    InteractionLoop([Ig2_Wall_Sphere_ScGeom()], [physics], [{law}]),
    NewtonIntegrator(damping=0, gravity=(*PULL, -GRAVITY)),
]
O.dt = CONTACT / {_STEPS}

ball.state.vel, ball.state.angVel = ({along}, -SPEED), ({spin})
gap, velocity = HEIGHT - RADIUS, -SPEED
for impact in range(IMPACTS):
    # the flight is known: it ends at first touch with this speed
    approach = math.sqrt(velocity**2 + 2.0 * GRAVITY * gap)
    flight = (velocity + approach) / GRAVITY
    x, y = (ball.state.vel[axis] + PULL[axis] * flight for axis in (0, 1))
    ball.state.pos, ball.state.vel = (0, 0, RADIUS), (x, y, -approach)
    damping = DAMPING[min(impact, len(DAMPING) - 1)]
    {new_damping}
    largest = 0.0
    for step in range({20 * _STEPS}):
        O.step()
        gap, velocity = ball.state.pos[2] - RADIUS, ball.state.vel[2]
        if gap > 0.0 and velocity > 0.0:
            break
        largest = max(largest, O.forces.f(1)[2])
    else:
        print("the sphere stays in contact")
        break
    speed = math.sqrt(velocity**2 + 2.0 * GRAVITY * gap)
    rebound = RADIUS + speed**2 / (2.0 * GRAVITY)
    print(
        f"impact {{impact + 1}}: approach speed {{approach:.9g}} m/s, restitution {{speed / approach:.9g}}, "
        f"rebound height {{rebound:.9g}} m, largest force {{largest:.9g}} N"
    )
{_PRINT_MOTION if drop.oblique else ""}'''.encode()
    }


def _notes(drop: Drop) -> list[str]:
    law, notes = drop.laws[0], [*shared_notes(drop), *friction_notes(drop, "YADE", _friction(drop))]
    if _friction(drop) is not None:
        part = 100.0 * float(drop.impacts["max_indentation_m"].max()) / drop.radius
        notes.append(
            "YADE's friction has the arm of the radius less the overlap, so that it "
            f"changes the spin by up to {part:.2g} % less."
        )
    if isinstance(law, Hertz):
        return notes
    name = "Law2_ScGeom_ViscElPhys_Basic" if _linear(drop) else "Law2_ScGeom_MindlinPhys_Mindlin"
    own = isinstance(law, (Tsuji, KelvinVoigtLaw))
    several = len(laws_of_impacts(drop)) > 1
    where = "the speed of each impact of this drop" if several else "the first impact's speed"
    notes.append(
        f"YADE's {name} stands for {law.name}; it "
        f"{'differs in that it never pulls' if own else 'has another damping'}, so forces within "
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
