"""What may be drawn in a panel of a chart: lines, points, bands, bars, maps and other
marks, as data in SI units.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.axis import Axis


@dataclass(frozen=True, eq=False)
class Line:
    """A line through points; NaN interrupts it.

    Parameters
    ----------
    x, y : array
        The points.
    name, role : str
        Name in the legend, and role.
    marked : bool
        Whether each point has a symbol too.
    texts : tuple of str
        What each of the points is, as those of `Points`.
    origins : tuple of float
        Values of x from which the line counts in each view, in place of those of the views: lines
        of several runs are laid upon each other at what they have in common, such as the first
        touch of an impact.
    """

    x: Floats
    y: Floats
    name: str = ""
    role: str = "main"
    marked: bool = False
    texts: tuple[str, ...] = ()
    origins: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class Points:
    """Single points.

    Parameters
    ----------
    x, y : array
        Where they are.
    name, role : str
        Name in the legend, and role.
    texts : tuple of str
        What each of them is; shown where the pointer is, above the coordinates, or in their place
        if the texts have several lines.
    keys : mapping of str to array
        Values by which the points may be coloured, numbers or names, by what they are.
    low, high : array, optional
        Ends of the intervals of y.
    """

    x: Floats
    y: Floats
    name: str = ""
    role: str = "mark"
    texts: tuple[str, ...] = ()
    keys: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    low: Floats | None = None
    high: Floats | None = None


@dataclass(frozen=True, eq=False)
class Band:
    """The area between two lines."""

    x: Floats
    low: Floats
    high: Floats
    name: str = ""
    role: str = "detail"


@dataclass(frozen=True, eq=False)
class Layer:
    """One of the areas of a stack: what adds to what is below it."""

    name: str
    values: Floats
    role: str


@dataclass(frozen=True, eq=False)
class Stack:
    """Areas on top of each other, from the lowest up; negative values lie below zero, where the
    stack begins.

    Parameters
    ----------
    x : array
        Where the values are.
    layers : tuple of Layer
        The areas.
    overview : array of int, optional
        Indices of the points that show the whole; by default all.
    """

    x: Floats
    layers: tuple[Layer, ...]
    overview: Indices | None = None


@dataclass(frozen=True, eq=False)
class Bars:
    """Bars at places along an axis, from `base` on; of a histogram, `places` are the edges.

    Parameters
    ----------
    places : array
        Centres of the bars, or edges, one more than there are values.
    values : array
        Their lengths.
    name, role : str
        Name in the legend, and role.
    width : float
        Width of a bar.
    base : array, optional
        Where each bar begins; by default at zero.
    lying : bool
        Whether the bars are horizontal.
    low, high : array, optional
        Ends of the intervals of the values.
    texts : tuple of str
        What each of the bars is, such as its name on an axis of names; shown where the pointer is,
        in place of where the bar is.
    """

    places: Floats
    values: Floats
    name: str = ""
    role: str = "detail"
    width: float = 0.6
    base: Floats | None = None
    lying: bool = False
    low: Floats | None = None
    high: Floats | None = None
    texts: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Map:
    """Values over a rectangular grid as colours.

    Parameters
    ----------
    x, y : array
        The grid's lines; of a grid of names 0, 1, 2 and so on.
    values : array, shape (len(y), len(x))
        The values; NaN where there is none.
    scale : Axis
        Quantity of the values; maps that have the same axis object share its range.
    diverging : bool
        Whether the scale is symmetric about zero.
    contours : bool
        Whether lines of equal value are drawn: zero thick, negative ones dashed.
    cells : bool
        Whether each value fills its cell; otherwise the values are interpolated.
    texts : tuple of str
        What each value is, row by row; shown where the pointer is, in place of the value.
    """

    x: Floats
    y: Floats
    values: Floats
    scale: Axis
    diverging: bool = False
    contours: bool = False
    cells: bool = True
    texts: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Facets:
    """The facets of a surface, as they are seen: polygons, each of one colour, the farthest first.

    Parameters
    ----------
    corners : array, shape (facets, corners, 2)
        Corners of the facets in the plane of the picture.
    values : array, shape (facets,)
        What the colours tell.
    diverging : bool
        Whether the scale is symmetric about zero; otherwise it is that of light on a surface, from
        shade to full light.
    scale : Axis, optional
        Quantity of the values, whose scale is then shown; facets and maps that have the same axis
        object share its range.
    """

    corners: Floats
    values: Floats
    diverging: bool = False
    scale: Axis | None = None


@dataclass(frozen=True, eq=False)
class Level:
    """A straight line across the whole panel at a value of its vertical axis, or of the
    horizontal one if `upright`.
    """

    value: float
    name: str = ""
    role: str = "reference"
    upright: bool = False
    label: str = ""


@dataclass(frozen=True, eq=False)
class Spans:
    """Ranges of the horizontal axis that are shaded, such as the times in contact."""

    starts: Floats
    ends: Floats
    name: str = ""
    role: str = "contact"


@dataclass(frozen=True, eq=False)
class Rug:
    """Ticks along the lower edge of a panel, such as at natural frequencies."""

    values: Floats
    name: str = ""
    role: str = "mark"


@dataclass(frozen=True, eq=False)
class Outline:
    """A closed outline, filled."""

    x: Floats
    y: Floats
    name: str = ""
    role: str = "body"


@dataclass(frozen=True, eq=False)
class Arrow:
    """An arrow from a point to another; a dimension if it points both ways."""

    start: tuple[float, float]
    end: tuple[float, float]
    both: bool = False
    role: str = "reference"


@dataclass(frozen=True, eq=False)
class Label:
    """Words at a place.

    Parameters
    ----------
    x, y : float
        The place.
    words : str
        The words.
    anchor : str
        Side on which the place lies: "left", "right", "center", "above" or "below".
    corner : bool
        Whether the place is in parts of the panel, from its lower left corner.
    """

    x: float
    y: float
    words: str
    anchor: str = "center"
    corner: bool = False


Mark = (
    Line
    | Points
    | Band
    | Stack
    | Bars
    | Map
    | Facets
    | Level
    | Spans
    | Rug
    | Outline
    | Arrow
    | Label
)
"""What may be drawn in a panel."""


def across(mark: Mark) -> Iterator[Any]:
    """Yield the values of a mark along the horizontal axis."""
    match mark:
        case Line() | Points() | Band() | Stack() | Map() | Outline():
            yield mark.x
        case Facets():
            yield mark.corners[..., 0]
        case Bars() if mark.lying:
            yield from _of_bars(mark)
        case Bars():
            yield mark.places
        case Level() if mark.upright:
            yield mark.value
        case Spans():
            yield mark.starts
            yield mark.ends
        case Rug():
            yield mark.values
        case Arrow():
            yield mark.start[0]
            yield mark.end[0]
        case Label() if not mark.corner:
            yield mark.x


def upwards(mark: Mark) -> Iterator[Any]:
    """Yield the values of a mark along the vertical axis."""
    match mark:
        case Line() | Outline() | Map():
            yield mark.y
        case Facets():
            yield mark.corners[..., 1]
        case Points():
            yield from (part for part in (mark.y, mark.low, mark.high) if part is not None)
        case Band():
            yield mark.low
            yield mark.high
        case Stack():
            yield from stack_edges(mark)
        case Bars() if not mark.lying:
            yield from _of_bars(mark)
        case Bars():
            yield mark.places
        case Level() if not mark.upright:
            yield mark.value
        case Arrow():
            yield mark.start[1]
            yield mark.end[1]
        case Label() if not mark.corner:
            yield mark.y


def _of_bars(bars: Bars) -> Iterator[Any]:
    if bars.base is None:
        yield bars.values
    else:
        yield bars.base
        yield bars.base + bars.values
    yield from (end for end in (bars.low, bars.high) if end is not None)


def stack_edges(stack: Stack) -> list[Floats]:
    """Return the edges between the layers of a stack, from its lower edge up: one more than there
    are layers.

    Examples
    --------
    >>> layers = (
    ...     Layer("potential", np.array([-1.0, 2.0]), "main"),
    ...     Layer("kinetic", np.array([3.0, 1.0]), "main"),
    ... )
    >>> [edge.tolist() for edge in stack_edges(Stack(np.array([0.0, 1.0]), layers))]
    [[-1.0, 0.0], [-1.0, 2.0], [2.0, 3.0]]
    """
    bottom = sum((np.minimum(layer.values, 0.0) for layer in stack.layers), np.zeros(len(stack.x)))
    edges = [bottom]
    for layer in stack.layers:
        edges.append(edges[-1] + np.maximum(layer.values, 0.0))
    return edges


def cell_edges(places: Floats, *, log: bool) -> Floats:
    """Return the edges of the cells around the lines of a grid: midpoints, geometric ones on a
    logarithmic axis.

    Examples
    --------
    >>> cell_edges(np.array([0.0, 1.0, 3.0]), log=False).tolist()
    [-0.5, 0.5, 2.0, 4.0]
    >>> cell_edges(np.array([1.0, 4.0]), log=True).round(9).tolist()
    [0.5, 2.0, 8.0]
    """
    if log:
        return np.asarray(np.exp(cell_edges(np.log(places), log=False)))
    if len(places) == 1:
        return np.array([places[0] - 0.5, places[0] + 0.5])
    middles = 0.5 * (places[1:] + places[:-1])
    return np.concatenate(
        [[2.0 * places[0] - middles[0]], middles, [2.0 * places[-1] - middles[-1]]]
    )
