"""Meshes of a rectangular plate: of solid elements, or of plate elements in its middle plane."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.element_kinds import PLATE_ORDER
from vibroimpact.structures.finite_elements.lattice import merged, mesh_of_blocks
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.finite_elements.rectangle import (
    MOST_NODES,
    Disc,
    rectangle_blocks,
    split_at,
    with_midpoints,
)

_NODES_PER_ELEMENT = 4  # of a large mesh of the kind "hex20"


def solid_plate_mesh(
    size: Sequence[float],
    element_size: float,
    layers: int = 1,
    kind: str = "hex20",
    discs: Sequence[Disc] = (),
    lines: tuple[Sequence[float], Sequence[float]] = ((), ()),
    splits: int = 0,
    lower_splits: int | None = None,
    rims: tuple[Sequence[float], Sequence[float]] = ((), ()),
) -> Mesh:
    """Return a mesh of a plate of solid elements, centred at the origin.

    Parameters
    ----------
    size : sequence of three floats
        Length (x), width (y) and thickness (z) [m].
    element_size : float
        Largest side of an element along x and y [m].
    layers : int, default 1
        Number of elements through the thickness.
    kind : str, default "hex20"
        Kind of element: "hex8", "hex20", "hex27", "tet4" or "tet10".
    discs, lines, rims
        Lines that edges of elements must follow: see `rectangle_blocks`.
    splits : int, default 0
        Number of splits of the elements at rims and along the edges of the plate: the strain is
        singular at the rim of a held patch and at the corners of a held face; along a free edge it
        varies within about half a thickness.
    lower_splits : int, optional
        Number of splits of the lowest layer; that of the rims by default.

    Examples
    --------
    >>> solid_plate_mesh((0.52, 0.42, 0.008), 0.004, layers=2).number_of_elements
    27300
    """
    most_elements = MOST_NODES // _NODES_PER_ELEMENT
    if (size[0] / element_size) * (size[1] / element_size) * layers > most_elements:
        remedy = "make them larger"
        if layers > 1:
            remedy += ", or take fewer layers"
        raise InputError(
            f"elements of {element_size:g} m in {layers} layer{'s' if layers > 1 else ''} "
            f"would be more than {most_elements}; {remedy}"
        )
    if lower_splits is None:
        lower_splits = splits
    layer_ends = np.linspace(-0.5 * size[2], 0.5 * size[2], layers + 1)
    heights = with_midpoints(split_at(layer_ends, lower_splits), 2)
    margins = [0.5 * size[2] * 0.25**split for split in range(splits)]
    rectangles = rectangle_blocks(size[:2], element_size, 2, discs, lines, splits, margins, rims)
    blocks = []
    for rectangle in rectangles:
        block = np.empty((*rectangle.shape[:2], len(heights), 3))
        block[..., :2] = rectangle[:, :, None]
        block[..., 2] = heights
        blocks.append(block)
    return mesh_of_blocks(blocks, kind)


def plate_mesh(
    size: Sequence[float],
    element_size: float,
    discs: Sequence[Disc] = (),
    lines: tuple[Sequence[float], Sequence[float]] = ((), ()),
    margins: Sequence[float] = (),
    rims: tuple[Sequence[float], Sequence[float]] = ((), ()),
) -> Mesh:
    """Return a mesh of plate elements in the plane z = 0, centred at the origin.

    Parameters
    ----------
    size : sequence of floats
        Length (x) and width (y) [m].
    element_size : float
        Largest side of an element [m].
    discs, lines, margins, rims
        Lines that edges of elements must follow: see `rectangle_blocks`.

    Examples
    --------
    >>> plate_mesh((0.52, 0.42), 0.052).nodes.shape
    (1517, 3)
    """
    blocks = rectangle_blocks(
        size, element_size, PLATE_ORDER, discs, lines, margins=margins, rims=rims
    )
    steps = np.arange(PLATE_ORDER + 1)
    points = []
    elements = []
    number_of_points = 0  # of the blocks so far
    for block in blocks:
        lattice = _right_handed(block)
        block_points = lattice[..., 0].size
        numbers = number_of_points + np.arange(block_points).reshape(lattice.shape[:2])
        first_corners = numbers[:-1:PLATE_ORDER, :-1:PLATE_ORDER].reshape(-1, 1)
        # in the nodes of an element the first coordinate runs fastest
        offsets = (lattice.shape[1] * steps[None, :] + steps[:, None]).ravel()
        elements.append(first_corners + offsets)
        heights = np.zeros((block_points, 1))
        points.append(np.concatenate([lattice.reshape(-1, 2), heights], axis=1))
        number_of_points += block_points
    nodes, connectivity = merged(np.concatenate(points), np.concatenate(elements))
    return Mesh(nodes, (ElementBlock("quad25", connectivity),))


def _right_handed(block: Floats) -> Floats:
    """Return the block, with its directions exchanged if needed for a normal upwards."""
    first = block[1, 0] - block[0, 0]
    second = block[0, 1] - block[0, 0]
    is_right_handed = first[0] * second[1] > first[1] * second[0]
    if is_right_handed:
        return block
    return block.transpose(1, 0, 2)
