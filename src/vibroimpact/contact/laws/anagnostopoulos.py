"""Anagnostopoulos's law: the linear spring and dashpot of buildings that pound."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.damping_ratio import damping_ratio_of
from vibroimpact.contact.kelvin_voigt import KelvinVoigtLaw
from vibroimpact.contact.law import parameter


@dataclass(frozen=True, kw_only=True)
class Anagnostopoulos(KelvinVoigtLaw):
    r"""Linear viscoelastic impact element of earthquake engineering (Anagnostopoulos 1988).

    .. math:: F = k \delta + 2 \xi \sqrt{k m}\, \dot\delta,\qquad \xi = -\ln e / \sqrt{\pi^2 + \ln^2 e}

    Parameters
    ----------
    stiffness : float or array
        Stiffness of the impact element :math:`k` [N/m], > 0.
    restitution : float or array
        Restitution asked for, :math:`e` [-], in (0, 1].
    effective_mass : float or array
        Effective mass of the pair :math:`m` [kg], > 0.

    Notes
    -----
    The element acts while the gap is closed, so it pulls shortly before the end; without gravity the restitution
    is then exactly the one asked for. The force jumps at first touch.

    References
    ----------
    Anagnostopoulos, S. A. (1988). Pounding of buildings in series during earthquakes. Earthquake Eng. Struct.
    Dyn. 16, 443-456.
    Anagnostopoulos, S. A. (2004). Equivalent viscous damping for modeling inelastic impacts in earthquake
    pounding problems. Earthquake Eng. Struct. Dyn. 33, 897-902.

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

    restitution: Array = parameter("restitution asked for, e", example=0.7, above=0, at_most=1)
    effective_mass: Array = parameter("mass for which the restitution is asked", "kg", above=0, from_pair="effective_mass")

    @property
    def dashpot(self) -> Array:
        """The dashpot c [N s/m]."""
        return 2.0 * damping_ratio_of(self.restitution) * np.sqrt(self.stiffness * self.effective_mass)
