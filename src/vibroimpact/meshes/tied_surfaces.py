"""Surfaces that a mesh file ties to one another.

Nodes of the one follow the faces of the other on which they lie.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.meshes.links import Equation
from vibroimpact.meshes.selection import Selection
from vibroimpact.meshes.text_files import TextLine
from vibroimpact.quoting import quoted
from vibroimpact.structures.finite_elements.joints import AXES
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.finite_elements.nearest_face import NearestPlace, nearest_places
from vibroimpact.structures.finite_elements.surface import Faces, outer_faces

# reach over the mean length of the edges of the faces, where a file gives none, as in Abaqus
_REACH = 0.05
_COARSER = 1.2  # ratio of mean lengths of edges
_LEAST = 1e-12  # weight of a node below which it is rounding
# over the extent of the mesh: smaller moves of nodes onto a face are rounding of the file
_MOVED = 1e-6


@dataclass
class MeshSurface:
    """A surface of a file: faces of elements, or nodes.

    Parameters
    ----------
    faces : list of (Selection, tuple of tuple of int)
        Elements, and by their number of corners the corners of the face of each; none for all outer
        faces.
    nodes : Selection
        Nodes.
    """

    faces: list[tuple[Selection, dict[int, tuple[int, ...]]]] = field(default_factory=list)
    nodes: Selection = field(default_factory=Selection)


@dataclass(frozen=True)
class Tie:
    """Two surfaces of which the first follows the second.

    Parameters
    ----------
    line : TextLine
        Where it is stated.
    names : tuple of two str
        The names of both.
    follower, leader : MeshSurface
        The surfaces.
    reach : float, optional
        Largest distance of nodes that are tied, in the unit of the file.
    """

    line: TextLine
    names: tuple[str, str]
    follower: MeshSurface
    leader: MeshSurface
    reach: float | None


@dataclass
class TiedNodes:
    """What the ties of a file do.

    There are equations between the nodes of the mesh, nodes that are moved onto a face, and
    remarks.
    """

    equations: list[Equation]
    nodes: Floats
    remarks: list[str]


def tied_nodes(
    mesh: Mesh, ties: Sequence[Tie], numbers: Integers, elements: tuple[Integers, Integers]
) -> TiedNodes:
    """Return what ties do to a mesh.

    Parameters
    ----------
    mesh : Mesh
        The mesh, its elements numbered as in the file.
    ties : sequence of Tie
        The ties.
    numbers : int array, shape (nodes,)
        Numbers of the nodes in the file.
    elements : tuple of two int arrays
        Numbers of the elements in the file, ascending, and their places in the mesh.
    """
    result = TiedNodes([], mesh.nodes.copy(), [])
    is_tied = np.zeros(len(mesh.nodes), dtype=bool)
    rounding = 0.0
    if ties:
        rounding = _MOVED * float(mesh.extent.max())
    for tie in ties:
        names = " to ".join(quoted(name)[1:-1] for name in tie.names)
        leader = _faces(mesh, tie.leader, elements)
        follower = _faces(mesh, tie.follower, elements)
        follower_nodes = tie.follower.nodes.places(numbers)
        followers = np.union1d(_nodes_of(follower), follower_nodes).astype(np.int64)
        followers = np.setdiff1d(followers[~is_tied[followers]], _nodes_of(leader))
        if not leader or not len(followers):
            result.remarks.append(
                f"the tie {names} of the mesh file joins nothing: the second surface has "
                "no faces of solid elements, or the first has no "
                "nodes of them but those of the second and those that are tied already"
            )
            continue
        # without a position tolerance, a part of an edge of an element of the leading surface
        edge = _mean_edge(mesh, leader)
        reach = _REACH * edge
        if tie.reach is not None:
            reach = max(tie.reach, rounding)
        if follower and _mean_edge(mesh, follower) > _COARSER * edge:
            result.remarks.append(
                f"of the surfaces that the mesh file ties, {names}, the first is the "
                "coarser: nodes of the second between its nodes move "
                "freely, and the joint is too soft; name the finer one first"
            )
        nearest = nearest_places(mesh.nodes, leader, mesh.nodes[followers], reach)
        for node, place in zip(followers.tolist(), nearest, strict=True):
            if place is not None:
                is_tied[node] = True
                result.nodes[node] = place.position
                result.equations += _equations(tie.line, node, place, numbers)
        result.remarks += _distance_remarks(names, nearest, reach, rounding)
    return result


def _equations(line: TextLine, node: int, place: NearestPlace, numbers: Integers) -> list[Equation]:
    """Return the equations by which a node follows a place on a face, one for each axis."""
    weights = [
        (int(numbers[int(face_node)]), -float(weight))
        for face_node, weight in zip(place.nodes, place.weights, strict=True)
        if abs(weight) > _LEAST
    ]
    # u - sum of w_k u_k = 0
    tied_node = int(numbers[node])
    equations = []
    for axis in range(AXES):
        followed = [((face_node, axis), weight) for face_node, weight in weights]
        equations.append(Equation(line, [((tied_node, axis), 1.0), *followed]))
    return equations


def _distance_remarks(
    names: str, nearest: Sequence[NearestPlace | None], reach: float, rounding: float
) -> list[str]:
    """Return remarks on nodes that are out of reach, and on those that are moved onto a face."""
    remarks = []
    out_of_reach = sum(place is None for place in nearest)
    if out_of_reach:
        are = "is" if out_of_reach == 1 else "are"
        remarks.append(
            f"of the {len(nearest)} nodes that the mesh file ties by {names}, {out_of_reach} "
            f"{are} further than {reach:.4g} (in the unit of the "
            f"file) from the faces of the second, and {are} not tied; give the tie a "
            "larger POSITION TOLERANCE"
        )
    furthest = max((place.distance for place in nearest if place is not None), default=0.0)
    if furthest > rounding:
        remarks.append(
            f"nodes that the mesh file ties by {names} are moved onto the faces of the "
            "second, by up to "
            f"{furthest:.4g} (in the unit of the file)"
        )
    return remarks


def _faces(mesh: Mesh, surface: MeshSurface, elements: tuple[Integers, Integers]) -> list[Faces]:
    """Return the faces of a surface, in groups."""
    numbers, places = elements
    outer = None
    groups = []
    for selection, by_corners in surface.faces:
        chosen = np.sort(places[selection.places(numbers)])
        if not by_corners:
            outer = outer or outer_faces(mesh)
            groups += _of_elements(mesh, outer, chosen)
        for block, rows in _rows_of_blocks(mesh, chosen):
            corners = by_corners.get(block.element.corners)
            face = next(
                (face for face in block.element.faces if corners and set(face) == set(corners)),
                None,
            )
            if face is not None and len(rows):
                groups.append(Faces(block.element, face, block.connectivity[rows]))
    return groups


def _rows_of_blocks(mesh: Mesh, chosen: Integers) -> Iterator[tuple[ElementBlock, Integers]]:
    """Yield the blocks of a mesh, with the rows of those elements in them that are chosen."""
    first = 0
    for block in mesh.blocks:
        end = first + len(block.connectivity)
        yield block, chosen[(chosen >= first) & (chosen < end)] - first
        first = end


def _of_elements(mesh: Mesh, outer: Sequence[Faces], chosen: Integers) -> list[Faces]:
    """Return those outer faces that belong to chosen elements."""
    groups = []
    for block, rows in _rows_of_blocks(mesh, chosen):
        elements = {tuple(nodes) for nodes in block.connectivity[rows].tolist()}
        for faces in outer:
            if faces.kind is not block.element:
                continue
            is_chosen = np.array(
                [tuple(nodes) in elements for nodes in faces.connectivity.tolist()], dtype=bool
            )
            if is_chosen.any():
                groups.append(Faces(faces.kind, faces.corners, faces.connectivity[is_chosen]))
    return groups


def _nodes_of(groups: Sequence[Faces]) -> Integers:
    """Return the nodes of faces."""
    nodes = [faces.connectivity[:, faces.has_node].ravel() for faces in groups]
    return np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *nodes]))


def _mean_edge(mesh: Mesh, groups: Sequence[Faces]) -> float:
    """Return the mean length of the edges of faces."""
    lengths = []
    for faces in groups:
        corners = mesh.nodes[faces.connectivity[:, list(faces.corners)]]
        edges = corners - np.roll(corners, 1, axis=1)
        lengths.append(np.linalg.norm(edges, axis=2).ravel())
    return float(np.concatenate(lengths).mean())
