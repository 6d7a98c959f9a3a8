r"""Waves in a plate: plate theory compared with three-dimensional elasticity of a layer.

Bending strains a plate across its thickness (Poisson's ratio), so that its face moves less than
plate theory states, of which the deflection is a mean over the thickness. The factor between them
is the ratio of two shapes of unit modal mass at the same wave number: the lowest antisymmetric wave
of a layer (H. Lamb, On waves in an elastic plate, Proc. R. Soc. A 93:114, 1917) at its face, and
the deflection of R. D. Mindlin's plate (J. Appl. Mech. 18:31, 1951). For long waves, of wave number
k, it is

.. math::

    d = 1 - \frac{k^2 \overline{r^2}}{4} + \ldots,\qquad
    \overline{r^2} = 2 h^2 \left(\frac{1}{6 (1 - \nu) \kappa} - \frac15\right)
"""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.polynomial import Chebyshev

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.plate_compliance import mean_square
from vibroimpact.structures.plate_element import shear_factor

_LARGEST = 8.0  # wave number times thickness beyond which the factor is constant
_DEGREE = 24  # of the polynomial that interpolates the factor within 3e-8
_RATIOS = 64  # Poisson's ratios of which the factor is cached
_HALVINGS = 60  # of the bisection
# wave number times thickness below which errors of plate theory go with its square, as rounding
# hides them
_LEAST = 0.05
_NODES = 24  # of Gauss's rule across the thickness
# coefficients of powers of Poisson's ratio, within 0.2 %; without waves longer than 20 thicknesses
_INERTIA = (0.02432, -0.03887, 0.05163)


def bending_factor(wave: Floats, poissons_ratio: float) -> Floats:
    """Return the displacement of the face of a plate in a bending wave over the deflection of plate
    theory [-].

    Parameters
    ----------
    wave : array
        Wave number times thickness [-].
    poissons_ratio : float
        Poisson's ratio [-].

    Examples
    --------
    >>> bending_factor(np.array([0.0, 0.5, 1.0, 2.0]), 0.3).round(4).tolist()
    [1.0, 0.9917, 0.9727, 0.9358]
    """
    return np.asarray(_factor(poissons_ratio)(np.minimum(wave, _LARGEST)))


def bending_error(wave: Floats, poissons_ratio: float, thin: bool = False) -> Floats:
    """Return the relative error of plate theory in the frequency of a bending wave, with respect to
    the layer [-].

    Parameters
    ----------
    wave : array
        Wave number times thickness [-], > 0.
    poissons_ratio : float
        Poisson's ratio [-].
    thin : bool, default False
        Whether the frequency is that of Kirchhoff's theory instead of Mindlin's.

    Examples
    --------
    >>> bending_error(np.array([1.0, 2.0]), 0.3).round(5).tolist()
    [-0.00028, -0.00157]
    >>> bending_error(np.array([1.0, 1e-3]), 0.3, thin=True).round(9).tolist()
    [0.156335414, 1.77e-07]
    """
    resolved = np.maximum(wave, _LEAST)
    exact = _lamb(resolved, poissons_ratio)[0]
    theory = (
        resolved**2 * math.sqrt(1.0 / (6.0 * (1.0 - poissons_ratio)))
        if thin
        else _mindlin(resolved, poissons_ratio)[0]
    )
    return np.asarray((theory / exact - 1.0) * (wave / resolved) ** 2)


def stiff_shear_error(wave: Floats, poissons_ratio: float) -> Floats:
    """Return the relative increase of the frequency of bending waves in Mindlin's theory without
    shear correction [-].

    Parameters
    ----------
    wave : array
        Wave number times thickness [-], > 0.
    poissons_ratio : float
        Poisson's ratio [-].
    """
    return np.asarray(
        _mindlin(wave, poissons_ratio, 1.0)[0] / _mindlin(wave, poissons_ratio)[0] - 1.0
    )


def stretching_error(angular_frequencies: Floats, thickness: float, material: Material) -> Floats:
    r"""Return the relative error of plate theory in the frequencies of in-plane longitudinal waves
    [-].

    It is :math:`(\nu k h)^2 / 24 (1-\nu)^2`, to the second order in the wave number k (Lamb 1917).

    Parameters
    ----------
    angular_frequencies : array
        Angular frequencies [rad/s].
    thickness : float
        Thickness h [m].
    material : Material
        Material of the plate.
    """
    ratio = material.poissons_ratio
    wave = (
        thickness
        * angular_frequencies
        * math.sqrt(material.density * (1.0 - ratio**2) / material.youngs_modulus)
    )
    return np.asarray((ratio * wave / (1.0 - ratio)) ** 2 / 24.0)


def shear_wave_factor(square: Floats, poissons_ratio: float) -> Floats:
    r"""Return the counterpart of `bending_factor` for shear waves, to the second order: :math:`1 /
    (1 + k^2 \overline{r^2} / 4)` [-].

    Parameters
    ----------
    square : array
        Square of wave number times thickness [-]; may be negative.
    poissons_ratio : float
        Poisson's ratio [-].
    """
    return np.asarray(
        1.0 / (1.0 + 0.25 * mean_square(1.0, poissons_ratio, shear_factor(poissons_ratio)) * square)
    )


