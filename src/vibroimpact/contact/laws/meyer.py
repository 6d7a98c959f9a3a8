"""Meyer's law: contact pressure that rises as a power of the contact radius.

It does so between first yield and full plasticity of a sphere.
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

_AT_YIELD = 1.6  # largest pressure at first yield, over the yield strength
_FULLY_PLASTIC = 2.8  # mean pressure when fully plastic, over the yield strength
# ratio of the mean pressures, which is two thirds of the largest one at first yield
_RISE = 1.5 * _FULLY_PLASTIC / _AT_YIELD
_MOST_ITERATIONS = 60
_CONVERGED = 1e-8  # relative step: convergence is quadratic, and the next would be below rounding


def _relative_radius_of_float(
    relative_indentation: float, meyer_index: float, full_radius: float
) -> float:
    """Return what `_relative_radius` does, of floats."""
    depth = 2.0 * relative_indentation
    exponent = meyer_index - 1.0
    x_at_full_pressure = 0.5 * (math.sqrt(_RISE * _RISE + 4.0 * depth) - _RISE)
    if x_at_full_pressure > full_radius:
        return x_at_full_pressure
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
    """Return the contact radius relative to that at yield [-].

    Indentations are relative to that at yield, and at least one.
    """
    depth = 2.0 * relative_indentation
    exponent = meyer_index - 1.0
    # where the pressure is full, twice the depth is x^2 + _RISE x
    x_at_full_pressure = 0.5 * (np.sqrt(_RISE * _RISE + 4.0 * depth) - _RISE)
    # where it rises, x^2 + x^(n-1): at least the root of x^2 + x, that of a constant pressure
    x = 0.5 * (np.sqrt(1.0 + 4.0 * depth) - 1.0)
    # x^2 + x^(n-1) is convex: Newton's method goes down to the root
    for _ in range(_MOST_ITERATIONS):
        rising = x**exponent
        step = (x * x + rising - depth) / (2.0 * x + exponent * rising / x)
        x = x - step
        if np.all(np.abs(step) <= _CONVERGED * x):
            break
    return np.where(x_at_full_pressure > full_radius, x_at_full_pressure, np.maximum(x, 1.0))


@scalar
def _plastic_force_at(x: Array, coefficients: Any) -> Array:
    """Return the loading force [N] at a contact radius relative to that at yield [-]."""
    yield_force = coefficients[10]
    meyer_index = coefficients[11]
    return yield_force * np.minimum(power(x, meyer_index), _RISE * x * x)


@scalar
def _plastic_force(delta: Array, coefficients: Any) -> Array:
    return _plastic_force_at(
        _relative_radius(delta / coefficients[6], coefficients[11], coefficients[12]), coefficients
    )


@scalar
def _plastic_state(delta: Array, coefficients: Any) -> tuple[Array, Array, Array]:
    yield_indentation = coefficients[6]
    effective_radius = coefficients[9]
    yield_force = coefficients[10]
    n = coefficients[11]
    full_radius = coefficients[12]
    x = _relative_radius(delta / yield_indentation, n, full_radius)
    # the integral of the force over the indentation, over that of both at yield. While the pressure
    # rises, the force is x^n and twice the indentation x^2 + x^(n-1), from x = 1 on
    x_rising = np.minimum(x, full_radius)
    work = (x_rising ** (n + 2.0) - 1.0) / (n + 2.0) + 0.5 * (n - 1.0) * (
        x_rising ** (2.0 * n - 1.0) - 1.0
    ) / (2.0 * n - 1.0)
    # where the pressure is full, they are _RISE x^2 and x^2 + _RISE x, from the full radius on
    square = x * x
    square_rising = x_rising * x_rising
    work_at_full_pressure = (square * square - square_rising * square_rising) / 4.0 + _RISE * (
        square * x - square_rising * x_rising
    ) / 6.0
    work = work + _RISE * work_at_full_pressure
    contact_radius = x * np.sqrt(effective_radius * yield_indentation)
    work_beyond_yield = yield_force * yield_indentation * work
    return _plastic_force_at(x, coefficients), work_beyond_yield, contact_radius


@scalar
def _levels(coefficients: Any) -> Levels:
    loaded_to = coefficients[0]
    touch_level = coefficients[1]
    yield_indentation = coefficients[6]
    full_radius = coefficients[12]
    # the force is not smooth at first yield, nor where the pressure becomes full
    full_plasticity = yield_indentation * 0.5 * full_radius * (full_radius + _RISE)
    return (
        touch_level,
        touch_level,
        loaded_to,
        np.maximum(yield_indentation, loaded_to),
        np.maximum(full_plasticity, loaded_to),
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
        """Contact radius at full plasticity, relative to that at yield [-].

        It is infinite for a pressure that does not rise.
        """
        with np.errstate(divide="ignore", over="ignore"):
            return _RISE ** np.divide(1.0, self.meyer_index - 2.0)
