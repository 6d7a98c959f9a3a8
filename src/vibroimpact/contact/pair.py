"""Properties of a pair of elastic bodies in contact.

They are effective modulus, radius and mass, Hertz's stiffness, and yield pressure.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.materials import Material


def effective_modulus(first: Material, second: Material) -> Array:
    r"""Return the effective modulus of a contact pair [Pa].

    .. math:: 1/E^* = (1 - \nu_1^2)/E_1 + (1 - \nu_2^2)/E_2

    Infinite if both materials are rigid.

    References
    ----------
    Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press, eq. (4.6).

    Examples
    --------
    >>> rock = Material(density=1380, youngs_modulus=2.26e9, poissons_ratio=0.28)
    >>> steel = Material(density=7850, youngs_modulus=2.1e11, poissons_ratio=0.3)
    >>> f"{effective_modulus(rock, steel):.6e}"
    '2.426472e+09'
    """
    compliance = 1.0 / first.plane_strain_modulus + 1.0 / second.plane_strain_modulus
    with np.errstate(divide="ignore"):
        return np.divide(1.0, compliance)


def effective_shear_modulus(first: Material, second: Material) -> Array:
    r"""Return the effective shear modulus of a contact pair [Pa].

    .. math:: 1/G^* = (2 - \nu_1)/(4 G_1) + (2 - \nu_2)/(4 G_2)

    A contact that sticks has the tangential stiffness :math:`2 G^* a`. Infinite if both materials
    are rigid.

    References
    ----------
    Mindlin, R. D. (1949). Compliance of elastic bodies in contact. J. Appl. Mech. 16, 259-268.

    Examples
    --------
    >>> alumina = Material(density=4000, youngs_modulus=380e9, poissons_ratio=0.23)
    >>> glass = Material(density=2500, youngs_modulus=70e9, poissons_ratio=0.25)
    >>> f"{effective_shear_modulus(alumina, glass):.4e}"
    '5.4084e+10'
    """
    # (2 - nu)/(4 G), with G = E/(2 (1 + nu))
    compliances = [
        0.5
        * (2.0 - material.poissons_ratio)
        * (1.0 + material.poissons_ratio)
        / material.youngs_modulus
        for material in (first, second)
    ]
    with np.errstate(divide="ignore"):
        return np.divide(1.0, compliances[0] + compliances[1])


def hertz_stiffness(modulus: Array, radius: Array) -> Array:
    r"""Return the stiffness K of the Hertzian contact force :math:`K \delta^{3/2}` [N/m^1.5].

    .. math:: K = \tfrac{4}{3} E^* \sqrt{R}

    Parameters
    ----------
    modulus : float or array
        Effective modulus :math:`E^*` [Pa].
    radius : float or array
        Effective radius :math:`R` [m]; of a sphere on a flat, that of the sphere.

    References
    ----------
    Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press, eq. (4.23).

    Examples
    --------
    >>> f"{hertz_stiffness(2.426472e9, 0.025):.5e}"
    '5.11545e+08'
    """
    return 4.0 / 3.0 * modulus * np.sqrt(radius)


@dataclass(frozen=True)
class ContactPair:
    """The properties of a pair of bodies from which a law may take its parameters.

    Parameters
    ----------
    effective_modulus : float or array
        :math:`E^*` [Pa]; infinite for two rigid materials.
    effective_radius : float or array
        :math:`R` [m].
    effective_mass : float or array
        :math:`m_1 m_2 / (m_1 + m_2)` [kg]; the mass of the sphere if the plate is fixed.
    yield_strength, poissons_ratio : float or array, optional
        Of the material that yields first [Pa], [-]; Poisson's ratio of the sphere if no yield
        strength is known.
    effective_shear_modulus : float or array, optional
        :math:`G^*` [Pa]; infinite for two rigid materials.
    """

    effective_modulus: Array
    effective_radius: Array
    effective_mass: Array
    yield_strength: Array | None = None
    poissons_ratio: Array | None = None
    effective_shear_modulus: Array | None = None

    @property
    def hertz_stiffness(self) -> Array:
        """Hertz's stiffness of the pair [N/m^1.5]."""
        return hertz_stiffness(self.effective_modulus, self.effective_radius)

    @property
    def yield_pressure(self) -> Array | None:
        """Largest contact pressure before yield [Pa].

        It is 1.6 times the yield strength (Johnson 1985, eq. 6.9).
        """
        if self.yield_strength is None:
            return None
        return 1.6 * self.yield_strength
