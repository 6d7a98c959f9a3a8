r"""Adhesion, which makes small particles stick and which most contact laws neglect."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import REBOUND, RESTITUTION, Limit, percent_less

WORK_OF_ADHESION = 0.1
"""Work of adhesion assumed [J/m^2]: the upper end of the range of clean and dry bodies,
0.02 to 0.1; rough bodies have less.
"""

_TEAR = 7.09  # over (w^5 R^4 / E*^2)^(1/3): work of separating a contact from zero indentation


def sticking_speed(
    radius: Array, modulus: Array, mass: Array, work_of_adhesion: Array = WORK_OF_ADHESION
) -> Array:
    r"""Return the approach speed below which an elastic sphere sticks to a flat [m/s].

    .. math:: v_s = \left(\frac{14.18}{m}\right)^{1/2} \left(\frac{w^5 R^4}{E^{*2}}\right)^{1/6}

    Parameters
    ----------
    radius, modulus, mass : float or array
        Radius [m], effective modulus [Pa] and mass of the sphere [kg].
    work_of_adhesion : float or array
        Work of adhesion of the pair [J/m^2].

    References
    ----------
    Thornton, C. and Ning, Z. (1998). A theoretical model for the stick/bounce behaviour of
    adhesive, elastic-plastic spheres. Powder Technology 99, 154-162.

    Examples
    --------
    >>> f"{sticking_speed(50e-6, 36e9, 1.3e-9):.2g} m/s"
    '0.0063 m/s'
    """
    return np.sqrt(2.0 * _TEAR / mass * np.cbrt(work_of_adhesion**5 * radius**4 / modulus**2))


def _number(drops: Conditions) -> Array:
    """Return the relative loss of the first restitution by adhesion; NaN for laws that
    include it, and in a liquid, of bodies not dry.
    """
    if (
        "work_of_adhesion" in drops.case["contact"]
        or drops.case["contact"].get("liquid") is not None
    ):
        return np.nan
    ratio = (
        sticking_speed(drops.effective_radius, drops.modulus, drops.effective_mass)
        / drops.summary.speed
    )
    return 1.0 - np.sqrt(1.0 - np.minimum(ratio, 1.0) ** 2)


def _sentence(drop: Conditions, lost: float) -> str:
    radius = drop.effective_radius
    speed = float(sticking_speed(radius, drop.modulus, drop.effective_mass))
    pull = 1.5 * np.pi * WORK_OF_ADHESION * radius
    decrease = percent_less(lost).removeprefix("-")
    consequence = f"the first restitution would fall by {decrease} or more"
    if lost >= 1.0:
        consequence = "the sphere would stick"
    return (
        f"with a work of adhesion of {WORK_OF_ADHESION:g} J/m^2, the largest of clean and "
        f"dry bodies, {consequence}: such spheres stick below "
        f'{speed:.2g} m/s, and their pull-off force is {pull:.2g} N; law = "jkr" or '
        '"krijt" has adhesion'
    )


LIMITS = (
    Limit(
        name="adhesion",
        title="adhesion",
        meaning=f"part of the first restitution that a work of adhesion of {WORK_OF_ADHESION:g} "
        "J/m^2 would take from an elastic contact",
        threshold=0.01,
        number=_number,
        sentence=_sentence,
        effects=lambda _, lost: {RESTITUTION: lost, REBOUND: 2.0 * lost},
        shown=percent_less,
    ),
)
