"""Surface of a mesh: its outer faces, the nodes of its lower side, and displacements at a
place (x, y) of either side.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.sparse import coo_array, csr_array

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.element_kinds import ElementKind
from vibroimpact.structures.mesh import ElementBlock, Mesh

Side = Literal["upper", "lower"]
Spot = tuple[float, float] | str | None
"""x and y [m]; or the name of a set of nodes, for its centre; or None, for the highest or
lowest node.
"""

_NO_SHARE = 1e-9  # least weight of a node in the displacement of a place to which it belongs
_ON_FACE = 1e-9  # distance of a node of the reference element from a face
# tolerance of a point beyond the edge of a face, relative to the length of the face
_OUTSIDE = 1e-6
# by which gradients on faces of pyramids are taken nearer to the middle of the face
_FROM_APEX = 1e-9
_MIDDLE = 1.0 / 3.0
_NEWTON_STEPS = 20
# last step of Newton's method in local coordinates: it is quadratic, so that the rest is rounding
_CONVERGED = 1e-10
_STARTS = (
    (1.0 / 3.0, 1.0 / 3.0),
    (0.9, 0.05),
    (0.05, 0.9),
    (0.05, 0.05),
    (0.9, 0.9),
)  # of Newton's method; on steep, curved faces it converges from near the solution only


@dataclass(frozen=True)
class Faces:
    """Outer faces with the same local number in elements of one kind; for plate elements,
    the elements themselves.
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
        """Return the points of the reference element (points, dimension) at local
        coordinates of the face (points, 2).
        """
        a, b = local[:, :1], local[:, 1:]
        corner = self.kind.reference[list(self.corners)]
        if len(corner) == 3:
            return np.asarray(corner[0] + a * (corner[1] - corner[0]) + b * (corner[2] - corner[0]))
        weights = np.concatenate([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b], axis=1)
        return np.asarray(weights @ corner)

    def shape_functions(self, local: Floats) -> tuple[Floats, Floats]:
        """Return shape functions (points, nodes) and their derivatives in the coordinates
        of the face (points, 2, nodes).
        """
        values, gradients = self.kind.basis(self.reference_points(local))
        # along a face they are continuous up to the apex, if they are taken on the face
        if self.kind.is_pyramid:
            gradients = self.kind.basis(
                self.reference_points(local + _FROM_APEX * (_MIDDLE - local))
            )[1]
        step = (
            0.5 * np.stack([np.eye(2), -np.eye(2)])[:, :, None]
        )  # a difference over one unit is exact, as the map is linear along either axis
        there, back = self.reference_points((local + step).reshape(-1, 2)).reshape(
            2, 2, len(local), self.kind.dimension
        )
        along = np.ascontiguousarray((there - back).transpose(1, 0, 2))
        return values, np.asarray(along @ gradients)

    def distance_outside(self, local: Floats) -> Floats:
        """Return the distance of points outside the face, in its local coordinates; not
        positive inside.
        """
        outside = np.maximum(
            -local.min(axis=1),
            (local.sum(axis=1) if len(self.corners) == 3 else local.max(axis=1)) - 1.0,
        )
        return np.asarray(outside)


def outer_faces(mesh: Mesh) -> list[Faces]:
    """Return the faces that belong to one element only, in groups; for plate elements,
    the elements.
    """
    owners, keys = [], []
    for block in mesh.blocks:
        if block.element.dimension == 2:
            return [Faces(block.element, block.element.faces[0], block.connectivity)]
        for face in block.element.faces:
            corner = np.sort(block.connectivity[:, list(face)], axis=1)
            keys.append(np.pad(corner, ((0, 0), (0, 4 - corner.shape[1])), constant_values=-1))
            owners.append((block.element, face, block.connectivity))
    if not keys:
        return []
    _, same, count = np.unique(
        np.concatenate(keys), axis=0, return_inverse=True, return_counts=True
    )
    alone = np.split(count[same.ravel()] == 1, np.cumsum([len(key) for key in keys])[:-1])
    return [
        Faces(kind, face, nodes[mine])
        for (kind, face, nodes), mine in zip(owners, alone, strict=True)
        if mine.any()
    ]


