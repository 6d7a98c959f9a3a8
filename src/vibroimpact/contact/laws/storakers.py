"""Storakers and others' law: a sphere of a material that hardens by a power law."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.contact.law import parameter
from vibroimpact.contact.pair import Array
from vibroimpact.contact.yielding_sphere import YieldingSphereLaw


@dataclass(frozen=True, kw_only=True)
class Storakers(YieldingSphereLaw):
    r"""Power-law-hardening elastic-plastic sphere (Storakers, Biwa and Larsson 1997).

    For a material with :math:`\sigma = \sigma_0\, \varepsilon^{1/m}` the similarity solution of the plastic contact is

    .. math:: F = 2^{1 - 1/2m}\, 3^{1 - 1/m}\, \pi\, c^{2 + 1/m}\, \sigma_0\, R^{1 - 1/2m}\, \delta^{1 + 1/2m},
              \qquad c^2 = 1.43\, \mathrm{e}^{-0.97/m}

    The contact is Hertz's until its force reaches this one, and unloads as Hertz's contact of a flatter sphere.

    Parameters
    ----------
    effective_modulus : float or array
        Effective modulus :math:`E^*` [Pa], > 0.
    effective_radius : float or array
        Effective radius :math:`R` [m], > 0.
    flow_stress : float or array
        Flow stress at a plastic strain of one, :math:`\sigma_0` [Pa], > 0, of the body that yields, the other staying
        elastic. From the materials, the smaller yield strength, which suits a material that hardens little.
    hardening_exponent : float or array, default 10
        Hardening exponent :math:`m` [-], >= 1.01; large for a perfectly plastic material.
    loaded_to : float or array, default 0
        State: deepest indentation so far [m].

    Notes
    -----
    The published solution has no elastic part. Here the smaller of it and Hertz's force acts in loading, so the change
    from elastic to plastic is sharp, where a real contact takes a range of loads for it; the restitution is
    good well below and well above that. For a perfectly plastic material the mean pressure is :math:`3\sigma_0`.
    Far above yield the restitution falls as :math:`v^{-(1 - 1/m)/(4 + 1/m)}`. The dent lasts.

    References
    ----------
    Storakers, B., Biwa, S. and Larsson, P.-L. (1997). Similarity analysis of inelastic contact. Int. J. Solids
    Struct. 34, 3061-3083.
    Brake, M. R. W. (2015). An analytical elastic plastic contact model with strain hardening and frictional effects
    for normal and oblique impacts. Int. J. Solids Struct. 62, 104-123 (the unloading).

    Examples
    --------
    >>> law = Storakers(effective_modulus=7e10, effective_radius=0.01, flow_stress=4e8, hardening_exponent=10.0)
    >>> [round(float(law.closed_form_restitution(0.01, v)), 5) for v in (0.001, 1.0, 10.0)]
    [1.0, 1.0, 0.74807]
    """

    name = "storakers"
    equation = (
        "F = min(4/3 E* sqrt(R) delta^1.5, 2^(1-1/2m) 3^(1-1/m) pi c^(2+1/m) sigma0 R^(1-1/2m) delta^(1+1/2m)), "
        "c^2 = 1.43 exp(-0.97/m); unloading Hertz's, of a flatter sphere"
    )
    source = "Storakers, Biwa & Larsson 1997, Int. J. Solids Struct. 34:3061; unloading Brake 2015, 62:104"

    flow_stress: Array = parameter("flow stress sigma0 at a plastic strain of one", "Pa", example=1e8, above=0, from_pair="yield_strength")
    hardening_exponent: Array = parameter("hardening exponent m", at_least=1.01, default=10.0)

    @property
    def free_parameter(self) -> str:
        """The flow stress."""
        return "flow_stress"

    @property
    def yield_indentation(self) -> Array:
        """Indentation at which the plastic force falls below Hertz's [m]."""
        return (self._plastic_stiffness / self.stiffness) ** (1.0 / (1.5 - self._power))

    def plastic_force(self, delta: Array) -> Array:
        """Return the force of the plastic contact [N]."""
        return self._plastic_stiffness * delta**self._power

    def plastic_loading_work(self, delta: Array) -> Array:
        """Return its integral from the yield indentation [J]."""
        at, power = self.yield_indentation, self._power + 1.0
        return self._plastic_stiffness * (delta**power - at**power) / power

    @property
    def _power(self) -> Array:
        return 1.0 + 0.5 / self.hardening_exponent

    @property
    def _plastic_stiffness(self) -> Array:
        m = self.hardening_exponent
        c = np.sqrt(1.43) * np.exp(-0.485 / m)
        factor = 2.0 ** (1.0 - 0.5 / m) * 3.0 ** (1.0 - 1.0 / m) * np.pi * c ** (2.0 + 1.0 / m)
        return factor * self.flow_stress * self.effective_radius ** (1.0 - 0.5 / m)
