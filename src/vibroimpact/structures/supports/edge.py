"""Clamped or simply supported edge of the plate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.element_kinds import PLATE_ORDER
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support

EdgeName = Literal["x-min", "x-max", "y-min", "y-max"]
EDGES: tuple[EdgeName, ...] = ("x-min", "x-max", "y-min", "y-max")
_FLAT = 1e-6  # of the plate's length: tolerance of the position of nodes of the edge
# weights of Boole's rule, over 1/90 of the length of an interval of four steps
_BOOLE = np.array([7.0, 32.0, 12.0, 32.0, 7.0])


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
        along = 1 - across
        nodes = self._nodes(mesh)
        if self.condition == "clamped":
            axes = list(range(mesh.dofs_per_node))
        else:
            slope_along = [4 - across] if mesh.is_flat else []
            axes = [along, 2, *slope_along]
        constraints.hold(mesh.dofs_per_node * nodes[:, None] + np.array(axes))
        # the end compliance in excess of plate theory is only noted, for the estimate of errors of
        # frequencies
        end_compliance = constraints.structure.end_compliance
        if mesh.is_flat and self.condition == "clamped" and end_compliance:
            ordered = nodes[np.argsort(mesh.nodes[nodes, along])]
            slopes_across = mesh.dofs_per_node * ordered + 3 + across
            compliances = end_compliance / _lengths(mesh.nodes[ordered, along])
            constraints.neglect(slopes_across, compliances)

    def _nodes(self, mesh: Mesh) -> Integers:
        """Return the nodes of the edge.

        Raises
        ------
        InputError
            If there are fewer than three.
        """
        axis = 0 if self.edge[0] == "x" else 1
        positions = mesh.nodes[:, axis]
        end = positions.max()
        if self.edge.endswith("min"):
            end = positions.min()
        nodes = np.flatnonzero(np.abs(positions - end) <= _FLAT * np.ptp(positions))
        if len(nodes) < 3:
            raise InputError(
                f'the edge "{self.edge}" has only {len(nodes)} of the nodes of the mesh: '
                "that side of the body is not flat"
            )
        return nodes


def _lengths(positions: Floats) -> Floats:
    """Return the length of the edge per node: the weights of Boole's rule on the elements."""
    lengths = np.zeros(len(positions))
    for start in range(0, len(positions) - PLATE_ORDER, PLATE_ORDER):
        element = slice(start, start + PLATE_ORDER + 1)
        corners = positions[element][[0, -1]]
        lengths[element] += (corners[1] - corners[0]) * _BOOLE / 90.0
    return lengths
