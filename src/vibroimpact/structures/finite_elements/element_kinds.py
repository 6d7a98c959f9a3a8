"""Kinds of finite elements: node order, shape functions, quadrature and faces.

Nodes are numbered as in Abaqus and VTK. The reference element of bricks is the unit cube, that of
tetrahedra the unit simplex, that of wedges the unit triangle times the unit interval, and that of
pyramids has the unit square as base and its apex above the middle, at height one. Shape functions
are those of scikit-fem, except for wedges and pyramids, and for two kinds with products of Lagrange
polynomials: the quadrilateral of order four for plates, and, for speed, the brick of 27 nodes,
which is evaluated for every drop of an elastic sphere.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial, reduce
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats, Integers

Shape = tuple[Floats, Floats]
"""Shape functions (points, nodes), and their gradients (points, dimension, nodes)."""
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
"""Polynomial degree of the plate element.

From degree four on, quadrilaterals do not lock in thin plates.
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
        if self.dimension == 2:
            return PLATE_ORDER
        has_only_corners = len(self.reference) == self.corners
        return 1 if has_only_corners else 2

    @property
    def is_brick(self) -> bool:
        """Whether the reference element is a square or a cube."""
        return self.corners == int(2**self.dimension)

    @property
    def is_pyramid(self) -> bool:
        """Whether the element is a pyramid.

        At its apex the gradients of its shape functions depend on the direction.
        """
        return self.corners == len(_PYRAMID_CORNERS)

    @property
    def edges(self) -> tuple[tuple[int, int], ...]:
        """The two corners of each edge, in the order of the nodes in the middle of edges.

        There are none for plate elements.
        """
        if self.dimension != _SPACE:
            return ()
        return tuple(_EDGES[self.corners])

    def quadrature(self, degree: int | None = None) -> tuple[Floats, Floats]:
        """Return the points (points, dimension) and weights of a quadrature exact to a degree.

        The degree is by default that of stiffness and mass.

        Examples
        --------
        >>> points, weights = ELEMENT_KINDS["hex20"].quadrature()
        >>> len(weights), round(float(weights.sum()), 12)
        (27, 1.0)
        """
        if degree is None:
            degree = self.degree
        return _quadrature(self.corners, self.dimension, degree)


@cache
def _quadrature(corners: int, dimension: int, degree: int) -> tuple[Floats, Floats]:
    """Return the points and weights of a quadrature on a reference element."""
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefHex, RefQuad, RefTet

    if corners == len(_WEDGE_CORNERS):
        return _wedge_quadrature(degree)
    if corners == len(_PYRAMID_CORNERS):
        return _pyramid_quadrature(degree)
    domain = {(4, 2): RefQuad, (8, 3): RefHex, (4, 3): RefTet}[corners, dimension]
    points, weights = get_quadrature(domain, degree)
    return np.ascontiguousarray(points.T), weights


def _wedge_quadrature(degree: int) -> tuple[Floats, Floats]:
    """Return the product of the rules on the triangle and on the line."""
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefLine, RefTri

    triangle, areas = get_quadrature(RefTri, degree)
    line, lengths = get_quadrature(RefLine, degree)
    points = np.concatenate(
        [np.tile(triangle, line.shape[1]), np.repeat(line, triangle.shape[1], axis=1)]
    )
    weights = np.repeat(lengths, len(areas)) * np.tile(areas, len(lengths))
    return np.ascontiguousarray(points.T), weights


def _pyramid_quadrature(degree: int) -> tuple[Floats, Floats]:
    """Return the conical product of Gauss and Gauss-Jacobi rules.

    The cross section shrinks linearly to the apex.
    """
    from scipy.special import roots_jacobi, roots_legendre

    number = degree // 2 + 1
    across, across_weights = roots_legendre(number)
    # with the weight (1 - u)^2, as the area has
    upwards, upwards_weights = roots_jacobi(number, 2.0, 0.0)
    grid = np.meshgrid(0.5 * across, 0.5 * across, 0.5 * (1.0 + upwards), indexing="ij")
    x, y, z = (coordinate.ravel() for coordinate in grid)
    points = np.stack([0.5 + (1.0 - z) * x, 0.5 + (1.0 - z) * y, z], axis=1)
    weights = (
        0.5
        * across_weights[:, None, None]
        * 0.5
        * across_weights[:, None]
        * 0.125
        * upwards_weights
    )
    return points, weights.ravel()


