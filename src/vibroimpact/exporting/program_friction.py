"""Friction of a drop for programs with friction laws of their own, and the limitations of
such an export.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, replace

import numpy as np

from vibroimpact.bodies.rigid_bodies import rigid_plate
from vibroimpact.contact.friction.law import CompliantFriction, FrictionLaw
from vibroimpact.contact.friction.registry import find_friction_law
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.pair import hertz_stiffness
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import approach_speeds, laws_of_impacts
from vibroimpact.exporting.drop import Drop

COULOMB = dict.fromkeys(
    ("coulomb", "mdr", "mindlin", "mindlin-rescale", "mindlin-force"), "coulomb"
)
"""The friction laws for which Coulomb's stands in programs that have no other."""


def friction_in(drop: Drop, program: str, stands_for: Mapping[str, str]) -> FrictionLaw | None:
    """Return the friction law that a program has for that of a drop; None if there is no friction.

    Parameters
    ----------
    drop : Drop
        The drop.
    program : str
        Name of the program.
    stands_for : mapping of str to str
        Which friction law stands for which in the program, by their names: those that it has itself
        stand for themselves.

    Raises
    ------
    InputError
        If nothing stands for the friction law of the drop.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> coulomb = find_friction_law("coulomb")(coefficient=0.3)
    >>> friction_in(
    ...     SimpleNamespace(oblique=SimpleNamespace(friction=coulomb)),
    ...     "EXUDYN",
    ...     {"coulomb": "coulomb"},
    ... ).coefficient
    0.3
    """
    if drop.oblique is None or drop.oblique.friction is None:
        return None
    law = drop.oblique.friction
    if law.name not in stands_for:
        others = f"{', '.join(stands_for)} can"
        kinds = [find_friction_law(name) for name in stands_for.values()]
        if all(issubclass(kind, CompliantFriction) for kind in kinds):
            # their tangential stiffness follows from Hertz's contact radius
            others += ", with a contact law whose spring has the exponent 1.5"
        raise InputError(
            f"{law.name} can't be written for {program}; {others}", "contact.friction.law"
        )
    kind = find_friction_law(stands_for[law.name])
    return kind(**{item.name: getattr(law, item.name) for item in fields(kind)})


def spring_of_overlap(
    law: CompliantFriction, drop: Drop, stiffness: float, exponent: float
) -> float:
    r"""Return the tangential stiffness over the root of the overlap [N/m^1.5], from which a program
    takes the radius of the contact.

    Here that is Hertz's under the normal force, :math:`a = \sqrt{R D}`. For the spring :math:`K
    \delta^{3/2}` the two are
    proportional; for another exponent they agree at the largest overlap of the first impact,
    without damping.

    Parameters
    ----------
    law : CompliantFriction
        The friction law.
    drop : Drop
        The drop.
    stiffness, exponent : float
        Of the normal spring [N/m^n].
    """
    depth = (0.5 * (exponent + 1.0) * drop.mass * approach_speeds(drop)[0] ** 2 / stiffness) ** (
        1.0 / (exponent + 1.0)
    )
    hertz = float(hertz_stiffness(law.effective_modulus, law.effective_radius))
    wider = (stiffness * depth ** (exponent - 1.5) / hertz) ** (1.0 / 3.0)
    return float(2.0 * law.effective_shear_modulus * np.sqrt(law.effective_radius) * wider)


def coefficient_of(friction: FrictionLaw | None) -> float:
    """Return the coefficient of friction as a program takes it: zero without friction."""
    if friction is None:
        return 0.0
    return float(friction.coefficient)


def friction_notes(drop: Drop, program: str, written: FrictionLaw | None) -> list[str]:
    """Return the limitations of the motion along the plate in a program that has the
    friction law `written` for it.
    """
    if drop.oblique is None or drop.oblique.friction is None or written is None:
        return []
    law = drop.oblique.friction
    notes = []
    if written.name != law.name:
        notes += [
            f"{program} has no {law.name}; its {written.name} stands for it, which is the "
            "same as long as all of the contact slips.",
            f"The first impact ends at {_first_rebound(drop, written):.4g} m/s along the "
            f"plate under {written.name}, and at "
            f"{_first_rebound(drop, law):.4g} m/s under {law.name}.",
        ]
    hertz = isinstance(drop.laws[0], Hertz) and drop.laws[0].exponent == 1.5
    if isinstance(written, CompliantFriction) and not hertz:
        notes.append(
            f"{program} takes the radius of the contact from the overlap; here it follows "
            "from the normal force with its damping. "
            "Where the contact sticks, velocities along the plate differ."
        )
    if law.rolling_coefficient:
        given = f"contact.friction.rolling_coefficient, {law.rolling_coefficient:g},"
        notes.append(
            f"This input of {program} is written without rolling resistance: {given} is left out."
        )
    if isinstance(law, CompliantFriction) and drop.oblique.spin[2]:
        notes.append(f"{program} leaves the spin about the normal as it is.")
    return notes


def _first_rebound(drop: Drop, friction: FrictionLaw) -> float:
    """Return the velocity along the plate after the first impact under a friction law [m/s]."""
    assert drop.oblique is not None
    first = {name: float(values[0]) for name, values in drop.impacts.items()}
    oblique = replace(
        drop.oblique,
        velocity=(first["approach_velocity_x_m_s"], first["approach_velocity_y_m_s"]),
        spin=(
            first["spin_x_before_rad_s"],
            first["spin_y_before_rad_s"],
            first["spin_z_before_rad_s"],
        ),
        friction=friction,
        size=None,
    )
    problem = Problem(
        sphere=drop.ball,
        plate=rigid_plate(),
        laws=(laws_of_impacts(drop)[0],),
        speed=approach_speeds(drop)[0],
        gravity=drop.gravity,
        oblique=oblique,
        impacts=1,
    )
    impacts = simulate(problem).impacts
    return math.hypot(*(float(impacts[f"separation_velocity_{axis}_m_s"][0]) for axis in "xy"))
