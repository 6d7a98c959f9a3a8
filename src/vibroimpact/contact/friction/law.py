"""The interface of a friction law.

A law is a frozen dataclass in a file of its own under `vibroimpact.contact.friction.laws`, where
the registry finds it. It declares `name`, `equation` and `source`, its parameters as contact laws
do, and is one of

* `ImpulsiveFriction`, whose slip velocity follows from the normal impulse so far;
* `CompliantFriction`, whose force depends on the tangential displacement and its history: by the
  turning points of this along one direction, and a row of springs in two, or by a single spring.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vibroimpact.arrays import Array, Floats
from vibroimpact.contact.friction.twisting import FULL_TWISTING, twisting_share
from vibroimpact.contact.parameters import Parameters, parameter


@dataclass(frozen=True, kw_only=True)
class FrictionLaw(Parameters):
    """Base of all friction laws.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> law = vi.find_friction_law("coulomb")(coefficient=0.3)
    >>> isinstance(law, vi.FrictionLaw), law.name
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

    def twisting_moment(self, force: Floats) -> Floats:
        """Return the moment of full twisting under a normal force [N m].

        It is 3 pi/16 mu F a (Johnson 1985, section 7.2; Lubkin 1951).
        """
        return np.asarray(FULL_TWISTING * self.coefficient * force * self.contact_radius(force))

    def twisting_part(self, force: Floats, friction: Floats, slip: Floats, spin: Floats) -> Floats:
        """Return the share of the moment of full twisting that a contact has [-].

        The rest is taken by its friction. The result has the shape of `force`.

        It is `contact.friction.twisting.twisting_share`, of a contact of the radius that the normal
        force makes.

        Parameters
        ----------
        force : array
            Normal force F [N].
        friction : array
            Size of the friction force Q [N].
        slip : array
            Speed of the contact point along the plate s [m/s].
        spin : array
            Rate of twisting [rad/s], >= 0.

        References
        ----------
        Contensou, P. (1963). Couplage entre frottement de glissement et frottement de pivotement
        dans la theorie de la toupie. In: Kreiselprobleme (ed. H. Ziegler), Springer, 201-216.

        Howe, R. D. and Cutkosky, M. R. (1996). Practical force-motion models for sliding
        manipulation. Int. J. Robotics Res. 15, 557-572.

        Examples
        --------
        >>> from vibroimpact.contact.friction.laws.mdr import MDR
        >>> law = MDR(
        ...     coefficient=0.1,
        ...     effective_modulus=60e9,
        ...     effective_shear_modulus=50e9,
        ...     effective_radius=2.5e-3,
        ... )
        >>> force, spin = np.full(3, 100.0), np.full(3, 50.0)
        >>> law.twisting_part(force, 0.1 * force, np.array([0.0, 1e-3, 1.0]), spin).round(
        ...     4
        ... ).tolist()
        [1.0, 0.9814, 0.0025]
        """
        sliding_force = self.coefficient * force
        used = np.divide(
            friction, sliding_force, out=np.ones_like(force), where=sliding_force > 0.0
        )
        rim_speed = self.contact_radius(force) * spin
        return np.asarray(twisting_share(rim_speed, slip, used))


@dataclass(frozen=True, kw_only=True)
class ImpulsiveFriction(FrictionLaw):
    """Base of the laws without tangential compliance."""

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
        raise NotImplementedError

    def force(self, slip: Floats, normal_force: Floats) -> Floats:
        """Return the friction force against the slip [N].

        It is zero where the law gives the impulse alone.
        """
        return np.zeros_like(slip)


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
