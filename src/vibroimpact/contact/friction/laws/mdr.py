"""Cattaneo's and Mindlin's contact under any history, by the method of dimensionality reduction."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.contact.friction.law import CompliantFriction


@dataclass(frozen=True, kw_only=True)
class MDR(CompliantFriction):
    r"""Partial slip (Cattaneo and Mindlin), by the method of dimensionality reduction.

    Both forces may have any history.

    .. math::

        Q = G^* \int_{-a}^{a} u\, dx,\qquad
        |u(x)| \le \mu \frac{E^*}{G^*} \left(D - \frac{x^2}{R}\right)

    with u the displacement of an independent spring at x, and D the depth of Hertz's contact under
    the normal force.

    Notes
    -----
    Under constant normal force this is the solution of Cattaneo (1938) and Mindlin (1949), under
    varying ones that of Mindlin and Deresiewicz (1953) and Jaeger (2005). The normal force is that
    of the contact law, with its damping. Twisting does not reduce the friction.

    References
    ----------
    Popov, V. L. and Hess, M. (2015). Method of Dimensionality Reduction in Contact Mechanics and
    Friction. Springer, chapter 5.

    Mindlin, R. D. and Deresiewicz, H. (1953). Elastic spheres in contact under varying oblique
    forces. J. Appl. Mech. 20, 327-344.

    Examples
    --------
    >>> MDR(
    ...     coefficient=0.1,
    ...     effective_modulus=60e9,
    ...     effective_shear_modulus=50e9,
    ...     effective_radius=2.5e-3,
    ... ).name
    'mdr'
    """

    name = "mdr"
    equation = "Q = G* int u dx, |u| <= mu E*/G* (D - x^2/R)"
    source = "Popov & Hess 2015, Method of Dimensionality Reduction, ch. 5"
    slips_at_rim = True
