"""The contact force of a drop as Adams run-time expressions, in millimetres, kilograms,
newtons and seconds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.registry import contact_laws
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.errors import InputError
from vibroimpact.exporting.adams_text import adams_number
from vibroimpact.exporting.contact_parameters import approach_speeds
from vibroimpact.exporting.drop import Drop

_ANY_PENETRATION = 1e-4
"""Penetration of full damping of laws without damping [m]; IMPACT requires a positive one."""


class Names(NamedTuple):
    """References to markers, sensor and variables in the expressions: numbers in a
    dataset, names in Adams View.
    """

    centre: str
    spot: str
    sensor: str
    speed: str
    damping: str
    slip_x: str
    slip_y: str
    drag: str

    @property
    def height(self) -> str:
        """Height of the sphere's centre above the plate [mm]."""
        return f"DZ({self.centre}, {self.spot}, {self.spot})"

    @property
    def velocity(self) -> str:
        """Upward velocity of the sphere's centre [mm/s]."""
        return f"VZ({self.centre}, {self.spot}, {self.spot}, {self.spot})"


@dataclass(frozen=True)
class AdamsContact:
    """A contact law in Adams' units; its methods return expressions for given `Names`.

    `damping` is the coefficient C [N s/mm] of IMPACT, or the factor D [-] of a hysteretic law: a
    number, or an expression of `speed`, the stored approach speed [mm/s]; `meaning` describes it in
    words. `penetration`, that of full damping [mm], is None for a hysteretic law.
    """

    radius: float
    gravity: float
    first_speed: float
    stiffness: float
    exponent: float
    penetration: float | None
    damping: str
    varies: bool
    meaning: str

    @property
    def holds_speed(self) -> bool:
        """Whether the force depends on the approach speed of the current contact, which a
        sensor then stores.
        """
        return self.varies or self.penetration is None

    def gap(self, names: Names) -> str:
        """Return the gap between the surfaces [mm], negative in contact."""
        return f"{names.height} - {adams_number(self.radius)}"

    def coming_speed(self, names: Names) -> str:
        """Return the approach speed of the next contact [mm/s], from the energy, which is
        constant during free flight.
        """
        return (
            f"SQRT({names.velocity}**2 + {adams_number(2.0 * self.gravity)} * "
            f"MAX({self.gap(names)}, 0.0))"
        )

    def held_speed(self, names: Names) -> str:
        """Return the stored approach speed of the current contact [mm/s]; that of the
        first contact until the sensor fires.
        """
        first = adams_number(self.first_speed)
        return f"IF(SENVAL({names.sensor}): {first}, {first}, SENVAL({names.sensor}))"

    def damping_now(self, names: Names) -> str:
        """Return the damping as an expression of the stored approach speed."""
        return self.damping.replace("speed", f"VARVAL({names.speed})")

    def force(self, names: Names) -> str:
        """Return the contact force [N]."""
        height = names.height
        velocity = names.velocity
        radius = adams_number(self.radius)
        stiffness = adams_number(self.stiffness)
        exponent = adams_number(self.exponent)
        damping = self.damping
        if self.varies:
            damping = f"VARVAL({names.damping})"
        if self.penetration is not None:
            return (
                f"IMPACT({height}, {velocity}, {radius}, {stiffness}, {exponent}, {damping}, "
                f"{adams_number(self.penetration)})"
            )
        return (
            f"{stiffness} * MAX({radius} - {height}, 0.0)**{exponent} * (1.0 - {damping} * "
            f"{velocity} / VARVAL({names.speed}))"
        )

    def readings(self, names: Names, force: str) -> dict[int, tuple[str, str]]:
        """Return title and expression of each output, by the column of an Adams request, whose
        first and fifth are magnitudes.

        Height [mm], velocity [mm/s] and contact force [N] (the force element `force`); approach
        speed and damping if they are stored.
        """
        outputs = {
            2: ("height", names.height),
            3: ("velocity", names.velocity),
            4: ("force", f"SFORCE({force}, 0, 4, {names.spot})"),
        }
        if self.holds_speed:
            outputs[6] = ("approach_speed", f"VARVAL({names.speed})")
        if self.varies:
            outputs[7] = ("damping", f"VARVAL({names.damping})")
        return outputs


