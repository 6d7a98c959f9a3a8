"""The kinds of finite elements: node order, shape functions, quadrature and faces.

The order of the nodes is the one of Abaqus and of VTK. Bricks live on the unit cube, tetrahedra on the unit simplex.
The shape functions are scikit-fem's but of two kinds, which are products of Lagrange's polynomials: the quadrilateral of order four
for plates, and the brick of 27 nodes, of which spheres are made, as it is evaluated for every drop of one.
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
"""The polynomial degree of the plate element; from four on, quadrilaterals of thin plates do not lock."""


_QUAD_CORNERS = (0, PLATE_ORDER, (PLATE_ORDER + 1) ** 2 - 1, PLATE_ORDER * (PLATE_ORDER + 1))


@dataclass(frozen=True)
class ElementKind:
    """One kind of element.

    Parameters
    ----------
    name : str
        Such as "hex20".
    reference : array, shape (nodes, dimension)
        Where the nodes lie on the reference element.
    corners : int
        How many of them, the first ones, are corners.
    faces : tuple of tuple of int
        The corners of each face, seen counter-clockwise from outside; of a plate element its own.
    basis : callable
        From points (points, dimension) to the values (points, nodes) and the gradients (points, dimension, nodes).
    degree : int
        Degree of the quadrature that integrates stiffness and mass.
    """

    name: str
    reference: Floats
    corners: int
    faces: tuple[tuple[int, ...], ...]
    basis: Callable[[Floats], Shape]
    degree: int

    @property
    def dimension(self) -> int:
        """Three for a solid, two for a plate."""
        return int(self.reference.shape[1])

    @property
    def order(self) -> int:
        """The degree of its shape functions along an edge."""
        return PLATE_ORDER if self.dimension == 2 else 1 if len(self.reference) == self.corners else 2

    @property
    def is_brick(self) -> bool:
        """Is it a product of intervals?"""
        return self.corners == int(2**self.dimension)

    def quadrature(self, degree: int | None = None) -> tuple[Floats, Floats]:
        """Return points (points, dimension) and weights of a rule exact to a degree; by default that of stiffness and mass.

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
    """Evaluate scikit-fem's shape functions in our order of the nodes."""
    element, order = _in_our_order(name, reference.tobytes(), reference.shape)
    found = [element.lbasis(points.T, index) for index in order]
    return np.stack([value for value, _ in found], axis=1), np.stack([slope.T for _, slope in found], axis=2)


@cache
def _in_our_order(name: str, reference: bytes, shape: tuple[int, int]) -> tuple[Any, list[int]]:
    import skfem

    element = getattr(skfem, name)()
    ours = np.frombuffer(reference).reshape(shape)
    distance = np.abs(ours[:, None, :] - np.asarray(element.doflocs)[None, :, :]).max(axis=2)
    return element, [int(index) for index in distance.argmin(axis=1)]


def _tensor_lagrange(order: int, places: Integers, points: Floats) -> Shape:
    """Evaluate products of Lagrange's polynomials; places (nodes, dimension) say which one belongs to a node along each axis."""
    axes = range(points.shape[1])
    along = [[part.take(places[:, axis], axis=1) for part in _lagrange(order, points[:, axis])] for axis in axes]
    slopes = [reduce(np.multiply, [along[axis][axis == sloping] for axis in axes]) for sloping in axes]
    return reduce(np.multiply, [value for value, _ in along]), np.stack(slopes, axis=1)


def _lagrange(order: int, x: Floats) -> tuple[Floats, Floats]:
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
"""The kinds by name: tetrahedra and bricks of first and second order, and the plate element."""
