"""A named set of nodes of a mesh that was brought, held still."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.structures.rectangle import Disc
from vibroimpact.structures.supports.constraints import Constraints


@dataclass(frozen=True)
class NodeSet:
    """A named set of nodes, or the nodes of a set of elements, held along some axes.

    Parameters
    ----------
    name : str
        Name of the set in the mesh file.
    directions : str, default "xyz"
        The axes along which it is held.
    """

    name: str
    directions: str = "xyz"

    @property
    def words(self) -> str:
        """What it is, for people."""
        return f"set {self.name} held along {self.directions}"

    @property
    def discs(self) -> Sequence[Disc]:
        """None; the mesh is there already."""
        return ()

    @property
    def lines(self) -> tuple[Sequence[float], Sequence[float]]:
        """None; the mesh is there already."""
        return (), ()

    def hold(self, constraints: Constraints) -> None:
        """Hold the nodes of the set."""
        mesh = constraints.structure.mesh
        axes = np.array(["xyz".index(letter) for letter in self.directions])
        constraints.hold(mesh.dofs_per_node * mesh.nodes_of(self.name)[:, None] + axes)
