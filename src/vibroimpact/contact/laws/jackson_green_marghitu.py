"""Jackson, Green and Marghitu's restitution of elastic-plastic spheres: a fitted formula."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.law import InstantaneousLaw
from vibroimpact.contact.mixins import ElasticPairLaw
from vibroimpact.contact.parameters import parameter

_CHANGE = 60.0  # dimensionless approach speed at which the fit changes its form


@dataclass(frozen=True, kw_only=True)
class JacksonGreenMarghitu(ElasticPairLaw, InstantaneousLaw):
    r"""Restitution of an elastic-perfectly-plastic sphere (Jackson, Green and Marghitu 2010).

    .. math:: e = \begin{cases} 1 & V^* \le 1 \\
              1 - 0.1 \ln V^* \left(\frac{V^* - 1}{59}\right)^{0.156} & 1 < V^* \le 60 \\
              1 - 0.1 \ln 60 - 0.11 \ln\frac{V^*}{60}\, (V^* - 60)^{2.36 S_y/E^*} & V^* > 60
              \end{cases}

    with :math:`V^* = v/v_c`, :math:`v_c = \sqrt{4 \omega_c P_c/(5 m)}`,
    :math:`\omega_c = R\, (\pi C S_y/2 E^*)^2`, :math:`P_c = \tfrac43 (R/E^*)^2 (\pi C S_y/2)^3` and
    :math:`C = 1.295\, \mathrm{e}^{0.736 \nu}`.

    Notes
    -----
    The law gives the restitution and no force. It keeps no dent: every impact falls on fresh
    material.

    References
    ----------
    Jackson, R. L., Green, I. and Marghitu, D. B. (2010). Predicting the coefficient of restitution
    of impacting elastic-perfectly plastic spheres. Nonlinear Dynamics 60, 217-229.

    Examples
    --------
    >>> law = JacksonGreenMarghitu(
    ...     effective_modulus=7e10, effective_radius=0.01, yield_strength=4e8, poissons_ratio=0.3
    ... )
    >>> [round(float(law.closed_form_restitution(0.01, v)), 5) for v in (0.001, 1.0, 10.0)]
    [1.0, 0.78782, 0.4878]
    """

    name = "jackson-green-marghitu"
    equation = (
        "e = 1 - 0.1 ln(V) ((V - 1)/59)^0.156 for 1 < V <= 60, 1 - 0.1 ln(60) - 0.11 ln(V/60) "
        "(V - 60)^(2.36 Sy/E*) beyond, V = v/v_c"
    )
    source = "Jackson, Green & Marghitu 2010, Nonlinear Dynamics 60:217"
    departure = "Where the formula is negative, at high speeds, the restitution is zero."
    free_parameter = "yield_strength"

    yield_strength: Array = parameter(
        "yield strength Sy",
        "Pa",
        detail="Yield strength :math:`S_y` of the body that yields.",
        example=1e8,
        above=0,
        from_pair="yield_strength",
    )
    poissons_ratio: Array = parameter(
        "Poisson's ratio of the body that yields",
        detail=r"Poisson's ratio :math:`\nu` of the body that yields.",
        example=0.3,
        at_least=0,
        below=0.5,
        from_pair="poissons_ratio",
    )

    def critical_speed(self, mass: Array) -> Array:
        """Return the approach speed at which a sphere of a mass [kg] begins to yield [m/s]."""
        pressure = 0.5 * np.pi * 1.295 * np.exp(0.736 * self.poissons_ratio) * self.yield_strength
        indentation = self.effective_radius * (pressure / self.effective_modulus) ** 2
        force = 4.0 / 3.0 * (self.effective_radius / self.effective_modulus) ** 2 * pressure**3
        return np.sqrt(0.8 * indentation * force / mass)

    def separation_speed(self, approach_speed: Array, mass: Array) -> Array:
        """Return the fitted restitution times the approach speed [m/s]."""
        ratio = approach_speed / self.critical_speed(mass)
        low = np.clip(ratio, 1.0, _CHANGE)
        high = np.maximum(ratio, _CHANGE)
        loss = 0.1 * np.log(low) * ((low - 1.0) / (_CHANGE - 1.0)) ** 0.156
        loss = loss + 0.11 * np.log(high / _CHANGE) * (high - _CHANGE) ** (
            2.36 * self.yield_strength / self.effective_modulus
        )
        return np.maximum(1.0 - loss, 0.0) * approach_speed
