"""What is typed into programs of discrete elements for the contact of a drop, and the time step.

Each program takes damping from a restitution by a formula of its own; the number that is typed is
the one with which that formula gives the restitution of the drop's law at its first impact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from vibroimpact.bodies.ball import mean_density
from vibroimpact.contact.kelvin_voigt import (
    damping_ratio_from_restitution,
    restitution_from_damping_ratio,
)
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.linear_spring_dashpot import LinearSpringDashpot
from vibroimpact.contact.laws.tsuji import Tsuji
from vibroimpact.contact.laws.walton_braun import WaltonBraun
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import (
    approach_speeds,
    first_contact,
    first_impact,
    laws_of_impacts,
    linear_or_hertzian,
)
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.yade_damping import yade_damping

STEPS = 50
"""Steps in a contact with which a restitution is accurate to about 0.001 by velocity Verlet."""

EDEM_FRACTION = 0.2
"""Time step over Rayleigh's time, that of EDEM's automatic time step."""

LIGGGHTS_FRACTION = 0.1
"""Time step over Rayleigh's and over Hertz's time, that of the example in LIGGGHTS' manual."""

YADE_FRACTION = 0.5
"""Time step over that of the P-wave, of YADE's tutorial."""

SOFTENINGS = (1.0, 10.0, 100.0, 1000.0)
"""Factors by which the stiffness is divided."""


class Entry(NamedTuple):
    """A number that is typed into a program, and what it is there."""

    program: str
    model: str
    key: str
    value: float
    unit: str


class TimeStep(NamedTuple):
    """A time step of a program [s], by which rule, and how many there are in the contact."""

    program: str
    step: float
    steps_per_contact: float
    rule: str


@dataclass(frozen=True)
class DemContact:
    """The contact of a sphere with a plate that is held, as programs are told of it.

    Parameters
    ----------
    stiffness, exponent : float
        Of the spring K delta^n [N/m^n], n of 1 or 1.5.
    restitution : float
        Restitution at the speed of the first impact, without gravity.
    mass, radius, density : float
        Mass [kg], radius [m] and mean density [kg/m^3] of the sphere.
    poissons_ratio : float
        That of the sphere.
    speed : float
        Approach speed of the first impact [m/s].
    duration : float
        Contact time of the drop's law at this speed [s].
    """

    stiffness: float
    exponent: float
    restitution: float
    mass: float
    radius: float
    density: float
    poissons_ratio: float
    speed: float
    duration: float

    @property
    def is_hertzian(self) -> bool:
        """Whether the spring is Hertz's."""
        return self.exponent == 1.5

    @property
    def effective_modulus(self) -> float:
        """Effective modulus E* of Hertz's contact with the stiffness [Pa]."""
        return 0.75 * self.stiffness / math.sqrt(self.radius)

    @property
    def youngs_modulus(self) -> float:
        """Young's modulus of sphere and plate that together have the effective one [Pa]."""
        return 2.0 * self.effective_modulus * (1.0 - self.poissons_ratio**2)

    @property
    def law(self) -> ContactLaw:
        """The spring with the damping that a restitution gives in closed form, at any speed."""
        if self.is_hertzian:
            return Tsuji(
                stiffness=self.stiffness,
                restitution=self.restitution,
                effective_mass=self.mass,
            )
        return LinearSpringDashpot(
            stiffness=self.stiffness, restitution=self.restitution, effective_mass=self.mass
        )


def dem_contact(drop: Drop) -> DemContact:
    """Return the contact of a drop at its first impact.

    Raises
    ------
    InputError
        If its spring is not linear or Hertz's, or nothing rebounds.
    """
    speed = approach_speeds(drop)[0]
    law = laws_of_impacts(drop)[0]
    stiffness, exponent = linear_or_hertzian(drop, "programs of discrete elements")
    restitution = float(achieved_restitution(law, drop.mass, speed))
    if not restitution > 0.0:
        raise InputError("the sphere does not rebound in this run; there is no restitution to type")
    duration, _ = first_contact(law, drop)
    return DemContact(
        stiffness=stiffness,
        exponent=exponent,
        restitution=min(restitution, 1.0),
        mass=drop.mass,
        radius=drop.radius,
        density=float(mean_density(drop.mass, drop.radius)),
        poissons_ratio=float(drop.sphere_material.poissons_ratio),
        speed=speed,
        duration=duration,
    )


