"""Elastic-plastic sphere of a power-law-hardening material.

It is Thornton's law with the pressure of Storakers and others.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.elastic_plastic import LoadingCurve
from vibroimpact.contact.parameters import parameter
from vibroimpact.contact.power_law import power
from vibroimpact.contact.yielding_sphere import YieldingSphereLaw, yielding_sphere


@scalar
def _plastic_force(delta: Array, coefficients: Any) -> Array:
    yield_force = coefficients[10]
    plastic_stiffness = coefficients[11]
    exponent = coefficients[12]
    power_at_yield = coefficients[13]
    return yield_force + plastic_stiffness * (power(delta, exponent) - power_at_yield)


@scalar
def _plastic_state(delta: Array, coefficients: Any) -> tuple[Array, Array, Array]:
    yield_indentation = coefficients[6]
    effective_radius = coefficients[9]
    yield_force = coefficients[10]
    plastic_stiffness = coefficients[11]
    exponent = coefficients[12]
    power_at_yield = coefficients[13]
    next_power_at_yield = coefficients[14]
    # the integral of F_y + k (delta^n - delta_y^n) from yield on
    constant_force = yield_force - plastic_stiffness * power_at_yield
    next_exponent = exponent + 1.0
    work = (
        constant_force * (delta - yield_indentation)
        + plastic_stiffness * (power(delta, next_exponent) - next_power_at_yield) / next_exponent
    )
    contact_radius = np.sqrt(effective_radius * delta)
    return _plastic_force(delta, coefficients), work, contact_radius


@dataclass(frozen=True, kw_only=True)
class Storakers(YieldingSphereLaw):
    r"""Power-law-hardening elastic-plastic sphere (pressure: Storakers, Biwa and Larsson 1997).

    A material with :math:`\sigma = \sigma_0\, \varepsilon^{1/m}` carries, in the fully plastic
    contact, the mean pressure

    .. math::
        p = 3 \sigma_0 \left(\frac{a}{6 R}\right)^{1/m},\qquad
        \sigma_0 = Y \left(\frac{E^*}{Y}\right)^{1/m}

    which grows with the contact radius a. With it in the place of a constant limiting pressure,
    Thornton's law reads

    .. math:: F = \begin{cases} \tfrac43 E^* \sqrt R\, \delta^{3/2} & \delta \le \delta_y \\
              F_y + \pi R\, [\delta\, p(\delta) - \delta_y\, p(\delta_y)] & \delta > \delta_y
              \end{cases},\qquad a^2 = R \delta

    and :math:`\delta_y` is where the two slopes agree. It unloads as Hertz's contact of a flatter
    sphere.

    Notes
    -----
    Far above yield the restitution falls as :math:`v^{-(1 - 1/m)/(4 + 1/m)}`. The dent lasts: the
    next impact on the same spot loses nothing unless it goes deeper.

    References
    ----------
    Storakers, B., Biwa, S. and Larsson, P.-L. (1997). Similarity analysis of inelastic contact.
    Int. J. Solids Struct. 34, 3061-3083.

    Thornton, C. (1997). Coefficient of restitution for collinear collisions of elastic-perfectly
    plastic spheres. J. Appl. Mech. 64, 383-386.

    Examples
    --------
    >>> law = Storakers(
    ...     effective_modulus=7e10,
    ...     effective_radius=0.01,
    ...     yield_strength=4e8,
    ...     hardening_exponent=10.0,
    ... )
    >>> [round(float(law.closed_form_restitution(0.01, v)), 5) for v in (0.001, 1.0, 10.0)]
    [1.0, 0.88244, 0.54901]
    """

    name = "storakers"
    equation = (
        "F = 4/3 E* sqrt(R) delta^1.5 up to yield, F_y + pi R [delta p(delta) - delta_y "
        "p(delta_y)] beyond, "
        "p = 3 Y (E*/Y)^(1/m) (a/6R)^(1/m), a^2 = R delta; unloading Hertz's, of a flatter sphere"
    )
    source = (
        "Storakers, Biwa & Larsson 1997, Int. J. Solids Struct. 34:3061, in Thornton 1997, J. "
        "Appl. Mech. 64:383"
    )
    departure = (
        "The pressure of the fully plastic contact is put into Thornton's law, which has a "
        "constant one, with Hertz's contact radius, "
        "a^2 = R delta. The source has a^2 = 2 c^2 R delta when fully plastic, where c^2 is "
        "0.5 for m = 1, and 1.43 "
        "without hardening, for which the restitution far above yield would be 1.48 times as high."
    )
    free_parameter = "yield_strength"
    loading_curve: ClassVar[LoadingCurve] = yielding_sphere(_plastic_force, _plastic_state)

    yield_strength: Array = parameter(
        "yield strength Y",
        "Pa",
        detail="Yield strength :math:`Y` of the body that yields; the power law goes through it at "
        "the strain :math:`Y/E^*`.",
        example=2e7,
        above=0,
        from_pair="yield_strength",
    )
    hardening_exponent: Array = parameter(
        "hardening exponent m",
        detail="Hardening exponent :math:`m`; large for a perfectly plastic material.",
        at_least=1.01,
        default=10.0,
    )

    @property
    def yield_indentation(self) -> Array:
        """Indentation at which Hertz's force and the plastic force have the same slope [m]."""
        slope = self._exponent * self._plastic_stiffness
        return (slope / (1.5 * self.stiffness)) ** (1.0 / (1.5 - self._exponent))

    @property
    def plastic_coefficients(self) -> tuple[Array, ...]:
        """Force at yield, plastic stiffness, exponent n, and powers of the yield indentation.

        The powers are n and n + 1.
        """
        yield_indentation = self.yield_indentation
        exponent = self._exponent
        yield_force = self.stiffness * yield_indentation**1.5
        return (
            yield_force,
            self._plastic_stiffness,
            exponent,
            yield_indentation**exponent,
            yield_indentation ** (exponent + 1.0),
        )

    @property
    def _exponent(self) -> Array:
        """Exponent n of the plastic force, 1 + 1/(2 m) [-]."""
        return 1.0 + 0.5 / self.hardening_exponent

    @property
    def _plastic_stiffness(self) -> Array:
        """Stiffness of the plastic force, pi R p(delta) over delta^(1/2m) [N/m^n]."""
        radius = self.effective_radius
        hardening = 1.0 / self.hardening_exponent
        flow_stress = (
            self.yield_strength * (self.effective_modulus / self.yield_strength) ** hardening
        )
        return 3.0 * np.pi * flow_stress * radius * (36.0 * radius) ** (-0.5 * hardening)
