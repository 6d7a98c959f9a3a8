"""Mixins with the parameters or the state that laws of different families share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.choice import where
from vibroimpact.contact.law import CompliantLaw, ContactLaw, Levels, ScalarCompressed, ScalarLevels
from vibroimpact.contact.parameters import memory, parameter


@scalar
def _two_phase_levels(coefficients: Any) -> Levels:
    return 0.0, 0.0, where(coefficients[2] > 0.0, np.inf, 0.0), np.inf, np.inf


@scalar
def _turn(deepest: Array, coefficients: Any, changed: Any) -> Array:
    changed[1] = where(deepest > 0.0, coefficients[3], coefficients[1])
    changed[2] = where(deepest > 0.0, 1.0, coefficients[2])
    return where(changed[2] > 0.0, np.inf, 0.0)


@dataclass(frozen=True, kw_only=True)
class ElasticPairLaw(ContactLaw):
    """Mixin of the laws that take the effective modulus and radius of the two bodies."""

    effective_modulus: Array = parameter(
        "effective modulus E*",
        "Pa",
        detail="Effective modulus :math:`E^*`.",
        above=0,
        from_pair="effective_modulus",
    )
    effective_radius: Array = parameter(
        "effective radius R",
        "m",
        detail="Effective radius :math:`R`.",
        above=0,
        from_pair="effective_radius",
    )


@dataclass(frozen=True, kw_only=True)
class RestitutionForMassLaw(CompliantLaw):
    """Mixin of the laws whose dashpot follows from a restitution and the effective mass."""

    restitution: Array = parameter(
        "restitution asked for, e",
        detail="Restitution asked for, :math:`e`.",
        example=0.7,
        above=0,
        at_most=1,
    )
    effective_mass: Array = parameter(
        "mass for which the restitution is asked",
        "kg",
        detail="Effective mass of the pair :math:`m`.",
        above=0,
        from_pair="effective_mass",
    )


@dataclass(frozen=True, kw_only=True)
class ViscoelasticLaw(CompliantLaw):
    """Mixin of the laws of viscoelastic spheres.

    Their energy loss is set by the dissipative constant A.
    """

    dissipation_time: Array = parameter(
        "dissipative constant A",
        "s",
        detail="Dissipative constant :math:`A`.",
        example=1e-5,
        at_least=0,
    )

    free_parameter = "dissipation_time"


@dataclass(frozen=True, kw_only=True)
class TwoPhaseLaw(CompliantLaw):
    """Mixin of the laws whose dissipative force differs in compression and restitution.

    The state tells the phase.
    """

    scalar_levels: ClassVar[ScalarLevels | None] = staticmethod(_two_phase_levels)
    scalar_compressed: ClassVar[ScalarCompressed | None] = staticmethod(_turn)

    turned: Array = memory(
        "has the indentation passed its first maximum? 1 if so",
        detail="1 once the indentation has passed its first maximum.",
    )

    def coefficients_by_phase(
        self, stiffness: Array, compression: Array, restitution: Array
    ) -> tuple[Array, ...]:
        """Return the coefficients of a law with two phases.

        They are stiffness, the constant of the dissipative force in the present phase, `turned`,
        and that constant in restitution.

        Parameters
        ----------
        stiffness : float or array
            The first coefficient.
        compression, restitution : float or array
            The constant of the dissipative force in either phase.
        """
        return (
            stiffness,
            np.where(self.turned > 0.0, restitution, compression),
            self.turned,
            restitution,
        )

    def after_compression(self, deepest: Array) -> Self:
        """Return the law for the restitution phase, of the drops that have been compressed."""
        return self.changed({"turned": np.where(deepest > 0.0, 1.0, self.turned)})
