"""The finite size of an elastic sphere: what its approach under a contact pressure lacks of that of the half space."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError

_REACH, _LEAST = 20.0, 60  # degrees of the series, over a / R, and more; three times as many of both change c by less than 5e-6
_NODES = 40  # of the integral over the patch, on which the harmonics have no more than fifteen zeros
_SMALLEST, _LARGEST = 0.005, 0.5  # ratios: below cancellation begins, above Hertz's pressure is meaningless
_PLACES = 9  # of the fit

FITTED = (0.01, 0.35)
"""Ratios of the radii of contact and sphere for which `sphere_term` holds."""


@dataclass(frozen=True)
class SphereTerm:
    r"""The finite-size factor of a sphere as a function of the ratio of radii x = a / R of contact and sphere.

    Parameters
    ----------
    constant, logarithm, linear, square : float
        Of :math:`c(x) = c_0 + c_l \ln x + c_1 x + c_2 x^2` [-].

    Notes
    -----
    The approach is that of Hertz plus :math:`s(F) = c(a/R)\,F/(E R)`. As a goes with :math:`F^{1/3}`, each part has an integral
    in closed form.
    """

    constant: float
    logarithm: float
    linear: float
    square: float

    def factor(self, radius_ratio: Floats | float) -> Floats:
        """Return c [-] at ratios of radii a / R, > 0."""
        x = np.asarray(radius_ratio, dtype=float)
        return np.asarray(self.constant + self.logarithm * np.log(x) + (self.linear + self.square * x) * x)


@functools.cache
def sphere_term(poissons_ratio: float) -> SphereTerm:
    r"""Return the finite-size factor of a sphere of a Poisson's ratio, in closed form.

    Notes
    -----
    Constant, linear and square are fitted to `finite_sphere_factor` by least squares for a / R from 0.01 to 0.35, where all is off
    by less than 3e-4. The logarithm is that of small contacts. Around a point force F the surface of the half space is under the
    radial stress :math:`(1-2\nu) F / 2\pi r^2` and moves by :math:`(1-2\nu)(1+\nu) F / 2\pi E r` inwards. The sphere's surface
    slopes by r / R there, and what the half space's stress lacks of leaving it free works on that motion at all r from a to R:
    :math:`c_l = -(1-2\nu)^2 (1+\nu) / 2\pi`.

    Examples
    --------
    >>> round(float(sphere_term(0.28).factor(0.1)), 3)
    -0.407
    """
    middle, half = 0.5 * (FITTED[1] + FITTED[0]), 0.5 * (FITTED[1] - FITTED[0])
    places = middle + half * np.cos(np.pi * (np.arange(_PLACES) + 0.5) / _PLACES)  # Chebyshev's: nearly the best fit
    logarithm = -((1.0 - 2.0 * poissons_ratio) ** 2) * (1.0 + poissons_ratio) / (2.0 * math.pi)
    rest = finite_sphere_factor(poissons_ratio, places) - logarithm * np.log(places)
    square, linear, constant = np.polyfit(places, rest, 2).tolist()
    return SphereTerm(constant, logarithm, linear, square)


def finite_sphere_factor(poissons_ratio: float, radius_ratio: Floats | float) -> Floats:
    r"""Return what the approach of an elastic sphere to a rigid plane lacks of Hertz's, over F / (E R).

    Parameters
    ----------
    poissons_ratio : float
        Poisson's ratio nu [-], from 0 to 0.5.
    radius_ratio : array or float
        Radius of the contact over that of the sphere, a / R [-], from 0.005 to 0.5.

    Returns
    -------
    array
        c [-], within 1e-5.

    Raises
    ------
    InputError
        If a ratio is out of its range.

    Notes
    -----
    A sphere carries vertical traction of Hertz's pressure :math:`p = \tfrac{3F}{2\pi a^2}\sqrt{1 - r^2/a^2}` on the projection
    of its pole, and a uniform body force balances it. The approach, conjugate to F, is the displacement relative to the mean of
    the sphere, averaged with p. Of the half space it is :math:`0.6\,(1 - \nu^2) F / (E a)`, and the sphere's is that plus
    :math:`c\,F/(E R)`.

    A. I. Lur'e, Three-dimensional Problems of the Theory of Elasticity (1964), gives the displacements for a traction that is a
    Legendre polynomial of degree n. The half space under the wave number (n + 1/2) / R is taken from each degree: over all
    degrees these sum to its approach exactly, as the pressure vanishes beyond a (Poisson's sum formula), and the differences
    fall with the fourth power of n a / R.

    Examples
    --------
    >>> finite_sphere_factor(0.28, [0.04, 0.18]).round(4).tolist()
    [-0.3773, -0.4209]
    """
    ratios = np.asarray(radius_ratio, dtype=float)
    if not (0.0 <= poissons_ratio <= 0.5 and ((ratios >= _SMALLEST) & (ratios <= _LARGEST)).all()):
        raise InputError(
            f"the finite size of a sphere is known for Poisson's ratios from 0 to 0.5 and contact radii from {_SMALLEST:g} to {_LARGEST:g} "
            f"of its radius, not for {poissons_ratio:g} and {ratios}"
        )
    return np.reshape([_factor(poissons_ratio, ratio) for ratio in ratios.ravel().tolist()], ratios.shape)


@functools.cache
def _factor(poissons_ratio: float, ratio: float) -> float:
    radial, tangential = _loads(ratio)
    outwards, along = _displacements(poissons_ratio, radial, tangential)
    place = (np.arange(len(radial)) + 0.5) * ratio
    half_space = (1.0 - poissons_ratio**2) / np.pi * (3.0 * (np.sin(place) - place * np.cos(place)) / place**3) ** 2
    return float((outwards * radial + along * tangential - half_space).sum())


def _loads(ratio: float) -> tuple[Floats, Floats]:
    """Return the work of a unit force on outward displacements P_n(cos theta), and on dP_n / d theta along the meridian."""
    nodes, weights = _gauss()
    angle = 0.25 * np.pi * (nodes + 1.0)  # r = a sin(angle) takes the root out of the pressure
    force = 0.25 * np.pi * weights * 3.0 * np.cos(angle) ** 2 * np.sin(angle)
    sine = ratio * np.sin(angle)
    cosine = np.sqrt(1.0 - sine**2)
    depth = sine**2 / (1.0 + cosine)
    count = math.ceil(_REACH / ratio) + _LEAST
    values, steps = np.ones((count, len(nodes))), np.zeros((count, len(nodes)))
    for n in range(1, count):  # Bonnet's recursion by differences: near the pole neighbours are nearly equal
        steps[n] = ((n - 1) * steps[n - 1] - (2 * n - 1) * depth * values[n - 1]) / n
        values[n] = values[n - 1] + steps[n]
    slopes = np.arange(count)[:, None] * (steps - depth * values) / sine
    return -values @ (force * cosine), slopes @ (force * sine)


@functools.cache
def _gauss() -> tuple[Floats, Floats]:
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    return np.asarray(nodes), np.asarray(weights)


def _displacements(poissons_ratio: float, radial: Floats, tangential: Floats) -> tuple[Floats, Floats]:
    """Return the displacements of the surface, degree by degree, of a sphere of unit radius and modulus under such loads.

    Tractions over twice the shear modulus are matched by two fields a degree: growing as r^(n + 1) and as r^(n - 1); of degree 1
    as r^2 both, with the body force, and the mean displacement taken away; of degree 0 there is one.
    """
    nu, degree = poissons_ratio, np.arange(len(radial), dtype=float)
    normal = (2.0 * degree + 1.0) * (1.0 + nu) / (4.0 * np.pi) * radial
    shear = (2.0 * degree + 1.0) * (1.0 + nu) / (4.0 * np.pi * np.maximum(degree * (degree + 1.0), 1.0)) * tangential
    n, t, s = degree[2:], normal[2:], shear[2:]
    of_first, of_second = (n + 1.0) * (n**2 - n - 2.0 - 2.0 * nu), n * (n - 1.0)
    along_first, along_second = n**2 + 2.0 * n - 1.0 + 2.0 * nu, n - 1.0
    determinant = of_first * along_second - of_second * along_first
    first = (t * along_second - s * of_second) / determinant
    second = (s * of_first - t * along_first) / determinant
    uniform = normal[0] * (1.0 - 2.0 * nu) / (1.0 + nu)
    along_axis = (2.0 * shear[1] - 0.5 * (1.0 - 2.0 * nu) * normal[1]) / (1.0 + nu)  # times r^2 e_z
    along_radius = ((1.0 - 2.0 * nu) * normal[1] - 2.0 * (1.0 - nu) * shear[1]) / (1.0 + nu)  # times z r, the vector
    mean = 0.6 * along_axis + 0.2 * along_radius
    outwards = np.concatenate([[uniform, along_axis + along_radius - mean], first * (n + 1.0) * (n - 2.0 + 4.0 * nu) + second * n])
    along = np.concatenate([[0.0, along_axis - mean], first * (n + 5.0 - 4.0 * nu) + second])
    return outwards, along
