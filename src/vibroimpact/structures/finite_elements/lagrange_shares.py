"""Spreading of amounts over the points of a regular grid.

It is the transpose of Lagrange's interpolation of degree five.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats, Integers

STENCIL = np.arange(-2, 4)
"""Points that share an amount, relative to the one at or before it."""
_CARDINAL = np.linalg.inv(np.vander(STENCIL.astype(float)))
"""Coefficients of the cardinal polynomials of the stencil, highest power first."""


def lagrange_shares(places: Floats) -> tuple[Integers, Floats]:
    """Return the points of `STENCIL` for places in steps of the grid, and their shares, (n, 6).

    A share is the part of an amount at the place that the point gets.

    Examples
    --------
    >>> points, shares = lagrange_shares(np.array([7.25]))
    >>> points.tolist(), round(float((shares * points**3).sum() - 7.25**3), 9)
    ([[5, 6, 7, 8, 9, 10]], 0.0)
    """
    cells = np.floor(places).astype(int)
    powers = np.vander(places - cells, len(STENCIL))
    return cells[:, None] + STENCIL, np.asarray(powers @ _CARDINAL)