def adams_contact(drop: Drop) -> AdamsContact:
    """Return the contact law of a drop for Adams.

    Raises
    ------
    InputError
        If its law is not supported, or changes from impact to impact in more than its damping.

    Examples
    --------
    >>> from vibroimpact.materials import find_material
    >>> steel, law = find_material("steel"), AdamsImpact(stiffness=1e9, damping_max=150.0)
    >>> drop = Drop(
    ...     name="a drop",
    ...     radius=0.025,
    ...     mass=0.1,
    ...     sphere_material=steel,
    ...     plate_material=steel,
    ...     height=1.0,
    ...     gravity=9.8,
    ...     laws=(law,),
    ...     end_time=1.0,
    ...     impacts={"approach_speed_m_s": np.array([4.4])},
    ... )
    >>> round(adams_contact(drop).stiffness, 6), adams_contact(drop).damping
    (31622.776602, '0.15')
    """
    speeds = approach_speeds(drop)
    laws = drop.laws[: len(speeds)]
    law = laws[0]
    if not isinstance(law, (AdamsImpact, Hertz, HystereticLaw)):
        hysteretic = ", ".join(
            name for name, kind in contact_laws().items() if issubclass(kind, HystereticLaw)
        )
        raise InputError(
            f"{law.name} can't be written for Adams; adams-impact, hertz and the laws with "
            f"hysteretic damping ({hysteretic}) can. "
            '"vibroimpact calibrate" finds the damping of adams-impact that achieves the '
            "same restitution"
        )
    # damping that changes from impact to impact becomes an expression of the approach speed, by
    # which the impacts are distinguished
    dampings = [_damping(of_impact, speed) for of_impact, speed in zip(laws, speeds, strict=False)]
    by_speed = isinstance(law, HuntCrossley) and law.dissipation is not None and len(laws) == 1
    varies = drop.function is not None or by_speed or len(set(dampings)) > 1
    if drop.function is not None:
        damping, meaning = _by_function(law, *drop.function)
    elif by_speed:  # the stored speed is in mm/s
        damping = f"{adams_number(dampings[0] / (1000.0 * speeds[0]))} * speed"
        meaning = "the dissipation times the approach speed"
    elif varies:
        damping, meaning = _by_steps(dampings, speeds, impact_law=isinstance(law, AdamsImpact))
    else:
        damping = adams_number(dampings[0])
        meaning = "the same in every impact"
    for of_impact in laws[1:]:
        if _stiffness_terms(of_impact) != _stiffness_terms(law):
            raise InputError(
                "Adams' contact can change its damping from impact to impact, and nothing else",
                "contact",
            )
    stiffness, exponent, penetration = _stiffness_terms(law)
    fall = max(drop.height - drop.radius, 0.0)
    first_speed = float(np.sqrt(drop.speed**2 + 2.0 * drop.gravity * fall))
    # from SI to mm, N and s
    if penetration is not None:
        penetration *= 1e3
    return AdamsContact(
        radius=1e3 * drop.radius,
        gravity=1e3 * drop.gravity,
        first_speed=1e3 * first_speed,
        stiffness=stiffness / 1000.0**exponent,
        exponent=exponent,
        penetration=penetration,
        damping=damping,
        varies=varies,
        meaning=meaning,
    )


def _stiffness_terms(law: ContactLaw) -> tuple[float, float, float | None]:
    """Return stiffness [N/m^n], exponent and penetration of full damping [m]."""
    assert isinstance(law, (AdamsImpact, Hertz, HystereticLaw))
    if isinstance(law, HystereticLaw):
        penetration = None
    else:
        penetration = float(getattr(law, "full_damping_penetration", _ANY_PENETRATION))
    return float(law.stiffness), float(law.exponent), penetration


def _damping(law: ContactLaw, speed: float) -> float:
    """Return the largest damping coefficient [N s/mm], or the damping factor of a
    hysteretic law at an approach speed [m/s] [-].
    """
    if isinstance(law, HystereticLaw):
        return float(law.damping_factor_at(speed))
    return float(getattr(law, "damping_max", 0.0)) / 1000.0


def _by_function(law: ContactLaw, name: str, function: SpeedFunction) -> tuple[str, str]:
    """Return the damping as a polynomial of the stored approach speed, clipped at zero
    since IMPACT requires it.
    """
    if not (isinstance(law, AdamsImpact) and name == "damping_max"):
        raise InputError(
            f"of {law.name}, {name} as a function of the approach speed can't be written "
            "for Adams; damping_max of adams-impact can"
        )
    # from N s/m over (m/s)^k to N s/mm over (mm/s)^k
    factors = [
        coefficient / 1000.0 ** (power + 1)
        for power, coefficient in enumerate(function.coefficients)
    ]
    polynomial = adams_number(factors[-1])
    for factor in factors[-2::-1]:
        polynomial = f"{adams_number(factor)} + speed * ({polynomial})"
    fitted = f"{function.slowest:.4g} to {function.fastest:.4g} m/s"
    return f"MAX({polynomial}, 0.0)", f"a polynomial of the approach speed, fitted over {fitted}"


def _by_steps(
    dampings: Sequence[float], speeds: Sequence[float], *, impact_law: bool
) -> tuple[str, str]:
    """Return the damping as a step function of the stored approach speed, with edges
    midway between the speeds of the impacts.
    """
    remedy = "give one damping for all"
    if impact_law:
        remedy += ", or damping_max as a function of the speed"
    for impact, (fast, slow) in enumerate(pairwise(speeds[: len(dampings)]), 1):
        if not slow < fast:
            raise InputError(
                f"impact {impact + 1} is not slower than impact {impact}, so that Adams "
                f"can't select their dampings by the approach speed; {remedy}",
                "contact",
            )
    steps = adams_number(dampings[-1])
    for damping, (fast, slow) in reversed(list(zip(dampings[:-1], pairwise(speeds), strict=False))):
        edge = adams_number(1000.0 * 0.5 * (fast + slow))
        steps = f"IF(speed - {edge}: {steps}, {adams_number(damping)}, {adams_number(damping)})"
    return (
        steps,
        "one value an impact, selected by the approach speed; the edges lie midway between "
        "the speeds of neighbouring impacts",
    )
