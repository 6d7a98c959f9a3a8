"""The restitution-based contact of MSC Adams: penalty spring and Poisson's hypothesis."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.law import ScalarEnergies, ScalarForces
from vibroimpact.contact.mixins import TwoPhaseLaw
from vibroimpact.contact.parameters import parameter
from vibroimpact.contact.power_law import spring_energies


@scalar
def _forces(
    delta: Array, delta_dot: Array, approach_speed: Array, coefficients: Any
) -> tuple[Array, Array]:
    penalty = coefficients[0]
    loss = coefficients[1]
    force = penalty * delta
    return force, -loss * force


@dataclass(frozen=True, kw_only=True)
class AdamsPoisson(TwoPhaseLaw):
    r"""Penalty spring with Poisson's hypothesis.

    The impulse of restitution is e times that of compression.

    .. math::
        F = p\, \delta \ \text{up to the first turn},\qquad F = e^2 p\, \delta \ \text{after it}

    Notes
    -----
    The parameters are those of the POISSON contact of Adams. Without gravity, between rigid bodies,
    both the
    ratio of the impulses and that of the speeds are e. The force falls at the deepest point from
    :math:`p\delta` to
    :math:`e^2 p\delta`.

    References
    ----------
    MSC Software. Adams/Solver guide, statement CONTACT, arguments POISSON, PENALTY,
    RESTITUTION_COEFFICIENT.

    Examples
    --------
    >>> law = AdamsPoisson(penalty=100.0, restitution=0.5)
    >>> (
    ...     float(sum(law.forces(1.0, 1.0, 1.0))),
    ...     float(sum(law.after_compression(2.0).forces(1.0, -1.0, 1.0))),
    ... )
    (100.0, 25.0)
    """

    name = "adams-poisson"
    equation = "F = p delta until the indentation first turns, e^2 p delta from then on"
    source = "MSC Adams/Solver guide, statement CONTACT (parameters)"
    departure = (
        "The course of the force is this software's: what happens within the contact "
        "(force, penetration, duration) is that of a linear "
        "spring, softer once the indentation has turned, and is no prediction of Adams."
    )
    contact_end = "zero-indentation"
    tension = "none"
    scalar_forces: ClassVar[ScalarForces | None] = staticmethod(_forces)
    scalar_energies: ClassVar[ScalarEnergies | None] = staticmethod(spring_energies)

    penalty: Array = parameter(
        "penalty p", "N/m", detail="Penalty :math:`p`.", example=2e6, above=0
    )
    restitution: Array = parameter(
        "restitution e", detail="Restitution :math:`e`.", example=0.7, above=0, at_most=1
    )

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Penalty, and the lost share of the force by phase.

        It is 1 - e^2 once the indentation has turned, and nothing before.
        """
        return self.coefficients_by_phase(
            self.penalty, 0.0, 1.0 - self.restitution * self.restitution
        )

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        """Return the restitution asked for."""
        return self.restitution + 0.0 * mass * speed