def entries(contact: DemContact) -> list[Entry]:
    """Return what is typed into each program.

    Examples
    --------
    >>> contact = DemContact(5e8, 1.5, 0.5, 0.09, 0.025, 1380.0, 0.3, 3.0, 2e-4)
    >>> [round(entry.value, 4) for entry in entries(contact) if entry.key == "DES_EN_WALL_INPUT(1)"]
    [0.4585]
    """
    makers = _HERTZIAN if contact.is_hertzian else _LINEAR
    return [entry for maker in makers for entry in maker(contact)]


def mfix_restitution(restitution: float) -> float:
    """Return the restitution that is typed for MFiX's Hertzian model to have one.

    Its damping is 2 beta sqrt(m K) delta^(1/4), with beta = -ln e / sqrt(pi^2 + ln^2 e), in place
    of sqrt(5) beta sqrt(m K) delta^(1/4), with which Hertz's spring has the restitution e (Antypov
    and Elliott 2011).

    Raises
    ------
    InputError
        If it is below 0.0019, which no number gives.

    Examples
    --------
    >>> round(mfix_restitution(0.5), 4)
    0.4585
    """
    ratio = 0.5 * math.sqrt(5.0) * float(damping_ratio_from_restitution(restitution))
    if not ratio < 1.0:
        raise InputError(
            f"MFiX's Hertzian model can't have a restitution of {restitution:.4g}: its damping "
            "would be more than critical"
        )
    return float(restitution_from_damping_ratio(ratio))


def time_steps(contact: DemContact) -> list[TimeStep]:
    """Return a time step for each program, by its own rule where its documentation has one.

    Examples
    --------
    >>> contact = DemContact(5e8, 1.5, 0.5, 0.09, 0.025, 1380.0, 0.3, 3.0, 2e-4)
    >>> [step.program for step in time_steps(contact)]
    ['LAMMPS', 'YADE', 'LIGGGHTS', 'EDEM', 'Rocky', 'MFiX']
    """
    part = contact.duration / STEPS
    own = f"contact time / {STEPS}"
    collision = "the program's own: its collision time / 50"
    steps = {"LAMMPS": (part, own)}
    if contact.is_hertzian:
        rayleigh = rayleigh_time(contact)
        steps |= {
            "YADE": (YADE_FRACTION * p_wave_time(contact), f"{YADE_FRACTION:g} PWaveTimeStep"),
            "LIGGGHTS": (
                LIGGGHTS_FRACTION * min(rayleigh, hertz_time(contact)),
                f"{LIGGGHTS_FRACTION:g} of Rayleigh's and of Hertz's time",
            ),
            "EDEM": (EDEM_FRACTION * rayleigh, f"{EDEM_FRACTION:g} of Rayleigh's time"),
        }
        collision = f"{collision}, with the stiffness at an overlap of 1 m"
    else:
        steps |= {"YADE": (part, own), "LIGGGHTS": (part, own)}
    steps |= {
        "Rocky": (part, f"{own}; the program sets its own unless told"),
        "MFiX": (mfix_collision_time(contact) / STEPS, collision),
    }
    return [
        TimeStep(program, step, contact.duration / step, rule)
        for program, (step, rule) in steps.items()
    ]


def rayleigh_time(contact: DemContact) -> float:
    """Return Rayleigh's time of the sphere with its typed modulus [s]."""
    shear_modulus = 0.5 * contact.youngs_modulus / (1.0 + contact.poissons_ratio)
    return (
        math.pi
        * contact.radius
        * math.sqrt(contact.density / shear_modulus)
        / (0.1631 * contact.poissons_ratio + 0.8766)
    )


def hertz_time(contact: DemContact) -> float:
    """Return the duration of Hertz's elastic contact, as LIGGGHTS has it [s]."""
    modulus = contact.effective_modulus
    return float(2.87 * (contact.mass**2 / (contact.radius * modulus**2 * contact.speed)) ** 0.2)


