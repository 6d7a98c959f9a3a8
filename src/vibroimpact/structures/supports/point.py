"""A point of the lower side, pinned."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.errors import InputError
from vibroimpact.structures.rectangle import Disc
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.surface import lower_nodes

_NEAR = 0.05  # of the plate's length: how far the nearest node may be


@dataclass(frozen=True)
class Point:
    """A point of the lower side that does not move; the plate turns about it.

    A point on a solid has no stiffness in the limit of a fine mesh, so this suits plate elements.

    Parameters
    ----------
    x, y : float
        Where it is [m].
    """

    x: float
    y: float

    @property
    def words(self) -> str:
        """What it is, for people."""
        return f"point ({self.x:g}, {self.y:g}) m pinned"

    @property
    def discs(self) -> Sequence[Disc]:
        """None."""
        return ()

    @property
    def lines(self) -> tuple[Sequence[float], Sequence[float]]:
        """Through the point, so that it is a node."""
        return (self.x,), (self.y,)

    def hold(self, constraints: Constraints) -> None:
        """Hold the nearest node of the lower side."""
        mesh = constraints.structure.mesh
        lower = lower_nodes(mesh)
        apart = np.hypot(*(mesh.nodes[lower, :2] - [self.x, self.y]).T) if len(lower) else np.array([np.inf])
        if apart.min() > _NEAR * mesh.extent.max():
            raise InputError(
                f"the point support at ({self.x:g}, {self.y:g}) m is {apart.min():.2g} m from the nearest node of the lower side"
            )
        constraints.attach(lower[[apart.argmin()]])
