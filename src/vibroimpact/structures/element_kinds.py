"""Kinds of finite elements: node order, shape functions, quadrature and faces.

Nodes are numbered as in Abaqus and VTK. The reference element of bricks is the unit cube, that of tetrahedra the unit simplex, that of
wedges the unit triangle times the unit interval. Shape functions are those of scikit-fem, except for wedges, and for two kinds with
products of Lagrange polynomials: the quadrilateral of order four for plates, and, for speed, the brick of 27 nodes, which is evaluated
for every drop of an elastic sphere.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, partial, reduce
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats, Integers

Shape = tuple[Floats, Floats]

_HEX_CORNERS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
_HEX_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
_HEX_FACES = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))
_TET_CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
_TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
_TET_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))

_WEDGE_CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]]
_WEDGE_EDGES = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
_WEDGE_FACES = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))

PLATE_ORDER = 4
"""Polynomial degree of the plate element; from degree four on, quadrilaterals do not lock in thin plates."""


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
        Corners of each face, counter-clockwise as seen from outside; of a plate element its own corners.
    basis : callable
        Shape functions: from points (points, dimension) to values (points, nodes) and gradients (points, dimension, nodes).
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
        return PLATE_ORDER if self.dimension == 2 else 1 if len(self.reference) == self.corners else 2

    @property
    def is_brick(self) -> bool:
        """Whether the reference element is a square or a cube."""
        return self.corners == int(2**self.dimension)

    def quadrature(self, degree: int | None = None) -> tuple[Floats, Floats]:
        """Return the points (points, dimension) and weights of a quadrature exact to a degree; by default that of stiffness and mass.

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
        points = np.concatenate([np.tile(triangle, line.shape[1]), np.repeat(line, triangle.shape[1], axis=1)])
        return np.ascontiguousarray(points.T), np.repeat(lengths, len(areas)) * np.tile(areas, len(lengths))
    points, weights = get_quadrature({(4, 2): RefQuad, (8, 3): RefHex, (4, 3): RefTet}[corners, dimension], degree)
    return np.ascontiguousarray(points.T), weights


def _scikit_fem(name: str, reference: Floats, points: Floats) -> Shape:
    """Return scikit-fem's shape functions and gradients, reordered to the node order used here."""
    element, order = _reordered(name, reference.tobytes(), reference.shape)
    found = [element.lbasis(points.T, index) for index in order]
    return np.stack([value for value, _ in found], axis=1), np.stack([slope.T for _, slope in found], axis=2)


@cache
def _reordered(name: str, reference: bytes, shape: tuple[int, int]) -> tuple[Any, list[int]]:
    """Return an element of scikit-fem, and the numbers of its shape functions in the node order used here."""
    import skfem

    element = getattr(skfem, name)()
    ours = np.frombuffer(reference).reshape(shape)
    distance = np.abs(ours[:, None, :] - np.asarray(element.doflocs)[None, :, :]).max(axis=2)
    return element, [int(index) for index in distance.argmin(axis=1)]


def _tensor_lagrange(order: int, places: Integers, points: Floats) -> Shape:
    """Return products of Lagrange polynomials and their gradients; `places` (nodes, dimension) are the factors of each node."""
    axes = range(points.shape[1])
    along = [[part.take(places[:, axis], axis=1) for part in _lagrange(order, points[:, axis])] for axis in axes]
    slopes = [reduce(np.multiply, [along[axis][axis == sloping] for axis in axes]) for sloping in axes]
    return reduce(np.multiply, [value for value, _ in along]), np.stack(slopes, axis=1)


def _lagrange(order: int, x: Floats) -> tuple[Floats, Floats]:
    """Return the Lagrange polynomials on equidistant nodes of [0, 1], and their derivatives, (points, order + 1)."""
    powers, coefficients = np.arange(order + 1), _lagrange_coefficients(order)
    values = x[:, None] ** powers
    slopes = powers * x[:, None] ** np.maximum(powers - 1, 0)
    return values @ coefficients, slopes @ coefficients


@cache
def _lagrange_coefficients(order: int) -> Floats:
    return np.asarray(np.linalg.inv(np.vander(np.arange(order + 1) / order, increasing=True)))