def p_wave_time(contact: DemContact) -> float:
    """Return the time of a P-wave over the radius with the modulus that YADE is given [s]."""
    return contact.radius * math.sqrt(contact.density / _yade_modulus(contact))


def mfix_collision_time(contact: DemContact) -> float:
    """Return the collision time of which MFiX takes a part, from the typed restitution [s].

    It is half the period of a damped linear spring, which with Hertz's stiffness in N/m^1.5 is that
    at an overlap of 1 m, and far shorter than the contact.
    """
    typed = contact.restitution
    if contact.is_hertzian:
        typed = mfix_restitution(typed)
    ratio = float(damping_ratio_from_restitution(typed))
    frequency = math.sqrt(contact.stiffness / contact.mass)
    return math.pi / (frequency * math.sqrt(1.0 - ratio**2))


class Softened(NamedTuple):
    """A contact with a lower stiffness and the same restitution.

    The factor by which the stiffness is divided; stiffness [N/m^n], contact time [s] and that over
    the one with the full stiffness; largest indentation over the radius, and largest force [N]; the
    restitution, simulated; and the modulus to type [Pa], NaN with a linear spring.
    """

    factor: float
    stiffness: float
    duration: float
    longer: float
    overlap: float
    force: float
    restitution: float
    youngs_modulus: float


def softened(contact: DemContact, drop: Drop) -> list[Softened]:
    """Return the contact with lower stiffnesses, at the same restitution.

    The contact time grows with the factor to the power 1/2 with a linear spring, 2/5 with Hertz's.
    """
    rows: list[Softened] = []
    for factor in SOFTENINGS:
        softer = replace(contact, stiffness=contact.stiffness / factor)
        impacts = first_impact(softer.law, drop)
        duration = float(impacts["duration_s"][0])
        modulus = softer.youngs_modulus if softer.is_hertzian else math.nan
        longer = duration / rows[0].duration if rows else 1.0
        rows.append(
            Softened(
                factor=factor,
                stiffness=softer.stiffness,
                duration=duration,
                longer=longer,
                overlap=float(impacts["max_indentation_m"][0]) / contact.radius,
                force=float(np.nanmax(impacts["max_force_N"])),
                restitution=float(impacts["restitution_achieved"][0]),
                youngs_modulus=modulus,
            )
        )
    return rows


def _yade_modulus(contact: DemContact) -> float:
    """Return the modulus of both bodies for YADE, to which a wall is a sphere of the same size."""
    poissons_ratio = contact.poissons_ratio
    return 1.5 * contact.stiffness * (1.0 - poissons_ratio**2) / math.sqrt(0.5 * contact.radius)


def _elastic_constants(
    contact: DemContact, program: str, model: str, keys: tuple[str, str]
) -> list[Entry]:
    """Return modulus and Poisson's ratio of sphere and plate."""
    modulus, ratio = keys
    return [
        Entry(program, model, modulus, contact.youngs_modulus, "Pa"),
        Entry(program, model, ratio, contact.poissons_ratio, ""),
    ]


def _lammps(contact: DemContact) -> list[Entry]:
    """Return the numbers of LAMMPS' granular models, whose Hertzian stiffness is over sqrt(R)."""
    if contact.is_hertzian:
        model = "granular hertz, damping coeff_restitution"
        stiffness = Entry(
            "LAMMPS", model, "kn", contact.stiffness / math.sqrt(contact.radius), "N/m^2"
        )
    else:
        model = "granular hooke, damping coeff_restitution"
        stiffness = Entry("LAMMPS", model, "kn", contact.stiffness, "N/m")
    return [stiffness, Entry("LAMMPS", model, "eta", contact.restitution, "")]