def _scikit_fem(name: str, reference: Floats, points: Floats) -> Shape:
    """Return scikit-fem's shape functions and gradients, reordered to the node order used here."""
    element, order = _reordered(name, reference.tobytes(), reference.shape)
    functions = [element.lbasis(points.T, index) for index in order]
    values = np.stack([value for value, _ in functions], axis=1)
    gradients = np.stack([gradient.T for _, gradient in functions], axis=2)
    return values, gradients


@cache
def _reordered(name: str, reference: bytes, shape: tuple[int, int]) -> tuple[Any, list[int]]:
    """Return an element of scikit-fem, and the numbers of its shape functions in our node order."""
    import skfem

    element = getattr(skfem, name)()
    nodes = np.frombuffer(reference).reshape(shape)
    their_nodes = np.asarray(element.doflocs)
    distance = np.abs(nodes[:, None, :] - their_nodes[None, :, :]).max(axis=2)
    return element, [int(index) for index in distance.argmin(axis=1)]


def _tensor_lagrange(order: int, factors: Integers, points: Floats) -> Shape:
    """Return products of Lagrange polynomials and their gradients.

    `factors` (nodes, dimension) are the numbers of the polynomials in the product of each node.
    """
    axes = range(points.shape[1])
    # polynomials and derivatives along each axis, by node
    along = []
    slopes_along = []
    for axis in axes:
        polynomials, derivatives = _lagrange(order, points[:, axis])
        along.append(polynomials.take(factors[:, axis], axis=1))
        slopes_along.append(derivatives.take(factors[:, axis], axis=1))
    values = reduce(np.multiply, along)
    # the derivative along an axis is the product with the polynomial of that axis derived
    gradients = []
    for derived in axes:
        product = along.copy()
        product[derived] = slopes_along[derived]
        gradients.append(reduce(np.multiply, product))
    return values, np.stack(gradients, axis=1)


def _lagrange(order: int, x: Floats) -> tuple[Floats, Floats]:
    """Return the Lagrange polynomials on equidistant nodes of [0, 1], and their derivatives.

    Both are (points, order + 1).
    """
    exponents = np.arange(order + 1)
    coefficients = _lagrange_coefficients(order)
    powers = x[:, None] ** exponents
    derivatives = exponents * x[:, None] ** np.maximum(exponents - 1, 0)
    return powers @ coefficients, derivatives @ coefficients


@cache
def _lagrange_coefficients(order: int) -> Floats:
    """Return the coefficients of powers in each Lagrange polynomial, (powers, nodes)."""
    return np.asarray(np.linalg.inv(np.vander(np.arange(order + 1) / order, increasing=True)))


def _wedge_shape(order: int, points: Floats) -> Shape:
    """Return the shape functions of a wedge of first or second order (serendipity)."""
    # area coordinates of the triangle, their gradients, and the height from -1 to 1
    area = np.stack([1.0 - points[:, 0] - points[:, 1], points[:, 0], points[:, 1]])
    area_gradients = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    t = 2.0 * points[:, 2] - 1.0
    # of each node: its value, its derivatives in area coordinates, and that in t
    terms = _wedge_corner_terms(order, area, t)
    if order == 2:
        terms += _wedge_edge_terms(area, t)
    values = np.stack([value for value, _, _ in terms], axis=1)
    along_triangle = [
        sum(slope[:, None] * area_gradients[index] for index, slope in by_area.items())
        for _, by_area, _ in terms
    ]
    along_height = [by_t for _, _, by_t in terms]
    in_plane = np.stack(along_triangle, axis=-1)
    upwards = 2.0 * np.stack(along_height, axis=-1)  # dt/dz = 2
    return values, np.concatenate([in_plane, upwards[:, None]], axis=1)


