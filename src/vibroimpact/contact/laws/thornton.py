"""Thornton's law: elastic-perfectly-plastic sphere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.elastic_plastic import LoadingCurve
from vibroimpact.contact.parameters import parameter
from vibroimpact.contact.yielding_sphere import YieldingSphereLaw, yielding_sphere


@scalar
def _plastic_force(delta: Array, coefficients: Any) -> Array:
    yield_indentation = coefficients[6]
    yield_force = coefficients[10]
    slope = coefficients[11]
    return yield_force + slope * (delta - yield_indentation)


@scalar
def _plastic_state(delta: Array, coefficients: Any) -> tuple[Array, Array, Array]:
    yield_indentation = coefficients[6]
    effective_radius = coefficients[9]
    yield_force = coefficients[10]
    slope = coefficients[11]
    work = (yield_force + 0.5 * slope * (delta - yield_indentation)) * (delta - yield_indentation)
    contact_radius = np.sqrt(effective_radius * delta)
    return _plastic_force(delta, coefficients), work, contact_radius


@dataclass(frozen=True, kw_only=True)
class Thornton(YieldingSphereLaw):
    r"""Elastic-perfectly-plastic sphere (Thornton 1997).

    .. math:: F = \begin{cases} \tfrac43 E^* \sqrt R\, \delta^{3/2} & \delta \le \delta_y \\
              F_y + \pi R\, p_y (\delta - \delta_y) & \delta > \delta_y \end{cases},\qquad
              \delta_y = R \left(\frac{\pi p_y}{2 E^*}\right)^2

    with unloading as Hertz's contact of a flatter sphere, from the deepest point to the dent that
    remains.

    Notes
    -----
    The pressure is Hertz's, cut off at :math:`p_y`. Below the yield speed
    :math:`v_y = \sqrt{4 K \delta_y^{5/2}/(5 m)}` nothing is lost; far above it e tends to
    :math:`1.185 (v_y/v)^{1/4}`, where
    :math:`K = \tfrac43 E^* \sqrt R` and m is the effective mass. The pressure of fully plastic
    contacts is about 2.8 times the yield
    strength (Tabor 1951); with 1.6 times the law then loses too much, and `yield_pressure` should
    be the hardness. The dent lasts: the next impact on the same spot meets a flatter contact, and
    loses nothing unless it goes deeper.

    References
    ----------
    Thornton, C. (1997). Coefficient of restitution for collinear collisions of elastic-perfectly
    plastic spheres. J. Appl. Mech. 64, 383-386.

    Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press, section 6.1 (1.6 times the
    yield strength).

    Tabor, D. (1951). The Hardness of Metals. Oxford University Press.

    Examples
    --------
    >>> law = Thornton(effective_modulus=7e10, effective_radius=0.01, yield_pressure=1e9)
    >>> [round(float(law.closed_form_restitution(0.01, v)), 5) for v in (0.001, 1.0, 10.0)]
    [1.0, 0.77856, 0.44794]
    """

    name = "thornton"
    equation = (
        "F = 4/3 E* sqrt(R) delta^1.5 up to yield, F_y + pi R p_y (delta - delta_y) beyond; "
        "unloading Hertz's, of a flatter sphere"
    )
    source = "Thornton 1997, J. Appl. Mech. 64:383"
    free_parameter = "yield_pressure"
    loading_curve: ClassVar[LoadingCurve] = yielding_sphere(_plastic_force, _plastic_state)

    yield_pressure: Array = parameter(
        "limiting contact pressure p_y",
        "Pa",
        detail="Limiting contact pressure :math:`p_y`; from the materials, 1.6 times the smaller "
        "yield strength.",
        example=1e8,
        above=0,
        from_pair="yield_pressure",
    )

    @property
    def yield_indentation(self) -> Array:
        r"""Indentation :math:`\delta_y` at yield [m]."""
        return (
            self.effective_radius
            * (np.pi * self.yield_pressure / (2.0 * self.effective_modulus)) ** 2
        )

    @property
    def plastic_coefficients(self) -> tuple[Array, ...]:
        """The force at yield and the slope of the plastic force."""
        yield_indentation = self.yield_indentation
        yield_force = self.stiffness * yield_indentation * np.sqrt(yield_indentation)
        return yield_force, np.pi * self.effective_radius * self.yield_pressure