def _yade(contact: DemContact) -> list[Entry]:
    """Return the numbers of YADE's laws, which never pull."""
    damping = yade_damping(
        contact.stiffness, contact.exponent, contact.restitution, contact.mass, contact.speed
    )
    if contact.is_hertzian:
        model = "MindlinPhys"
        return [
            Entry("YADE", model, "young", _yade_modulus(contact), "Pa"),
            Entry("YADE", model, "poisson", contact.poissons_ratio, ""),
            Entry("YADE", model, "betan", damping, ""),
        ]
    model = "ViscElPhys_Basic"
    # springs and dashpots of two bodies are in series
    return [
        Entry("YADE", model, "kn", 2.0 * contact.stiffness, "N/m"),
        Entry("YADE", model, "cn", 2.0 * damping, "N s/m"),
    ]


def _liggghts_hertz(contact: DemContact) -> list[Entry]:
    model = "model hertz, limitForce off"
    return [
        *_elastic_constants(contact, "LIGGGHTS", model, ("youngsModulus", "poissonsRatio")),
        Entry("LIGGGHTS", model, "coefficientRestitution", contact.restitution, ""),
    ]


def _liggghts_hooke(contact: DemContact) -> list[Entry]:
    """Return the numbers of hooke/stiffness, whose damping is multiplied by the effective mass."""
    model = "model hooke/stiffness, limitForce off"
    ratio = float(damping_ratio_from_restitution(contact.restitution))
    gamma = 2.0 * ratio * math.sqrt(contact.stiffness / contact.mass)
    return [
        Entry("LIGGGHTS", model, "kn", contact.stiffness, "N/m"),
        Entry("LIGGGHTS", model, "gamman", gamma, "1/s"),
    ]


def _edem(contact: DemContact) -> list[Entry]:
    model = "Hertz-Mindlin (no slip)"
    return [
        *_elastic_constants(contact, "EDEM", model, ("Young's Modulus", "Poisson's Ratio")),
        Entry("EDEM", model, "Coefficient of Restitution", contact.restitution, ""),
    ]


def rocky_stiffness(contact: DemContact) -> float:
    """Return the stiffness of loading of a hysteretic linear spring with the same contact time.

    Loading takes a quarter of a period, and unloading a quarter of one that is shorter by the
    restitution. A linear spring keeps its own stiffness.
    """
    if not contact.is_hertzian:
        return contact.stiffness
    quarters = 0.5 * math.pi * (1.0 + contact.restitution)
    return contact.mass * (quarters / contact.duration) ** 2


def _rocky(contact: DemContact) -> list[Entry]:
    """Return the numbers of Rocky's hysteretic linear spring, that of Walton and Braun.

    Its stiffness is modulus times size, of sphere and plate in series.
    """
    model = "Hysteretic Linear Spring"
    stiffness = rocky_stiffness(contact)
    return [
        Entry("Rocky", model, "Young's Modulus", stiffness / contact.radius, "Pa"),
        Entry("Rocky", model, "Restitution Coefficient", contact.restitution, ""),
    ]


def rocky_law(contact: DemContact) -> WaltonBraun:
    """Return Rocky's hysteretic linear spring."""
    return WaltonBraun(stiffness=rocky_stiffness(contact), restitution=contact.restitution)


def _mfix_hertz(contact: DemContact) -> list[Entry]:
    model = 'DES_COLL_MODEL = "HERTZIAN"'
    return [
        Entry("MFiX", model, "E_YOUNG(1), EW_YOUNG", contact.youngs_modulus, "Pa"),
        Entry("MFiX", model, "V_POISSON(1), VW_POISSON", contact.poissons_ratio, ""),
        Entry("MFiX", model, "DES_EN_WALL_INPUT(1)", mfix_restitution(contact.restitution), ""),
    ]


def _mfix_linear(contact: DemContact) -> list[Entry]:
    model = 'DES_COLL_MODEL = "LSD"'
    return [
        Entry("MFiX", model, "KN_W", contact.stiffness, "N/m"),
        Entry("MFiX", model, "DES_EN_WALL_INPUT(1)", contact.restitution, ""),
    ]


_Maker = Callable[[DemContact], list[Entry]]

_HERTZIAN: tuple[_Maker, ...] = (_lammps, _yade, _liggghts_hertz, _edem, _rocky, _mfix_hertz)

_LINEAR: tuple[_Maker, ...] = (_lammps, _yade, _liggghts_hooke, _rocky, _mfix_linear)
