"""The conditions under which the limits of the theory are evaluated.

They are the resolved case and the peak values of the drop.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.bodies.ball import ball_volume, mean_density
from vibroimpact.contact.elastic_plastic import ElasticPlasticLaw
from vibroimpact.contact.law import ContactLaw, InstantaneousLaw
from vibroimpact.contact.pair import effective_modulus, hertz_stiffness
from vibroimpact.contact.registry import find_contact_law
from vibroimpact.contact.speed_function import BySpeed, held, of_table
from vibroimpact.materials import RIGID, Material
from vibroimpact.resolved_case import ResolvedCase

# relative: a stiffness that differs by more was measured or fitted, and includes effects beyond
# Hertz's theory
_LIKE_HERTZ = 0.01

_OTHER_TABLES = {"friction", "liquid", "measured"}
"""Tables in the contact section of a case that are not parameters of the law."""


@dataclass(frozen=True)
class DropSummary:
    """Computed or expected peak values of a drop.

    Arrays have one value per drop, NaN where a value is not known.

    Parameters
    ----------
    force, depth : float or array
        Largest contact force [N] and largest indentation [m].
    duration, speed : float or array
        Duration of the first contact [s], or, if it consists of several micro-impacts, of one
        contact of the same depth; and approach speed of the first impact [m/s].
    deflection : float or array
        Largest deflection of an elastic plate at the contact point [m].
    modes : mapping of str to (float, float)
        By the name of an elastic body: estimated relative change of the largest force by the
        truncated modes, and highest frequency of the retained modes [Hz].
    changes : array, shape (impacts,)
        Sensitivity of a single drop on elastic bodies: relative change of each impact for a
        perturbation of the drop of `RELATIVE_CHANGE`, or of the tolerance if that is larger.
    plate_theory : float
        For a single drop on plate elements: estimated part by which its first largest force is too
        large due to plate theory.
    plate_mesh : float
        For a single drop on plate elements: estimated part by which its first largest force is too
        large due to the mesh.
    slowest : float or array
        Lowest approach speed of its impacts [m/s].
    """

    force: Array = math.nan
    depth: Array = math.nan
    duration: Array = math.nan
    speed: Array = math.nan
    deflection: Array = math.nan
    modes: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    changes: Array = 0.0
    plate_theory: Array = math.nan
    plate_mesh: Array = math.nan
    slowest: Array = math.nan


@dataclass(frozen=True)
class Conditions:
    """A drop, or a batch of drops, with its peak values.

    Parameters
    ----------
    case : ResolvedCase
        A resolved case; any number in it may be an array with one value per drop. Empty for a
        problem made in Python.
    summary : DropSummary
        Its peak values.
    """

    case: ResolvedCase
    summary: DropSummary

    @cached_property
    def materials(self) -> dict[str, Material]:
        """The materials of "sphere" and "plate"."""
        return {
            "sphere": _material(self.case["sphere"]["material"]),
            "plate": _material(self.case["plate"]["material"]),
        }

    @property
    def radius(self) -> Array:
        """Radius of the sphere [m]."""
        return self.case["sphere"]["radius"]

    @cached_property
    def mass(self) -> Array:
        """Mass of the sphere [kg]."""
        stated_mass = self.case["sphere"].get("mass")
        if stated_mass is not None:
            return stated_mass
        return ball_volume(np.asarray(self.radius)) * self.materials["sphere"].density

    @property
    def density(self) -> Array:
        """Mass of the sphere over its volume [kg/m^3]."""
        return mean_density(self.mass, self.radius)

    @cached_property
    def effective_radius(self) -> Array:
        """Effective radius of the pair [m].

        It is that of the sphere, or of two spheres if one replaces the plate.
        """
        radius_below = self.case["plate"].get("radius")
        if radius_below is None:
            return self.radius
        return self.radius * radius_below / (self.radius + radius_below)

    @cached_property
    def effective_mass(self) -> Array:
        """Effective mass of the pair [kg].

        It is that of the sphere, or the reduced mass if a free sphere replaces the plate.
        """
        plate = self.case["plate"]
        if "radius" not in plate or plate.get("supports") != "free":
            return self.mass
        mass_below = ball_volume(np.asarray(plate["radius"])) * self.materials["plate"].density
        return self.mass * mass_below / (self.mass + mass_below)

    @cached_property
    def modulus(self) -> Array:
        """Effective modulus of the pair [Pa]."""
        return effective_modulus(self.materials["sphere"], self.materials["plate"])

    @cached_property
    def contact_radius(self) -> Array:
        """Hertz's contact radius at the largest force [m]."""
        return np.cbrt(0.75 * self.summary.force * self.effective_radius / self.modulus)

    @cached_property
    def peak_pressure(self) -> Array:
        """Hertz's peak pressure at the largest force [Pa]."""
        return 1.5 * self.summary.force / (math.pi * self.contact_radius**2)

    @cached_property
    def law(self) -> type[ContactLaw]:
        """Class of the contact law."""
        return find_contact_law(self.case["contact"]["law"])

    def law_parameter(self, name: str, otherwise: Any = math.nan) -> Array:
        """Return a parameter of the contact law for the first impact."""
        value = self.case["contact"].get(name, otherwise)
        if isinstance(value, Mapping):  # a function of the approach speed
            return held(of_table(value), self.summary.speed)
        if isinstance(value, (list, tuple)):  # by impact
            return value[0]
        return value

    @cached_property
    def by_speed(self) -> dict[str, BySpeed]:
        """The parameters of the contact law that are functions of the approach speed."""
        return {
            key: of_table(value)
            for key, value in self.case["contact"].items()
            if isinstance(value, Mapping) and key not in _OTHER_TABLES
        }

    @property
    def yields(self) -> bool:
        """Whether the law models yielding, or gives no contact force at all."""
        return issubclass(self.law, (ElasticPlasticLaw, InstantaneousLaw))

    @property
    def hertz_ratio(self) -> Array:
        """Stiffness of the law over that of Hertz's contact of the bodies [-], as numbers."""
        return self.law_parameter("stiffness") / hertz_stiffness(
            self.modulus, self.effective_radius
        )

    @cached_property
    def is_hertzian(self) -> Array:
        """Whether the elastic force of the law is that of Hertz for these bodies."""
        if self.yields:
            return False
        contact = self.case["contact"]
        if "effective_modulus" in contact:
            return np.isfinite(self.modulus)
        if "stiffness" not in contact:
            return False
        # a law without an exponent is that of a sphere by the unit of its stiffness
        unit = self.law.__dataclass_fields__["stiffness"].metadata["unit"]
        if "exponent" not in contact and "1.5" not in unit:
            return False
        has_hertz_stiffness = abs(self.hertz_ratio - 1.0) < _LIKE_HERTZ
        return has_hertz_stiffness & (self.law_parameter("exponent", 1.5) == 1.5)

    def model(self, body: Literal["sphere", "plate"]) -> str:
        """Return whether "sphere" or "plate" is "rigid" or "elastic"."""
        return str(self.case[body].get("model", "rigid"))

    @property
    def size(self) -> Array:
        """Length, width and thickness of the plate [m]; None if not given."""
        return self.case["plate"].get("size")


def _material(table: Mapping[str, Any] | str) -> Material:
    """Return the material of a resolved case, in which "rigid" is the only name."""
    if isinstance(table, str):
        return RIGID
    return Material(**table)