def _wedge_shape(order: int, points: Floats) -> Shape:
    """Return the shape functions of a wedge of first or second order (serendipity), and their gradients."""
    area = np.stack([1.0 - points[:, 0] - points[:, 1], points[:, 0], points[:, 1]])  # the coordinates of the triangle
    slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    t = 2.0 * points[:, 2] - 1.0
    values, by_area, by_t = [], [], []

    def add(value: Floats, partial_of: dict[int, Floats], along: Floats) -> None:
        values.append(value)
        by_area.append(sum(part[:, None] * slope[index] for index, part in partial_of.items()))
        by_t.append(along)

    for sign in (-1.0, 1.0):
        for index, one in enumerate(area):
            side, bubble = 0.5 * (1.0 + sign * t), 0.5 * (1.0 - t**2) if order == 2 else np.zeros_like(t)
            shape, steep = (one * (2.0 * one - 1.0), 4.0 * one - 1.0) if order == 2 else (one, np.ones_like(one))
            add(shape * side - one * bubble, {index: steep * side - bubble}, 0.5 * sign * shape + (one * t if order == 2 else 0.0))
    for start, end in _WEDGE_EDGES if order == 2 else []:
        if end == start + 3:
            add(area[start] * (1.0 - t**2), {start: 1.0 - t**2}, -2.0 * t * area[start])
        else:
            sign, first, second = (1.0 if start > 2 else -1.0), start % 3, end % 3
            side = 2.0 * (1.0 + sign * t)
            of = {first: side * area[second], second: side * area[first]}
            add(side * area[first] * area[second], of, 2.0 * sign * area[first] * area[second])
    gradients = np.concatenate([np.stack(by_area, axis=-1), 2.0 * np.stack(by_t, axis=-1)[:, None]], axis=1)
    return np.stack(values, axis=1), gradients


def _wedge(name: str, reference: Floats, order: int, degree: int) -> ElementKind:
    return ElementKind(name, reference, len(_WEDGE_CORNERS), _WEDGE_FACES, partial(_wedge_shape, order), degree)


def _kind(name: str, reference: Floats, corners: int, element: str, degree: int) -> ElementKind:
    faces = _HEX_FACES if corners == 8 else _TET_FACES
    return ElementKind(name, reference, corners, faces, partial(_scikit_fem, element, reference), degree)


def _product(name: str, reference: Floats, corners: int, faces: tuple[tuple[int, ...], ...], order: int, degree: int) -> ElementKind:
    places = np.rint(order * reference).astype(np.int64)
    return ElementKind(name, reference, corners, faces, partial(_tensor_lagrange, order, places), degree)


def _kinds() -> Mapping[str, ElementKind]:
    hexa, tet = np.array(_HEX_CORNERS, dtype=float), np.array(_TET_CORNERS, dtype=float)
    hex20 = np.concatenate([hexa, [hexa[list(edge)].mean(axis=0) for edge in _HEX_EDGES]])
    hex27 = np.concatenate([hex20, [hexa[list(face)].mean(axis=0) for face in _HEX_FACES], [[0.5, 0.5, 0.5]]])
    tet10 = np.concatenate([tet, [tet[list(edge)].mean(axis=0) for edge in _TET_EDGES]])
    wedge = np.array(_WEDGE_CORNERS, dtype=float)
    wedge15 = np.concatenate([wedge, [wedge[list(edge)].mean(axis=0) for edge in _WEDGE_EDGES]])
    steps = np.linspace(0.0, 1.0, PLATE_ORDER + 1)
    quad = np.array([[x, y] for y in steps for x in steps])
    return {
        "tet4": _kind("tet4", tet, 4, "ElementTetP1", 2),
        "tet10": _kind("tet10", tet10, 4, "ElementTetP2", 5),
        "wedge6": _wedge("wedge6", wedge, 1, 4),
        "wedge15": _wedge("wedge15", wedge15, 2, 5),
        "hex8": _kind("hex8", hexa, 8, "ElementHex1", 3),
        "hex20": _kind("hex20", hex20, 8, "ElementHexS2", 5),
        "hex27": _product("hex27", hex27, 8, _HEX_FACES, 2, 5),
        "quad25": _product("quad25", quad, 4, (_QUAD_CORNERS,), PLATE_ORDER, 2 * PLATE_ORDER + 1),
    }


ELEMENT_KINDS: Mapping[str, ElementKind] = _kinds()
"""Element kinds by name: tetrahedra, wedges and bricks of first and second order, and the plate element."""