def facing(mesh: Mesh, side: Side) -> list[Faces]:
    """Return the outer faces with a normal upwards or downwards; for plate elements all."""
    groups = outer_faces(mesh)
    if mesh.is_flat:
        return groups
    found = []
    for faces in groups:
        corner = mesh.nodes[faces.connectivity[:, list(faces.corners)]]
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        upwards, area = (
            normal[:, 2] if side == "upper" else -normal[:, 2],
            np.linalg.norm(normal, axis=1),
        )
        facing = upwards > 1e-3 * area  # False for a degenerate face without area
        found.append(Faces(faces.kind, faces.corners, faces.connectivity[facing]))
    return [faces for faces in found if len(faces.connectivity)]


def lower_nodes(mesh: Mesh) -> Integers:
    """Return the nodes of the faces with a normal downwards; for plate elements all nodes."""
    if mesh.is_flat:
        return np.arange(len(mesh.nodes))
    found = [faces.connectivity[:, faces.has_node].ravel() for faces in facing(mesh, "lower")]
    return np.unique(np.concatenate(found)) if found else np.zeros(0, dtype=np.int64)


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
        x, y = mesh.nodes[height.argmax() if side == "upper" else height.argmin(), :2]
    return float(x), float(y)


def surface_motion(
    mesh: Mesh, places: Floats, side: Side = "upper", thickness: float = 0.0, what: str = ""
) -> tuple[csr_array, Floats]:
    """Return the displacements of places on one side of a body as linear functions of its degrees
    of freedom.

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
    >>> from vibroimpact.structures.lattice import box_mesh
    >>> motion, positions = surface_motion(
    ...     box_mesh((1.0, 1.0, 0.1), (3, 3, 1)), np.array([[0.2, 0.1]])
    ... )
    >>> positions.round(9).tolist(), float(motion.sum().round(9))
    ([[0.2, 0.1, 0.05]], 3.0)
    """
    places = np.atleast_2d(np.asarray(places, dtype=float))
    sign = 1.0 if side == "upper" else -1.0
    best = np.full(len(places), -np.inf)
    nodes: list[Integers] = [np.zeros(0, dtype=np.int64)] * len(places)
    weights: list[Floats] = [np.zeros(0)] * len(places)
    positions = np.full((len(places), 3), np.nan)
    groups = facing(_near_column(mesh, places), side)
    for start in _STARTS:  # further starts only for places that none before has found
        waiting = np.flatnonzero(np.isneginf(best))
        for faces in groups if len(waiting) else []:
            found, face, local = _locate(mesh.nodes, faces, places[waiting], start)
            if not len(found):
                continue
            values = faces.shape_functions(local)[0]
            at = np.einsum("pk,pki->pi", values, mesh.nodes[faces.connectivity[face]])
            for index, which in enumerate(waiting[found].tolist()):
                if sign * at[index, 2] > best[which]:
                    best[which] = sign * at[index, 2]
                    positions[which] = at[index]
                    nodes[which], weights[which] = faces.connectivity[face[index]], values[index]
    beside = np.flatnonzero(np.isneginf(best))
    if len(beside):
        x, y = places[beside[0]]
        low, high = mesh.nodes.min(axis=0), mesh.nodes.max(axis=0)
        raise InputError(
            f"{what}{': ' if what else ''}({x:g}, {y:g}) m is not on the body, which "
            f"reaches from {low[0]:g} to {high[0]:g} m along x and "
            f"from {low[1]:g} to {high[1]:g} m along "
            f"y{_nearest_text(mesh, places[beside[0]], side)}"
        )
    height = sign * 0.5 * thickness if mesh.is_flat else 0.0
    positions[:, 2] += height
    return _rows(mesh, nodes, weights, height), positions


