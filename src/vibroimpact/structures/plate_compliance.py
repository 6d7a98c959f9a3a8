r"""Correction of the point compliance of a plate for what finite elements do not resolve.

They give the compliance of plate theory, or the response of the opposite face. A pressure of wave
number k on the upper face of an elastic layer displaces that face by A + S, and the lower face by
A - S, with :math:`A = \frac{2(1-\nu^2)}{E k}\frac{\cosh^2 x}{\sinh 2x - 2x}`, :math:`S =
\frac{2(1-\nu^2)}{E k}\frac{\sinh^2 x}{\sinh 2x + 2x}` and x = k h / 2 (I. N. Sneddon, Fourier
Transforms, 1951, section 46), and that of the half space by :math:`2(1-\nu^2)/(E k)`. The
structural compliance is that of a point under a normal force less that of the half space, with the
kernel :math:`A + S - 2(1-\nu^2)/(E k)`.

Finite elements give the compliance with load and response averaged over a disc, each with the
transform :math:`d(k) = 1 - k^2 \overline{r^2}/4 + \ldots`. The mean of r^2 is chosen so that both
kernels agree in the terms :math:`k^{-4}` and :math:`k^{-2}`. The integral of their difference over
:math:`k\,dk/2\pi` then depends on the layer near the point only, not on the edges of the plate or
its supports.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats

_PLATES = 64  # of which the terms are cached, for other places on them
_NODES = 16  # of Gauss's rule on each interval of the integral
_DEEPEST = 40.0  # wave number times thickness beyond which the faces are uncoupled
_FINEST = 100.0  # wave number times radius at which the integral ends: the rest is 1e-6 of the term


@dataclass(frozen=True)
class Average:
    r"""Average over a disc with the weight :math:`1 + \beta (1 - 2 r^2 / b^2)`.

    Parameters
    ----------
    radius : float
        Radius b [m], >= 0.
    tilt : float
        beta [-]; with 3 the mean of r^2 is zero.
    """

    radius: float
    tilt: float

    def weights(self, places: Floats) -> Floats:
        """Return the weight at places on the unit disc, shape (points, 2)."""
        return np.asarray(1.0 + self.tilt * (1.0 - 2.0 * (places**2).sum(axis=1)))

    def transform(self, k: Floats) -> Floats:
        """Return the transform d: the average of a wave of wave number k [1/m]."""
        from scipy.special import jv

        z = k * self.radius
        return np.asarray(jv(0, z) + jv(2, z) + self.tilt / 3.0 * (jv(2, z) + jv(4, z)))


def through_thickness_average(radius: float) -> Average:
    """Return the average of `through_thickness_term` over a disc of a radius [m].

    The mean of r^2 is zero.
    """
    return Average(radius, 3.0)


@functools.lru_cache(maxsize=_PLATES)
def through_thickness_term(
    thickness: float, youngs_modulus: float, poissons_ratio: float, average: Average
) -> float:
    r"""Return the structural compliance of a plate less that of its opposite face [m/N].

    The latter is averaged over a disc.

    Parameters
    ----------
    thickness : float
        Thickness h [m], > 0.
    youngs_modulus, poissons_ratio : float
        E [Pa] and nu [-].
    average : Average
        Average of the force on one face, and of the displacement of the other:
        `through_thickness_average`.

    Notes
    -----
    The kernel that is subtracted is :math:`(A - S)\,d^2`. For points, of radius 0, A cancels and
    the term is :math:`\frac{2(1-\nu^2)}{\pi E h} \int_0^\infty \left(\frac{2\sinh^2 x}{\sinh 2x +
    2x} - 1\right) dx = -1.1676\,\frac{2(1-\nu^2)}{\pi E h}`.

    Examples
    --------
    >>> round(
    ...     through_thickness_term(0.01, 210e9, 0.3, through_thickness_average(0.0))
    ...     * 210e9
    ...     * 0.01
    ...     * 3.14159265
    ...     / (2 * 0.91),
    ...     4,
    ... )
    -1.1676
    """
    modulus = youngs_modulus / (1.0 - poissons_ratio**2)  # in plane strain

    def kernel(k: Floats) -> Floats:
        half_space = 2.0 / (modulus * k)
        bending, squeezing = layer_kernels(k * thickness)  # over the half space
        structural = bending + squeezing - 1.0
        opposite_face = (bending - squeezing) * average.transform(k) ** 2
        return np.asarray(half_space * (structural - opposite_face))

    return _integral(kernel, thickness, average)


def plate_theory_average(
    radius: float, thickness: float, poissons_ratio: float, shear_factor: float
) -> Average:
    """Return the average of `plate_theory_term` over a disc of a radius [m].

    The mean of r^2 is `mean_square`.
    """
    square = mean_square(thickness, poissons_ratio, shear_factor)
    return Average(radius, 3.0 - 6.0 * square / radius**2)


def mean_square(thickness: float, poissons_ratio: float, shear_factor: float) -> float:
    r"""Return the mean of r^2 with which plate theory agrees with the face of a layer [m^2].

    It is that of an average over a disc; they agree for long waves.

    Notes
    -----
    :math:`\overline{r^2} = 2 h^2 \left(\frac{1}{6 (1 - \nu) \kappa} - \frac15\right)`.
    """
    return 2.0 * thickness**2 * (1.0 / (6.0 * (1.0 - poissons_ratio) * shear_factor) - 0.2)


@functools.lru_cache(maxsize=_PLATES)
def plate_theory_term(
    thickness: float,
    youngs_modulus: float,
    poissons_ratio: float,
    shear_factor: float,
    average: Average,
) -> float:
    r"""Return the structural compliance of a plate less the averaged one of plate theory [m/N].

    Parameters
    ----------
    thickness : float
        Thickness h [m], > 0.
    youngs_modulus, poissons_ratio : float
        E [Pa] and nu [-].
    shear_factor : float
        Factor kappa of the shear stiffness [-].
    average : Average
        Average of the force and of the displacement: `plate_theory_average`, of a radius > 0.

    Notes
    -----
    The kernel that is subtracted is :math:`\left(\frac{1}{D k^4} + \frac{1}{\kappa G h k^2}\right)
    d^2` (R. D. Mindlin, J. Appl. Mech. 18:31, 1951).

    Examples
    --------
    >>> average = plate_theory_average(0.0075, 0.01, 0.3, 5 / 5.7)
    >>> round(plate_theory_term(0.01, 210e9, 0.3, 5 / 5.7, average) * 210e9 * 0.01, 4)
    -0.5982
    """
    modulus = youngs_modulus / (1.0 - poissons_ratio**2)
    rigidity = modulus * thickness**3 / 12.0
    # kappa G h, with G = E/(2 (1 + nu)) = (1 - nu)/2 of the modulus in plane strain
    shear_stiffness = shear_factor * 0.5 * (1.0 - poissons_ratio) * modulus * thickness

    def kernel(k: Floats) -> Floats:
        structural = 2.0 / (modulus * k) * (np.sum(layer_kernels(k * thickness), axis=0) - 1.0)
        plate_theory = 1.0 / (rigidity * k**4) + 1.0 / (shear_stiffness * k**2)
        return np.asarray(structural - plate_theory * average.transform(k) ** 2)

    return _integral(kernel, thickness, average)


def layer_kernels(y: Floats) -> tuple[Floats, Floats]:
    """Return A and S over the kernel of the half space, at y = k h.

    For short waves each tends to 1/2.
    """
    # with x = y/2: cosh^2 x = (1 + cosh y)/2 and sinh^2 x = (cosh y - 1)/2
    y = np.minimum(y, _DEEPEST)
    bending = (1.0 + np.cosh(y)) / (2.0 * _sinh_less(y))
    squeezing = (np.cosh(y) - 1.0) / (2.0 * (np.sinh(y) + y))
    return bending, squeezing


def _sinh_less(y: Floats) -> Floats:
    """Return sinh y - y, by its series where the difference would cancel."""
    # y^3/6 (1 + y^2/(4 5) (1 + y^2/(6 7) ...)), by Horner's rule
    series = np.ones_like(y)
    for n in range(17, 3, -2):
        series = 1.0 + y**2 / (n * (n - 1)) * series
    return np.asarray(np.where(y < 2.0, y**3 / 6.0 * series, np.sinh(y) - y))


def _integral(kernel: Callable[[Floats], Floats], thickness: float, average: Average) -> float:
    """Return the integral of a kernel over k dk / 2 pi from zero to the cutoff.

    It is taken by Gauss's rule on equal intervals.
    """
    largest = max(thickness, average.radius)
    cutoff = _DEEPEST / thickness
    if average.radius:
        cutoff = max(cutoff, _FINEST / average.radius)
    intervals = math.ceil(largest * cutoff)  # each of the length 1 / largest
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    k = (np.arange(intervals)[:, None] + 0.5 * (nodes + 1.0)).ravel() / largest
    return float(kernel(k) @ (k * np.tile(weights, intervals)) / (4.0 * math.pi * largest))
