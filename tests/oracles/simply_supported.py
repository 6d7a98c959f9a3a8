"""Modes of a simply supported rectangular plate after Kirchhoff, in closed form (an oracle: imports
nothing of vibroimpact).

omega_ij = pi^2 (i^2/a^2 + j^2/b^2) sqrt(D / (rho h)) with D = E h^3 / (12 (1 - nu^2)), and shapes
of unit modal mass 2 / sqrt(rho h a b) sin(i pi x / a) sin(j pi y / b), x and y from a corner.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def simply_supported(
    size: tuple[float, float, float],
    material: tuple[float, float, float],
    place: tuple[float, float],
    number: int,
) -> tuple[Floats, Floats]:
    """Frequencies [Hz] of the lowest modes, and how they move a place [kg^-1/2];
    `material`: density, Young's modulus, Poisson's ratio.
    """
    (a, b, h), (density, modulus, ratio) = size, material
    i, j = (
        index.ravel() for index in np.meshgrid(np.arange(1, number + 1), np.arange(1, number + 1))
    )
    omega = (
        np.pi**2
        * ((i / a) ** 2 + (j / b) ** 2)
        * np.sqrt(modulus * h**2 / (12.0 * density * (1.0 - ratio**2)))
    )
    order = np.argsort(omega)[:number]
    shapes = (
        2.0
        / np.sqrt(density * h * a * b)
        * np.sin(i * np.pi * place[0] / a)
        * np.sin(j * np.pi * place[1] / b)
    )
    return omega[order] / (2.0 * np.pi), shapes[order]
