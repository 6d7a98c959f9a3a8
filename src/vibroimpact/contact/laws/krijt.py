"""Krijt and others' law: adhesive viscoelastic sphere."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.adhesion import AdhesiveLaw
from vibroimpact.contact.mixins import ViscoelasticLaw
from vibroimpact.contact.parameters import inherited_parameter


@dataclass(frozen=True, kw_only=True)
class Krijt(ViscoelasticLaw, AdhesiveLaw):
    r"""Adhesion with viscoelastic loss in the bulk (after Krijt and others 2013).

    .. math:: F = F_\mathrm{JKR}(a) + 2 E^* A\, a\, \dot\delta

    with the contact radius a of Johnson, Kendall and Roberts.

    Notes
    -----
    As the work of adhesion tends to zero, the force tends to that of Kuwabara and Kono's law
    without its cut at zero.

    References
    ----------
    Krijt, S., Guettler, C., Heisselmann, D., Dominik, C. and Tielens, A. G. G. M. (2013). Energy
    dissipation in head-on collisions of spheres. J. Phys. D: Appl. Phys. 46, 435303.

    Examples
    --------
    >>> law = Krijt(
    ...     effective_modulus=1e9,
    ...     effective_radius=1e-3,
    ...     work_of_adhesion=0.1,
    ...     dissipation_time=1e-7,
    ... )
    >>> _, dissipative = law.forces(0.0, 1.0, 1.0)
    >>> bool(abs(dissipative / (2e9 * 1e-7 * law.contact_radius(0.0)) - 1) < 1e-12)
    True
    """

    name = "krijt"
    equation = "F = F_JKR(a) + 2 E* A a delta_dot"
    source = "Krijt et al. 2013, J. Phys. D 46:435303 (the loss in the bulk)"
    departure = (
        "Two losses of the paper are not in this law: that of a work of adhesion which "
        "depends on the speed of the contact's edge, and that of yielding."
    )

    dissipation_time: Array = inherited_parameter(
        ViscoelasticLaw,
        "dissipation_time",
        detail="Dissipative constant :math:`A`; in the paper's terms the relaxation time over the "
        "square of Poisson's ratio.",
    )

    @property
    def dashpot_per_radius(self) -> Array:
        """The dashpot constant over the contact radius [N s/m^2]."""
        return 2.0 * self.effective_modulus * self.dissipation_time
