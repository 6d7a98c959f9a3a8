"""Outlines of the supports of a plate, seen from above."""

from __future__ import annotations

from collections.abc import Sequence

from vibroimpact.arrays import Floats
from vibroimpact.charts.outlines import THIN, disc, rectangle, strip
from vibroimpact.structures.finite_elements.mesh import Mesh
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
    return [_outline(support, mesh) for support in supports if not isinstance(support, NodeSet)]


def _outline(support: Support, mesh: Mesh) -> tuple[Floats, Floats]:
    """Return x and y of the outline of a support [m]."""
    thin = THIN * float(mesh.extent[:2].max())
    match support:
        case Edge():
            low = mesh.nodes.min(axis=0)
            high = mesh.nodes.max(axis=0)
            return strip(support.edge, (low[0], high[0]), (low[1], high[1]), thin)
        case RectangularPatch():
            return rectangle(support.x, support.y, support.length, support.width)
        case _:  # a disc: a patch, a bar, a spring; or a point
            radius = float(getattr(support, "radius", 0.0)) or thin
            x, y = (float(getattr(support, coordinate)) for coordinate in ("x", "y"))
            return disc(x, y, radius)
