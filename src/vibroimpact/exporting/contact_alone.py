"""The contact of a drop for programs that have laws of their own: its spring, and what it loses."""

from __future__ import annotations

from dataclasses import fields
from functools import cache

import numpy as np

from vibroimpact.bodies.body import Body
from vibroimpact.bodies.rigid import rigid_plate
from vibroimpact.calibration.speed_function import SpeedFunction
from vibroimpact.contact.kelvin_voigt import KelvinVoigtLaw
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.adams_poisson import AdamsPoisson
from vibroimpact.contact.power_law import PowerLaw, SphereLaw
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.restitution import law_achieving
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.errors import InputError
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.rigid_notes import rigid_notes
from vibroimpact.ranges import Range


def approach_speeds(drop: Drop) -> list[float]:
    """Return the approach speed of each impact of a drop of rigid bodies [m/s].

    Raises
    ------
    InputError
        If it has no impact, or there is no gravity.
    """
    assert drop.rigid is None, "the approach speeds of what deforms are not those that rigid bodies have: take as_rigid(drop)"
    if drop.gravity == 0.0:
        raise InputError("there is no gravity in this run; a drop that is written for another program needs it, to come back")
    speeds = [float(speed) for speed in drop.impacts["approach_speed_m_s"]]
    if not speeds:
        raise InputError("the sphere does not reach the plate in this run; another program needs at least one impact to be told of")
    return speeds


def laws_of_impacts(drop: Drop) -> list[ContactLaw]:
    """Return the contact law of the first impact, the second, ..., with the value that a function has at its approach speed.

    There is one law if it is the same for all.
    """
    speeds = approach_speeds(drop)
    if drop.function is None:
        return list(drop.laws[: len(speeds)])
    return [law_at(drop.laws[0], *drop.function, speed) for speed in speeds]


def law_at(law: ContactLaw, name: str, function: SpeedFunction, speed: float) -> ContactLaw:
    """Return a law with the value that the function of its parameter `name` has at an approach speed [m/s], or the nearest allowed."""
    allowed: Range = next(item for item in fields(law) if item.name == name).metadata["range"]
    return law.changed({name: float(allowed.clip(function(speed)))})


def spring(law: ContactLaw, program: str) -> tuple[float, float]:
    """Return stiffness [N/m^n] and exponent n of the spring of a law.

    Raises
    ------
    InputError
        If it has none, or one that is not a power of the indentation.

    Examples
    --------
    >>> from vibroimpact.contact.laws.hertz import Hertz
    >>> spring(Hertz(stiffness=5e8), "LAMMPS")
    (500000000.0, 1.5)
    """
    if isinstance(law, PowerLaw):
        return float(law.stiffness), float(law.exponent)
    if isinstance(law, SphereLaw):
        return float(law.stiffness), 1.5
    if isinstance(law, KelvinVoigtLaw):
        return float(law.stiffness), 1.0
    if isinstance(law, AdamsPoisson):
        return float(law.penalty), 1.0
    raise InputError(
        f"{law.name} can't be written for {program}: its spring is not K delta^n; take a law that has one, "
        'such as tsuji, with the restitution that "vibroimpact calibrate" finds'
    )


def linear_or_hertzian(drop: Drop, program: str) -> tuple[float, float]:
    """Return stiffness and exponent of the spring of all impacts, for a program that has the exponents 1 and 1.5 alone.

    Raises
    ------
    InputError
        If the exponent is neither, or the spring changes from impact to impact.
    """
    springs = {spring(law, program) for law in laws_of_impacts(drop)}
    if len(springs) > 1:
        raise InputError(f"the spring changes from impact to impact, which can't be written for {program}; give it one value", "stiffness")
    stiffness, exponent = springs.pop()
    if exponent not in (1.0, 1.5):
        raise InputError(f"{exponent:g} can't be written for {program}, whose springs have 1 or 1.5", "exponent")
    return stiffness, exponent


def first_contact(law: ContactLaw, drop: Drop) -> tuple[float, float]:
    """Return how long a contact at the drop's first approach speed takes [s], and its largest force [N]; bodies rigid, no gravity."""
    ball = Body(mass=drop.mass, contact_offset=drop.radius)
    impacts = simulate(
        Problem(sphere=ball, plate=rigid_plate(), laws=(law,), speed=approach_speeds(drop)[0], gravity=0.0, impacts=1)
    ).impacts
    return float(impacts["duration_s"][0]), float(np.nanmax(impacts["max_force_N"]))


def shared_notes(drop: Drop) -> list[str]:
    """Return what no program with rigid bodies takes of a drop, and where its function is used beyond its speeds."""
    notes = rigid_notes(drop)
    if drop.function is not None and drop.function[1].degree:
        name, function = drop.function
        speeds = function.beyond(np.array(approach_speeds(drop)))
        if speeds.size:
            fitted = f"the function of {name} was fitted over {function.slowest:.4g} to {function.fastest:.4g} m/s"
            notes.append(f"{fitted}, and this drop has impacts at {speeds.min():.4g} to {speeds.max():.4g} m/s.")
    return notes


def clipped_dashpot(stiffness: float, exponent: float, restitution: float, mass: float, speed: float) -> float:
    r"""Return the dashpot c [N s/m] of :math:`F = \max(0, K \delta^n + c\,\dot\delta)` that achieves a restitution at a speed.

    Examples
    --------
    >>> round(clipped_dashpot(1e6, 1.0, 0.7, mass=0.1, speed=3.0), 2)
    77.3
    """
    depth = float((mass * speed**2 / stiffness) ** (1.0 / (exponent + 1.0)))
    return mass * speed / depth * _unit_dashpot(exponent, restitution)


@cache
def _unit_dashpot(exponent: float, restitution: float) -> float:
    """Return the same where stiffness, mass and speed are one, to which all others are alike."""
    # IMPACT, faded in over so little that it can't be seen
    law = AdamsImpact(stiffness=1.0, exponent=exponent, damping_max=1.0, full_damping_penetration=1e-7)
    return float(law_achieving(law, restitution, 1.0, 1.0).damping_max)
