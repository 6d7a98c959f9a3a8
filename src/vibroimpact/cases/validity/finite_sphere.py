r"""Finite size of the sphere, which Hertz's theory treats as a half space."""

from __future__ import annotations

from functools import cache

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Limit, of_force_and_duration, percent_less
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.structures.sphere_compliance import FITTED, sphere_term

_STEPS = 3  # Newton iterations, which leave an error below 1e-6
# Poisson's ratios of the interpolation table, whose relative error is 1e-3
_RATIOS = np.linspace(0.0, 0.49, 15)


def force_lacking(
    force: Array, radius: Array, modulus: Array, youngs_modulus: Array, poissons_ratio: Array
) -> Array:
    r"""Return the relative deficit of Hertz's largest force.

    It is that of a half space with respect to a sphere of finite size.

    Both absorb the same energy quasi-statically. With Hertz's indentation :math:`\delta` at his
    force :math:`F`, and the displacement :math:`s(F)` in series for the finite sphere
    (`QuasiStatic`), the force of the finite sphere is :math:`f F`, and

    .. math:: \tfrac25 F \delta\, f^{5/3} + \int_0^{f F} F'\, s'(F')\, dF' = \tfrac25 F \delta

    The result is :math:`1 - 1/f`. Only the sphere is of finite size, so the effect is small if the
    plate is softer than the sphere.

    Parameters
    ----------
    force, radius, modulus : float or array
        Hertz's largest force [N], the radius of the sphere [m] and the effective modulus of the
        pair [Pa].
    youngs_modulus, poissons_ratio : float or array
        Young's modulus [Pa] and Poisson's ratio of the sphere.

    Examples
    --------
    >>> modulus = 2.26e9 / (1 - 0.28**2)  # a soft sphere on a rigid plane
    >>> float(
    ...     round(
    ...         force_lacking(4 / 3 * modulus * 0.025**2 * 0.115**3, 0.025, modulus, 2.26e9, 0.28),
    ...         3,
    ...     )
    ... )
    0.054
    """
    # at which Hertz's contact radius would be that of the sphere
    unit_force = 4.0 / 3.0 * modulus * radius**2
    relative_radius = np.minimum(np.cbrt(force / unit_force), FITTED[1])
    force = unit_force * relative_radius**3  # limited to the range of the fitted correction
    series = QuasiStatic(0.0, 1.0 / (youngs_modulus * radius), _factors(poissons_ratio), unit_force)
    hertz_energy = 0.4 * force * radius * relative_radius**2
    factor = 1.0  # f of the equation, by Newton's method
    for _ in range(_STEPS):
        root = np.cbrt(factor)
        excess = hertz_energy * (root**5 - 1.0) + series.energy(factor * force)
        _, compliance = series.linearised(factor * force)
        slope = hertz_energy * 5.0 / 3.0 * root**2 + factor * force**2 * compliance
        factor = factor - excess / slope
    return 1.0 - 1.0 / factor


def _factors(poissons_ratio: Array) -> tuple[Array, Array, Array, Array]:
    """Return the factors of the finite-size term.

    For an array of ratios they are interpolated.
    """
    if np.ndim(poissons_ratio) == 0:
        # rare negative ratios: the term of zero is close
        term = sphere_term(min(max(float(poissons_ratio), 0.0), 0.5))
        return term.constant, term.logarithm, term.linear, term.square
    constant, logarithm, linear, square = (
        np.interp(poissons_ratio, _RATIOS, row) for row in _table()
    )
    return constant, logarithm, linear, square


@cache
def _table() -> Array:
    """Return the factors of the finite-size term at the ratios of the interpolation table.

    There is one row per factor.
    """
    terms = [sphere_term(float(ratio)) for ratio in _RATIOS]
    return np.array([[term.constant, term.logarithm, term.linear, term.square] for term in terms]).T


def _number(drops: Conditions) -> Array:
    contact = drops.case["contact"]
    if "radius" in drops.case["plate"]:
        return np.nan  # the correction is known for a sphere on a flat only
    if (
        drops.model("sphere") == "elastic"
        or contact.get("finite_sphere")
        or contact.get("local_compliance") == "identified"
    ):
        return np.nan  # these include the effect, or count local deformation twice
    sphere = drops.materials["sphere"]
    deficit = force_lacking(
        drops.summary.force,
        drops.radius,
        drops.modulus,
        sphere.youngs_modulus,
        sphere.poissons_ratio,
    )
    return np.where(drops.is_hertzian, deficit, np.nan)


def _sentence(drop: Conditions, deficit: float) -> str:
    case = drop.case
    is_oblique = (
        {"velocity", "angle", "spin"} & set(case["drop"])
        or "inclination" in case["plate"]
        or "friction" in case["contact"]
    )
    remedy = "" if is_oblique else "; contact.finite_sphere = true corrects it"
    relative_radius = float(drop.contact_radius / drop.radius)
    about = "about" if relative_radius <= FITTED[1] else "at least"
    return (
        f"Hertz's half space makes the largest force {about} "
        f"{percent_less(deficit).removeprefix('-')} too small: the contact radius is "
        f"{relative_radius:.2g} of the sphere's, which is stiffer than a half space{remedy}"
    )


LIMITS = (
    Limit(
        name="finite_sphere",
        title="half space for a finite sphere",
        meaning="part by which the largest force of Hertz's half space is below that of a "
        "sphere of finite size",
        threshold=0.02,
        number=_number,
        sentence=_sentence,
        effects=lambda _, deficit: of_force_and_duration(deficit),
        shown=percent_less,
    ),
)
