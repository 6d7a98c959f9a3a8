"""A circular plate that deflects far under a force at its centre: von Karman by SciPy (an oracle:
imports nothing of vibroimpact).

Timoshenko and Woinowsky-Krieger 1959, eq. (231), for radius 1, in thicknesses: slope and
displacement along the radius. The linear deflections, P a^2 / (16 pi D) clamped and (3 + nu) / (1 +
nu) times that supported, are met to 1e-3.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_bvp

Floats = NDArray[np.float64]

_CENTRE = 1e-4  # where the plate begins; the slope goes as r ln r


def stiffening(
    load: float, *, clamped: bool, held: bool, nu: float = 0.3, thickness: float = 0.01
) -> tuple[float, float]:
    """Return the deflection at the centre over the thickness, and by which part the plate is
    stiffer than when it is hardly loaded.

    The load is P a^2 / (16 pi D h), the deflection of a clamped plate over its thickness if it were
    small.
    """

    def equations(r: Floats, y: Floats) -> Floats:
        slope, curvature, u, strain = y
        tension = 12.0 / thickness**2 * (strain + nu * u / r + 0.5 * slope**2)
        force = 8.0 * thickness * load / r  # P / (2 pi D r)
        bending = -curvature / r + slope / r**2 + tension * slope + force
        stretching = -strain / r + u / r**2 - (1.0 - nu) / (2.0 * r) * slope**2 - slope * curvature
        return np.array([curvature, bending, strain, stretching])

    def ends(at: Floats, rim: Floats) -> Floats:
        edge = rim[0] if clamped else rim[1] + nu * rim[0]
        pulled = rim[2] if held else rim[3] + nu * rim[2] + 0.5 * rim[0] ** 2
        return np.array([at[0], at[2], edge, pulled])

    r = np.geomspace(_CENTRE, 1.0, 200)
    found = solve_bvp(equations, ends, r, np.zeros((4, r.size)), tol=1e-8, max_nodes=20000)
    assert found.success, found.message
    fine = np.geomspace(_CENTRE, 1.0, 4000)
    deflection = abs(float(np.trapezoid(found.sol(fine)[0], fine))) / thickness
    small = load * (1.0 if clamped else (3.0 + nu) / (1.0 + nu))
    return deflection, small / deflection - 1.0