def inertia_beyond_bending(thickness: float, material: Material) -> float:
    r"""Return the contribution of the waves of a layer other than bending to :math:`\sum \varphi^2
    / \omega^4` at a point [m s^2/N].

    It is the response of the face to the second derivative of a force in excess of plate theory,
    :math:`c\,\rho h / G^2`. The factor
    c, from :math:`\int \sum \varphi^2 \omega^{-4} k\,dk / 2\pi` over all other branches, is fitted
    by a parabola in Poisson's ratio.

    Parameters
    ----------
    thickness : float
        Thickness h [m].
    material : Material
        Material of the plate.

    Examples
    --------
    >>> from vibroimpact.materials import find_material
    >>> f"{inertia_beyond_bending(0.01, find_material('steel-paper')):.2g}"
    '2.1e-22'
    """
    ratio = material.poissons_ratio
    shear = 0.5 * material.youngs_modulus / (1.0 + ratio)
    return (
        float(np.polynomial.polynomial.polyval(ratio, _INERTIA))
        * material.density
        * thickness
        / shear**2
    )


def wave_numbers(
    angular_frequencies: Floats, thickness: float, material: Material, thin: bool = False
) -> Floats:
    """Return the wave numbers of bending waves [1/m] at angular frequencies [rad/s], by
    Mindlin's or Kirchhoff's (`thin`) theory.
    """
    if thin:
        rigidity = (
            material.youngs_modulus * thickness**2 / (12.0 * (1.0 - material.poissons_ratio**2))
        )
        return np.asarray((material.density * angular_frequencies**2 / rigidity) ** 0.25)
    return np.asarray(np.sqrt(mindlin_squares(angular_frequencies, thickness, material)[0]))


def mindlin_squares(
    omega: Floats, thickness: float, material: Material
) -> tuple[Floats, Floats, Floats]:
    r"""Return the squares of both wave numbers of Mindlin's plate, and :math:`\rho \omega^2 /
    \kappa G` [1/m^2].

    That of the bending wave is positive. That of the shear wave is negative below :math:`\sqrt{12
    \kappa G / (\rho h^2)}`, where it is
    evanescent.

    Parameters
    ----------
    omega : array
        Angular frequencies [rad/s].
    thickness : float
        Thickness h [m].
    material : Material
        Material of the plate.
    """
    ratio = material.poissons_ratio
    modulus = material.youngs_modulus / (1.0 - ratio**2)
    lag = material.density * omega**2 / (shear_factor(ratio) * 0.5 * (1.0 - ratio) * modulus)
    turn = material.density * omega**2 / modulus  # of rotary inertia
    root = np.sqrt(0.25 * (lag - turn) ** 2 + 12.0 * turn / thickness**2)
    return 0.5 * (lag + turn) + root, 0.5 * (lag + turn) - root, lag


@functools.lru_cache(maxsize=_RATIOS)
def _factor(poissons_ratio: float) -> Chebyshev:
    """Return `bending_factor` as a polynomial in wave number times thickness."""

    def ratio(wave: Floats) -> Floats:
        return np.asarray(_lamb(wave, poissons_ratio)[1] / _mindlin(wave, poissons_ratio)[1])

    return Chebyshev.interpolate(ratio, _DEGREE, domain=[0.0, _LARGEST])


def _mindlin(y: Floats, ratio: float, factor: float | None = None) -> tuple[Floats, Floats]:
    """Return the angular frequency of bending waves and their deflection for unit modal
    mass per area, for h = rho = G = 1 and y = k h.
    """
    shear = shear_factor(ratio) if factor is None else factor
    bend = y**2 / (6.0 * (1.0 - ratio))  # rigidity times k^2
    trace, product = shear * y**2 + 12.0 * (bend + shear), 12.0 * shear * y**2 * bend
    square = 2.0 * product / (trace + np.sqrt(trace**2 - 4.0 * product))
    # over the deflection, from equilibrium of the transverse forces
    slope = y - square / (shear * y)
    return np.sqrt(square), 1.0 / np.sqrt(1.0 + slope**2 / 12.0)


def _lamb(y: Floats, ratio: float) -> tuple[Floats, Floats]:
    r"""Return the angular frequency and the face displacement of the lowest antisymmetric Lamb
    wave, normalised and in units as `_mindlin`.

    Its speed is below that of Rayleigh waves, so that with :math:`\alpha^2 = y^2 - \omega^2 /
    c_L^2`, :math:`\beta^2 = y^2 - \omega^2`
    the equation :math:`(y^2 + \beta^2)^2 \tanh(\alpha/2) = 4 y^2 \alpha \beta \tanh(\beta/2)` has
    one root, found by bisection.
    """
    y = np.asarray(y, dtype=float)
    slowness = 0.5 * (1.0 - 2.0 * ratio) / (1.0 - ratio)  # the square of c_T / c_L

    def depths(square: Floats) -> tuple[Floats, Floats]:
        return y * np.sqrt(1.0 - slowness * square), y * np.sqrt(1.0 - square)

    low, high = np.zeros_like(y), np.ones_like(y)  # of the square of the speed over c_T
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        a, b = depths(middle)
        fast = (2.0 - middle) ** 2 * y**2 * np.tanh(0.5 * a) > 4.0 * a * b * np.tanh(0.5 * b)
        low, high = np.where(fast, low, middle), np.where(fast, middle, high)
    square = 0.5 * (low + high)
    a, b = depths(square)
    z, weight = np.polynomial.legendre.leggauss(_NODES)
    z, a, b, k = 0.5 * z, a[..., None], b[..., None], y[..., None]
    share = 2.0 * k * a / (k**2 + b**2)
    along = k * np.sinh(a * z) / np.cosh(0.5 * a) - share * b * np.sinh(b * z) / np.cosh(0.5 * b)
    across = a * np.cosh(a * z) / np.cosh(0.5 * a) - share * k * np.cosh(b * z) / np.cosh(0.5 * b)
    face = (a - share * k)[..., 0]
    return y * np.sqrt(square), np.abs(face) / np.sqrt(0.5 * (along**2 + across**2) @ weight)
