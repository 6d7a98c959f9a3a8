"""An elastic pad under the plate, or a spring under a point of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support
from vibroimpact.structures.surface import surface_motion

_RINGS, _SPOKES = 6, 24  # of the rule that spreads a pad; exact to polynomials of degree 11 and 23


@dataclass(frozen=True)
class Spring(Support):
    """A spring between the lower side and the ground, spread evenly over a disc, or at a point.

    Parameters
    ----------
    x, y : float
        Its centre [m].
    stiffness : float
        Vertical stiffness in all [N/m], >= 0.
    horizontal_stiffness : float, default 0
        Stiffness along x, and along y [N/m], >= 0.
    radius : float, default 0
        Radius of the disc [m]; zero for a point.
    """

    x: float
    y: float
    stiffness: float
    horizontal_stiffness: float = 0.0
    radius: float = 0.0

    @property
    def words(self) -> str:
        """What it is, for people."""
        return f"spring of {self.stiffness:g} N/m at ({self.x:g}, {self.y:g}) m" + (
            f", spread over a radius of {self.radius:g} m" if self.radius else ""
        )

    def hold(self, constraints: Constraints) -> None:
        """Add the stiffness of the pad."""
        places, weights = disc_rule(self.radius)
        structure = constraints.structure
        motion, _ = surface_motion(structure.mesh, places + np.array([self.x, self.y]), "lower", structure.thickness, self.words)
        stiffness = np.outer(weights, [self.horizontal_stiffness, self.horizontal_stiffness, self.stiffness]).ravel()
        dofs = np.unique(motion.indices)
        local = motion[:, dofs].toarray()
        constraints.add_stiffness(dofs, local.T @ (stiffness[:, None] * local))


def disc_rule(radius: float) -> tuple[Floats, Floats]:
    """Return points (points, 2) on a disc around the origin, and weights that sum to one; one point if the radius is zero.

    Examples
    --------
    >>> points, weights = disc_rule(2.0)
    >>> round(float(weights @ points[:, 0] ** 2), 12)  # of a disc: radius^2 / 4
    1.0
    """
    if radius == 0.0:
        return np.zeros((1, 2)), np.ones(1)
    squared, weights = np.polynomial.legendre.leggauss(_RINGS)  # even in the square of the radius, which is even in area
    angle = 2.0 * np.pi * (np.arange(_SPOKES) + 0.5) / _SPOKES
    radii = radius * np.sqrt(0.5 * (squared + 1.0))
    points = radii[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return points.reshape(-1, 2), np.repeat(0.5 * weights / _SPOKES, _SPOKES)
