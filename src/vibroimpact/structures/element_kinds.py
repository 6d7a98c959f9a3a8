"""Kinds of finite elements: node order, shape functions, quadrature and faces.

Nodes are numbered as in Abaqus and VTK. The reference element of bricks is the unit cube, that of
tetrahedra the unit simplex, that of wedges the unit triangle times the unit interval, and that of
pyramids has the unit square as base and its apex above the middle, at height one. Shape functions
are those of scikit-fem, except for wedges and pyramids, and for two kinds with products of Lagrange
polynomials: the quadrilateral of order four for plates, and, for speed, the brick of 27 nodes,
which is evaluated for every drop of an elastic sphere.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, partial, reduce
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats, Integers

Shape = tuple[Floats, Floats]

_HEX_CORNERS = [
    [0, 0, 0],
    [1, 0, 0],
    [1, 1, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [1, 1, 1],
    [0, 1, 1],
]
_HEX_EDGES = [
    (0, 1),
    (1, 2),
    (2, 3),
    (3, 0),
    (4, 5),
    (5, 6),
    (6, 7),
    (7, 4),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
]
_HEX_FACES = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))
_TET_CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
_TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
_TET_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))

_WEDGE_CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]]
_WEDGE_EDGES = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
_WEDGE_FACES = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))

_PYRAMID_CORNERS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]]
_PYRAMID_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)]
_PYRAMID_FACES = ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))

_EDGES = {4: _TET_EDGES, 5: _PYRAMID_EDGES, 6: _WEDGE_EDGES, 8: _HEX_EDGES}
_SPACE = 3  # dimensions of a solid element

PLATE_ORDER = 4
"""Polynomial degree of the plate element; from degree four on, quadrilaterals do not lock
in thin plates.
"""


_QUAD_CORNERS = (0, PLATE_ORDER, (PLATE_ORDER + 1) ** 2 - 1, PLATE_ORDER * (PLATE_ORDER + 1))


@dataclass(frozen=True)
class ElementKind:
    """Kind of finite element.

    Parameters
    ----------
    name : str
        Name, such as "hex20".
    reference : array, shape (nodes, dimension)
        Nodes of the reference element.
    corners : int
        Number of corners, which are the first nodes.
    faces : tuple of tuple of int
        Corners of each face, counter-clockwise as seen from outside; of a plate element its own
        corners.
    basis : callable
        Shape functions: from points (points, dimension) to values (points, nodes) and gradients
        (points, dimension, nodes).
    degree : int
        Degree of the quadrature of stiffness and mass.
    """

    name: str
    reference: Floats
    corners: int
    faces: tuple[tuple[int, ...], ...]
    basis: Callable[[Floats], Shape]
    degree: int

    @property
    def dimension(self) -> int:
        """Dimension of the reference element: 3 for solids, 2 for plates."""
        return int(self.reference.shape[1])

    @property
    def order(self) -> int:
        """Polynomial degree of the shape functions along an edge."""
        return (
            PLATE_ORDER if self.dimension == 2 else 1 if len(self.reference) == self.corners else 2
        )

    @property
    def is_brick(self) -> bool:
        """Whether the reference element is a square or a cube."""
        return self.corners == int(2**self.dimension)

    @property
    def is_pyramid(self) -> bool:
        """Whether the element is a pyramid, at whose apex the gradients of its shape
        functions depend on the direction.
        """
        return self.corners == len(_PYRAMID_CORNERS)

    @property
    def edges(self) -> tuple[tuple[int, int], ...]:
        """The two corners of each edge, in the order of the nodes in the middle of edges;
        none for plate elements.
        """
        return tuple(_EDGES[self.corners]) if self.dimension == _SPACE else ()

    def quadrature(self, degree: int | None = None) -> tuple[Floats, Floats]:
        """Return the points (points, dimension) and weights of a quadrature exact to a degree; by
        default that of stiffness and mass.

        Examples
        --------
        >>> points, weights = ELEMENT_KINDS["hex20"].quadrature()
        >>> len(weights), round(float(weights.sum()), 12)
        (27, 1.0)
        """
        return _quadrature(self.corners, self.dimension, self.degree if degree is None else degree)


@cache
def _quadrature(corners: int, dimension: int, degree: int) -> tuple[Floats, Floats]:
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefHex, RefLine, RefQuad, RefTet, RefTri

    if corners == len(_WEDGE_CORNERS):
        triangle, areas = get_quadrature(RefTri, degree)
        line, lengths = get_quadrature(RefLine, degree)
        points = np.concatenate(
            [np.tile(triangle, line.shape[1]), np.repeat(line, triangle.shape[1], axis=1)]
        )
        return np.ascontiguousarray(points.T), np.repeat(lengths, len(areas)) * np.tile(
            areas, len(lengths)
        )
    if corners == len(_PYRAMID_CORNERS):
        return _pyramid_quadrature(degree)
    points, weights = get_quadrature(
        {(4, 2): RefQuad, (8, 3): RefHex, (4, 3): RefTet}[corners, dimension], degree
    )
    return np.ascontiguousarray(points.T), weights


def _pyramid_quadrature(degree: int) -> tuple[Floats, Floats]:
    """Return the conical product of Gauss and Gauss-Jacobi rules, for a cross section
    that shrinks linearly to the apex.
    """
    from scipy.special import roots_jacobi, roots_legendre

    number = degree // 2 + 1
    across, shares = roots_legendre(number)
    upwards, lengths = roots_jacobi(number, 2.0, 0.0)  # with the weight (1 - u)^2, as the area has
    x, y, z = (
        part.ravel()
        for part in np.meshgrid(0.5 * across, 0.5 * across, 0.5 * (1.0 + upwards), indexing="ij")
    )
    points = np.stack([0.5 + (1.0 - z) * x, 0.5 + (1.0 - z) * y, z], axis=1)
    weights = 0.5 * shares[:, None, None] * 0.5 * shares[:, None] * 0.125 * lengths
    return points, weights.ravel()


def _scikit_fem(name: str, reference: Floats, points: Floats) -> Shape:
    """Return scikit-fem's shape functions and gradients, reordered to the node order used here."""
    element, order = _reordered(name, reference.tobytes(), reference.shape)
    found = [element.lbasis(points.T, index) for index in order]
    return np.stack([value for value, _ in found], axis=1), np.stack(
        [slope.T for _, slope in found], axis=2
    )


