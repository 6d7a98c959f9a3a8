"""Finite-size correction of Hertz's theory for an elastic sphere.

It is the approach of the sphere under a contact pressure less that of the half space.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError

# the series has _REACH / (a / R) + _LEAST degrees; three times both change c by less than 5e-6
_REACH = 20.0
_LEAST = 60
_NODES = 40  # of the integral over the contact, where the harmonics have at most fifteen zeros
_SMALLEST = 0.005  # a / R: below it the series cancels
_LARGEST = 0.5  # a / R: above it Hertz's pressure does not apply
_FITTED_RATIOS = 9  # number of ratios a / R in the fit

FITTED = (0.01, 0.35)
"""Range of the ratio a / R of the radii of contact and sphere in which `sphere_term` holds."""


@dataclass(frozen=True)
class SphereTerm:
    r"""Finite-size factor of a sphere as a function of the ratio of the radii x = a / R.

    The radii are those of the contact and of the sphere.

    Parameters
    ----------
    constant, logarithm, linear, square : float
        Coefficients of :math:`c(x) = c_0 + c_l \ln x + c_1 x + c_2 x^2` [-].

    Notes
    -----
    The approach is that of Hertz plus :math:`s(F) = c(a/R)\,F/(E R)`. As a is proportional to
    :math:`F^{1/3}`, each term has an integral in closed form.
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
    around a point force F the surface of the half space has the radial stress :math:`(1-2\nu) F /
    2\pi r^2` and the radial displacement :math:`(1-2\nu)(1+\nu) F / 2\pi E r` inwards. As the
    sphere's surface has the slope r / R there, that stress would leave a traction on it; the work
    of the traction on that displacement, for r from a to R, gives :math:`c_l = -(1-2\nu)^2 (1+\nu)
    / 2\pi`.

    Examples
    --------
    >>> round(float(sphere_term(0.28).factor(0.1)), 3)
    -0.407
    """
    middle = 0.5 * (FITTED[1] + FITTED[0])
    half_range = 0.5 * (FITTED[1] - FITTED[0])
    # Chebyshev nodes, for a nearly best fit
    angles = np.pi * (np.arange(_FITTED_RATIOS) + 0.5) / _FITTED_RATIOS
    ratios = middle + half_range * np.cos(angles)
    logarithm = -((1.0 - 2.0 * poissons_ratio) ** 2) * (1.0 + poissons_ratio) / (2.0 * math.pi)
    polynomial = finite_sphere_factor(poissons_ratio, ratios) - logarithm * np.log(ratios)
    square, linear, constant = np.polyfit(ratios, polynomial, 2).tolist()
    return SphereTerm(constant, logarithm, linear, square)


def finite_sphere_factor(poissons_ratio: float, radius_ratio: Floats | float) -> Floats:
    r"""Return the approach of an elastic sphere less that of Hertz's theory, over F / (E R).

    The sphere touches a rigid plane.

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
    a^2}\sqrt{1 - r^2/a^2}` on the projection of its pole, in equilibrium with a uniform body force.
    The approach, conjugate to F, is the displacement relative to the mean of the sphere, averaged
    with the weight p. For the half space it is :math:`0.6\,(1 - \nu^2) F / (E a)`; for the sphere
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
    radial_loads, meridional_loads = _loads(ratio)
    radial, meridional = _displacements(poissons_ratio, radial_loads, meridional_loads)
    # the half space under Hertz's pressure, at the wave number (n + 1/2) / R of each degree; the
    # Hankel transform of the pressure is 3 (sin x - x cos x) / x^3
    x = (np.arange(len(radial_loads)) + 0.5) * ratio
    half_space = (1.0 - poissons_ratio**2) / np.pi * (3.0 * (np.sin(x) - x * np.cos(x)) / x**3) ** 2
    return float((radial * radial_loads + meridional * meridional_loads - half_space).sum())


def _loads(ratio: float) -> tuple[Floats, Floats]:
    """Return the radial and the meridional load of a unit force on the sphere, by degree n.

    They are its work on radial displacements P_n(cos theta), and on meridional ones
    dP_n / d theta.
    """
    nodes, weights = _gauss()
    # r = a sin(angle) removes the root of Hertz's pressure, p = 3/(2 pi a^2) sqrt(1 - r^2/a^2):
    # 2 pi p r dr = 3 cos^2(angle) sin(angle) d angle, from 0 to pi/2
    angle = 0.25 * np.pi * (nodes + 1.0)
    force = 0.25 * np.pi * weights * 3.0 * np.cos(angle) ** 2 * np.sin(angle)
    # of the polar angle theta on the sphere
    sine = ratio * np.sin(angle)
    cosine = np.sqrt(1.0 - sine**2)
    one_less_cosine = sine**2 / (1.0 + cosine)

    degrees = math.ceil(_REACH / ratio) + _LEAST
    legendre = np.ones((degrees, len(nodes)))  # P_n(cos theta)
    differences = np.zeros((degrees, len(nodes)))  # P_n - P_(n-1)
    # Bonnet's recursion for differences, as successive values nearly cancel near the pole
    for n in range(1, degrees):
        of_last_difference = (n - 1) * differences[n - 1]
        of_last_value = (2 * n - 1) * one_less_cosine * legendre[n - 1]
        differences[n] = (of_last_difference - of_last_value) / n
        legendre[n] = legendre[n - 1] + differences[n]
    # sin(theta) dP_n/d theta = n (cos(theta) P_n - P_(n-1))
    n_column = np.arange(degrees)[:, None]
    slopes = n_column * (differences - one_less_cosine * legendre) / sine
    radial = -legendre @ (force * cosine)
    meridional = slopes @ (force * sine)
    return radial, meridional


@functools.cache
def _gauss() -> tuple[Floats, Floats]:
    """Return the nodes and weights of Gauss's rule from -1 to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    return np.asarray(nodes), np.asarray(weights)


def _displacements(
    poissons_ratio: float, radial_loads: Floats, meridional_loads: Floats
) -> tuple[Floats, Floats]:
    """Return the radial and the meridional displacements of the surface under the loads, by degree.

    The sphere is of unit radius and modulus. Tractions over twice the shear modulus are met by two
    fields per degree, which are of order r^(n + 1) and r^(n - 1); for degree 1 both are of order
    r^2, with the body force, and the mean displacement is subtracted; degree 0 has one field.
    """
    nu = poissons_ratio
    degree = np.arange(len(radial_loads), dtype=float)
    # tractions over twice the shear modulus; (2 n + 1) / 4 pi, and n (n + 1) for the meridional
    # ones, are the norms of the harmonics
    normal = (2.0 * degree + 1.0) * (1.0 + nu) / (4.0 * np.pi) * radial_loads
    meridional_norm = np.maximum(degree * (degree + 1.0), 1.0)
    shear = (2.0 * degree + 1.0) * (1.0 + nu) / (4.0 * np.pi * meridional_norm) * meridional_loads
    meridional_1, radial_1 = _first_degree(nu, normal[1], shear[1])
    expansion = normal[0] * (1.0 - 2.0 * nu) / (1.0 + nu)

    n = degree[2:]
    outer, inner = _field_amplitudes(nu, n, normal[2:], shear[2:])
    radial_beyond_1 = outer * (n + 1.0) * (n - 2.0 + 4.0 * nu) + inner * n
    meridional_beyond_1 = outer * (n + 5.0 - 4.0 * nu) + inner
    radial = np.concatenate([[expansion, radial_1], radial_beyond_1])
    meridional = np.concatenate([[0.0, meridional_1], meridional_beyond_1])
    return radial, meridional


def _field_amplitudes(nu: float, n: Floats, normal: Floats, shear: Floats) -> tuple[Floats, Floats]:
    """Return the amplitudes of the fields of order r^(n + 1) and r^(n - 1), for degrees n >= 2.

    They solve two equations, for the normal and for the shear traction.
    """
    normal_of_outer = (n + 1.0) * (n**2 - n - 2.0 - 2.0 * nu)
    normal_of_inner = n * (n - 1.0)
    shear_of_outer = n**2 + 2.0 * n - 1.0 + 2.0 * nu
    shear_of_inner = n - 1.0
    determinant = normal_of_outer * shear_of_inner - normal_of_inner * shear_of_outer
    outer = (normal * shear_of_inner - shear * normal_of_inner) / determinant
    inner = (shear * normal_of_outer - normal * shear_of_outer) / determinant
    return outer, inner


def _first_degree(nu: float, normal: float, shear: float) -> tuple[float, float]:
    """Return the meridional and the radial displacement of degree 1, less the mean displacement."""
    # coefficient of r^2 e_z
    along_axis = (2.0 * shear - 0.5 * (1.0 - 2.0 * nu) * normal) / (1.0 + nu)
    # coefficient of z times the position vector
    along_radius = ((1.0 - 2.0 * nu) * normal - 2.0 * (1.0 - nu) * shear) / (1.0 + nu)
    mean = 0.6 * along_axis + 0.2 * along_radius  # over the volume of the sphere
    return along_axis - mean, along_axis + along_radius - mean
