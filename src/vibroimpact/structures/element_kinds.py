"""Kinds of finite elements: node order, shape functions, quadrature and faces.

Nodes are numbered as in Abaqus and VTK. The reference element of bricks is the unit cube, that of tetrahedra the unit simplex. Shape
functions are those of scikit-fem, except for two kinds with products of Lagrange polynomials: the quadrilateral of order four for
plates, and, for speed, the brick of 27 nodes, which is evaluated for every drop of an elastic sphere.
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
        return _quadrature(self.is_brick, self.dimension, self.degree if degree is None else degree)


@cache
def _quadrature(brick: bool, dimension: int, degree: int) -> tuple[Floats, Floats]:
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefHex, RefQuad, RefTet

    points, weights = get_quadrature({2: RefQuad, 3: RefHex}[dimension] if brick else RefTet, degree)
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
    steps = np.linspace(0.0, 1.0, PLATE_ORDER + 1)
    quad = np.array([[x, y] for y in steps for x in steps])
    return {
        "tet4": _kind("tet4", tet, 4, "ElementTetP1", 2),
        "tet10": _kind("tet10", tet10, 4, "ElementTetP2", 5),
        "hex8": _kind("hex8", hexa, 8, "ElementHex1", 3),
        "hex20": _kind("hex20", hex20, 8, "ElementHexS2", 5),
        "hex27": _product("hex27", hex27, 8, _HEX_FACES, 2, 5),
        "quad25": _product("quad25", quad, 4, (_QUAD_CORNERS,), PLATE_ORDER, 2 * PLATE_ORDER + 1),
    }


ELEMENT_KINDS: Mapping[str, ElementKind] = _kinds()
"""Element kinds by name: tetrahedra and bricks of first and second order, and the plate element."""
