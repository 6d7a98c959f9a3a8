"""Walton and Braun's law: linear loading, and linear unloading with a higher stiffness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.elastic_plastic import ElasticPlasticLaw, LoadingCurve
from vibroimpact.contact.parameters import inherited_parameter, parameter
from vibroimpact.errors import InputError


@scalar
def _loading_force(delta: Array, coefficients: Any) -> Array:
    return coefficients[6] * delta


@scalar
def _loading_state(delta: Array, coefficients: Any) -> tuple[Array, Array, Array]:
    stiffness = coefficients[6]  # k1
    squared_restitution = coefficients[7]
    stiffening = coefficients[8]
    # F_m/k2, with k2 = k1/e^2 or k1 + S F_m
    recovery = squared_restitution * delta / (1.0 + stiffening * delta)
    return stiffness * delta, 0.5 * stiffness * delta * delta, recovery


@dataclass(frozen=True, kw_only=True)
class WaltonBraun(ElasticPlasticLaw):
    r"""Partially latching spring (Walton and Braun 1986).

    .. math:: F = k_1 \delta \ \text{loading},\qquad F = k_2 (\delta - \delta_r) \ \text{unloading},
              \qquad \delta_r = \delta_m (1 - k_1/k_2)

    with :math:`k_2 = k_1/e^2`, if a `restitution` is given, or :math:`k_2 = k_1 + S F_m`, if
    `stiffening` is.

    Raises
    ------
    InputError
        Unless exactly one of `restitution` and `stiffening` is given.

    Notes
    -----
    Without gravity the restitution is the one asked for if a `restitution` is given; with
    `stiffening` it falls with the
    approach speed :math:`v_0`, :math:`e = \sqrt{\omega_0/(S v_0 + \omega_0)}`, :math:`\omega_0 =
    \sqrt{k_1/m}`. The
    contact ends at zero force, at :math:`\delta_r`; the next contact begins without a dent.

    References
    ----------
    Walton, O. R. and Braun, R. L. (1986). Viscosity, granular-temperature, and stress calculations
    for shearing assemblies of inelastic, frictional disks. J. Rheology 30, 949-980.

    Examples
    --------
    >>> law = WaltonBraun(stiffness=100.0, restitution=0.5)
    >>> loading, _ = law.forces(0.5, 1.0, 1.0)
    >>> unloading, _ = law.after_compression(0.6).forces(0.5, -1.0, 1.0)
    >>> float(loading), round(float(unloading), 9)
    (50.0, 20.0)
    """

    name = "walton-braun"
    equation = "F = k1 delta loading, k2 (delta - delta_r) unloading; k2 = k1 / e^2 or k1 + S F_max"
    source = "Walton & Braun 1986, J. Rheology 30:949"
    lasting = False
    unloading_exponent = 1.0
    loading_curve: ClassVar[LoadingCurve] = LoadingCurve(_loading_force, _loading_state)

    loaded_to: Array = inherited_parameter(
        ElasticPlasticLaw, "loaded_to", detail="Deepest indentation of this contact so far."
    )
    stiffness: Array = parameter(
        "stiffness of loading k1",
        "N/m",
        detail="Stiffness of loading :math:`k_1`.",
        example=2e6,
        above=0,
    )
    restitution: Array | None = parameter(
        "restitution asked for, unless stiffening is given",
        detail="Restitution asked for, :math:`e`.",
        example=0.7,
        above=0,
        at_most=1,
        default=None,
    )
    stiffening: Array | None = parameter(
        "growth S of the unloading stiffness with the largest force",
        "1/m",
        detail="Growth of the unloading stiffness with the largest force, :math:`S`.",
        at_least=0,
        default=None,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.restitution is None) == (self.stiffening is None):
            raise InputError(
                f"{self.name} needs either restitution or stiffening [1/m], and not both"
            )

    @property
    def free_parameter(self) -> str:
        """The name of the parameter given, restitution or stiffening."""
        return "stiffening" if self.restitution is None else "restitution"

    @property
    def loading_coefficients(self) -> tuple[Array, ...]:
        """Stiffness of loading, square of the restitution, and stiffening.

        Where they are not given, the second is one, and the third zero.
        """
        squared_restitution: Array = 1.0
        if self.restitution is not None:
            squared_restitution = self.restitution**2
        stiffening: Array = 0.0
        if self.stiffening is not None:
            stiffening = self.stiffening
        return self.stiffness, squared_restitution, stiffening

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        """Return the published restitution of a fresh contact.

        That of a dented one follows from the energy balance.
        """
        if np.any(self.loaded_to):
            return super().closed_form_restitution(mass, speed)
        if self.restitution is not None:
            return self.restitution + 0.0 * mass * speed
        frequency = np.sqrt(self.stiffness / mass)
        return np.sqrt(frequency / (self.stiffening * speed + frequency))
