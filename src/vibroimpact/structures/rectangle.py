"""Division of a rectangle into structured blocks whose element edges follow given lines
and the rims of discs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError

MOST_NODES = 1_000_000
"""Larger meshes are refused before they are made, as the factors of their stiffness
exceed the index range of the solver.
"""

_CORE = 0.5  # half the side of the square inside a disc, in radii
# least radius of a disc over the longer side; lines of a mesh closer than 1e-6 of a side are merged
_SMALLEST = 1e-5
_MARGIN = 1.5  # half the side of the square around a disc, in radii
# radii: least distance of the centre of a disc from an edge of the plate, or from half way to
# another disc
CLOSEST = 1.15

_CROWDED = 0.5  # of a margin: no line is added closer than this to another one


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
    most = MOST_NODES // order**2
    if max(1.0, size[0] / element_size) * max(1.0, size[1] / element_size) > most:
        words = (
            f"elements of {element_size:g} m would be more than {most} on "
            "this plate; make them larger"
        )
        raise InputError(words, "mesh.element_size")
    breaks = []
    for axis in range(2):
        sides = [-0.5 * size[axis], 0.5 * size[axis], *rims[axis]]
        others = [
            *lines[axis],
            *(end for box in boxes for end in box[axis]),
            *((disc.x, disc.y)[axis] for disc in discs),
        ]
        found = _distinct([*sides, *others], size[axis])
        covered = [box[axis] for box in boxes]
        breaks.append(
            _with_margins(
                found,
                _distinct(sides, size[axis]),
                [one for one in margins if one < element_size],
                covered,
            )
        )
    axes = [_points(found, element_size, order) for found in breaks]
    taken, blocks = [], []
    for disc, box in zip(discs, boxes, strict=True):
        (x0, x1), (y0, y1) = (
            tuple(np.abs(axis - end).argmin() for end in ends)
            for axis, ends in zip(axes, box, strict=True)
        )
        taken.append([(int(x0), int(x1)), (int(y0), int(y1))])
        blocks += _around(
            disc, axes[0][x0 : x1 + 1], axes[1][y0 : y1 + 1], element_size, order, splits
        )
    return _rest(axes, taken, order) + blocks


def _box(
    disc: Disc, size: Sequence[float], discs: Sequence[Disc]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the box around a disc as intervals of x and y, clear of other discs and
    without slivers along the edges of the plate.
    """
    said = f"the round support at ({disc.x:g}, {disc.y:g}) m, radius {disc.radius:g} m,"
    if disc.radius < _SMALLEST * max(size[:2]):
        least = f"{_SMALLEST * max(size[:2]):g} m"
        raise InputError(
            f"{said} is too small for a plate of {size[0]:g} m x {size[1]:g} m; take a "
            f"point, or a radius of at least {least}"
        )
    sides = []
    for at, length, axis in ((disc.x, size[0], "x"), (disc.y, size[1], "y")):
        ends = []
        for edge in (-0.5 * length, 0.5 * length):
            room = (edge - at) * (1.0 if edge > 0.0 else -1.0)
            if room < CLOSEST * disc.radius:
                fault = (
                    "does not lie wholly on the plate"
                    if room < disc.radius
                    else "is too near to the edge of the plate"
                )
                raise InputError(
                    f"{said} {fault}, which reaches from {-0.5 * length:g} to "
                    f"{0.5 * length:g} m along {axis}; "
                    f"between it and the edge must be at least {CLOSEST - 1.0:.2g} radii",
                    "supports",
                )
            ends.append(edge)
        sides.append((ends[0], ends[1]))
    reach = _MARGIN * disc.radius
    for other in discs:
        apart = max(abs(other.x - disc.x), abs(other.y - disc.y))
        if other is not disc:
            reach = min(reach, apart * disc.radius / (disc.radius + other.radius))
    if reach < CLOSEST * disc.radius:
        words = (
            f"{said} is too near to another one; along x or y their centres must be "
            f"{CLOSEST:g} times the sum of their radii apart"
        )
        raise InputError(words, "supports")
    for index, at in enumerate((disc.x, disc.y)):
        low, high = sides[index]
        near = reach + 0.5 * disc.radius  # no sliver along the edge
        sides[index] = (
            low if at - low < near else at - reach,
            high if high - at < near else at + reach,
        )
    return sides[0], sides[1]


def _distinct(values: Sequence[float], length: float) -> Floats:
    """Return the values within the rectangle, ascending, with close ones merged."""
    found = np.sort(np.asarray(values, dtype=float))
    found = found[(found >= -0.5 * length) & (found <= 0.5 * length)]
    apart = np.concatenate([[True], np.diff(found) > 1e-6 * length])
    return np.asarray(found[apart])


