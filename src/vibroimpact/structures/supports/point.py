"""Held point of the lower side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.structures.finite_elements.surface import surface_motion
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support


@dataclass(frozen=True)
class Point(Support):
    """Point of the lower side held along some axes; the plate rotates freely about it.

    It is for plate elements: with solid elements the stiffness at a point tends to zero in the
    limit of a fine mesh.

    Parameters
    ----------
    x, y : float
        Position [m].
    directions : str, default "z"
        Axes along which the displacement is held. Several points that are also held along x and y
        stretch the plate in bending, as they lie below its middle plane.
    """

    x: float
    y: float
    directions: str = "z"

    @property
    def description(self) -> str:
        """Short description for users."""
        return f"point ({self.x:g}, {self.y:g}) m held along {self.directions}"

    @property
    def lines(self) -> tuple[Sequence[float], Sequence[float]]:
        """The x and y [m] of the point, so that it is a node."""
        return (self.x,), (self.y,)

    def hold(self, constraints: Constraints) -> None:
        """Hold the point, by the shape functions of its element."""
        structure = constraints.structure
        motion, _ = surface_motion(
            structure.mesh,
            np.array([[self.x, self.y]]),
            "lower",
            structure.thickness,
            self.description,
        )
        constraints.hold_motion(motion[["xyz".index(letter) for letter in self.directions]])
