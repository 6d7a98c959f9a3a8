"""Meyer's law: sphere whose contact pressure rises as a power of the contact radius
between first yield and full plasticity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar, scalar_as
from vibroimpact.contact.elastic_plastic import LoadingCurve
from vibroimpact.contact.law import Levels, ScalarLevels
from vibroimpact.contact.parameters import parameter
from vibroimpact.contact.power_law import power
from vibroimpact.contact.yielding_sphere import YieldingSphereLaw, yielding_sphere

# largest pressure at first yield, and mean pressure when fully plastic, over the yield strength
_AT_YIELD, _FULLY_PLASTIC = 1.6, 2.8
# ratio of the mean pressures, which is two thirds of the largest one at first yield
_RISE = 1.5 * _FULLY_PLASTIC / _AT_YIELD
# convergence is quadratic: the next step would be below rounding
_MOST_ITERATIONS, _CONVERGED = 60, 1e-8


def _relative_radius_of_float(
    relative_indentation: float, meyer_index: float, full_radius: float
) -> float:
    depth, exponent = 2.0 * relative_indentation, meyer_index - 1.0
    full = 0.5 * (math.sqrt(_RISE * _RISE + 4.0 * depth) - _RISE)
    if full > full_radius:
        return full
    x = 0.5 * (math.sqrt(1.0 + 4.0 * depth) - 1.0)
    for _ in range(_MOST_ITERATIONS):
        rising = x**exponent
        step = (x * x + rising - depth) / (2.0 * x + exponent * rising / x)
        x -= step
        if abs(step) <= _CONVERGED * x:
            break
    return float(max(x, 1.0))


@scalar_as(_relative_radius_of_float)
def _relative_radius(relative_indentation: Array, meyer_index: Array, full_radius: Array) -> Array:
    """Return the contact radius relative to that at yield [-], at indentations relative
    to that at yield [-], at least one.
    """
    depth, exponent = 2.0 * relative_indentation, meyer_index - 1.0
    # where the pressure is full: x^2 + _RISE x
    full = 0.5 * (np.sqrt(_RISE * _RISE + 4.0 * depth) - _RISE)
    # where it does not rise, and not less where it does
    x = 0.5 * (np.sqrt(1.0 + 4.0 * depth) - 1.0)
    # x^2 + x^(n-1) is convex: Newton's method goes down to the root
    for _ in range(_MOST_ITERATIONS):
        rising = x**exponent
        step = (x * x + rising - depth) / (2.0 * x + exponent * rising / x)
        x = x - step
        if np.all(np.abs(step) <= _CONVERGED * x):
            break
    return np.where(full > full_radius, full, np.maximum(x, 1.0))


@scalar
def _plastic_force_at(x: Array, coefficients: Any) -> Array:
    """Return the loading force [N] at a contact radius relative to that at yield [-]."""
    yield_force, meyer_index = coefficients[10], coefficients[11]
    return yield_force * np.minimum(power(x, meyer_index), _RISE * x * x)


@scalar
def _plastic_force(delta: Array, coefficients: Any) -> Array:
    return _plastic_force_at(
        _relative_radius(delta / coefficients[6], coefficients[11], coefficients[12]), coefficients
    )


@scalar
def _plastic_state(delta: Array, coefficients: Any) -> tuple[Array, Array, Array]:
    yield_indentation, effective_radius, yield_force = (
        coefficients[6],
        coefficients[9],
        coefficients[10],
    )
    n, full_radius = coefficients[11], coefficients[12]
    x = _relative_radius(delta / yield_indentation, n, full_radius)
    rising = np.minimum(x, full_radius)
    work = (rising ** (n + 2.0) - 1.0) / (n + 2.0) + 0.5 * (n - 1.0) * (
        rising ** (2.0 * n - 1.0) - 1.0
    ) / (2.0 * n - 1.0)
    square, rising_square = x * x, rising * rising
    full = (square * square - rising_square * rising_square) / 4.0 + _RISE * (
        square * x - rising_square * rising
    ) / 6.0
    work = work + _RISE * full
    radius = x * np.sqrt(effective_radius * yield_indentation)
    return _plastic_force_at(x, coefficients), yield_force * yield_indentation * work, radius


@scalar
def _levels(coefficients: Any) -> Levels:
    loaded_to, touch_level, yield_indentation, full_radius = (
        coefficients[0],
        coefficients[1],
        coefficients[6],
        coefficients[12],
    )
    at_full = yield_indentation * 0.5 * full_radius * (full_radius + _RISE)
    return (
        touch_level,
        touch_level,
        loaded_to,
        np.maximum(yield_indentation, loaded_to),
        np.maximum(at_full, loaded_to),
    )


@dataclass(frozen=True, kw_only=True)
class Meyer(YieldingSphereLaw):
    r"""Elastic-plastic sphere with Meyer's index (Tabor 1951; Kharaz and Gorham 2000).

    Beyond first yield the mean pressure rises with the contact radius as Meyer's law has it, up to
    full plasticity:

    .. math::

        \bar p = \min\left(1.07\, Y (a/a_y)^{n-2},\; 2.8\, Y\right),\qquad F = \pi a^2 \bar p,\qquad
              \delta = \frac{a^2}{2 R} + \frac{3 F}{8 E^* a}

    with :math:`\delta_y = a_y^2/R = R\, (1.6\, \pi Y/2 E^*)^2` at yield. Unloading is Hertz's, of a
    sphere in the dent of the same
    contact radius.

    Notes
    -----
    The indentation is that of a sphere that leaves a spherical dent: Hertz's :math:`a^2/R` at
    yield, and :math:`a^2/2R`, the depth of the dent, far beyond. With :math:`n = 3` the contact is
    Hertzian until the pressure is full, with :math:`n = 2` the mean pressure does not rise. In
    between e tends to a power of the speed, :math:`v^{-(3-n)/(n+2)}`, as long as the pressure
    rises, and to
    :math:`v^{-1/4}` where it is full. Of a material whose hardness H is known rather than its yield
    strength, give :math:`Y = H/2.8`.

    Spheres of alumina on thick plates of mild steel and of an aluminium alloy, dropped from 0.6 mm
    to 1.75 m, follow such a power, and become fully plastic at speeds of the order of 100 times
    that of first yield (Kharaz and Gorham 2000). The default index is chosen for this speed; it is
    not fitted to their restitutions.

    References
    ----------
    Tabor, D. (1951). The Hardness of Metals. Oxford University Press, chapters 5 and 8.

    Kharaz, A. H. and Gorham, D. A. (2000). A study of the restitution coefficient in
    elastic-plastic impact. Philosophical Magazine Letters 80, 549-559.

    Examples
    --------
    >>> law = Meyer(effective_modulus=7e10, effective_radius=0.01, yield_strength=4e8)
    >>> [round(float(law.closed_form_restitution(0.01, v)), 5) for v in (0.001, 1.0, 10.0)]
    [1.0, 0.79307, 0.59643]
    """

    name = "meyer"
    equation = (
        "F = pi a^2 p, p = min(1.07 Y (a/a_y)^(n-2), 2.8 Y) beyond yield, delta = a^2/(2 R) "
        "+ 3 F/(8 E* a); "
        "unloading Hertz's, of a sphere in its dent"
    )
    source = "Kharaz & Gorham 2000, Philos. Mag. Lett. 80:549; Tabor 1951, The Hardness of Metals"
    departure = (
        "The law is put together by this software: the pressures at yield and at full "
        "plasticity (Tabor), a power of the contact radius "
        "between them (Meyer), the depth of a spherical dent, and Hertz's unloading."
    )
    free_parameter = "yield_strength"
    loading_curve: ClassVar[LoadingCurve] = yielding_sphere(_plastic_force, _plastic_state)
    scalar_levels: ClassVar[ScalarLevels | None] = staticmethod(_levels)

    yield_strength: Array = parameter(
        "yield strength Y",
        "Pa",
        detail="Yield strength :math:`Y` of the body that yields.",
        example=1e8,
        above=0,
        from_pair="yield_strength",
    )
    meyer_index: Array = parameter(
        "Meyer's index n, 2 for constant pressure, 3 for an elastic contact",
        detail="Meyer's index :math:`n`; with the default the contact is fully plastic from 99 "
        "times the speed of first yield on.",
        default=2.45,
        at_least=2,
        at_most=3,
    )

    @property
    def yield_indentation(self) -> Array:
        r"""Indentation :math:`\delta_y` at yield [m]."""
        return (
            self.effective_radius
            * (0.5 * np.pi * _AT_YIELD * self.yield_strength / self.effective_modulus) ** 2
        )

    def contact_radius(self, delta: Array) -> Array:
        """Return the contact radius beyond the yield indentation [m]."""
        return _plastic_state(delta, self._undented)[2]

    @property
    def plastic_coefficients(self) -> tuple[Array, ...]:
        """Force at yield, Meyer's index and the relative radius at full plasticity."""
        yield_force = self.stiffness * self.yield_indentation * np.sqrt(self.yield_indentation)
        return yield_force, self.meyer_index, self._full_radius

    @property
    def _full_radius(self) -> Array:
        """Contact radius at full plasticity, relative to that at yield [-]; infinite for
        a pressure that does not rise.
        """
        with np.errstate(divide="ignore", over="ignore"):
            return _RISE ** np.divide(1.0, self.meyer_index - 2.0)