def _with_margins(
    breaks: Floats, sides: Floats, margins: Sequence[float], covered: Sequence[tuple[float, float]]
) -> Floats:
    """Return breaks with more at the margins from sides, except near other breaks or
    inside the box of a disc.
    """
    for margin in sorted(margins, reverse=True):
        for at in np.concatenate([sides - margin, sides + margin]).tolist():
            if any(low < at < high for low, high in covered):
                continue
            if breaks[0] < at < breaks[-1] and np.abs(breaks - at).min() > _CROWDED * margin:
                breaks = np.sort(np.append(breaks, at))
    return breaks


def _points(breaks: Floats, element_size: float, order: int) -> Floats:
    """Return the points of the lattice along one axis, with equal elements in each interval."""
    parts = [breaks[:1]]
    for start, end in pairwise(breaks.tolist()):
        number = order * max(1, int(np.ceil((end - start) / element_size - 1e-9)))
        parts.append(start + (end - start) * np.arange(1, number + 1) / number)
    return np.concatenate(parts)


def split_at(corners: Floats, splits: int) -> Floats:
    """Return a row of elements with the first one split several times at a quarter of its length,
    towards a singularity of the strain.

    Examples
    --------
    >>> split_at(np.array([0.0, 1.0, 2.0]), 2).tolist()
    [0.0, 0.0625, 0.25, 1.0, 2.0]
    """
    first = corners[0] + (corners[1] - corners[0]) * 0.25 ** np.arange(splits, 0, -1)
    return np.concatenate([corners[:1], first, corners[1:]])


def with_midpoints(corners: Floats, order: int) -> Floats:
    """Return the lattice points along a row of elements from its corners.

    Examples
    --------
    >>> with_midpoints(np.array([0.0, 1.0, 3.0]), 2).tolist()
    [0.0, 0.5, 1.0, 2.0, 3.0]
    """
    inside = corners[:-1, None] + np.diff(corners)[:, None] * np.arange(order) / order
    return np.append(inside.ravel(), corners[-1])


def _around(
    disc: Disc, xs: Floats, ys: Floats, element_size: float, order: int, splits: int
) -> list[Floats]:
    """Return the nine blocks of a box around a disc: the inner square, four to the rim,
    and four to the box.
    """
    centre = np.array([disc.x, disc.y])
    # -1 to 1 along each side
    along = [2.0 * (axis - axis[0]) / (axis[-1] - axis[0]) - 1.0 for axis in (xs, ys)]
    half = _CORE * disc.radius
    rings: list[tuple[Floats, Floats, Floats]] = []
    for axis in range(2):  # along which the side runs
        run = along[axis]
        for sign, end in ((-1.0, 0), (1.0, -1)):
            inner, rim, outer = np.empty((3, len(run), 2))
            inner[:, axis], inner[:, 1 - axis] = half * run, sign * half
            rim[:, axis], rim[:, 1 - axis] = (
                disc.radius * np.sin(0.25 * np.pi * run),
                sign * disc.radius * np.cos(0.25 * np.pi * run),
            )
            outer[:, axis], outer[:, 1 - axis] = (
                (xs, ys)[axis] - centre[axis],
                (xs, ys)[1 - axis][end] - centre[1 - axis],
            )
            rings.append((inner, rim, outer))
    blocks = [centre + half * np.stack(np.meshgrid(*along, indexing="ij"), axis=-1)]
    for start, end in ((0, 1), (1, 2)):
        longest = max(np.linalg.norm(ring[end] - ring[start], axis=1).max() for ring in rings)
        # the same on all four sides
        corners = _points(np.array([0.0, longest]), element_size, 1) / longest
        graded = (
            1.0 - split_at(1.0 - corners[::-1], splits)[::-1]
            if end == 1
            else split_at(corners, splits)
        )
        step = with_midpoints(graded, order)[None, :, None]
        blocks += [
            centre + (1.0 - step) * ring[start][:, None] + step * ring[end][:, None]
            for ring in rings
        ]
    return blocks


def _rest(axes: list[Floats], taken: list[list[tuple[int, int]]], order: int) -> list[Floats]:
    """Return the rest of the rectangle outside the boxes, in blocks between the lines of
    their edges.
    """
    cuts = [
        sorted({0, len(axes[axis]) - 1, *(end for box in taken for end in box[axis])})
        for axis in range(2)
    ]
    blocks = []
    for x0, x1 in pairwise(cuts[0]):
        for y0, y1 in pairwise(cuts[1]):
            if not any(
                box[0][0] <= x0 < box[0][1] and box[1][0] <= y0 < box[1][1] for box in taken
            ):
                blocks.append(
                    np.stack(
                        np.meshgrid(axes[0][x0 : x1 + 1], axes[1][y0 : y1 + 1], indexing="ij"),
                        axis=-1,
                    )
                )
    return blocks
