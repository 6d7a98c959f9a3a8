"""Hysteretic damping, proportional to elastic force and indentation rate, and its restitution."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.law import ScalarForces
from vibroimpact.contact.parameters import parameter
from vibroimpact.contact.power_law import PowerLaw, power

# power series e(D) = 1 - 2 D/3 + ... of the equation in `hysteretic_restitution`, exact to 1e-17
# for D < 0.02
_SERIES = (
    1.0,
    -2 / 3,
    4 / 9,
    -44 / 135,
    104 / 405,
    -40 / 189,
    7648 / 42525,
    -2848 / 18225,
    31712 / 229635,
)
_SMALL = 0.02


@scalar
def _forces(
    delta: Array, delta_dot: Array, approach_speed: Array, coefficients: Any
) -> tuple[Array, Array]:
    stiffness = coefficients[0]
    exponent = coefficients[1]
    damping_factor = coefficients[2]
    dissipation = coefficients[3]
    elastic = stiffness * power(delta, exponent)
    return elastic, elastic * ((damping_factor / approach_speed + dissipation) * delta_dot)


@dataclass(frozen=True, kw_only=True)
class HystereticLaw(PowerLaw):
    r"""Base of the laws :math:`F = K \delta^n (1 + D\, \dot\delta/\dot\delta_0)`.

    Each law has its own damping factor :math:`D`.
    """

    contact_end = "zero-indentation"
    tension = "none"
    scalar_forces: ClassVar[ScalarForces | None] = staticmethod(_forces)

    restitution: Array = parameter(
        "restitution asked for, e",
        detail="Restitution asked for, :math:`e`.",
        example=0.7,
        at_least=0,
        at_most=1,
    )

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-]."""
        raise NotImplementedError

    def damping_factor_at(self, approach_speed: Array) -> Array:
        """Return the damping factor [-] at an approach speed [m/s]; here the same at all speeds."""
        return self.damping_factor

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Stiffness, exponent, damping factor and dissipation.

        The last is the damping factor over the approach speed, of laws in which this ratio, rather
        than the factor, is a constant [s/m].
        """
        return self.stiffness, self.exponent, self.damping_factor, 0.0

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        """Return the restitution without gravity, a function of D only."""
        return hysteretic_restitution(self.damping_factor_at(speed) + 0.0 * mass * speed)


def hysteretic_restitution(damping_factor: Array) -> Array:
    r"""Return the restitution of hysteretic damping without gravity [-].

    The law is :math:`F = K \delta^n (1 + D\, \dot\delta/\dot\delta_0)`.

    It is independent of K, n, mass and speed, and solves

    .. math:: D (1 + e) = \ln \frac{1 + D}{1 - e D}

    Parameters
    ----------
    damping_factor : float or array
        Damping factor :math:`D` [-], >= 0.

    References
    ----------
    Gonthier, Y., McPhee, J., Lange, C. and Piedboeuf, J.-C. (2004). A regularized contact model
    with asymmetric damping and dwell-time dependent friction. Multibody Syst. Dyn. 11, 209-233.

    Examples
    --------
    >>> [round(float(hysteretic_restitution(d)), 5) for d in (0.0, 0.634828, 3.0)]
    [1.0, 0.7, 0.3069]
    """
    factor = np.asarray(damping_factor, dtype=float)
    is_small = factor < _SMALL
    # for small factors both sides of the equation cancel: a series in D
    series = np.polynomial.polynomial.polyval(np.where(is_small, factor, 0.0), _SERIES)
    # with e D = 1 - exp(-w) the equation is w + exp(-w) - 1 = D - ln(1 + D): convex in w, so that
    # Newton's method converges monotonically from an upper bound of the root
    large_factor = np.where(is_small, 1.0, factor)  # one where the series is taken
    right_side = large_factor - np.log1p(large_factor)
    w = np.minimum(right_side + 1.0, right_side + np.sqrt(2.0 * right_side))
    for _ in range(60):
        step = (w + np.expm1(-w) - right_side) / -np.expm1(-w)
        w = w - step
        if np.all(np.abs(step) <= 1e-15 * w):
            break
    return np.where(is_small, series, -np.expm1(-w) / large_factor)[()]
