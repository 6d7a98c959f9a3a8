"""A point of the lower side that is held."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support
from vibroimpact.structures.surface import surface_motion


@dataclass(frozen=True)
class Point(Support):
    """A point of the lower side that does not move along some axes; the plate turns about it.

    A point on a solid has no stiffness in the limit of a fine mesh, so this suits plate elements.

    Parameters
    ----------
    x, y : float
        Where it is [m].
    directions : str, default "z"
        The axes along which it is held. Held along x and y too, several points also stretch the plate as it bends, as they
        lie below its middle.
    """

    x: float
    y: float
    directions: str = "z"

    @property
    def words(self) -> str:
        """What it is, for people."""
        return f"point ({self.x:g}, {self.y:g}) m held along {self.directions}"

    @property
    def lines(self) -> tuple[Sequence[float], Sequence[float]]:
        """Through the point, so that it is a node."""
        return (self.x,), (self.y,)

    def hold(self, constraints: Constraints) -> None:
        """Hold the point, by the shape functions of the element that it is on."""
        structure = constraints.structure
        motion, _ = surface_motion(structure.mesh, np.array([[self.x, self.y]]), "lower", structure.thickness, self.words)
        constraints.hold_motion(motion[["xyz".index(letter) for letter in self.directions]])
