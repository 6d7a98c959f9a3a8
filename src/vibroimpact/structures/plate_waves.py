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
from vibroimpact.structures.finite_elements.plate_element import shear_factor
from vibroimpact.structures.plate_compliance import mean_square

_LARGEST = 8.0  # wave number times thickness beyond which the bending factor is constant
_DEGREE = 24  # of the polynomial that interpolates the factor within 3e-8
_RATIOS = 64  # Poisson's ratios of which the factor is cached
_HALVINGS = 60  # of the bisection
# wave number times thickness below which errors of plate theory go with its square, as rounding
# hides them
_LEAST = 0.05
_NODES = 24  # of Gauss's rule across the thickness
# of the factor c of `inertia_beyond_bending`: coefficients of powers of Poisson's ratio, within
# 0.2 %; without waves longer than 20 thicknesses
_INERTIA = (0.02432, -0.03887, 0.05163)


def bending_factor(wave: Floats, poissons_ratio: float) -> Floats:
    """Return the displacement of a face over the deflection of plate theory in bending waves [-].

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
    """Return the relative error of plate theory in the frequency of bending waves [-].

    The frequency is compared with that of the layer.

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
    layer_frequency = _lamb(resolved, poissons_ratio)[0]
    if thin:
        # omega = k^2 sqrt(D / (rho h)), for h = rho = G = 1
        plate_frequency = resolved**2 * math.sqrt(1.0 / (6.0 * (1.0 - poissons_ratio)))
    else:
        plate_frequency = _mindlin(resolved, poissons_ratio)[0]
    return np.asarray((plate_frequency / layer_frequency - 1.0) * (wave / resolved) ** 2)


def stiff_shear_error(wave: Floats, poissons_ratio: float) -> Floats:
    """Return the relative error of Mindlin's bending frequencies without shear correction [-].

    Parameters
    ----------
    wave : array
        Wave number times thickness [-], > 0.
    poissons_ratio : float
        Poisson's ratio [-].
    """
    uncorrected = _mindlin(wave, poissons_ratio, 1.0)[0]
    corrected = _mindlin(wave, poissons_ratio)[0]
    return np.asarray(uncorrected / corrected - 1.0)


def stretching_error(angular_frequencies: Floats, thickness: float, material: Material) -> Floats:
    r"""Return the relative error of plate theory in frequencies of longitudinal waves [-].

    The waves move in the plane of the plate. The error is :math:`(\nu k h)^2 / 24 (1-\nu)^2`, to
    the second order in the wave number k (Lamb 1917).

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
    # slowness of longitudinal waves in a thin plate
    slowness = math.sqrt(material.density * (1.0 - ratio**2) / material.youngs_modulus)
    wave = thickness * angular_frequencies * slowness
    return np.asarray((ratio * wave / (1.0 - ratio)) ** 2 / 24.0)


def shear_wave_factor(square: Floats, poissons_ratio: float) -> Floats:
    r"""Return the counterpart of `bending_factor` for shear waves, to the second order [-].

    It is :math:`1 / (1 + k^2 \overline{r^2} / 4)`.

    Parameters
    ----------
    square : array
        Square of wave number times thickness [-]; may be negative.
    poissons_ratio : float
        Poisson's ratio [-].
    """
    mean_squared_radius = mean_square(1.0, poissons_ratio, shear_factor(poissons_ratio))
    return np.asarray(1.0 / (1.0 + 0.25 * mean_squared_radius * square))


def inertia_beyond_bending(thickness: float, material: Material) -> float:
    r"""Return the sum of phi^2 / omega^4 over the waves of a layer other than bending [m s^2/N].

    It is the response of a point of the face to the second derivative of a force in excess of
    plate theory, :math:`c\,\rho h / G^2`. The factor c, from
    :math:`\int \sum \varphi^2 \omega^{-4} k\,dk / 2\pi` over all other branches, is fitted by a
    parabola in Poisson's ratio.

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
    shear_modulus = 0.5 * material.youngs_modulus / (1.0 + ratio)
    factor = float(np.polynomial.polynomial.polyval(ratio, _INERTIA))
    return factor * material.density * thickness / shear_modulus**2


def wave_numbers(
    angular_frequencies: Floats, thickness: float, material: Material, thin: bool = False
) -> Floats:
    """Return the wave numbers of bending waves [1/m] at angular frequencies [rad/s].

    They are those of Mindlin's theory, or of Kirchhoff's if `thin`.
    """
    if not thin:
        return np.asarray(np.sqrt(mindlin_squares(angular_frequencies, thickness, material)[0]))
    ratio = material.poissons_ratio
    rigidity = material.youngs_modulus * thickness**2 / (12.0 * (1.0 - ratio**2))  # D / h
    return np.asarray((material.density * angular_frequencies**2 / rigidity) ** 0.25)


