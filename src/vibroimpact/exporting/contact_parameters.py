"""Contact parameters of a drop for programs with contact laws of their own, and the
limitations of such an export.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from functools import cache

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.bodies.rigid_bodies import rigid_plate
from vibroimpact.contact.kelvin_voigt import KelvinVoigtLaw
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.adams_poisson import AdamsPoisson
from vibroimpact.contact.power_law import PowerLaw, SphereLaw
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.dynamics.restitution import law_achieving
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.exporting.drop import Drop
from vibroimpact.ranges import Range

_LOSSLESS = 1e-6
"""Energy that rounding takes, as a difference of the restitution from 1."""

_SHOWN = 5
"""Impacts whose restitution a note gives."""


def approach_speeds(drop: Drop) -> list[float]:
    """Return the approach speed of each impact of a drop between rigid bodies [m/s].

    Raises
    ------
    InputError
        If it has no impact, or gravity is zero.
    """
    assert drop.rigid is None, (
        "the approach speeds of what deforms are not those that rigid "
        "bodies have: take as_rigid(drop)"
    )
    if drop.gravity == 0.0:
        raise InputError(
            "there is no gravity in this run; a drop that is written for another program "
            "needs it, to come back"
        )
    speeds = [float(speed) for speed in drop.impacts["approach_speed_m_s"]]
    if not speeds:
        raise InputError(
            "the sphere does not reach the plate in this run; a drop that is written for "
            "another program needs an impact"
        )
    return speeds


def laws_of_impacts(drop: Drop) -> list[ContactLaw]:
    """Return the contact law of the first impact, the second, ..., with a fitted function evaluated
    at each approach speed.

    One law if it is the same for all impacts.
    """
    speeds = approach_speeds(drop)
    if drop.function is None:
        return list(drop.laws[: len(speeds)])
    return [law_at(drop.laws[0], *drop.function, speed) for speed in speeds]


def laws_at_impacts(problem: Problem, speeds: Floats) -> tuple[ContactLaw, ...]:
    """Return the contact laws of the impacts of a drop, with functions of the approach
    speed evaluated at those of its impacts [m/s].
    """
    if not problem.by_speed or not len(speeds):
        return problem.laws
    return tuple(
        problem.law_at(problem.law_of(impact), float(speed)) for impact, speed in enumerate(speeds)
    )


def law_at(law: ContactLaw, name: str, function: SpeedFunction, speed: float) -> ContactLaw:
    """Return a law whose parameter `name` is a function of the approach speed [m/s],
    evaluated there and clipped to its range.
    """
    allowed: Range = next(item for item in fields(law) if item.name == name).metadata["range"]
    return law.changed({name: float(allowed.clip(function(speed)))})


def power_law_spring(law: ContactLaw, program: str) -> tuple[float, float]:
    """Return stiffness [N/m^n] and exponent n of the elastic part K delta^n of a law.

    Raises
    ------
    InputError
        If its elastic part is not a power law of the indentation.

    Examples
    --------
    >>> from vibroimpact.contact.laws.hertz import Hertz
    >>> power_law_spring(Hertz(stiffness=5e8), "LAMMPS")
    (500000000.0, 1.5)
    """
    spring = spring_of(law)
    if spring is not None:
        return spring
    raise InputError(
        f"{law.name} can't be written for {program}: its spring is not K delta^n; take a "
        "law that has one, "
        'such as tsuji, with the restitution that "vibroimpact calibrate" finds'
    )


def spring_of(law: ContactLaw) -> tuple[float, float] | None:
    """Return stiffness [N/m^n] and exponent n of the elastic part K delta^n of a law; None if it
    has none.

    Examples
    --------
    >>> from vibroimpact.contact.laws.newton import Newton
    >>> spring_of(Newton(restitution=0.7))
    """
    if isinstance(law, PowerLaw):
        return float(law.stiffness), float(law.exponent)
    if isinstance(law, SphereLaw):
        return float(law.stiffness), 1.5
    if isinstance(law, KelvinVoigtLaw):
        return float(law.stiffness), 1.0
    if isinstance(law, AdamsPoisson):
        return float(law.penalty), 1.0
    return None


def linear_or_hertzian(drop: Drop, program: str) -> tuple[float, float]:
    """Return stiffness and exponent of the spring of all impacts, for a program that supports only
    the exponents 1 and 1.5.

    Raises
    ------
    InputError
        If the exponent is neither, or the spring changes from impact to impact.
    """
    springs = {power_law_spring(law, program) for law in laws_of_impacts(drop)}
    if len(springs) > 1:
        raise InputError(
            "the spring changes from impact to impact, which can't be written for "
            f"{program}; give it one value",
            f"contact.{_spring_key(drop)}",
        )
    stiffness, exponent = springs.pop()
    if exponent not in (1.0, 1.5):
        raise InputError(
            f"{exponent:g} can't be written for {program}, whose springs have 1 or 1.5",
            "contact.exponent",
        )
    return stiffness, exponent


def _spring_key(drop: Drop) -> str:
    """Return the parameter of the contact law of a drop that sets its spring, and changes
    from impact to impact.
    """
    names = [name for name in ("penalty", "exponent", "stiffness") if hasattr(drop.laws[0], name)]
    return next(
        (name for name in names if len({getattr(law, name) for law in drop.laws}) > 1), names[-1]
    )


def first_contact(law: ContactLaw, drop: Drop) -> tuple[float, float]:
    """Return duration [s] and peak force [N] of a contact at the drop's first approach
    speed, between rigid bodies without gravity.
    """
    impacts = first_impact(law, drop)
    return float(impacts["duration_s"][0]), float(np.nanmax(impacts["max_force_N"]))


def first_impact(law: ContactLaw, drop: Drop) -> dict[str, Floats]:
    """Return the impact table of a contact at the drop's first approach speed, between
    rigid bodies without gravity.
    """
    return simulate(
        Problem(
            sphere=drop.ball,
            plate=rigid_plate(),
            laws=(law,),
            speed=approach_speeds(drop)[0],
            gravity=0.0,
            impacts=1,
        )
    ).impacts


def shared_notes(drop: Drop) -> list[str]:
    """Return the limitations shared by all exports to rigid-body programs, among them a
    function used beyond its fitted speeds.
    """
    notes = [*drop.notes, *_rigid_notes(drop)]
    if drop.function is not None and drop.function[1].degree:
        name, function = drop.function
        speeds = function.beyond(np.array(approach_speeds(drop)))
        if speeds.size:
            fitted = (
                f"the function of {name} was fitted over {function.slowest:.4g} to "
                f"{function.fastest:.4g} m/s"
            )
            slowest = f"{speeds.min():.4g}"
            fastest = f"{speeds.max():.4g}"
            if slowest != fastest:
                impacts_of_drop = f"impacts at {slowest} to {fastest}"
            else:
                impacts_of_drop = f"an impact at {fastest}"
            notes.append(f"{fitted}, and this drop has {impacts_of_drop} m/s.")
    return notes


def _rigid_notes(drop: Drop) -> list[str]:
    """Return what the rigid-body version of a drop neglects, how that changes the
    restitution, and a remedy.
    """
    lost = []
    remedy = []
    if drop.elastic:
        verb = "is" if len(drop.elastic) == 1 else "are"
        lost.append(
            f"The {' and '.join(drop.elastic)} {verb} written as rigid, with the contact "
            "law alone, without vibration."
        )
        remedy.append('model = "rigid" and none of the keys of elastic bodies')
        if "plate" in drop.elastic:
            remedy.append("no [[sensors]]")
    if drop.local_element:
        lost.append(
            "The local element in series with the contact law, which stands for the "
            "sphere's deformation, is left out."
        )
        remedy.append("no contact.local_compliance")
    if drop.finite_sphere:
        lost.append(
            "The contact law is written with Hertz's half space for the sphere, whose "
            "finite size was corrected here."
        )
        remedy.append("no contact.finite_sphere")
    if not drop.original_impacts:
        return lost
    written = restitution_words(drop.impacts)
    original = restitution_words(drop.original_impacts)
    return [
        *lost,
        "The exported drop therefore differs from the one that was run: it is the same case "
        "between rigid bodies, with the first "
        "value of the contact law at its first impact, and so on; a parameter that depends "
        "on the approach speed has the value at its own.",
        f"Restitution from impact to impact: {written} as written, {original} in the run.",
        _remedy(drop, remedy),
    ]


def _remedy(drop: Drop, changes: list[str]) -> str:
    """Return the sentence on how to get rigid bodies that rebound as in the run, with
    these changes of its case.
    """
    if np.max(drop.original_impacts["restitution_achieved"], initial=0.0) > 1.0:
        return (
            "Rigid bodies can't rebound as in the run, where an impact has a restitution above 1."
        )
    needed = list(changes)
    if drop.laws[0].free_parameter is None:
        needed.append("a contact law with a loss parameter, such as tsuji")
    *first, last = needed
    if first:
        last = f"{', '.join(first)} and {last}"
    return (
        "For rigid bodies that rebound as in the run, export it with --match rebound, which "
        "takes Adams' IMPACT; or, to keep the law, calibrate the case with "
        f"{last} to the run's impacts.csv as [calibrate] "
        "target, and export the calibration."
    )


def restitution_words(impacts: Mapping[str, Floats]) -> str:
    """Return the restitutions of the first impacts of a table, in words.

    Examples
    --------
    >>> restitution_words({"restitution_achieved": np.array([0.7, 0.71])})
    '0.700, 0.710'
    """
    values = impacts["restitution_achieved"].tolist()
    if not values:
        return "none"
    shown = [f"{value:.3f}" for value in values[:_SHOWN]]
    if len(values) > _SHOWN:
        shown.append("...")
    return ", ".join(shown)


def is_lossless(impacts: Mapping[str, Floats]) -> bool:
    """Return whether no impact of a table between rigid bodies takes energy.

    Examples
    --------
    >>> is_lossless({"restitution_achieved": np.array([1.0, 0.9])})
    False
    """
    return bool(np.all(impacts["restitution_achieved"] > 1.0 - _LOSSLESS))


def unknown_damping_note(law: ContactLaw) -> str:
    """Return the sentence on a contact whose law takes no energy, and what tells its damping.

    Examples
    --------
    >>> from vibroimpact.contact.laws.hertz import Hertz
    >>> unknown_damping_note(Hertz(stiffness=5e8))[:52]
    'The law of this contact, hertz, takes no energy here'
    """
    return (
        f"The law of this contact, {law.name}, takes no energy here, so that nothing is known of "
        "the contact's own damping. A measured rebound tells it (vibroimpact calibrate). Without "
        "one, give the materials their yield_strength, of a metal its hardness over 2.8, run "
        "with contact.law = meyer, and export with --match rebound."
    )


def clipped_dashpot(
    stiffness: float, exponent: float, restitution: float, mass: float, speed: float
) -> float:
    r"""Return the dashpot c [N s/m] of :math:`F = \max(0, K \delta^n + c\,\dot\delta)` that
    achieves a restitution at a speed.

    Examples
    --------
    >>> round(clipped_dashpot(1e6, 1.0, 0.7, mass=0.1, speed=3.0), 2)
    77.3
    """
    depth = float((mass * speed**2 / stiffness) ** (1.0 / (exponent + 1.0)))
    return mass * speed / depth * _unit_dashpot(exponent, restitution)


@cache
def _unit_dashpot(exponent: float, restitution: float) -> float:
    """Return the dashpot for unit stiffness, mass and speed, from which `clipped_dashpot`
    scales.
    """
    # Adams' IMPACT with a negligible penetration of full damping is this clipped law
    law = AdamsImpact(
        stiffness=1.0, exponent=exponent, damping_max=1.0, full_damping_penetration=1e-7
    )
    return float(law_achieving(law, restitution, 1.0, 1.0).damping_max)
