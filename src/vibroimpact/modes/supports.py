"""Outlines of the supports of a plate, seen from above."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.supports.edge import Edge
from vibroimpact.structures.supports.node_set import NodeSet
from vibroimpact.structures.supports.patch import RectangularPatch
from vibroimpact.structures.supports.support import Support

_TURN = np.linspace(0.0, 2.0 * np.pi, 25)
_THIN = 0.012
"""Size of what stands for a point or an edge, relative to the longer side of the plate."""


def support_outlines(supports: Sequence[Support], mesh: Mesh) -> list[tuple[Floats, Floats]]:
    """Return the outlines of supports as x and y [m]; edges are narrow strips, sets of nodes are left out.

    Examples
    --------
    >>> from vibroimpact.structures.plate_mesh import plate_mesh
    >>> ((x, y),) = support_outlines([Edge("x-min", "clamped")], plate_mesh((0.5, 0.4), 0.2))
    >>> x.round(3).tolist(), y.tolist()
    ([-0.25, -0.244, -0.244, -0.25], [-0.2, -0.2, 0.2, 0.2])
    """
    return [_outline(support, mesh) for support in supports if not isinstance(support, NodeSet)]


def _outline(support: Support, mesh: Mesh) -> tuple[Floats, Floats]:
    small = _THIN * float(mesh.extent[:2].max())
    match support:
        case Edge():
            return _strip(support, mesh, small)
        case RectangularPatch():
            across, up = 0.5 * support.length, 0.5 * support.width
            return support.x + across * np.array([-1.0, 1.0, 1.0, -1.0]), support.y + up * np.array([-1.0, -1.0, 1.0, 1.0])
        case _:  # a disc: a patch, a bar, a spring; or a point
            radius = float(getattr(support, "radius", 0.0)) or small
            x, y = (float(getattr(support, side)) for side in "xy")
            return x + radius * np.cos(_TURN), y + radius * np.sin(_TURN)


def _strip(support: Edge, mesh: Mesh, wide: float) -> tuple[Floats, Floats]:
    side = 0 if support.edge[0] == "x" else 1
    low, high = mesh.nodes.min(axis=0), mesh.nodes.max(axis=0)
    at, inner = (low[side], low[side] + wide) if support.edge.endswith("min") else (high[side], high[side] - wide)
    first, second = np.array([at, inner, inner, at]), np.array([low[1 - side]] * 2 + [high[1 - side]] * 2)
    return (first, second) if side == 0 else (second, first)