def mindlin_squares(
    omega: Floats, thickness: float, material: Material
) -> tuple[Floats, Floats, Floats]:
    r"""Return the squares of both wave numbers of Mindlin's plate, and their shear term [1/m^2].

    The first, that of the bending wave, is positive. The second, that of the shear wave, is
    negative below :math:`\sqrt{12 \kappa G / (\rho h^2)}`, where the wave is evanescent. The shear
    term is :math:`\rho \omega^2 / \kappa G`.

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
    shear_stiffness = shear_factor(ratio) * 0.5 * (1.0 - ratio) * modulus  # kappa G
    shear_term = material.density * omega**2 / shear_stiffness
    rotary_term = material.density * omega**2 / modulus  # of rotary inertia
    root = np.sqrt(0.25 * (shear_term - rotary_term) ** 2 + 12.0 * rotary_term / thickness**2)
    mean = 0.5 * (shear_term + rotary_term)
    return mean + root, mean - root, shear_term


@functools.lru_cache(maxsize=_RATIOS)
def _factor(poissons_ratio: float) -> Chebyshev:
    """Return `bending_factor` as a polynomial in wave number times thickness."""

    def ratio(wave: Floats) -> Floats:
        return np.asarray(_lamb(wave, poissons_ratio)[1] / _mindlin(wave, poissons_ratio)[1])

    return Chebyshev.interpolate(ratio, _DEGREE, domain=[0.0, _LARGEST])


def _mindlin(wave: Floats, ratio: float, factor: float | None = None) -> tuple[Floats, Floats]:
    """Return the angular frequency and deflection of Mindlin's bending waves.

    The deflection is that for unit modal mass per area. Units are such that h = rho = G = 1, so
    that `wave` is k h; `factor` is the shear correction, by default `shear_factor`.
    """
    if factor is None:
        factor = shear_factor(ratio)
    shear_stiffness = factor  # kappa G h
    bending_stiffness = wave**2 / (6.0 * (1.0 - ratio))  # D k^2
    # omega^2 is the smaller root of x^2 - trace x + product, in a form without cancellation
    trace = shear_stiffness * wave**2 + 12.0 * (bending_stiffness + shear_stiffness)
    product = 12.0 * shear_stiffness * wave**2 * bending_stiffness
    squared_frequency = 2.0 * product / (trace + np.sqrt(trace**2 - 4.0 * product))
    # over the deflection, from equilibrium of the transverse forces
    slope = wave - squared_frequency / (shear_stiffness * wave)
    # rotary inertia is 1/12 of the inertia of the deflection per squared slope
    return np.sqrt(squared_frequency), 1.0 / np.sqrt(1.0 + slope**2 / 12.0)


def _lamb(wave: Floats, ratio: float) -> tuple[Floats, Floats]:
    """Return the angular frequency and face displacement of the lowest antisymmetric Lamb wave.

    They are normalised and in units as those of `_mindlin`.
    """
    wave = np.asarray(wave, dtype=float)
    squared_speed = _squared_lamb_speed(wave, ratio)
    frequency = wave * np.sqrt(squared_speed)

    # one axis more, for the heights z from the middle of the layer
    alpha, beta = (rate[..., None] for rate in _decay_rates(wave, squared_speed, ratio))
    k = wave[..., None]
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    z = 0.5 * nodes

    # amplitude of the shear part over that of the pressure part, without shear stress on the faces
    shear_part = 2.0 * k * alpha / (k**2 + beta**2)
    # over their values at the face, as the hyperbolic functions of short waves are large there
    pressure_at_face = np.cosh(0.5 * alpha)
    shear_at_face = np.cosh(0.5 * beta)
    pressure_along = k * np.sinh(alpha * z) / pressure_at_face
    shear_along = shear_part * beta * np.sinh(beta * z) / shear_at_face
    pressure_across = alpha * np.cosh(alpha * z) / pressure_at_face
    shear_across = shear_part * k * np.cosh(beta * z) / shear_at_face
    along = pressure_along - shear_along
    across = pressure_across - shear_across
    face = (alpha - shear_part * k)[..., 0]
    modal_mass = 0.5 * (along**2 + across**2) @ weights
    return frequency, np.abs(face) / np.sqrt(modal_mass)


def _squared_lamb_speed(wave: Floats, ratio: float) -> Floats:
    r"""Return the squared speed of the lowest antisymmetric Lamb wave, over that of shear waves.

    The speed is below that of Rayleigh waves, so that with :math:`\alpha^2 = y^2 - \omega^2 /
    c_L^2`, :math:`\beta^2 = y^2 - \omega^2` and y = k h the equation :math:`(y^2 + \beta^2)^2
    \tanh(\alpha/2) = 4 y^2 \alpha \beta \tanh(\beta/2)` has one root, found by bisection.
    """
    low = np.zeros_like(wave)
    high = np.ones_like(wave)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        alpha, beta = _decay_rates(wave, middle, ratio)
        # both sides of the equation over y^2
        left = (2.0 - middle) ** 2 * wave**2 * np.tanh(0.5 * alpha)
        right = 4.0 * alpha * beta * np.tanh(0.5 * beta)
        is_below = left > right
        low = np.where(is_below, low, middle)
        high = np.where(is_below, middle, high)
    return np.asarray(0.5 * (low + high))


def _decay_rates(wave: Floats, squared_speed: Floats, ratio: float) -> tuple[Floats, Floats]:
    """Return alpha and beta: the decay of the pressure and of the shear part across a layer."""
    squared_speed_ratio = 0.5 * (1.0 - 2.0 * ratio) / (1.0 - ratio)  # (c_T / c_L)^2
    alpha = wave * np.sqrt(1.0 - squared_speed_ratio * squared_speed)
    beta = wave * np.sqrt(1.0 - squared_speed)
    return alpha, beta