def _wedge_corner_terms(
    order: int, area: Floats, t: Floats
) -> list[tuple[Floats, dict[int, Floats], Floats]]:
    """Return value, derivatives in area coordinates and derivative in t of each corner's function.

    Corners of the lower triangle, at t = -1, come first.
    """
    terms = []
    for sign in (-1.0, 1.0):
        for index, coordinate in enumerate(area):
            linear = 0.5 * (1.0 + sign * t)
            if order == 2:
                bubble = 0.5 * (1.0 - t**2)
                triangle = coordinate * (2.0 * coordinate - 1.0)
                triangle_slope = 4.0 * coordinate - 1.0
                bubble_slope = coordinate * t
            else:
                bubble = np.zeros_like(t)
                triangle = coordinate
                triangle_slope = np.ones_like(coordinate)
                bubble_slope = np.zeros_like(t)
            # L (2 L - 1) (1 + s t)/2 - L (1 - t^2)/2, or to first order L (1 + s t)/2
            value = triangle * linear - coordinate * bubble
            by_area = {index: triangle_slope * linear - bubble}
            by_t = 0.5 * sign * triangle + bubble_slope
            terms.append((value, by_area, by_t))
    return terms


def _wedge_edge_terms(area: Floats, t: Floats) -> list[tuple[Floats, dict[int, Floats], Floats]]:
    """Return, as `_wedge_corner_terms`, the functions of the nodes in the middle of edges."""
    terms = []
    for start, end in _WEDGE_EDGES:
        if end == start + 3:  # along the height
            value = area[start] * (1.0 - t**2)
            by_area = {start: 1.0 - t**2}
            by_t = -2.0 * t * area[start]
        else:  # of the lower or upper triangle
            sign = 1.0 if start > 2 else -1.0
            first = area[start % 3]
            second = area[end % 3]
            side = 2.0 * (1.0 + sign * t)
            value = side * first * second
            by_area = {start % 3: side * second, end % 3: side * first}
            by_t = 2.0 * sign * first * second
        terms.append((value, by_area, by_t))
    return terms


