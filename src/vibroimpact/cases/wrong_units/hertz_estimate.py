"""Estimates of the first impact by Hertz's theory, against which the values of a case are
checked.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from vibroimpact.cases.limits.conditions import Conditions, DropSummary
from vibroimpact.contact.pair import hertz_stiffness
from vibroimpact.contact.power_law import HERTZ_TIME
from vibroimpact.materials import Material
from vibroimpact.resolved_case import ResolvedCase


@dataclass(frozen=True)
class HertzEstimate:
    """Peak values of the first impact of a case by Hertz's theory without damping; NaN where they
    can't be estimated.

    Parameters
    ----------
    case : mapping
        A resolved case.
    """

    case: ResolvedCase

    @cached_property
    def _conditions(self) -> Conditions:
        return Conditions(self.case, DropSummary())

    @property
    def plate(self) -> Material:
        """Material of the plate."""
        return self._conditions.materials["plate"]

    @property
    def size(self) -> tuple[float, float, float]:
        """Length, width and thickness of the plate [m]."""
        size = self.case["plate"].get("size")
        if size is None:
            return (math.nan, math.nan, math.nan)
        return tuple(size)

    @property
    def across(self) -> float:
        """Larger of length and width of the plate [m]."""
        return max(self.size[:2])

    @property
    def radius(self) -> float:
        """Radius of the sphere [m]."""
        return float(self.case["sphere"]["radius"])

    @cached_property
    def mass(self) -> float:
        """Mass of the sphere [kg]."""
        return float(self._conditions.mass)

    @property
    def gravity(self) -> float:
        """Acceleration of gravity along the normal of the plate [m/s^2]."""
        inclination = self.case["plate"].get("inclination") or 0.0
        return float(self.case["drop"]["gravity"] * math.cos(inclination))

    @property
    def _upward(self) -> float:
        """Velocity along the normal at the start [m/s], upwards; zero if it falls from rest."""
        velocity = self.case["drop"].get("velocity")
        if velocity is None:
            return 0.0
        return float(velocity[2])

    @cached_property
    def speed(self) -> float:
        """Approach speed of the first impact [m/s]."""
        drop = self.case["drop"]
        if drop.get("speed") is not None:
            return float(drop["speed"])
        if drop.get("height") is None:
            return -self._upward
        return float(
            np.sqrt(self._upward**2 + 2.0 * self.gravity * max(drop["height"] - self.radius, 0.0))
        )

    @property
    def touch(self) -> float:
        """Time of the first touch of a plate that is not moved [s]."""
        if self.case["drop"].get("height") is None:
            return 0.0
        # gravity turns the velocity from upwards at the start to the speed downwards at touch
        return (self._upward + self.speed) / self.gravity

    @property
    def in_fluid(self) -> bool:
        """Whether air or a liquid slows the fall, which the estimates leave out."""
        return bool(self.case["drop"].get("air") or self.case["contact"].get("liquid"))

    @cached_property
    def stiffness(self) -> float:
        """Hertz's stiffness of the two bodies [N/m^1.5]."""
        stiffness = float(
            hertz_stiffness(self._conditions.modulus, self._conditions.effective_radius)
        )
        if not math.isfinite(stiffness):  # of rigid bodies
            return math.nan
        return stiffness

    @cached_property
    def depth(self) -> float:
        """Largest indentation [m]."""
        return math.pow(
            1.25 * float(self._conditions.effective_mass) * self.speed**2 / self.stiffness, 0.4
        )

    @property
    def force(self) -> float:
        """Largest force [N]."""
        return self.stiffness * math.pow(self.depth, 1.5)

    @property
    def contact_time(self) -> float:
        """Duration of the first contact [s]."""
        return HERTZ_TIME * self.depth / self.speed

    @property
    def critical_damping(self) -> float:
        """Critical damping of the sphere with the tangent stiffness of the contact at the
        largest indentation [N s/m].
        """
        return 2.0 * math.sqrt(self.mass * 1.5 * self.stiffness * math.sqrt(self.depth))

    @property
    def exponent(self) -> float:
        """Exponent of the elastic force of the law."""
        known: Mapping[str, Any] = self._conditions.law.__dataclass_fields__
        if "exponent" in known:
            return float(self._conditions.law_parameter("exponent", 1.5))
        if "stiffness" in known and "1.5" in known["stiffness"].metadata["unit"]:
            return 1.5
        return 1.0

    @property
    def derived_parameters(self) -> set[str]:
        """Names of the parameters of the law whose values equal those derived from the
        bodies, so that the user did not give them.
        """
        bodies = self._conditions.materials.values()
        strengths = [
            material.yield_strength for material in bodies if material.yield_strength is not None
        ]
        given = {
            "stiffness": [self.stiffness],
            "effective_modulus": [float(self._conditions.modulus)],
            "effective_mass": [float(self._conditions.effective_mass)],
            "effective_radius": [float(self._conditions.effective_radius)],
            "yield_strength": strengths,
            "yield_pressure": [1.6 * strength for strength in strengths],
        }
        contact = self.case["contact"]
        # a parameter may have one value for each impact
        own = {name: np.atleast_1d(contact.get(name, math.nan)) for name in given}
        return {
            name
            for name, values in given.items()
            if any(np.allclose(own[name], value, rtol=1e-9, atol=0.0) for value in values)
        }
