"""Rigid patches: circular or rectangular parts of the lower side that are held."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.rectangle import Disc
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support, nodes_within


@dataclass(frozen=True)
class Patch(Support):
    """Rigid circular patch of the lower side, held in all directions.

    Parameters
    ----------
    x, y : float
        Centre [m].
    radius : float
        Radius [m], > 0.
    """

    x: float
    y: float
    radius: float

    @property
    def description(self) -> str:
        """Short description for users."""
        return f"rigid patch of radius {self.radius:g} m at ({self.x:g}, {self.y:g}) m"

    @property
    def discs(self) -> Sequence[Disc]:
        """The disc of the patch."""
        return (Disc(self.x, self.y, self.radius),)

    def hold(self, constraints: Constraints) -> None:
        """Hold the nodes within the patch."""
        nodes = nodes_within(constraints.structure, self.x, self.y, self.radius, "the patch")
        constraints.attach(nodes, self.radius)


@dataclass(frozen=True)
class RectangularPatch(Support):
    """Rigid rectangular patch of the lower side, held in all directions.

    Parameters
    ----------
    x, y : float
        Centre [m].
    length, width : float
        Sides along x and y [m], > 0.
    """

    x: float
    y: float
    length: float
    width: float

    @property
    def description(self) -> str:
        """Short description for users."""
        return f"rigid patch, {self.length:g} x {self.width:g} m, at ({self.x:g}, {self.y:g}) m"

    @property
    def lines(self) -> tuple[Sequence[float], Sequence[float]]:
        """The x and y [m] of its sides."""
        xs = (self.x - 0.5 * self.length, self.x + 0.5 * self.length)
        ys = (self.y - 0.5 * self.width, self.y + 0.5 * self.width)
        return xs, ys

    @property
    def rims(self) -> tuple[Sequence[float], Sequence[float]]:
        """The x and y [m] of its sides."""
        return self.lines

    def hold(self, constraints: Constraints) -> None:
        """Hold the nodes within the patch."""
        centre = np.array([self.x, self.y])
        half_sides = 0.5 * np.array([self.length, self.width])
        nodes = constraints.structure.mesh.nodes[:, :2]
        low = nodes.min(axis=0)
        high = nodes.max(axis=0)
        tolerance = 1e-6 * (high - low)
        is_below = np.any(centre - half_sides < low - tolerance)
        is_above = np.any(centre + half_sides > high + tolerance)
        if is_below or is_above:
            raise InputError(
                f"the {self.description} does not lie wholly on the plate, which reaches "
                f"from {low[0]:g} to {high[0]:g} m along x and "
                f"from {low[1]:g} to {high[1]:g} m along y"
            )
        held_nodes = nodes_within(constraints.structure, self.x, self.y, half_sides, "the patch")
        # twice the area over the perimeter, as of a disc
        radius = self.length * self.width / (self.length + self.width)
        constraints.attach(held_nodes, radius)
