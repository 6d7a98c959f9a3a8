"""Spring under a point of the plate, or elastic pad under a disc of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.structures.finite_elements.disc_quadrature import disc_rule
from vibroimpact.structures.finite_elements.surface import surface_motion
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support


@dataclass(frozen=True)
class Spring(Support):
    """Spring between the lower side and the ground, at a point or spread uniformly over a disc.

    Parameters
    ----------
    x, y : float
        Centre [m].
    stiffness : float
        Total vertical stiffness [N/m], >= 0.
    horizontal_stiffness : float, default 0
        Total stiffness along x, and along y [N/m], >= 0.
    radius : float, default 0
        Radius of the disc [m]; 0 for a point.
    """

    x: float
    y: float
    stiffness: float
    horizontal_stiffness: float = 0.0
    radius: float = 0.0

    @property
    def description(self) -> str:
        """Short description for users."""
        description = f"spring of {self.stiffness:g} N/m at ({self.x:g}, {self.y:g}) m"
        if self.radius:
            description += f", spread over a radius of {self.radius:g} m"
        return description

    def hold(self, constraints: Constraints) -> None:
        """Add the stiffness of the spring, by the shape functions at the points of the disc."""
        points, weights = disc_rule(self.radius)
        structure = constraints.structure
        motion, _ = surface_motion(
            structure.mesh,
            points + np.array([self.x, self.y]),
            "lower",
            structure.thickness,
            self.description,
        )
        # of each point along x, y and z
        stiffness_along_axes = [
            self.horizontal_stiffness,
            self.horizontal_stiffness,
            self.stiffness,
        ]
        stiffness = np.outer(weights, stiffness_along_axes).ravel()
        dofs = np.unique(motion.indices)
        local_motion = motion[:, dofs].toarray()
        constraints.add_stiffness(dofs, local_motion.T @ (stiffness[:, None] * local_motion))