def materials_at(
    mesh: Mesh, material: Material, place: tuple[float, float], side: Side
) -> tuple[Material, ...]:
    """Return the materials of the elements that have a place on one side of a body: several where
    they meet there.

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
    having = np.concatenate(
        [np.isin(block.connectivity, nodes).sum(axis=1) == len(nodes) for block in mesh.blocks]
    )
    return _materials_of(mesh, material, having)


def materials_around(
    mesh: Mesh, material: Material, place: tuple[float, float], reach: float
) -> tuple[Material, ...]:
    """Return the materials of the elements within a distance along x and y of a place, over the
    height of the body.

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
    near = []
    for block in mesh.blocks:
        at = mesh.nodes[block.connectivity, :2]
        near.append(
            (
                (at.min(axis=1) <= np.add(place, reach))
                & (at.max(axis=1) >= np.subtract(place, reach))
            ).all(axis=1)
        )
    return _materials_of(mesh, material, np.concatenate(near))


def _materials_of(mesh: Mesh, material: Material, chosen: Bools) -> tuple[Material, ...]:
    """Return the materials of chosen elements, once each."""
    if not mesh.materials:
        return (material,)
    numbers = np.unique(mesh.element_materials[chosen])
    return tuple((*mesh.materials, material)[number] for number in numbers)


def _nearest_text(mesh: Mesh, place: Floats, side: Side) -> str:
    """Return in words which node of a side is nearest to a place."""
    nodes = np.concatenate(
        [faces.connectivity[:, list(faces.corners)].ravel() for faces in facing(mesh, side)]
        or [np.zeros(0, np.int64)]
    )
    if not len(nodes):
        return ""
    x, y = mesh.nodes[nodes[np.linalg.norm(mesh.nodes[nodes, :2] - place, axis=1).argmin()], :2]
    return f"; the nearest node of its {side} side is at ({x:g}, {y:g}) m"


def slope_divergence(mesh: Mesh, place: tuple[float, float]) -> csr_array:
    r"""Return the divergence of the slopes of a plate at a place [1/m], as a row of the degrees of
    freedom of its plate elements.

    It is :math:`\partial_x \beta_x + \partial_y \beta_y`; on common edges of elements, the mean
    over these.

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
    >>> from vibroimpact.structures.plate_mesh import plate_mesh
    >>> mesh = plate_mesh((0.5, 0.4), 0.1)
    >>> x, y = mesh.nodes[:, :2].T
    >>> motion = np.stack([0 * x, 0 * x, 0 * x, x**2 * y, y**2], axis=1)
    >>> (slope_divergence(mesh, (0.1, 0.05)) @ motion.ravel()).round(9).tolist()  # 2 x y + 2 y
    [0.11]
    """
    node, gradients = face_gradients(mesh, place)
    columns = mesh.dofs_per_node * node + np.array([[3], [4]])
    shape = (1, mesh.dofs_per_node * len(mesh.nodes))
    return csr_array(
        coo_array(
            (gradients.ravel(), (np.zeros(gradients.size, dtype=np.int64), columns.ravel())),
            shape=shape,
        )
    )


