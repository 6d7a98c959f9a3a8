"""The motion along the plate and the friction of a drop for Adams, in millimetres,
kilograms, newtons, seconds and radians.
"""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.exporting.adams_contact import Names
from vibroimpact.exporting.adams_text import adams_number
from vibroimpact.exporting.contact_parameters import approach_speeds
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.program_friction import COULOMB, coefficient_of, friction_in

_CREEP = 1e-3
"""Slip beside which others must be large for all of the friction, over the first approach
speed: it rounds off Coulomb's law.
"""


@dataclass(frozen=True)
class AdamsMotion:
    """Velocity along the plate [mm/s], spin [rad/s] and gravity along the plate [mm/s^2],
    and Coulomb's friction; `creep` [mm/s].
    """

    velocity: tuple[float, float]
    spin: tuple[float, float, float]
    gravity: tuple[float, float]
    radius: float
    coefficient: float
    creep: float

    def variables(self, names: Names, force: str) -> dict[str, tuple[str, str]]:
        """Return reference and expression of each variable, by its name: the slip [mm/s], and
        friction over slip [N s/mm].

        `force`: the reference of the contact force.
        """
        measure = f"({names.centre}, {names.spot}, {names.spot}"
        radius = adams_number(self.radius)
        slip_x = f"VARVAL({names.slip_x})"
        slip_y = f"VARVAL({names.slip_y})"
        slip = f"SQRT({slip_x}**2 + {slip_y}**2 + {adams_number(self.creep)}**2)"
        pressing = f"MAX(SFORCE({force}, 0, 4, {names.spot}), 0.0)"
        return {
            "slip_x": (names.slip_x, f"VX{measure}, {names.spot}) - {radius} * WY{measure})"),
            "slip_y": (names.slip_y, f"VY{measure}, {names.spot}) + {radius} * WX{measure})"),
            "drag": (names.drag, f"{adams_number(self.coefficient)} * {pressing} / {slip}"),
        }

    def components(self, names: Names) -> list[str]:
        """Return the force on the centre along x, y and z [N], and the moment about them [N mm]."""
        drag_x = f"VARVAL({names.drag}) * VARVAL({names.slip_x})"
        drag_y = f"VARVAL({names.drag}) * VARVAL({names.slip_y})"
        radius = adams_number(self.radius)
        force = [f"-{drag_x}", f"-{drag_y}", "0.0"]
        moment = [f"-{radius} * {drag_y}", f"{radius} * {drag_x}", "0.0"]
        return force + moment

    def readings(self, names: Names) -> dict[int, tuple[str, str]]:
        """Return title and expression of each output, as `AdamsContact.readings` does."""
        measure = f"({names.centre}, {names.spot}, {names.spot}"
        along = {
            2: ("velocity_x", f"VX{measure}, {names.spot})"),
            3: ("velocity_y", f"VY{measure}, {names.spot})"),
        }
        return along | {
            6 + axis: (f"spin_{name}", f"W{name.upper()}{measure})")
            for axis, name in enumerate("xyz")
        }


def adams_motion(drop: Drop) -> AdamsMotion | None:
    """Return the motion along the plate of a drop for Adams; None if it has none.

    Raises
    ------
    InputError
        If Coulomb's friction can't stand for that of the drop.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> adams_motion(SimpleNamespace(oblique=None)) is None
    True
    """
    if drop.oblique is None:
        return None
    law = adams_friction(drop)
    velocity_x, velocity_y = map(float, drop.oblique.velocity)
    spin_x, spin_y, spin_z = map(float, drop.oblique.spin)
    gravity_x, gravity_y = map(float, drop.oblique.gravity)
    return AdamsMotion(
        velocity=(1e3 * velocity_x, 1e3 * velocity_y),
        spin=(spin_x, spin_y, spin_z),
        gravity=(1e3 * gravity_x, 1e3 * gravity_y),
        radius=1e3 * drop.radius,
        coefficient=coefficient_of(law),
        creep=1e3 * _CREEP * approach_speeds(drop)[0],
    )


def adams_friction(drop: Drop) -> FrictionLaw | None:
    """Return the friction law that is written for Adams; None without friction."""
    return friction_in(drop, "Adams", COULOMB)
