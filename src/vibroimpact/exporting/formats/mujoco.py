"""MuJoCo: an MJCF model of a sphere above a plane; its soft contact is a linear spring
and dashpot.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

from vibroimpact.arrays import Array
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import (
    approach_speeds,
    clipped_dashpot,
    first_contact,
    laws_of_impacts,
    power_law_spring,
    shared_notes,
)
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, comment_lines, file_name
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
    law, speed = laws_of_impacts(drop)[0], approach_speeds(drop)[0]
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


@dataclass(frozen=True)
class _Motion:
    """How the sphere may move: its joint, coordinates and velocities at the start,
    gravity along the plate, and what is said of them.
    """

    joint: str
    place: str
    velocity: str
    gravity: str
    meaning: str


def _motion(drop: Drop) -> _Motion:
    """Return the motion along the normal alone, or that of a free body."""
    height, rising = float(drop.height), -float(drop.speed)
    if drop.oblique is None:
        joint = f'<joint name="height" type="slide" axis="0 0 1" ref="{height!r}"/>'
        meaning = (
            "The height of the sphere's centre above the plate is qpos[0], its velocity qvel[0]."
        )
        return _Motion(joint, repr(height), repr(rising), "0 0", meaning)
    if drop.oblique.friction is not None:
        raise InputError(
            f"{drop.oblique.friction.name} can't be written for MuJoCo, whose friction is "
            "viscous up to its cone, and changes the "
            "restitution of what slides; a drop without friction can be",
            "contact.friction",
        )
    return _Motion(
        '<freejoint name="motion"/>',
        _numbers(*drop.position, height, 1.0, 0.0, 0.0, 0.0),
        _numbers(*drop.oblique.velocity, rising, *drop.oblique.spin),
        _numbers(*drop.oblique.gravity),
        "The position of the sphere's centre is qpos[0:3], its velocity qvel[0:3], its "
        "angular velocity in its own axes qvel[3:6].",
    )


def _numbers(*values: Array) -> str:
    return " ".join(repr(float(value)) for value in values)


def _write(drop: Drop) -> Mapping[str, bytes]:
    linear, laws = _linear(drop), laws_of_impacts(drop)
    duration, force = first_contact(linear, drop)
    _, own_force = first_contact(laws[0], drop)
    length, width, _ = drop.plate_size or (0.0, 0.0, 0.0)  # zero means infinite extent
    x, y = (float(value) for value in drop.position)
    motion = _motion(drop)
    comment = f"""\
{plain_words(drop.name)}. Units: m, kg, s, N.
The contact law is {laws[0].name}: {laws[0].equation}
{comment_lines(_notes(drop)).replace("# ", "")}
solref = -(stiffness / mass), -(damping / mass) of the contact: {linear.stiffness:.9g} N/m and {linear.damping_max:.9g} N s/m.
Duration of the first contact {duration:.6g} s; largest force {force:.6g} N, where the law has {own_force:.6g} N.
{motion.meaning}"""
    comment = re.sub("-(?=-)", "- ", comment)  # two hyphens would end the XML comment
    text = f"""\
<!--
{comment}
-->
<mujoco model={quoteattr(plain_words(drop.name))}>
  <option timestep="{duration / _STEPS!r}" gravity="{motion.gravity} {-drop.gravity!r}" integrator="Euler" cone="elliptic"/>
  <default>
    <geom condim="1" solref="{-linear.stiffness / drop.mass!r} {-linear.damping_max / drop.mass!r}"
          solimp="{_IMPEDANCE} {_IMPEDANCE} 1 0.5 1"/>
  </default>
  <worldbody>
    <geom name="plate" type="plane" size="{0.5 * length!r} {0.5 * width!r} 1"/>
    <body name="sphere" pos="{x!r} {y!r} {drop.height!r}">
      {motion.joint}
      <inertial pos="0 0 0" mass="{drop.mass!r}" diaginertia="{_numbers(*[drop.inertia] * 3)}"/>
      <geom name="surface" type="sphere" size="{drop.radius!r}"/>
    </body>
  </worldbody>
  <keyframe>
    <key name="start" qpos="{motion.place}" qvel="{motion.velocity}"/>
  </keyframe>
</mujoco>
"""
    return {file_name(drop, ".xml"): text.encode()}


def _notes(drop: Drop) -> list[str]:
    laws, notes = laws_of_impacts(drop), shared_notes(drop)
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
    changing = (
        "; parameters that change from impact to impact can't be represented."
        if len(laws) > 1
        else "."
    )
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
