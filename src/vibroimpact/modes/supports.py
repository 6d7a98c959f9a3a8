"""Outlines of the supports of a plate, seen from above."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.outlines import THIN, disc, rectangle, strips
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.outline import outline
from vibroimpact.structures.supports.edge import Edge
from vibroimpact.structures.supports.node_set import NodeSet
from vibroimpact.structures.supports.patch import RectangularPatch
from vibroimpact.structures.supports.support import Support


def support_outlines(supports: Sequence[Support], mesh: Mesh) -> list[tuple[Floats, Floats]]:
    """Return the outlines of supports as x and y [m]; edges are narrow strips, sets of nodes are
    left out.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
    >>> ((x, y),) = support_outlines([Edge("x-min", "clamped")], plate_mesh((0.5, 0.4), 0.2))
    >>> x.round(3).tolist(), y.tolist()
    ([-0.25, -0.244, -0.244, -0.25], [-0.2, -0.2, 0.2, 0.2])
    """
    return [
        drawn
        for support in supports
        if not isinstance(support, NodeSet)
        for drawn in _outlines(support, mesh)
    ]


def held_nodes(supports: Sequence[Support], mesh: Mesh) -> Floats:
    """Return the nodes of the sets that are held [m], (nodes, 3)."""
    nodes = [mesh.nodes_of(support.name) for support in supports if isinstance(support, NodeSet)]
    held = np.concatenate([np.empty(0, dtype=np.int64), *nodes])
    return np.asarray(mesh.nodes[held])


def _outlines(support: Support, mesh: Mesh) -> list[tuple[Floats, Floats]]:
    """Return x and y of the outline of a support [m]; of an edge of each part of it."""
    thin = THIN * float(mesh.extent[:2].max())
    match support:
        case Edge():
            return strips(support.edge, np.column_stack(outline(mesh)), thin)
        case RectangularPatch():
            return [rectangle(support.x, support.y, support.length, support.width)]
        case _:  # a disc: a patch, a bar, a spring; or a point
            radius = float(getattr(support, "radius", 0.0)) or thin
            x, y = (float(getattr(support, coordinate)) for coordinate in ("x", "y"))
            return [disc(x, y, radius)]