def _pyramid_terms(count: int, points: Floats) -> Shape:
    """Return the functions that span the shape functions of a pyramid, and their gradients.

    The pyramid has 5, 13 or 14 nodes.
    With x and y from the axis, from -1 to 1 at the base, and c = 1 - z, they are 1, x, y, z and
    xy/c; for 13 nodes also x^2, y^2, z^2, xy, xz, yz, x^2 y/c and x y^2/c (G. Bedrosian, Int. J.
    Numer. Meth. Engng 35:95, 1992); for 14 also the bubble of the base. On the faces they are the
    polynomials of the tetrahedra and bricks of the same order.
    """
    x = 2.0 * points[:, 0] - 1.0
    y = 2.0 * points[:, 1] - 1.0
    z = points[:, 2]
    c = 1.0 - z
    # s = x / c and t = y / c; at the apex as along the axis
    is_apex = c == 0.0
    divisor = np.where(is_apex, 1.0, c)
    s = np.where(is_apex, 0.0, x / divisor)
    t = np.where(is_apex, 0.0, y / divisor)
    unity = np.ones_like(x)
    zero = np.zeros_like(x)
    # each function, and its derivatives along x, y and z
    terms = [
        (unity, zero, zero, zero),
        (x, unity, zero, zero),
        (y, zero, unity, zero),
        (z, zero, zero, unity),
        (x * t, t, s, s * t),
        (x * x, 2.0 * x, zero, zero),
        (y * y, zero, 2.0 * y, zero),
        (z * z, zero, zero, 2.0 * z),
        (x * y, y, x, zero),
        (x * z, z, zero, x),
        (y * z, zero, z, y),
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
    # x and y run twice as fast as the coordinates of the reference element
    gradients = np.stack(
        [np.stack([2.0 * by_x, 2.0 * by_y, by_z]) for _, by_x, by_y, by_z in terms], axis=2
    )
    return values, gradients.transpose(1, 0, 2)


@cache
def _pyramid_coefficients(reference: bytes, count: int) -> Floats:
    """Return the coefficients of the spanning functions in each shape function.

    They are (functions, nodes).
    """
    nodes = np.frombuffer(reference).reshape(count, 3)
    return np.asarray(np.linalg.inv(_pyramid_terms(count, nodes)[0]))


def _pyramid_shape(reference: Floats, points: Floats) -> Shape:
    """Return the shape functions of a pyramid and their gradients."""
    values, gradients = _pyramid_terms(len(reference), points)
    coefficients = _pyramid_coefficients(reference.tobytes(), len(reference))
    return values @ coefficients, gradients @ coefficients


def _pyramid(name: str, reference: Floats, degree: int) -> ElementKind:
    shape = partial(_pyramid_shape, reference)
    return ElementKind(name, reference, len(_PYRAMID_CORNERS), _PYRAMID_FACES, shape, degree)


def _wedge(name: str, reference: Floats, order: int, degree: int) -> ElementKind:
    shape = partial(_wedge_shape, order)
    return ElementKind(name, reference, len(_WEDGE_CORNERS), _WEDGE_FACES, shape, degree)


def _tetrahedron(name: str, reference: Floats, element: str, degree: int) -> ElementKind:
    shape = partial(_scikit_fem, element, reference)
    return ElementKind(name, reference, len(_TET_CORNERS), _TET_FACES, shape, degree)


def _brick(name: str, reference: Floats, element: str, degree: int) -> ElementKind:
    shape = partial(_scikit_fem, element, reference)
    return ElementKind(name, reference, len(_HEX_CORNERS), _HEX_FACES, shape, degree)


def _product(
    name: str,
    reference: Floats,
    corners: int,
    faces: tuple[tuple[int, ...], ...],
    order: int,
    degree: int,
) -> ElementKind:
    """Return a kind whose shape functions are products of Lagrange polynomials."""
    factors = np.rint(order * reference).astype(np.int64)
    shape = partial(_tensor_lagrange, order, factors)
    return ElementKind(name, reference, corners, faces, shape, degree)


def _kinds() -> Mapping[str, ElementKind]:
    tet4 = np.array(_TET_CORNERS, dtype=float)
    tet10 = _with_middles(tet4, _TET_EDGES)
    wedge6 = np.array(_WEDGE_CORNERS, dtype=float)
    wedge15 = _with_middles(wedge6, _WEDGE_EDGES)
    pyramid5 = np.array(_PYRAMID_CORNERS, dtype=float)
    pyramid13 = _with_middles(pyramid5, _PYRAMID_EDGES)
    pyramid14 = np.concatenate([pyramid13, [pyramid5[:4].mean(axis=0)]])
    hex8 = np.array(_HEX_CORNERS, dtype=float)
    hex20 = _with_middles(hex8, _HEX_EDGES)
    face_middles = [hex8[list(face)].mean(axis=0) for face in _HEX_FACES]
    hex27 = np.concatenate([hex20, face_middles, [[0.5, 0.5, 0.5]]])
    steps = np.linspace(0.0, 1.0, PLATE_ORDER + 1)
    quad25 = np.array([[x, y] for y in steps for x in steps])
    kinds = [
        _tetrahedron("tet4", tet4, "ElementTetP1", 2),
        _tetrahedron("tet10", tet10, "ElementTetP2", 5),
        _wedge("wedge6", wedge6, 1, 4),
        _wedge("wedge15", wedge15, 2, 5),
        _pyramid("pyramid5", pyramid5, 5),
        _pyramid("pyramid13", pyramid13, 5),
        _pyramid("pyramid14", pyramid14, 5),
        _brick("hex8", hex8, "ElementHex1", 3),
        _brick("hex20", hex20, "ElementHexS2", 5),
        _product("hex27", hex27, 8, _HEX_FACES, 2, 5),
        _product("quad25", quad25, 4, (_QUAD_CORNERS,), PLATE_ORDER, 2 * PLATE_ORDER + 1),
    ]
    return {kind.name: kind for kind in kinds}


def _with_middles(corners: Floats, edges: Sequence[tuple[int, int]]) -> Floats:
    """Return the corners of an element, followed by the middles of its edges."""
    return np.concatenate([corners, [corners[list(edge)].mean(axis=0) for edge in edges]])


ELEMENT_KINDS: Mapping[str, ElementKind] = _kinds()
"""Element kinds by name.

They are tetrahedra, wedges, pyramids and bricks of first and second order, and the plate element.
"""