@cache
def _reordered(name: str, reference: bytes, shape: tuple[int, int]) -> tuple[Any, list[int]]:
    """Return an element of scikit-fem, and the numbers of its shape functions in the node
    order used here.
    """
    import skfem

    element = getattr(skfem, name)()
    ours = np.frombuffer(reference).reshape(shape)
    distance = np.abs(ours[:, None, :] - np.asarray(element.doflocs)[None, :, :]).max(axis=2)
    return element, [int(index) for index in distance.argmin(axis=1)]


def _tensor_lagrange(order: int, places: Integers, points: Floats) -> Shape:
    """Return products of Lagrange polynomials and their gradients; `places` (nodes,
    dimension) are the factors of each node.
    """
    axes = range(points.shape[1])
    along = [
        [part.take(places[:, axis], axis=1) for part in _lagrange(order, points[:, axis])]
        for axis in axes
    ]
    slopes = [
        reduce(np.multiply, [along[axis][axis == sloping] for axis in axes]) for sloping in axes
    ]
    return reduce(np.multiply, [value for value, _ in along]), np.stack(slopes, axis=1)


def _lagrange(order: int, x: Floats) -> tuple[Floats, Floats]:
    """Return the Lagrange polynomials on equidistant nodes of [0, 1], and their
    derivatives, (points, order + 1).
    """
    powers, coefficients = np.arange(order + 1), _lagrange_coefficients(order)
    values = x[:, None] ** powers
    slopes = powers * x[:, None] ** np.maximum(powers - 1, 0)
    return values @ coefficients, slopes @ coefficients


@cache
def _lagrange_coefficients(order: int) -> Floats:
    return np.asarray(np.linalg.inv(np.vander(np.arange(order + 1) / order, increasing=True)))