def element_at(mesh: Mesh, place: tuple[float, float]) -> tuple[Floats, Floats]:
    """Return corners and local coordinates at a place of the plate element that contains it; of
    several, of the largest.

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
    """Return nodes (k,), and the weights of their values in the gradient of a function along x and
    y on one side, (2, k).

    On common edges of elements it is the mean over these. Of faces above one another the outermost
    is taken.

    Raises
    ------
    InputError
        If the place is not on the body.
    """
    places, sign, best = np.array([place]), 1.0 if side == "upper" else -1.0, -np.inf
    found: tuple[Integers, Floats] | None = None
    for faces in facing(_near_column(mesh, places), side):
        _, face, local = _locate(mesh.nodes, faces, places, _STARTS[0])
        if not len(face):
            continue
        values, along = faces.shape_functions(local)
        node = faces.connectivity[face]
        height = sign * np.einsum("pk,pk->p", values, mesh.nodes[node][:, :, 2])
        outermost = height > height.max() - 1e-9 * np.ptp(mesh.nodes[:, 0])
        if height.max() > best:
            best, node, along = height.max(), node[outermost], along[outermost]
            gradients = np.linalg.solve(along @ mesh.nodes[node][:, :, :2], along) / len(node)
            found = node.ravel(), gradients.transpose(1, 0, 2).reshape(2, -1)
    if found is None:
        raise InputError(f"({place[0]:g}, {place[1]:g}) m is not on the body")
    return found


def _near_column(mesh: Mesh, places: Floats) -> Mesh:
    """Return the mesh of those elements that may lie above or below places; the outermost
    faces there remain outermost.
    """
    low, high = places.min(axis=0), places.max(axis=0)
    blocks = []
    for block in mesh.blocks:
        at = (
            mesh.nodes[block.connectivity[:, : block.element.corners], :2]
            if not mesh.is_flat
            else mesh.nodes[block.connectivity, :2]
        )
        first, last = at.min(axis=1), at.max(axis=1)
        # curved edges extend beyond the corners
        reach = 0.5 * (last - first).max(axis=1, keepdims=True)
        near = ((first - reach <= high) & (last + reach >= low)).all(axis=1)
        blocks.append(ElementBlock(block.kind, block.connectivity[near]))
    return replace(mesh, blocks=tuple(block for block in blocks if len(block.connectivity)))


def _rows(mesh: Mesh, nodes: list[Integers], weights: list[Floats], height: float) -> csr_array:
    """Return the rows of points that move with nodes by weights, at a height above the
    nodes of plate elements.
    """
    point = np.repeat(np.arange(len(nodes)), [len(found) for found in nodes])
    node, weight = np.concatenate(nodes), np.concatenate(weights)
    per_node = mesh.dofs_per_node
    rows = [3 * point + axis for axis in range(3)]
    columns = [per_node * node + axis for axis in range(3)]
    values = [weight] * 3
    if mesh.is_flat:  # the slopes displace a point above the middle plane
        rows += [3 * point + axis for axis in range(2)]
        columns += [per_node * node + 3 + axis for axis in range(2)]
        values += [height * weight] * 2
    shape = (3 * len(nodes), per_node * len(mesh.nodes))
    return csr_array(
        coo_array(
            (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=shape
        )
    )


def _locate(
    nodes: Floats, faces: Faces, places: Floats, start: tuple[float, float]
) -> tuple[Integers, Integers, Floats]:
    """Return pairs of places and faces that contain them, and the local coordinates, by
    Newton's method for all candidates.
    """
    at = nodes[faces.connectivity][:, :, :2]
    corner = at[:, list(faces.corners)]
    middle, reach = 0.5 * (corner.max(axis=1) + corner.min(axis=1)), 0.75 * np.ptp(corner, axis=1)
    # curved edges extend beyond the corners
    reach = np.maximum(reach, 0.5 * reach.max(axis=1, keepdims=True))
    near = (np.abs(places[:, None] - middle[None]) <= reach[None]).all(axis=2)
    point, face = np.nonzero(near)
    local = np.tile(start, (len(point), 1))
    apart, flat = np.zeros((len(point), 2)), np.zeros(len(point), dtype=bool)
    for _ in range(_NEWTON_STEPS if len(point) else 0):
        values, slopes = faces.shape_functions(local)
        apart = np.einsum("pk,pki->pi", values, at[face]) - places[point]
        jacobian = (slopes @ at[face]).transpose(0, 2, 1)  # of x and y in the local coordinates
        flat = (
            np.abs(np.linalg.det(jacobian))
            < 1e-14 * np.abs(jacobian).max(axis=(1, 2), initial=1e-300) ** 2
        )
        jacobian[flat] = np.eye(2)
        step = np.linalg.solve(jacobian, apart[:, :, None])[:, :, 0]
        local = np.clip(local - step, -1.0, 2.0)
        if np.abs(step).max() < _CONVERGED:
            break
    missed = np.linalg.norm(apart, axis=1) > _OUTSIDE * reach[face].max(axis=1)
    inside = (faces.distance_outside(local) <= _OUTSIDE) & ~missed & ~flat
    return point[inside], face[inside], local[inside]
