"""Held set of nodes of an imported mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support


@dataclass(frozen=True)
class NodeSet(Support):
    """Named set of nodes, or nodes of a named set of elements, held along some axes.

    Parameters
    ----------
    name : str
        Name of the set in the mesh file.
    directions : str, default "xyz"
        Axes along which displacements are held.
    """

    name: str
    directions: str = "xyz"

    @property
    def description(self) -> str:
        """Short description for users."""
        return f"set {self.name} held along {self.directions}"

    def hold(self, constraints: Constraints) -> None:
        """Hold the nodes of the set."""
        mesh = constraints.structure.mesh
        axes = np.array(["xyz".index(letter) for letter in self.directions])
        constraints.hold(mesh.dofs_per_node * mesh.nodes_of(self.name)[:, None] + axes)