def _wedge_shape(order: int, points: Floats) -> Shape:
    """Return the shape functions of a wedge of first or second order (serendipity), and
    their gradients.
    """
    # the coordinates of the triangle
    area = np.stack([1.0 - points[:, 0] - points[:, 1], points[:, 0], points[:, 1]])
    slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    t = 2.0 * points[:, 2] - 1.0
    values, by_area, by_t = [], [], []

    def add(value: Floats, partial_of: dict[int, Floats], along: Floats) -> None:
        values.append(value)
        by_area.append(sum(part[:, None] * slope[index] for index, part in partial_of.items()))
        by_t.append(along)

    for sign in (-1.0, 1.0):
        for index, one in enumerate(area):
            side, bubble = (
                0.5 * (1.0 + sign * t),
                0.5 * (1.0 - t**2) if order == 2 else np.zeros_like(t),
            )
            shape, steep = (
                (one * (2.0 * one - 1.0), 4.0 * one - 1.0)
                if order == 2
                else (one, np.ones_like(one))
            )
            add(
                shape * side - one * bubble,
                {index: steep * side - bubble},
                0.5 * sign * shape + (one * t if order == 2 else 0.0),
            )
    for start, end in _WEDGE_EDGES if order == 2 else []:
        if end == start + 3:
            add(area[start] * (1.0 - t**2), {start: 1.0 - t**2}, -2.0 * t * area[start])
        else:
            sign, first, second = (1.0 if start > 2 else -1.0), start % 3, end % 3
            side = 2.0 * (1.0 + sign * t)
            of = {first: side * area[second], second: side * area[first]}
            add(side * area[first] * area[second], of, 2.0 * sign * area[first] * area[second])
    gradients = np.concatenate(
        [np.stack(by_area, axis=-1), 2.0 * np.stack(by_t, axis=-1)[:, None]], axis=1
    )
    return np.stack(values, axis=1), gradients


def _pyramid_terms(count: int, points: Floats) -> Shape:
    """Return the functions that span the shape functions of a pyramid of 5, 13 or 14 nodes, and
    their gradients.

    With x and y from the axis, from -1 to 1 at the base, and c = 1 - z, they are 1, x, y, z and
    xy/c; for 13 nodes also x^2, y^2, z^2, xy, xz, yz, x^2 y/c and x y^2/c (G. Bedrosian, Int. J.
    Numer. Meth. Engng 35:95, 1992); for 14 also the bubble of the base. On the faces they are the
    polynomials of the tetrahedra and bricks of the same order.
    """
    x, y, z = 2.0 * points[:, 0] - 1.0, 2.0 * points[:, 1] - 1.0, points[:, 2]
    c = 1.0 - z
    below = np.where(c == 0.0, 1.0, c)
    # at the apex as along the axis
    s, t = np.where(c == 0.0, 0.0, x / below), np.where(c == 0.0, 0.0, y / below)
    one, none = np.ones_like(x), np.zeros_like(x)
    terms = [
        (one, none, none, none),
        (x, one, none, none),
        (y, none, one, none),
        (z, none, none, one),
        (x * t, t, s, s * t),
        (x * x, 2.0 * x, none, none),
        (y * y, none, 2.0 * y, none),
        (z * z, none, none, 2.0 * z),
        (x * y, y, x, none),
        (x * z, z, none, x),
        (y * z, none, z, y),
        (x * x * t, 2.0 * x * t, x * s, x * s * t),
        (x * y * t, y * t, 2.0 * x * t, y * s * t),
        (
            c * c - x * x - y * y + (x * t) ** 2,
            2.0 * x * (t * t - 1.0),
            2.0 * y * (s * s - 1.0),
            2.0 * c * ((s * t) ** 2 - 1.0),
        ),
    ][:count]
    values = np.stack([value for value, *_ in terms], axis=1)
    slopes = np.stack(
        [
            np.stack([2.0 * along_x, 2.0 * along_y, along_z])
            for _, along_x, along_y, along_z in terms
        ],
        axis=2,
    )
    return values, slopes.transpose(1, 0, 2)


