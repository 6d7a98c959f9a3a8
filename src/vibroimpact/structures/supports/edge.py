"""Clamped or simply supported edge of the plate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.structures.element_kinds import PLATE_ORDER
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support

EdgeName = Literal["x-min", "x-max", "y-min", "y-max"]
EDGES: tuple[EdgeName, ...] = ("x-min", "x-max", "y-min", "y-max")
_FLAT = 1e-6  # of the plate's length: tolerance of the position of nodes of the edge


@dataclass(frozen=True)
class Edge(Support):
    """Support along a straight edge of the plate.

    Parameters
    ----------
    edge : str
        "x-min", "x-max", "y-min" or "y-max".
    condition : str
        "clamped": all degrees of freedom are held. "simply-supported": displacements vertically and
        along the edge are held, and rotation about the edge is free (the hard condition, that of
        Navier's solution); over the full height of a solid plate.
    """

    edge: EdgeName
    condition: Literal["clamped", "simply-supported"]

    @property
    def description(self) -> str:
        """Short description for users."""
        return f"edge {self.edge} {self.condition}"

    def hold(self, constraints: Constraints) -> None:
        """Hold the nodes of the edge."""
        mesh = constraints.structure.mesh
        across = 0 if self.edge[0] == "x" else 1
        at = mesh.nodes[:, across]
        end = at.min() if self.edge.endswith("min") else at.max()
        nodes = np.flatnonzero(np.abs(at - end) <= _FLAT * np.ptp(at))
        if len(nodes) < 3:
            raise InputError(
                f'the edge "{self.edge}" has only {len(nodes)} of the nodes of the mesh: '
                "that side of the body is not flat"
            )
        turning = [4 - across] if mesh.is_flat else []
        axes = (
            list(range(mesh.dofs_per_node))
            if self.condition == "clamped"
            else [1 - across, 2, *turning]
        )
        constraints.hold(mesh.dofs_per_node * nodes[:, None] + np.array(axes))
        # the end compliance in excess of plate theory is only noted, for the estimate of errors of
        # frequencies
        if mesh.is_flat and self.condition == "clamped" and constraints.structure.end_compliance:
            order = nodes[np.argsort(mesh.nodes[nodes, 1 - across])]
            compliance = constraints.structure.end_compliance / _lengths(
                mesh.nodes[order, 1 - across]
            )
            constraints.neglect(mesh.dofs_per_node * order + 3 + across, compliance)


def _lengths(at: Floats) -> Floats:
    """Return the length of the edge per node: the weights of Boole's rule on the elements."""
    found = np.zeros(len(at))
    for start in range(0, len(at) - PLATE_ORDER, PLATE_ORDER):
        part = slice(start, start + PLATE_ORDER + 1)
        found[part] += (at[part][-1] - at[part][0]) * np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90.0
    return found
