"""How a plate is held: its extent, and its supports from above, from the side and in words."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.marks import Line, Mark, Outline, Points
from vibroimpact.charts.outlines import THIN, disc, rectangle, strip, strips
from vibroimpact.quoting import shortened, visible
from vibroimpact.results.plate_shape import PlateShape
from vibroimpact.results.result import Result
from vibroimpact.results.single_supports import single_supports

_DEPTH = 0.07
"""Drawn depth of a support, relative to the length of the plate; columns may be this many
times deeper.
"""
_MOST_DEEP = 4.0


class Extent(NamedTuple):
    """Extent of a plate [m]: the smallest and the largest x and y, and the thickness, NaN
    where it is not known.
    """

    x: tuple[float, float]
    y: tuple[float, float]
    thickness: float

    @property
    def longer(self) -> float:
        """The longer side [m]."""
        return max(self.x[1] - self.x[0], self.y[1] - self.y[0])


def plate_extent(result: Result) -> Extent | None:
    """Return the extent of the plate: of its case, or of its mesh if that was brought;
    None if it has none.
    """
    plate = result.case.get("plate", {})
    shape = result.plate_shape
    if shape is not None:
        (left, front, _), (right, back, _) = shape.low.tolist(), shape.high.tolist()
        return Extent((left, right), (front, back), math.nan)
    deflection = result.deflection
    size = [float(side) for side in plate.get("size", ())]
    thickness = size[2] if size else math.nan
    if deflection is not None and ("file" in plate.get("mesh", {}) or not size):
        x = (float(deflection.x[0]), float(deflection.x[-1]))
        y = (float(deflection.y[0]), float(deflection.y[-1]))
        return Extent(x, y, thickness)
    if not size:
        return None
    # a plate of a given size lies around the origin
    half_x = 0.5 * size[0]
    half_y = 0.5 * size[1]
    return Extent((-half_x, half_x), (-half_y, half_y), thickness)


def support_outlines(result: Result, *, edges: bool = True) -> list[tuple[Floats, Floats]]:
    """Return the outlines of the supports seen from above as x and y [m]; edges are narrow strips,
    sets of nodes are left out.

    Parameters
    ----------
    result : Result
        The result.
    edges : bool
        Whether those of edges are among them.
    """
    extent = plate_extent(result)
    if extent is None:
        return []
    return [
        outline
        for support in single_supports(result.case)
        if edges or support["type"] != "edge"
        for outline in _outlines(support, extent, result.plate_shape)
    ]


def plate_outline(result: Result, extent: Extent) -> Outline:
    """Return the outline of the plate seen from above, with its holes if its mesh was brought."""
    if result.plate_shape is not None:
        return Outline(*result.plate_shape.above.T)
    (left, right), (front, back) = extent.x, extent.y
    return Outline(np.array([left, right, right, left]), np.array([front, front, back, back]))


def _outlines(
    support: Mapping[str, Any], extent: Extent, shape: PlateShape | None
) -> list[tuple[Floats, Floats]]:
    """Return the outline of a support; of an edge one for each part of it where the plate is."""
    small = THIN * extent.longer
    if support["type"] == "edge":
        if shape is not None:
            return strips(support["edge"], shape.above, small)
        return [strip(support["edge"], extent.x, extent.y, small)]
    if "position" not in support:
        return []
    x, y = (float(part) for part in support["position"])
    if support.get("size"):
        length, width = (float(side) for side in support["size"])
        return [rectangle(x, y, length, width)]
    return [disc(x, y, float(support.get("radius") or small))]


def held_nodes(result: Result, axes: Sequence[int]) -> list[Mark]:
    """Return the nodes of sets that are held, as they are seen along the third axis.

    Parameters
    ----------
    result : Result
        The result.
    axes : sequence of int
        The two axes of the picture: 0 for x, 1 for y, 2 for z.
    """
    shape = result.plate_shape
    if shape is None or not len(shape.held):
        return []
    across, up = (shape.held[:, axis] for axis in axes)
    return [Points(across, up, "held nodes", "held nodes")]


def supports_from_the_side(result: Result, extent: Extent, thickness: float) -> list[Mark]:
    """Return the supports as they are seen along y: what is fixed is hatched. A rigid plate lies on
    what is fixed.

    Parameters
    ----------
    result : Result
        The result.
    extent : Extent
        Extent of the plate.
    thickness : float
        Thickness as it is drawn [m].
    """
    deep = _DEPTH * (extent.x[1] - extent.x[0])
    wide = THIN * extent.longer
    if result.case.get("plate", {}).get("model") == "rigid":
        return [_block(*extent.x, -thickness, -thickness - deep)]
    marks_of_supports: dict[
        tuple[Any, ...], list[Mark]
    ] = {}  # of those behind each other one is seen
    shape = result.plate_shape
    for number, support in enumerate(single_supports(result.case)):
        level = (-thickness, 0.0)
        if shape is not None:
            level = (float(shape.levels[number, 0]), float(shape.levels[number, 1]))
        for across, _ in _outlines(support, extent, shape):
            low = float(across.min())
            high = float(across.max())
            key = support["type"], support.get("condition"), round(low, 9), round(high, 9)
            marks_of_supports.setdefault(
                key, _from_the_side(support, (low, high), level, (deep, wide))
            )
    # the widest, which may be the support of a whole edge, lie behind the others
    return [
        mark
        for _, marks in sorted(marks_of_supports.items(), key=lambda item: item[0][2] - item[0][3])
        for mark in marks
    ]


def _from_the_side(
    support: Mapping[str, Any],
    across: tuple[float, float],
    level: tuple[float, float],
    sizes: tuple[float, float],
) -> list[Mark]:
    low, high = across
    deep, wide = sizes
    below, above = level
    middle = 0.5 * (low + high)
    if support["type"] == "edge" and high - low > 2.0 * wide:
        # along the plate, in front and behind
        return [_block(low, high, below, below - 0.5 * deep, "held")]
    if support["type"] == "edge" and support["condition"] == "clamped":
        # the jaw lies outside the plate, and reaches above it
        outside = (high, high + deep)
        if support["edge"] == "x-min":
            outside = (low - deep, low)
        return [_block(*outside, above + 0.5 * deep, below - 0.5 * deep)]
    if support["type"] in ("edge", "point"):  # a knife
        side = np.array([0.0, 0.5, -0.5])
        down = np.array([0.0, 1.0, 1.0])
        return [Outline(middle + deep * side, below - deep * down, role="support")]
    if support["type"] == "spring":
        turns = np.array([0.0, 0.0, 1.0, -1.0, 1.0, -1.0, 0.0, 0.0])
        heights = below - deep * np.array([0.0, 0.15, 0.25, 0.42, 0.58, 0.75, 0.85, 1.0])
        ground = _block(middle - 0.5 * deep, middle + 0.5 * deep, below - deep, below - 1.3 * deep)
        return [Line(middle + 0.25 * deep * turns, heights), ground]
    if support["type"] == "bar":
        foot = below - min(float(support["length"]), _MOST_DEEP * deep)
        return [
            _block(low, high, below, foot, "body"),
            _block(low - 0.3 * deep, high + 0.3 * deep, foot, foot - 0.3 * deep),
        ]
    return [_block(low, high, below, below - deep)]


def _block(left: float, right: float, top: float, bottom: float, role: str = "support") -> Outline:
    return Outline(
        np.array([left, right, right, left]), np.array([top, top, bottom, bottom]), role=role
    )


def support_words(result: Result) -> str:
    """Return in words how the plate is held.

    Examples
    --------
    >>> empty = Result({"plate": {"model": "elastic", "supports": "clamped"}}, {}, {}, {}, "")
    >>> support_words(empty)
    'clamped along all edges'
    """
    plate = result.case.get("plate", {})
    given = plate.get("supports")
    if given == "free":
        return "free"
    if plate.get("motion") is not None and plate.get("model", "rigid") == "rigid":
        return "moved with its supports"
    if plate.get("model", "rigid") == "rigid":
        return "held fixed"
    if isinstance(given, str):
        return f"{given.replace('-', ' ')} along all edges"
    singles = single_supports(result.case)
    counts = Counter(_kind(single) for single in singles if single["type"] in _PLURALS)
    phrase = []
    for (kind, plural), count in counts.items():
        phrase.append(f"{count} {plural}" if count > 1 else kind)
    conditions = [single["condition"] for single in singles if single["type"] == "edge"]
    for condition in dict.fromkeys(conditions):
        edges = [single["edge"] for single in singles if single.get("condition") == condition]
        phrase.append(f"{condition.replace('-', ' ')} at {', '.join(edges)}")
    phrase += [
        f"held at its set {shortened(visible(single['name']), 40)}"
        for single in singles
        if single["type"] == "set"
    ]
    return "; ".join(phrase)


_PLURALS = {
    "patch": ("rigid patch", "rigid patches"),
    "bar": ("elastic column", "elastic columns"),
    "spring": ("spring", "springs"),
    "point": ("point", "points"),
}


def _kind(support: Mapping[str, Any]) -> tuple[str, str]:
    """Return what a support is called, one and several of them."""
    single, several = _PLURALS[support["type"]]
    if support["type"] != "point":
        return single, several
    along = f" held along {', '.join(support['directions'])}"
    return single + along, several + along
