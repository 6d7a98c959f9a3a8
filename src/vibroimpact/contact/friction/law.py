"""The interface of a friction law.

A law is a frozen dataclass in a file of its own under `vibroimpact.contact.friction.laws`, where
the registry finds it. It declares `name`, `equation` and `source`, its parameters as contact laws
do, and is one of

* `ImpulsiveFriction`, whose slip velocity follows from the normal impulse so far;
* `CompliantFriction`, whose force depends on the tangential displacement and its history: by the
  turning points of this along one direction, and a row of springs in two, or by a single spring.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array, Floats
from vibroimpact.compiled import scalar
from vibroimpact.contact.parameters import Parameters, parameter

SlipAfter = Callable[[Array, Array, Array, Array, Any], Array]
"""A function of slip without friction [m/s], normal impulse so far and as a whole [N s], effective
mass [kg] and coefficients: slip [m/s].
"""

SlidingForce = Callable[[Array, Array, Any], Array]
"""A function of slip [m/s], normal force [N] and coefficients: friction force [N]."""


@dataclass(frozen=True, kw_only=True)
class FrictionLaw(Parameters):
    """Base of all friction laws.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> law = vi.friction.find_friction_law("coulomb")(coefficient=0.3)
    >>> isinstance(law, vi.friction.FrictionLaw), law.name
    (True, 'coulomb')
    """

    coefficient: Array = parameter(
        "coefficient of friction mu",
        detail=r"Coefficient of friction :math:`\mu`.",
        example=0.3,
        at_least=0,
    )
    rolling_coefficient: Array = parameter(
        "coefficient of rolling friction mu_r",
        detail=r"Coefficient of rolling friction :math:`\mu_r`: its moment is :math:`\mu_r R F`, "
        r"with the radius of the sphere.",
        default=0.0,
        at_least=0,
    )

    def contact_radius(self, force: Floats) -> Floats:
        """Return the radius of the contact under a normal force [m]; none where it is a point."""
        return np.zeros_like(force)


@scalar
def no_friction(slip: Array, normal_force: Array, coefficients: Any) -> Array:
    """Return no friction force [N]: the law tells the impulse alone."""
    return 0.0 * slip


@dataclass(frozen=True, kw_only=True)
class ImpulsiveFriction(FrictionLaw):
    """Base of the laws without tangential compliance.

    A law gives its functions of floats or arrays, and the coefficients of these. One that defines
    `slip_after` and `force` instead works as well, but is not compiled.
    """

    function_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "scalar_slip_after": ("slip_after",),
        "scalar_friction": ("force",),
    }

    scalar_slip_after: ClassVar[SlipAfter | None] = None
    """The slip as a function of floats, marked by `compiled.scalar`: of the arguments of
    `slip_after` and the coefficients.
    """

    scalar_friction: ClassVar[SlidingForce | None] = staticmethod(no_friction)
    """The friction force as a function of floats: of the arguments of `force` and the
    coefficients.
    """

    _array_slip_after: ClassVar[SlipAfter | None] = None
    _array_friction: ClassVar[SlidingForce] = staticmethod(no_friction)

    def slip_after(self, slip: Floats, impulse: Floats, whole: Floats, mass: Floats) -> Floats:
        """Return the slip velocity [m/s], of the shape of `impulse`.

        Parameters
        ----------
        slip : array, shape (..., B)
            Slip velocity without friction [m/s].
        impulse : array, shape (..., B)
            Normal impulse so far [N s].
        whole : array, shape (B,)
            Normal impulse of the whole contact [N s].
        mass : array, shape (B,)
            Effective mass of the tangential motion [kg].
        """
        array_slip_after = type(self)._array_slip_after
        if array_slip_after is None:
            raise NotImplementedError(
                f"{type(self).__name__} has neither `scalar_slip_after` nor `slip_after`"
            )
        return np.asarray(array_slip_after(slip, impulse, whole, mass, self.coefficients))

    def force(self, slip: Floats, normal_force: Floats) -> Floats:
        """Return the friction force against the slip [N].

        It is zero where the law gives the impulse alone.
        """
        return np.asarray(type(self)._array_friction(slip, normal_force, self.coefficients))


@dataclass(frozen=True, kw_only=True)
class CompliantFriction(FrictionLaw):
    r"""Base of the laws with the tangential compliance of elastic half-spaces.

    The normal force F acts on a Hertzian contact, whose depth under it is
    :math:`D = [3F / (4 E^* \sqrt R)]^{2/3}`. Tangential displacements s are counted in
    :math:`\kappa = \mu E^* / G^*`, and the friction force is :math:`2 G^* \sqrt R\, \kappa I`, at
    most :math:`\mu F`, where :math:`I = \tfrac23 D^{3/2}`.
    """

    stretching: ClassVar[tuple[int, int]] = (0, 0)
    r"""Powers :math:`\gamma` of the contact radius in the integral of a contact that sticks, as it
    grows and as it shrinks.

    With a the radius over the root of R, this is :math:`I = a^\gamma z`, where
    :math:`\dot z = a^{1 - \gamma} \dot s`.
    """

    slips_at_rim: ClassVar[bool] = False
    """Do parts of the contact slip while others stick, as turning points tell? Otherwise
    it sticks or slides.
    """

    sliding_energy: ClassVar[float] = 0.4
    r"""Elastic work of a contact as it grows while all of it slides, over :math:`\mu F
    \kappa D`.
    """

    effective_modulus: Array = parameter(
        "effective modulus E*",
        "Pa",
        detail="Effective modulus :math:`E^*`.",
        above=0,
        from_pair="effective_modulus",
    )
    effective_shear_modulus: Array = parameter(
        "effective shear modulus G*",
        "Pa",
        detail="Effective shear modulus :math:`G^*`.",
        above=0,
        from_pair="effective_shear_modulus",
    )
    effective_radius: Array = parameter(
        "effective radius R",
        "m",
        detail="Effective radius :math:`R`.",
        above=0,
        from_pair="effective_radius",
    )

    @property
    def kappa(self) -> Array:
        r"""The unit :math:`\kappa = \mu E^* / G^*` of tangential displacements [-]."""
        return self.coefficient * self.effective_modulus / self.effective_shear_modulus

    def contact_radius(self, force: Floats) -> Floats:
        """Return the radius of Hertz's contact under a normal force [m]."""
        return np.asarray(np.cbrt(0.75 * force * self.effective_radius / self.effective_modulus))
