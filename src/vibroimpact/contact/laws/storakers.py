"""Elastic-plastic sphere of a power-law-hardening material: the fully plastic contact of Storakers and others, from Hertz's on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.parameters import parameter
from vibroimpact.contact.yielding_sphere import YieldingSphereLaw

_PERFECTLY_PLASTIC, _LINEAR = 1.43, 0.5  # c^2 in figure 5 of Storakers and others, without hardening and for m = 1
_MOST_ITERATIONS, _CONVERGED = 60, 1e-8  # convergence is quadratic: the next step would be below rounding


@dataclass(frozen=True, kw_only=True)
class Storakers(YieldingSphereLaw):
    r"""Power-law-hardening elastic-plastic sphere (fully plastic contact: Storakers, Biwa and Larsson 1997).

    A material with :math:`\sigma = \sigma_0\, \varepsilon^{1/m}` has, in the fully plastic contact of radius a, the mean pressure p and the
    indentation :math:`\delta`:

    .. math:: p(a) = 3 \sigma_0 \left(\frac{a}{6 R}\right)^{1/m},\qquad \delta = \frac{a^2}{2 c^2 R},\qquad
              \sigma_0 = Y \left(\frac{E^*}{Y}\right)^{1/m},\qquad c^2 = 1.43 \left(\frac{0.5}{1.43}\right)^{1/m}

    Up to yield the contact is Hertz's, and from there it tends to the fully plastic one:

    .. math:: F = F_y + \pi\, [a^2\, p(a) - a_y^2\, p(a_y)],\qquad
              \delta = \frac{1}{2 c^2}\, \frac{a^2}{R} + \left(1 - \frac{1}{2 c^2}\right) \frac{3 F}{4 E^* a}

    with :math:`\delta_y = a_y^2/R` where the slopes of the two curves agree. It unloads as Hertz's contact of a flatter sphere, from the
    same contact radius.

    Notes
    -----
    The contact stays elastic until Hertz's largest pressure is near the fully plastic pressure, whereas a sphere begins to yield at 1.6 Y.
    Without hardening nothing is lost up to 4.8 times the speed of first yield, and too little until the contact is fully plastic, at about
    100 times that speed; `meyer` has the rise of the pressure in between. The restitution is above Jackson, Green and Marghitu's fit to
    finite elements: without hardening by 0.18 to 0.20 at 30 to 300 times the speed of first yield. Far above yield it falls as
    :math:`v^{-(1 - 1/m)/(4 + 1/m)}`. The dent lasts: the next impact on the same spot loses nothing unless it goes deeper.

    References
    ----------
    Storakers, B., Biwa, S. and Larsson, P.-L. (1997). Similarity analysis of inelastic contact. Int. J. Solids
    Struct. 34, 3061-3083.

    Thornton, C. (1997). Coefficient of restitution for collinear collisions of elastic-perfectly plastic spheres.
    J. Appl. Mech. 64, 383-386.

    Examples
    --------
    >>> law = Storakers(effective_modulus=7e10, effective_radius=0.01, yield_strength=4e8, hardening_exponent=10.0)
    >>> [round(float(law.closed_form_restitution(0.01, v)), 5) for v in (0.001, 1.0, 10.0)]
    [1.0, 0.95523, 0.70486]
    """

    name = "storakers"
    equation = (
        "F = 4/3 E* sqrt(R) delta^1.5 up to yield, F_y + pi [a^2 p(a) - a_y^2 p(a_y)] beyond, p = 3 Y (E*/Y)^(1/m) (a/6R)^(1/m), "
        "delta = a^2/(2 c^2 R) + (1 - 1/(2 c^2)) 3 F/(4 E* a), c^2 = 1.43 (0.5/1.43)^(1/m); unloading Hertz's, of a flatter sphere"
    )
    source = "Storakers, Biwa & Larsson 1997, Int. J. Solids Struct. 34:3061 (fully plastic); Thornton 1997, J. Appl. Mech. 64:383"
    departure = (
        "Published are the two relations of the fully plastic contact, with c^2 of 1.43 without hardening, 1 for an m of about 3, and 0.5 "
        "for m = 1. The power between the ends is this software's, and gives 1.007 for m = 3. So is the passage from Hertz's contact: the "
        "force over the contact radius is Thornton's, with this pressure in the place of a constant one, and the indentation is the mean "
        "of the fully plastic and the elastic one, with the weights by which it is Hertz's at yield."
    )
    free_parameter = "yield_strength"

    yield_strength: Array = parameter(
        "yield strength Y",
        "Pa",
        detail="Yield strength :math:`Y` of the body that yields; the power law goes through it at the strain :math:`Y/E^*`.",
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
        slope = self._power * self._plastic_stiffness
        return (slope / (1.5 * self.stiffness)) ** (1.0 / (1.5 - self._power))

    @property
    def pile_up(self) -> Array:
        """Contact radius squared over twice the effective radius and the indentation when fully plastic: the source's c^2 [-]."""
        return _PERFECTLY_PLASTIC * (_LINEAR / _PERFECTLY_PLASTIC) ** (1.0 / self.hardening_exponent)

    def contact_radius(self, delta: Array) -> Array:
        """Return the contact radius beyond the yield indentation [m]."""
        return self._relative_radius(delta) * np.sqrt(self.effective_radius * self.yield_indentation)

    def plastic_force(self, delta: Array) -> Array:
        """Return the loading force beyond the yield indentation [N]."""
        rise = self._rise
        return self._yield_force * (1.0 - rise + rise * self._relative_radius(delta) ** (2.0 * self._power))

    def plastic_loading_work(self, delta: Array) -> Array:
        """Return the integral of the plastic force from the yield indentation [J]."""
        x, rise, power, plastic = self._relative_radius(delta), self._rise, 2.0 * self._power, self._plastic_part
        constant = 1.0 - rise
        # the force constant + rise x^power, times the change of each part of the indentation
        by_area = 0.5 * constant * (x**2 - 1.0) + rise * (x ** (power + 2.0) - 1.0) / (power + 2.0)
        by_force = constant**2 * (1.0 / x - 1.0) + constant * rise * (power - 2.0) * (x ** (power - 1.0) - 1.0) / (power - 1.0)
        by_force = by_force + rise**2 * (power - 1.0) * (x ** (2.0 * power - 1.0) - 1.0) / (2.0 * power - 1.0)
        return self._yield_force * self.yield_indentation * (2.0 * plastic * by_area + (1.0 - plastic) * by_force)

    def _relative_radius(self, delta: Array) -> Array:
        """Return the contact radius relative to that at yield [-], at indentations from that at yield on [m]."""
        depth, rise, power, plastic = delta / self.yield_indentation, self._rise, 2.0 * self._power, self._plastic_part
        x = np.sqrt(depth / plastic)  # more than the root; the indentation over x is convex: Newton's method goes down to it
        for _ in range(_MOST_ITERATIONS):
            constant, rising = (1.0 - rise) / x, rise * x ** (power - 1.0)
            excess = plastic * x * x + (1.0 - plastic) * (constant + rising) - depth
            step = excess / (2.0 * plastic * x + (1.0 - plastic) * ((power - 1.0) * rising - constant) / x)
            x = x - step
            if np.all(np.abs(step) <= _CONVERGED * x):
                break
        return np.maximum(x, 1.0)

    @property
    def _plastic_part(self) -> Array:
        """Weight of the plastic indentation; that of the elastic one is the rest [-]."""
        return 0.5 / self.pile_up

    @property
    def _rise(self) -> Array:
        """Pressure times area at yield over the force there, so that the force grows over the contact radius as Hertz's does there [-]."""
        return 1.5 / self._power

    @property
    def _yield_force(self) -> Array:
        return self.stiffness * self.yield_indentation * np.sqrt(self.yield_indentation)

    @property
    def _power(self) -> Array:
        return 1.0 + 0.5 / self.hardening_exponent

    @property
    def _plastic_stiffness(self) -> Array:
        radius, power = self.effective_radius, 1.0 / self.hardening_exponent
        flow_stress = self.yield_strength * (self.effective_modulus / self.yield_strength) ** power
        return 3.0 * np.pi * flow_stress * radius * (36.0 * radius) ** (-0.5 * power)