@cache
def _pyramid_coefficients(reference: bytes, count: int) -> Floats:
    """Return the coefficients of the spanning functions in each shape function,
    (functions, nodes).
    """
    return np.asarray(
        np.linalg.inv(_pyramid_terms(count, np.frombuffer(reference).reshape(count, 3))[0])
    )


def _pyramid_shape(reference: Floats, points: Floats) -> Shape:
    """Return the shape functions of a pyramid and their gradients."""
    values, slopes = _pyramid_terms(len(reference), points)
    coefficients = _pyramid_coefficients(reference.tobytes(), len(reference))
    return values @ coefficients, slopes @ coefficients


def _pyramid(name: str, reference: Floats, degree: int) -> ElementKind:
    return ElementKind(
        name,
        reference,
        len(_PYRAMID_CORNERS),
        _PYRAMID_FACES,
        partial(_pyramid_shape, reference),
        degree,
    )


def _wedge(name: str, reference: Floats, order: int, degree: int) -> ElementKind:
    return ElementKind(
        name, reference, len(_WEDGE_CORNERS), _WEDGE_FACES, partial(_wedge_shape, order), degree
    )


def _kind(name: str, reference: Floats, corners: int, element: str, degree: int) -> ElementKind:
    faces = _HEX_FACES if corners == 8 else _TET_FACES
    return ElementKind(
        name, reference, corners, faces, partial(_scikit_fem, element, reference), degree
    )


def _product(
    name: str,
    reference: Floats,
    corners: int,
    faces: tuple[tuple[int, ...], ...],
    order: int,
    degree: int,
) -> ElementKind:
    places = np.rint(order * reference).astype(np.int64)
    return ElementKind(
        name, reference, corners, faces, partial(_tensor_lagrange, order, places), degree
    )


def _kinds() -> Mapping[str, ElementKind]:
    hexa, tet = np.array(_HEX_CORNERS, dtype=float), np.array(_TET_CORNERS, dtype=float)
    hex20 = np.concatenate([hexa, [hexa[list(edge)].mean(axis=0) for edge in _HEX_EDGES]])
    hex27 = np.concatenate(
        [hex20, [hexa[list(face)].mean(axis=0) for face in _HEX_FACES], [[0.5, 0.5, 0.5]]]
    )
    tet10 = np.concatenate([tet, [tet[list(edge)].mean(axis=0) for edge in _TET_EDGES]])
    wedge = np.array(_WEDGE_CORNERS, dtype=float)
    wedge15 = np.concatenate([wedge, [wedge[list(edge)].mean(axis=0) for edge in _WEDGE_EDGES]])
    pyramid = np.array(_PYRAMID_CORNERS, dtype=float)
    pyramid13 = np.concatenate(
        [pyramid, [pyramid[list(edge)].mean(axis=0) for edge in _PYRAMID_EDGES]]
    )
    pyramid14 = np.concatenate([pyramid13, [pyramid[:4].mean(axis=0)]])
    steps = np.linspace(0.0, 1.0, PLATE_ORDER + 1)
    quad = np.array([[x, y] for y in steps for x in steps])
    return {
        "tet4": _kind("tet4", tet, 4, "ElementTetP1", 2),
        "tet10": _kind("tet10", tet10, 4, "ElementTetP2", 5),
        "wedge6": _wedge("wedge6", wedge, 1, 4),
        "wedge15": _wedge("wedge15", wedge15, 2, 5),
        "pyramid5": _pyramid("pyramid5", pyramid, 5),
        "pyramid13": _pyramid("pyramid13", pyramid13, 5),
        "pyramid14": _pyramid("pyramid14", pyramid14, 5),
        "hex8": _kind("hex8", hexa, 8, "ElementHex1", 3),
        "hex20": _kind("hex20", hex20, 8, "ElementHexS2", 5),
        "hex27": _product("hex27", hex27, 8, _HEX_FACES, 2, 5),
        "quad25": _product("quad25", quad, 4, (_QUAD_CORNERS,), PLATE_ORDER, 2 * PLATE_ORDER + 1),
    }


ELEMENT_KINDS: Mapping[str, ElementKind] = _kinds()
"""Element kinds by name: tetrahedra, wedges, pyramids and bricks of first and second
order, and the plate element.
"""
