"""Anagnostopoulos's law: linear spring and dashpot for structural pounding."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.kelvin_voigt import KelvinVoigtLaw, dashpot_for_restitution
from vibroimpact.contact.mixins import RestitutionForMassLaw
from vibroimpact.contact.parameters import inherited_parameter


@dataclass(frozen=True, kw_only=True)
class Anagnostopoulos(RestitutionForMassLaw, KelvinVoigtLaw):
    r"""Linear viscoelastic impact element of earthquake engineering (Anagnostopoulos 1988).

    .. math::
        F = k \delta + 2 \xi \sqrt{k m}\, \dot\delta,\qquad \xi = -\ln e / \sqrt{\pi^2 + \ln^2 e}

    Notes
    -----
    The element acts while the bodies overlap, so that with e < 1 it pulls shortly before the end.
    Without gravity the restitution of an impact with this effective mass is the one asked for. With
    e < 1 the force jumps at first touch.

    References
    ----------
    Anagnostopoulos, S. A. (1988). Pounding of buildings in series during earthquakes. Earthquake
    Eng. Struct. Dyn. 16, 443-456.

    Anagnostopoulos, S. A. (2004). Equivalent viscous damping for modeling inelastic impacts in
    earthquake pounding problems. Earthquake Eng. Struct. Dyn. 33, 897-902.

    Examples
    --------
    >>> law = Anagnostopoulos(stiffness=100.0, restitution=0.5, effective_mass=1.0)
    >>> elastic, dissipative = law.forces(0.5, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 4)
    (50.0, 4.3091)
    """

    name = "anagnostopoulos"
    equation = "F = k delta + 2 xi sqrt(k m) delta_dot, xi = -ln e / sqrt(pi^2 + ln^2 e)"
    source = "Anagnostopoulos 1988, Earthquake Eng. Struct. Dyn. 16:443"

    stiffness: Array = inherited_parameter(
        KelvinVoigtLaw, "stiffness", detail="Stiffness of the impact element :math:`k`."
    )

    @property
    def dashpot(self) -> Array:
        """The dashpot constant c [N s/m]."""
        return dashpot_for_restitution(self.restitution, self.stiffness, self.effective_mass)
