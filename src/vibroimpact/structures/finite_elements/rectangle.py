"""Division of a rectangle into structured blocks of elements.

Edges of the elements follow given lines and the rims of discs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError

MOST_NODES = 1_000_000
"""Larger meshes are refused before they are made.

The factors of their stiffness exceed the index range of the solver.
"""

_CORE = 0.5  # half the side of the square inside a disc, in radii
# least radius of a disc over the longer side; lines of a mesh closer than 1e-6 of a side are merged
_SMALLEST = 1e-5
_MARGIN = 1.5  # half the side of the square around a disc, in radii
# radii: least distance of the centre of a disc from an edge of the plate, or from half way to
# another disc
CLOSEST = 1.15

_CROWDED = 0.5  # of a margin: no line is added closer than this to another one

Interval = tuple[float, float]
"""Ends of an interval along an axis [m]."""


@dataclass(frozen=True)
class Disc:
    """Disc on the rectangle: x and y of its centre and its radius [m]."""

    x: float
    y: float
    radius: float


def rectangle_blocks(
    size: Sequence[float],
    element_size: float,
    order: int,
    discs: Sequence[Disc] = (),
    lines: tuple[Sequence[float], Sequence[float]] = ((), ()),
    splits: int = 0,
    margins: Sequence[float] = (),
    rims: tuple[Sequence[float], Sequence[float]] = ((), ()),
) -> list[Floats]:
    """Return the blocks of a rectangle centred at the origin.

    Parameters
    ----------
    size : sequence of two floats
        Length along x and width along y [m].
    element_size : float
        Largest side of an element [m].
    order : int
        Steps of the lattice per element.
    discs : sequence of Disc
        Discs whose rims become edges of elements: a square, four blocks around it to the rim, and
        four more to a box.
    lines : two sequences of floats
        x and y [m] of further edges of elements.
    splits : int, default 0
        Number of splits of the elements on both sides of each rim of a disc, see `split_at`.
    margins : sequence of float, optional
        Distances [m] from the edges of the rectangle, and from rims, of further edges of elements;
        those below the element size apply.
    rims : two sequences of floats, optional
        Those lines that have margins.

    Returns
    -------
    list of arrays, shape (order a + 1, order b + 1, 2)
        The blocks; neighbours have the same points where they meet.

    Raises
    ------
    InputError
        If discs overlap, or reach the edge of the rectangle.

    Examples
    --------
    >>> len(rectangle_blocks((1.0, 1.0), 0.5, 2))
    1
    >>> len(rectangle_blocks((1.0, 1.0), 0.1, 2, [Disc(0.0, 0.0, 0.1)]))
    17
    """
    boxes = [_box(disc, size, discs) for disc in discs]
    most_elements = MOST_NODES // order**2
    if max(1.0, size[0] / element_size) * max(1.0, size[1] / element_size) > most_elements:
        raise InputError(
            f"elements of {element_size:g} m would be more than {most_elements} on "
            "this plate; make them larger",
            "mesh.element_size",
        )
    small_margins = [margin for margin in margins if margin < element_size]
    axes = []  # the points of the lattice along x and y
    for axis in range(2):
        length = size[axis]
        sides = [-0.5 * length, 0.5 * length, *rims[axis]]
        box_ends = [end for box in boxes for end in box[axis]]
        centres = [(disc.x, disc.y)[axis] for disc in discs]
        breaks = _distinct([*sides, *lines[axis], *box_ends, *centres], length)
        covered = [box[axis] for box in boxes]
        breaks = _with_margins(breaks, _distinct(sides, length), small_margins, covered)
        axes.append(_points(breaks, element_size, order))
    box_ranges = []  # first and last number of the points of each box, along x and y
    disc_blocks = []
    for disc, box in zip(discs, boxes, strict=True):
        x_range, y_range = (
            (int(np.abs(points - low).argmin()), int(np.abs(points - high).argmin()))
            for points, (low, high) in zip(axes, box, strict=True)
        )
        box_ranges.append((x_range, y_range))
        xs = axes[0][x_range[0] : x_range[1] + 1]
        ys = axes[1][y_range[0] : y_range[1] + 1]
        disc_blocks += _blocks_around(disc, xs, ys, element_size, order, splits)
    return _blocks_between(axes, box_ranges) + disc_blocks


def _box(disc: Disc, size: Sequence[float], discs: Sequence[Disc]) -> tuple[Interval, Interval]:
    """Return the box around a disc as intervals of x and y.

    It is clear of other discs, and leaves no slivers along the edges of the plate.
    """
    name = f"the round support at ({disc.x:g}, {disc.y:g}) m, radius {disc.radius:g} m,"
    least_radius = _SMALLEST * max(size[:2])
    if disc.radius < least_radius:
        raise InputError(
            f"{name} is too small for a plate of {size[0]:g} m x {size[1]:g} m; take a "
            f"point, or a radius of at least {least_radius:g} m"
        )
    _refuse_near_edge(disc, disc.x, size[0], "x", name)
    _refuse_near_edge(disc, disc.y, size[1], "y", name)
    reach = _MARGIN * disc.radius
    for other in discs:
        distance = max(abs(other.x - disc.x), abs(other.y - disc.y))
        if other is not disc:
            reach = min(reach, distance * disc.radius / (disc.radius + other.radius))
    if reach < CLOSEST * disc.radius:
        raise InputError(
            f"{name} is too near to another one; along x or y their centres must be "
            f"{CLOSEST:g} times the sum of their radii apart",
            "supports",
        )
    return (
        _box_side(disc.x, size[0], reach, disc.radius),
        _box_side(disc.y, size[1], reach, disc.radius),
    )


def _refuse_near_edge(disc: Disc, centre: float, length: float, axis: str, name: str) -> None:
    """Raise if a disc is too near to the edges of the plate across an axis."""
    for edge in (-0.5 * length, 0.5 * length):
        # negative where the centre lies beyond the edge
        distance = np.sign(edge) * (edge - centre)
        if distance >= CLOSEST * disc.radius:
            continue
        fault = "is too near to the edge of the plate"
        if distance < disc.radius:
            fault = "does not lie wholly on the plate"
        raise InputError(
            f"{name} {fault}, which reaches from {-0.5 * length:g} to "
            f"{0.5 * length:g} m along {axis}; "
            f"between it and the edge must be at least {CLOSEST - 1.0:.2g} radii",
            "supports",
        )


def _box_side(centre: float, length: float, reach: float, radius: float) -> Interval:
    """Return the ends of a box along an axis, at the edges of the plate if these are near."""
    low_edge = -0.5 * length
    high_edge = 0.5 * length
    near = reach + 0.5 * radius  # no sliver along the edge
    low = centre - reach
    if centre - low_edge < near:
        low = low_edge
    high = centre + reach
    if high_edge - centre < near:
        high = high_edge
    return low, high


def _distinct(positions: Sequence[float], length: float) -> Floats:
    """Return the positions within the rectangle, ascending, with close ones merged."""
    ascending = np.sort(np.asarray(positions, dtype=float))
    ascending = ascending[(ascending >= -0.5 * length) & (ascending <= 0.5 * length)]
    is_distinct = np.concatenate([[True], np.diff(ascending) > 1e-6 * length])
    return np.asarray(ascending[is_distinct])


def _with_margins(
    breaks: Floats, sides: Floats, margins: Sequence[float], covered: Sequence[Interval]
) -> Floats:
    """Return breaks with more at the margins from sides.

    There are none near other breaks, or inside the box of a disc.
    """
    for margin in sorted(margins, reverse=True):
        for position in np.concatenate([sides - margin, sides + margin]).tolist():
            is_inside = breaks[0] < position < breaks[-1]
            is_covered = any(low < position < high for low, high in covered)
            if not is_inside or is_covered:
                continue
            if np.abs(breaks - position).min() > _CROWDED * margin:
                breaks = np.sort(np.append(breaks, position))
    return breaks


def _points(breaks: Floats, element_size: float, order: int) -> Floats:
    """Return the points of the lattice along one axis, with equal elements in each interval."""
    points = [breaks[:1]]
    for start, end in pairwise(breaks.tolist()):
        elements = max(1, int(np.ceil((end - start) / element_size - 1e-9)))
        steps = order * elements
        points.append(start + (end - start) * np.arange(1, steps + 1) / steps)
    return np.concatenate(points)


def split_at(corners: Floats, splits: int) -> Floats:
    """Return a row of elements with the first one split several times at a quarter of its length.

    The elements become smaller towards a singularity of the strain.

    Examples
    --------
    >>> split_at(np.array([0.0, 1.0, 2.0]), 2).tolist()
    [0.0, 0.0625, 0.25, 1.0, 2.0]
    """
    new_corners = corners[0] + (corners[1] - corners[0]) * 0.25 ** np.arange(splits, 0, -1)
    return np.concatenate([corners[:1], new_corners, corners[1:]])


def with_midpoints(corners: Floats, order: int) -> Floats:
    """Return the lattice points along a row of elements from its corners.

    Examples
    --------
    >>> with_midpoints(np.array([0.0, 1.0, 3.0]), 2).tolist()
    [0.0, 0.5, 1.0, 2.0, 3.0]
    """
    inside = corners[:-1, None] + np.diff(corners)[:, None] * np.arange(order) / order
    return np.append(inside.ravel(), corners[-1])


def _blocks_around(
    disc: Disc, xs: Floats, ys: Floats, element_size: float, order: int, splits: int
) -> list[Floats]:
    """Return the nine blocks of a box around a disc.

    They are the inner square, four to the rim, and four to the box.
    """
    centre = np.array([disc.x, disc.y])
    # positions along each side of the box, from -1 to 1
    length = xs[-1] - xs[0]
    width = ys[-1] - ys[0]
    along_x = 2.0 * (xs - xs[0]) / length - 1.0
    along_y = 2.0 * (ys - ys[0]) / width - 1.0
    rings = _rings(disc, xs, ys, along_x, along_y)
    square = np.stack(np.meshgrid(along_x, along_y, indexing="ij"), axis=-1)
    blocks = [centre + _CORE * disc.radius * square]
    for inner, outer in ((0, 1), (1, 2)):
        longest = max(np.linalg.norm(ring[outer] - ring[inner], axis=1).max() for ring in rings)
        # the same on all four sides
        corners = _points(np.array([0.0, longest]), element_size, 1) / longest
        # split towards the rim, where the strain is singular
        if outer == 1:
            corners = 1.0 - split_at(1.0 - corners[::-1], splits)[::-1]
        else:
            corners = split_at(corners, splits)
        # straight lines from the inner ring to the outer one
        step = with_midpoints(corners, order)[None, :, None]
        for ring in rings:
            start = ring[inner][:, None]
            end = ring[outer][:, None]
            blocks.append(centre + (1.0 - step) * start + step * end)
    return blocks


def _rings(
    disc: Disc, xs: Floats, ys: Floats, along_x: Floats, along_y: Floats
) -> list[tuple[Floats, Floats, Floats]]:
    """Return the points on the inner square, on the rim and on the box, for each of four sides.

    They are relative to the centre of the disc.
    """
    half = _CORE * disc.radius
    rings = []
    sides = (  # the axis of a side, the points along it, and those of the box across it
        (0, along_x, xs - disc.x, ys - disc.y),
        (1, along_y, ys - disc.y, xs - disc.x),
    )
    for axis, along, box_along, box_across in sides:
        for sign, end in ((-1.0, 0), (1.0, -1)):
            square = np.empty((len(along), 2))
            square[:, axis] = half * along
            square[:, 1 - axis] = sign * half
            rim = np.empty((len(along), 2))
            rim[:, axis] = disc.radius * np.sin(0.25 * np.pi * along)
            rim[:, 1 - axis] = sign * disc.radius * np.cos(0.25 * np.pi * along)
            box = np.empty((len(along), 2))
            box[:, axis] = box_along
            box[:, 1 - axis] = box_across[end]
            rings.append((square, rim, box))
    return rings


def _blocks_between(
    axes: list[Floats], box_ranges: list[tuple[tuple[int, int], tuple[int, int]]]
) -> list[Floats]:
    """Return the rest of the rectangle outside the boxes, in blocks between lines of their edges.

    The ranges are the first and last number of the points of each box, along x and y.
    """
    cuts = []
    for axis in range(2):
        box_ends = [end for box in box_ranges for end in box[axis]]
        cuts.append(sorted({0, len(axes[axis]) - 1, *box_ends}))
    blocks = []
    for x_first, x_last in pairwise(cuts[0]):
        for y_first, y_last in pairwise(cuts[1]):
            is_in_box = any(
                x_range[0] <= x_first < x_range[1] and y_range[0] <= y_first < y_range[1]
                for x_range, y_range in box_ranges
            )
            if not is_in_box:
                xs = axes[0][x_first : x_last + 1]
                ys = axes[1][y_first : y_last + 1]
                blocks.append(np.stack(np.meshgrid(xs, ys, indexing="ij"), axis=-1))
    return blocks
