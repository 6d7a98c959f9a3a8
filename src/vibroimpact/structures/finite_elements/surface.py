"""Surface of a mesh: its outer faces, and displacements at a place (x, y) of either side."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.sparse import coo_array, csr_array

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.element_kinds import ElementKind
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh

Side = Literal["upper", "lower"]
Spot = tuple[float, float] | str | None
"""x and y [m]; or the name of a set of nodes, for its centre; or None, for the extreme node.

That is the highest node of the upper side, or the lowest of the lower one.
"""

_NO_SHARE = 1e-9  # least weight of a node in the displacement of a place to which it belongs
_ON_FACE = 1e-9  # distance of a node of the reference element from a face
# tolerance of a point beyond the edge of a face, relative to the length of the face
_OUTSIDE = 1e-6
# by which gradients on faces of pyramids are taken nearer to the middle of the face
_FROM_APEX = 1e-9
_MIDDLE = 1.0 / 3.0  # local coordinates of the middle of a triangle
_SINGULAR = 1e-14  # of the square of the largest derivative: determinant of a face seen edge on
_NEWTON_STEPS = 20
# last step of Newton's method in local coordinates: it is quadratic, so that the rest is rounding
_CONVERGED = 1e-10
# local coordinates from which Newton's method starts; on steep, curved faces it converges from
# near the solution only
_STARTS = (
    (1.0 / 3.0, 1.0 / 3.0),
    (0.9, 0.05),
    (0.05, 0.9),
    (0.05, 0.05),
    (0.9, 0.9),
)


@dataclass(frozen=True)
class Faces:
    """Outer faces with the same local number in elements of one kind.

    For plate elements they are the elements themselves.
    """

    kind: ElementKind
    corners: tuple[int, ...]
    connectivity: Integers

    @property
    def has_node(self) -> Bools:
        """Which nodes of the element lie on the face."""
        corner = self.kind.reference[list(self.corners)]
        normal = np.cross(corner[1] - corner[0], corner[2] - corner[0])
        return np.asarray(np.abs((self.kind.reference - corner[0]) @ normal) < _ON_FACE)

    def reference_points(self, local: Floats) -> Floats:
        """Return the points of the reference element at local coordinates of the face.

        They are (points, dimension), and the local coordinates (points, 2).
        """
        a = local[:, :1]
        b = local[:, 1:]
        corner = self.kind.reference[list(self.corners)]
        if len(corner) == 3:
            return np.asarray(corner[0] + a * (corner[1] - corner[0]) + b * (corner[2] - corner[0]))
        bilinear = np.concatenate([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b], axis=1)
        return np.asarray(bilinear @ corner)

    def shape_functions(self, local: Floats) -> tuple[Floats, Floats]:
        """Return shape functions (points, nodes) and their derivatives (points, 2, nodes).

        The derivatives are those in the local coordinates of the face.
        """
        values, gradients = self.kind.basis(self.reference_points(local))
        # along a face they are continuous up to the apex, if they are taken on the face
        if self.kind.is_pyramid:
            off_apex = local + _FROM_APEX * (_MIDDLE - local)
            gradients = self.kind.basis(self.reference_points(off_apex))[1]
        # tangents of the face in the reference element: a difference over one unit is exact, as the
        # map is linear along either axis
        half_steps = 0.5 * np.stack([np.eye(2), -np.eye(2)])[:, :, None]
        ends = self.reference_points((local + half_steps).reshape(-1, 2))
        forward, backward = ends.reshape(2, 2, len(local), self.kind.dimension)
        tangents = np.ascontiguousarray((forward - backward).transpose(1, 0, 2))
        return values, np.asarray(tangents @ gradients)

    def distance_outside(self, local: Floats) -> Floats:
        """Return the distance of points outside the face in its local coordinates, <= 0 inside."""
        is_triangle = len(self.corners) == 3
        farthest = local.max(axis=1)
        if is_triangle:  # whose third side is a + b = 1
            farthest = local.sum(axis=1)
        return np.asarray(np.maximum(-local.min(axis=1), farthest - 1.0))


def outer_faces(mesh: Mesh) -> list[Faces]:
    """Return the faces that belong to one element only, in groups.

    For plate elements they are the elements.
    """
    groups: list[Faces] = []  # all faces, also those between two elements
    corner_keys = []  # the sorted corners of each face, by group
    for block in mesh.blocks:
        if block.element.dimension == 2:
            return [Faces(block.element, block.element.faces[0], block.connectivity)]
        for face in block.element.faces:
            corner = np.sort(block.connectivity[:, list(face)], axis=1)
            padding = ((0, 0), (0, 4 - corner.shape[1]))
            corner_keys.append(np.pad(corner, padding, constant_values=-1))
            groups.append(Faces(block.element, face, block.connectivity))
    if not groups:
        return []
    _, key_of_face, elements_of_key = np.unique(
        np.concatenate(corner_keys), axis=0, return_inverse=True, return_counts=True
    )
    is_outer = elements_of_key[key_of_face.ravel()] == 1
    ends = np.cumsum([len(keys) for keys in corner_keys])[:-1]
    outer_groups = []
    for faces, is_outer_face in zip(groups, np.split(is_outer, ends), strict=True):
        if is_outer_face.any():
            connectivity = faces.connectivity[is_outer_face]
            outer_groups.append(Faces(faces.kind, faces.corners, connectivity))
    return outer_groups


def facing(mesh: Mesh, side: Side) -> list[Faces]:
    """Return the outer faces with a normal upwards or downwards; for plate elements all."""
    return facing_along(mesh, np.array([0.0, 0.0, {"upper": 1.0, "lower": -1.0}[side]]))


def facing_along(mesh: Mesh, direction: Floats) -> list[Faces]:
    """Return the outer faces whose normal has a part along a direction; for plate elements all.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    direction : array, shape (3,)
        A unit vector.
    """
    groups = outer_faces(mesh)
    if mesh.is_flat:
        return groups
    facing_groups = []
    for faces in groups:
        corner = mesh.nodes[faces.connectivity[:, list(faces.corners)]]
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        area = np.linalg.norm(normal, axis=1)
        is_facing = normal @ direction > 1e-3 * area  # False for a degenerate face without area
        if is_facing.any():
            connectivity = faces.connectivity[is_facing]
            facing_groups.append(Faces(faces.kind, faces.corners, connectivity))
    return facing_groups


def lower_nodes(mesh: Mesh) -> Integers:
    """Return the nodes of the faces with a normal downwards; for plate elements all nodes."""
    if mesh.is_flat:
        return np.arange(len(mesh.nodes))
    nodes = [faces.connectivity[:, faces.has_node].ravel() for faces in facing(mesh, "lower")]
    if not nodes:
        return np.zeros(0, dtype=np.int64)
    return np.unique(np.concatenate(nodes))


def place_of(mesh: Mesh, spot: Spot, side: Side) -> tuple[float, float]:
    """Return x and y [m] of a spot on one side of a mesh.

    Raises
    ------
    InputError
        If the mesh has no set of that name.
    """
    if isinstance(spot, tuple):
        return spot
    if isinstance(spot, str):
        x, y = mesh.nodes[mesh.nodes_of(spot), :2].mean(axis=0)
    else:
        height = mesh.nodes[:, 2]
        extreme_node = height.argmax()
        if side == "lower":
            extreme_node = height.argmin()
        x, y = mesh.nodes[extreme_node, :2]
    return float(x), float(y)


def surface_motion(
    mesh: Mesh, places: Floats, side: Side = "upper", thickness: float = 0.0, what: str = ""
) -> tuple[csr_array, Floats]:
    """Return the displacements of places on a side of a body per degree of freedom.

    Parameters
    ----------
    mesh : Mesh
        Mesh of the body.
    places : array, shape (points, 2)
        x and y [m].
    side : str, default "upper"
        "upper" or "lower"; of several faces above one another the outermost is taken.
    thickness : float, default 0
        Thickness of plate elements [m]; their faces are half of it above and below the nodes.
    what : str, optional
        Name of the places in the message if one is not on the body.

    Returns
    -------
    motion : sparse array, shape (3 points, dofs)
        Three rows per point: its displacements along x, y and z.
    positions : array, shape (points, 3)
        Positions of the points [m].

    Raises
    ------
    InputError
        If a place is not on the body.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> motion, positions = surface_motion(
    ...     box_mesh((1.0, 1.0, 0.1), (3, 3, 1)), np.array([[0.2, 0.1]])
    ... )
    >>> positions.round(9).tolist(), float(motion.sum().round(9))
    ([[0.2, 0.1, 0.05]], 3.0)
    """
    places = np.atleast_2d(np.asarray(places, dtype=float))
    sign = 1.0 if side == "upper" else -1.0
    outermost = np.full(len(places), -np.inf)  # height of the outermost face, outwards
    nodes: list[Integers] = [np.zeros(0, dtype=np.int64)] * len(places)
    weights: list[Floats] = [np.zeros(0)] * len(places)
    positions = np.full((len(places), 3), np.nan)
    groups = facing(_near_column(mesh, places), side)
    for start in _STARTS:  # further starts only for places that lie on no face so far
        unlocated = np.flatnonzero(np.isneginf(outermost))
        if not len(unlocated):
            break
        for faces in groups:
            index, face, local = _locate(mesh.nodes, faces, places[unlocated], start)
            if not len(index):
                continue
            values, _ = faces.shape_functions(local)
            nodes_of_pair = faces.connectivity[face]
            points = np.einsum("pk,pki->pi", values, mesh.nodes[nodes_of_pair])
            for pair, place in enumerate(unlocated[index].tolist()):
                height = sign * points[pair, 2]
                if height > outermost[place]:
                    outermost[place] = height
                    positions[place] = points[pair]
                    nodes[place] = nodes_of_pair[pair]
                    weights[place] = values[pair]
    off_body = np.flatnonzero(np.isneginf(outermost))
    if len(off_body):
        raise _not_on_body(mesh, places[off_body[0]], side, what)
    offset = sign * 0.5 * thickness if mesh.is_flat else 0.0
    positions[:, 2] += offset
    return _rows(mesh, nodes, weights, offset), positions


def thickness_at(mesh: Mesh, place: tuple[float, float], side: Side) -> float:
    """Return the thickness of a body of solid elements at a place of a side [m].

    It is that of the wall below its outermost face: the distance to the next face across it.

    Raises
    ------
    InputError
        If the place is not on the body.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> round(thickness_at(box_mesh((1.0, 1.0, 0.1), (3, 3, 1)), (0.2, 0.1), "upper"), 9)
    0.1
    """
    places = np.array([place])
    touched = surface_motion(mesh, places, side)[1][0, 2]
    other_side: Side = "lower" if side == "upper" else "upper"
    distances = []
    for faces in facing(_near_column(mesh, places), other_side):
        for start in _STARTS:
            _, face, local = _locate(mesh.nodes, faces, places, start)
            values, _ = faces.shape_functions(local)
            heights = np.einsum("pk,pk->p", values, mesh.nodes[faces.connectivity[face]][:, :, 2])
            distances.append(np.abs(heights - touched))
    return float(np.concatenate(distances).min())


def _not_on_body(mesh: Mesh, place: Floats, side: Side, what: str) -> InputError:
    """Return the error for a place that is not on the body, with where the body reaches."""
    x, y = place
    low = mesh.nodes.min(axis=0)
    high = mesh.nodes.max(axis=0)
    return InputError(
        f"{what}{': ' if what else ''}({x:g}, {y:g}) m is not on the body, which "
        f"reaches from {low[0]:g} to {high[0]:g} m along x and "
        f"from {low[1]:g} to {high[1]:g} m along "
        f"y{_nearest_text(mesh, place, side)}"
    )


def materials_at(
    mesh: Mesh, material: Material, place: tuple[float, float], side: Side
) -> tuple[Material, ...]:
    """Return the materials of the elements at a place on one side of a body.

    They are several where elements of different materials meet.

    Parameters
    ----------
    mesh : Mesh
        Mesh of the body.
    material : Material
        Material of the elements that have none of their own.
    place : tuple of two floats
        x and y [m].
    side : str
        "upper" or "lower".

    Raises
    ------
    InputError
        If the place is not on the body.
    """
    motion, _ = surface_motion(mesh, np.array([place]), side)
    vertical = motion[[2]]
    nodes = np.unique(vertical.indices[np.abs(vertical.data) > _NO_SHARE] // mesh.dofs_per_node)
    has_place = [
        np.isin(block.connectivity, nodes).sum(axis=1) == len(nodes) for block in mesh.blocks
    ]
    return _materials_of(mesh, material, np.concatenate(has_place))


def materials_around(
    mesh: Mesh, material: Material, place: tuple[float, float], reach: float
) -> tuple[Material, ...]:
    """Return the materials of the elements within a distance of a place, over the whole height.

    The distance is taken along x and along y.

    Parameters
    ----------
    mesh : Mesh
        Mesh of the body.
    material : Material
        Material of the elements that have none of their own.
    place : tuple of two floats
        x and y [m].
    reach : float
        Distance [m].
    """
    low = np.subtract(place, reach)
    high = np.add(place, reach)
    is_near = []
    for block in mesh.blocks:
        nodes = mesh.nodes[block.connectivity, :2]
        overlaps = (nodes.min(axis=1) <= high) & (nodes.max(axis=1) >= low)
        is_near.append(overlaps.all(axis=1))
    return _materials_of(mesh, material, np.concatenate(is_near))


def _materials_of(mesh: Mesh, material: Material, chosen: Bools) -> tuple[Material, ...]:
    """Return the materials of chosen elements, once each."""
    if not mesh.materials:
        return (material,)
    numbers = np.unique(mesh.element_materials[chosen])
    return tuple((*mesh.materials, material)[number] for number in numbers)


def _nearest_text(mesh: Mesh, place: Floats, side: Side) -> str:
    """Return in words which node of a side is nearest to a place."""
    groups = facing(mesh, side)
    if not groups:
        return ""
    nodes = np.concatenate([faces.connectivity[:, list(faces.corners)].ravel() for faces in groups])
    distance = np.linalg.norm(mesh.nodes[nodes, :2] - place, axis=1)
    x, y = mesh.nodes[nodes[distance.argmin()], :2]
    return f"; the nearest node of its {side} side is at ({x:g}, {y:g}) m"


def slope_divergence(mesh: Mesh, place: tuple[float, float]) -> csr_array:
    r"""Return the divergence of the slopes of a plate at a place per degree of freedom [1/m].

    It is :math:`\partial_x \beta_x + \partial_y \beta_y` as a sparse row of the degrees of freedom
    of the plate elements; on common edges of elements, the mean over these.

    Parameters
    ----------
    mesh : Mesh
        Mesh of plate elements.
    place : tuple of two floats
        x and y [m].

    Raises
    ------
    InputError
        If the place is not on the body.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
    >>> mesh = plate_mesh((0.5, 0.4), 0.1)
    >>> x, y = mesh.nodes[:, :2].T
    >>> motion = np.stack([0 * x, 0 * x, 0 * x, x**2 * y, y**2], axis=1)
    >>> (slope_divergence(mesh, (0.1, 0.05)) @ motion.ravel()).round(9).tolist()  # 2 x y + 2 y
    [0.11]
    """
    nodes, gradients = face_gradients(mesh, place)
    slopes = np.array([[3], [4]])  # degrees of freedom of a node
    columns = mesh.dofs_per_node * nodes + slopes
    rows = np.zeros(gradients.size, dtype=np.int64)
    shape = (1, mesh.dofs_per_node * len(mesh.nodes))
    return csr_array(coo_array((gradients.ravel(), (rows, columns.ravel())), shape=shape))


def element_at(mesh: Mesh, place: tuple[float, float]) -> tuple[Floats, Floats]:
    """Return the corners of the plate element at a place, and the local coordinates of the place.

    Of several elements that contain the place it is the largest.

    Parameters
    ----------
    mesh : Mesh
        Mesh of plate elements.
    place : tuple of two floats
        x and y [m].

    Returns
    -------
    corners : array, shape (4, 2)
        x and y of the corners in order [m].
    local : array, shape (2,)
        Position of the place from the first corner towards the second and the fourth, from 0 to 1.

    Raises
    ------
    InputError
        If the place is not on the body.
    """
    places = np.array([place])
    for faces in facing(_near_column(mesh, places), "upper"):
        _, face, local = _locate(mesh.nodes, faces, places, _STARTS[0])
        if len(face):
            corners = mesh.nodes[faces.connectivity[face][:, list(faces.corners)]][:, :, :2]
            largest = int(np.ptp(corners, axis=1).prod(axis=1).argmax())
            return corners[largest], local[largest]
    raise InputError(f"({place[0]:g}, {place[1]:g}) m is not on the body")


def face_gradients(
    mesh: Mesh, place: tuple[float, float], side: Side = "upper"
) -> tuple[Integers, Floats]:
    """Return nodes (k,), and their weights in the gradient of a function on one side, (2, k).

    The gradient is that along x and y. On common edges of elements it is the mean over these. Of
    faces above one another the outermost is taken.

    Raises
    ------
    InputError
        If the place is not on the body.
    """
    places = np.array([place])
    sign = 1.0 if side == "upper" else -1.0
    outermost = -np.inf
    weights_at_place: tuple[Integers, Floats] | None = None
    for faces in facing(_near_column(mesh, places), side):
        _, face, local = _locate(mesh.nodes, faces, places, _STARTS[0])
        if not len(face):
            continue
        values, slopes = faces.shape_functions(local)
        nodes = faces.connectivity[face]
        height = sign * np.einsum("pk,pk->p", values, mesh.nodes[nodes][:, :, 2])
        if height.max() > outermost:
            outermost = height.max()
            # all faces that meet at the place
            is_outermost = height > height.max() - 1e-9 * np.ptp(mesh.nodes[:, 0])
            nodes = nodes[is_outermost]
            slopes = slopes[is_outermost]
            jacobian = slopes @ mesh.nodes[nodes][:, :, :2]
            gradients = np.linalg.solve(jacobian, slopes) / len(nodes)
            weights_at_place = nodes.ravel(), gradients.transpose(1, 0, 2).reshape(2, -1)
    if weights_at_place is None:
        raise InputError(f"({place[0]:g}, {place[1]:g}) m is not on the body")
    return weights_at_place


def _near_column(mesh: Mesh, places: Floats) -> Mesh:
    """Return the mesh of those elements that may lie above or below places.

    The outermost faces there remain outermost.
    """
    low = places.min(axis=0)
    high = places.max(axis=0)
    blocks = []
    for block in mesh.blocks:
        corners = block.connectivity
        if not mesh.is_flat:  # the corners are the first nodes
            corners = block.connectivity[:, : block.element.corners]
        positions = mesh.nodes[corners, :2]
        element_low = positions.min(axis=1)
        element_high = positions.max(axis=1)
        # curved edges extend beyond the corners
        bulge = 0.5 * (element_high - element_low).max(axis=1, keepdims=True)
        is_near = ((element_low - bulge <= high) & (element_high + bulge >= low)).all(axis=1)
        if is_near.any():
            blocks.append(ElementBlock(block.kind, block.connectivity[is_near]))
    return replace(mesh, blocks=tuple(blocks))


def _rows(mesh: Mesh, nodes: list[Integers], weights: list[Floats], height: float) -> csr_array:
    """Return the rows of points that move with nodes by weights.

    Points of plate elements are at a height above the nodes.
    """
    nodes_of_point = [len(point_nodes) for point_nodes in nodes]
    point = np.repeat(np.arange(len(nodes)), nodes_of_point)
    node = np.concatenate(nodes)
    weight = np.concatenate(weights)
    first_row = 3 * point
    first_column = mesh.dofs_per_node * node
    rows = [first_row + axis for axis in range(3)]
    columns = [first_column + axis for axis in range(3)]
    values = [weight] * 3
    if mesh.is_flat:  # u + z beta_x, v + z beta_y: the slopes are degrees of freedom 3 and 4
        rows += [first_row + axis for axis in range(2)]
        columns += [first_column + 3 + axis for axis in range(2)]
        values += [height * weight] * 2
    coordinates = (np.concatenate(rows), np.concatenate(columns))
    shape = (3 * len(nodes), mesh.dofs_per_node * len(mesh.nodes))
    return csr_array(coo_array((np.concatenate(values), coordinates), shape=shape))


def _locate(
    nodes: Floats, faces: Faces, places: Floats, start: tuple[float, float]
) -> tuple[Integers, Integers, Floats]:
    """Return pairs of places and faces that contain them, and the local coordinates.

    They are found by Newton's method, for all pairs that may match at once.
    """
    face_nodes = nodes[faces.connectivity][:, :, :2]
    place, face, size = _candidates(face_nodes[:, list(faces.corners)], places)
    number = len(place)
    nodes_of_pair = face_nodes[face]
    local = np.tile(start, (number, 1))
    error = np.zeros((number, 2))
    is_singular = np.zeros(number, dtype=bool)
    steps = _NEWTON_STEPS if number else 0
    for _ in range(steps):
        # x(xi) - x of the place, and dx/dxi
        values, slopes = faces.shape_functions(local)
        error = np.einsum("pk,pki->pi", values, nodes_of_pair) - places[place]
        jacobian = (slopes @ nodes_of_pair).transpose(0, 2, 1)
        # a face seen edge on has no inverse; its steps do not count
        scale = np.abs(jacobian).max(axis=(1, 2), initial=1e-300)
        determinant = np.abs(np.linalg.det(jacobian))
        is_singular = determinant < _SINGULAR * scale**2
        jacobian[is_singular] = np.eye(2)
        step = np.linalg.solve(jacobian, error[:, :, None])[:, :, 0]
        # kept near the face, or one wild step would be the last
        local = np.clip(local - step, -1.0, 2.0)
        if np.abs(step).max() < _CONVERGED:
            break
    has_missed = np.linalg.norm(error, axis=1) > _OUTSIDE * size[face].max(axis=1)
    is_on_face = faces.distance_outside(local) <= _OUTSIDE
    is_inside = is_on_face & ~has_missed & ~is_singular
    return place[is_inside], face[is_inside], local[is_inside]


def _candidates(corners: Floats, places: Floats) -> tuple[Integers, Integers, Floats]:
    """Return pairs of places and faces that may contain them, and the sizes of the faces.

    Corners are (faces, corners, 2). A size is three quarters of the extent along x and y, (faces,
    2), as curved edges extend beyond the corners.
    """
    middle = 0.5 * (corners.max(axis=1) + corners.min(axis=1))
    size = 0.75 * np.ptp(corners, axis=1)
    size = np.maximum(size, 0.5 * size.max(axis=1, keepdims=True))
    is_near = (np.abs(places[:, None] - middle[None]) <= size[None]).all(axis=2)
    place, face = np.nonzero(is_near)
    return place, face, size
