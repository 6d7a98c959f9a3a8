"""Finite-size correction of Hertz's theory for an elastic sphere: its approach under a
contact pressure less that of the half space.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError

# the series has _REACH / (a / R) + _LEAST degrees; three times both change c by less than 5e-6
_REACH, _LEAST = 20.0, 60
_NODES = 40  # of the integral over the contact, where the harmonics have at most fifteen zeros
# a / R: below, the series cancels; above, Hertz's pressure does not apply
_SMALLEST, _LARGEST = 0.005, 0.5
_PLACES = 9  # points of the fit

FITTED = (0.01, 0.35)
"""Range of the ratio a / R of the radii of contact and sphere in which `sphere_term` holds."""


@dataclass(frozen=True)
class SphereTerm:
    r"""Finite-size factor of a sphere as a function of the ratio x = a / R of the radii of contact
    and sphere.

    Parameters
    ----------
    constant, logarithm, linear, square : float
        Coefficients of :math:`c(x) = c_0 + c_l \ln x + c_1 x + c_2 x^2` [-].

    Notes
    -----
    The approach is that of Hertz plus :math:`s(F) = c(a/R)\,F/(E R)`. As a is proportional to
    :math:`F^{1/3}`, each term has an
    integral in closed form.
    """

    constant: float
    logarithm: float
    linear: float
    square: float

    def factor(self, radius_ratio: Floats | float) -> Floats:
        """Return the factor c [-] at ratios of radii a / R, > 0."""
        x = np.asarray(radius_ratio, dtype=float)
        return np.asarray(
            self.constant + self.logarithm * np.log(x) + (self.linear + self.square * x) * x
        )


@functools.cache
def sphere_term(poissons_ratio: float) -> SphereTerm:
    r"""Return the finite-size factor of a sphere with a Poisson's ratio, in closed form.

    Notes
    -----
    Constant, linear and square are fitted to `finite_sphere_factor` by least squares for a / R from
    0.01 to 0.35, with an error below 3e-4. The logarithm is the asymptote for small contacts:
    around a point force F the surface of the half space has the radial
    stress :math:`(1-2\nu) F / 2\pi r^2` and the radial displacement :math:`(1-2\nu)(1+\nu) F / 2\pi
    E r` inwards. As the sphere's
    surface has the slope r / R there, that stress would leave a traction on it; the work of the
    traction on that displacement,
    for r from a to R, gives :math:`c_l = -(1-2\nu)^2 (1+\nu) / 2\pi`.

    Examples
    --------
    >>> round(float(sphere_term(0.28).factor(0.1)), 3)
    -0.407
    """
    middle, half = 0.5 * (FITTED[1] + FITTED[0]), 0.5 * (FITTED[1] - FITTED[0])
    # Chebyshev nodes, for a nearly best fit
    places = middle + half * np.cos(np.pi * (np.arange(_PLACES) + 0.5) / _PLACES)
    logarithm = -((1.0 - 2.0 * poissons_ratio) ** 2) * (1.0 + poissons_ratio) / (2.0 * math.pi)
    rest = finite_sphere_factor(poissons_ratio, places) - logarithm * np.log(places)
    square, linear, constant = np.polyfit(places, rest, 2).tolist()
    return SphereTerm(constant, logarithm, linear, square)


def finite_sphere_factor(poissons_ratio: float, radius_ratio: Floats | float) -> Floats:
    r"""Return the approach of an elastic sphere to a rigid plane less that of Hertz, over F / (E
    R).

    Parameters
    ----------
    poissons_ratio : float
        Poisson's ratio nu [-], from 0 to 0.5.
    radius_ratio : array or float
        Radius of the contact over that of the sphere, a / R [-], from 0.005 to 0.5.

    Returns
    -------
    array
        Factor c [-], within 1e-5.

    Raises
    ------
    InputError
        If a ratio is out of its range.

    Notes
    -----
    The sphere is loaded by a vertical traction of Hertz's pressure :math:`p = \tfrac{3F}{2\pi
    a^2}\sqrt{1 - r^2/a^2}` on the
    projection of its pole, in equilibrium with a uniform body force. The approach, conjugate to F,
    is the displacement relative to
    the mean of the sphere, averaged with the weight p. For the half space it is :math:`0.6\,(1 -
    \nu^2) F / (E a)`; for the sphere
    that plus :math:`c\,F/(E R)`.

    A. I. Lur'e, Three-dimensional Problems of the Theory of Elasticity (1964), gives the
    displacements for a traction that is a Legendre polynomial of degree n. From each degree the
    term of the half space with the wave number (n + 1/2) / R is subtracted: the sum of these over
    all degrees is the approach of the half space exactly, as the pressure is zero beyond a
    (Poisson's summation formula), and the differences decrease with the fourth power of n a / R.

    Examples
    --------
    >>> finite_sphere_factor(0.28, [0.04, 0.18]).round(4).tolist()
    [-0.3773, -0.4209]
    """
    ratios = np.asarray(radius_ratio, dtype=float)
    if not (0.0 <= poissons_ratio <= 0.5 and ((ratios >= _SMALLEST) & (ratios <= _LARGEST)).all()):
        raise InputError(
            "the finite size of a sphere is known for Poisson's ratios from 0 to 0.5 and "
            f"contact radii from {_SMALLEST:g} to {_LARGEST:g} "
            f"of its radius, not for {poissons_ratio:g} and {ratios}"
        )
    return np.reshape(
        [_factor(poissons_ratio, ratio) for ratio in ratios.ravel().tolist()], ratios.shape
    )


@functools.cache
def _factor(poissons_ratio: float, ratio: float) -> float:
    """Return c at one ratio of radii, as a sum over the degrees."""
    radial, tangential = _loads(ratio)
    outwards, along = _displacements(poissons_ratio, radial, tangential)
    place = (np.arange(len(radial)) + 0.5) * ratio
    half_space = (
        (1.0 - poissons_ratio**2)
        / np.pi
        * (3.0 * (np.sin(place) - place * np.cos(place)) / place**3) ** 2
    )
    return float((outwards * radial + along * tangential - half_space).sum())


def _loads(ratio: float) -> tuple[Floats, Floats]:
    """Return the work of a unit force on radial displacements P_n(cos theta), and on
    meridional ones dP_n / d theta, by degree.
    """
    nodes, weights = _gauss()
    angle = 0.25 * np.pi * (nodes + 1.0)  # r = a sin(angle) removes the square root of the pressure
    force = 0.25 * np.pi * weights * 3.0 * np.cos(angle) ** 2 * np.sin(angle)
    sine = ratio * np.sin(angle)
    cosine = np.sqrt(1.0 - sine**2)
    depth = sine**2 / (1.0 + cosine)
    count = math.ceil(_REACH / ratio) + _LEAST
    values, steps = np.ones((count, len(nodes))), np.zeros((count, len(nodes)))
    # Bonnet's recursion for differences, as successive values nearly cancel near the pole
    for n in range(1, count):
        steps[n] = ((n - 1) * steps[n - 1] - (2 * n - 1) * depth * values[n - 1]) / n
        values[n] = values[n - 1] + steps[n]
    slopes = np.arange(count)[:, None] * (steps - depth * values) / sine
    return -values @ (force * cosine), slopes @ (force * sine)


@functools.cache
def _gauss() -> tuple[Floats, Floats]:
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    return np.asarray(nodes), np.asarray(weights)


def _displacements(
    poissons_ratio: float, radial: Floats, tangential: Floats
) -> tuple[Floats, Floats]:
    """Return the radial and meridional surface displacements by degree, for a sphere of unit radius
    and modulus under the loads.

    Tractions over twice the shear modulus are met by two fields per degree, which are of order r^(n
    + 1) and r^(n - 1); for degree 1 both are of order r^2, with the body force, and the mean
    displacement is subtracted; degree 0 has one field.
    """
    nu, degree = poissons_ratio, np.arange(len(radial), dtype=float)
    normal = (2.0 * degree + 1.0) * (1.0 + nu) / (4.0 * np.pi) * radial
    shear = (
        (2.0 * degree + 1.0)
        * (1.0 + nu)
        / (4.0 * np.pi * np.maximum(degree * (degree + 1.0), 1.0))
        * tangential
    )
    n, t, s = degree[2:], normal[2:], shear[2:]
    of_first, of_second = (n + 1.0) * (n**2 - n - 2.0 - 2.0 * nu), n * (n - 1.0)
    along_first, along_second = n**2 + 2.0 * n - 1.0 + 2.0 * nu, n - 1.0
    determinant = of_first * along_second - of_second * along_first
    first = (t * along_second - s * of_second) / determinant
    second = (s * of_first - t * along_first) / determinant
    uniform = normal[0] * (1.0 - 2.0 * nu) / (1.0 + nu)
    # coefficient of r^2 e_z
    along_axis = (2.0 * shear[1] - 0.5 * (1.0 - 2.0 * nu) * normal[1]) / (1.0 + nu)
    # coefficient of z times the position vector
    along_radius = ((1.0 - 2.0 * nu) * normal[1] - 2.0 * (1.0 - nu) * shear[1]) / (1.0 + nu)
    mean = 0.6 * along_axis + 0.2 * along_radius
    outwards = np.concatenate(
        [
            [uniform, along_axis + along_radius - mean],
            first * (n + 1.0) * (n - 2.0 + 4.0 * nu) + second * n,
        ]
    )
    along = np.concatenate([[0.0, along_axis - mean], first * (n + 5.0 - 4.0 * nu) + second])
    return outwards, along
