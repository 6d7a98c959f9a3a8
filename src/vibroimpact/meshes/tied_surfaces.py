"""Surfaces that a mesh file ties to one another: nodes of the one follow the faces of the
other on which they lie.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.meshes.links import Equation
from vibroimpact.meshes.selection import Selection
from vibroimpact.meshes.text_files import TextLine
from vibroimpact.quoting import quoted
from vibroimpact.structures.joints import AXES
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.nearest_face import nearest_places
from vibroimpact.structures.surface import Faces, outer_faces

# of the mean length of edges of the faces: where a file gives no distance, as in Abaqus
_REACH = 0.05
_COARSER = 1.2  # ratio of mean lengths of edges
_LEAST = 1e-12  # weight of a node below which it is rounding
# of the extent of the mesh: smaller moves of nodes onto a face are rounding of the file
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
    """What the ties of a file do: equations between the nodes of the mesh, nodes that are
    moved onto a face, and remarks.
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
    found = TiedNodes([], mesh.nodes.copy(), [])
    tied = np.zeros(len(mesh.nodes), dtype=bool)
    for tie in ties:
        names = " to ".join(quoted(name)[1:-1] for name in tie.names)
        leader = _faces(mesh, tie.leader, elements)
        followers = np.union1d(
            _nodes_of(_faces(mesh, tie.follower, elements)), tie.follower.nodes.places(numbers)
        ).astype(np.int64)
        followers = np.setdiff1d(followers[~tied[followers]], _nodes_of(leader))
        if not leader or not len(followers):
            found.remarks.append(
                f"the tie {names} of the mesh file joins nothing: the second surface has "
                "no faces of solid elements, or the first has no "
                "nodes of them but those of the second and those that are tied already"
            )
            continue
        rounding = _MOVED * float(mesh.extent.max())
        reach = _REACH * _mean_edge(mesh, leader) if tie.reach is None else max(tie.reach, rounding)
        own = _faces(mesh, tie.follower, elements)
        if own and _mean_edge(mesh, own) > _COARSER * _mean_edge(mesh, leader):
            found.remarks.append(
                f"of the surfaces that the mesh file ties, {names}, the first is the "
                "coarser: nodes of the second between its nodes move "
                "freely, and the joint is too soft; name the finer one first"
            )
        places = nearest_places(mesh.nodes, leader, mesh.nodes[followers], reach)
        furthest = 0.0
        for node, place in zip(followers.tolist(), places, strict=True):
            if place is None:
                continue
            tied[node] = True
            furthest = max(furthest, place.distance)
            found.nodes[node] = place.position
            shares = [
                (int(other), -float(weight))
                for other, weight in zip(place.nodes, place.weights, strict=True)
                if abs(weight) > _LEAST
            ]
            for axis in range(AXES):
                terms = [
                    ((int(numbers[node]), axis), 1.0),
                    *(((int(numbers[other]), axis), weight) for other, weight in shares),
                ]
                found.equations.append(Equation(tie.line, terms))
        away = sum(place is None for place in places)
        if away:
            are = "is" if away == 1 else "are"
            found.remarks.append(
                f"of the {len(places)} nodes that the mesh file ties by {names}, {away} "
                f"{are} further than {reach:.4g} (in the unit of the "
                f"file) from the faces of the second, and {are} not tied; give the tie a "
                "larger POSITION TOLERANCE"
            )
        if furthest > rounding:
            found.remarks.append(
                f"nodes that the mesh file ties by {names} are moved onto the faces of the "
                "second, by up to "
                f"{furthest:.4g} (in the unit of the file)"
            )
    return found


def _faces(mesh: Mesh, surface: MeshSurface, elements: tuple[Integers, Integers]) -> list[Faces]:
    """Return the faces of a surface, in groups."""
    numbers, places = elements
    outer = None
    found = []
    for chosen, by_corners in surface.faces:
        here = np.sort(places[chosen.places(numbers)])
        first = 0
        if not by_corners:
            outer = outer or outer_faces(mesh)
            found += _of_elements(mesh, outer, here)
        for block in mesh.blocks:
            rows = here[(here >= first) & (here < first + len(block.connectivity))] - first
            first += len(block.connectivity)
            corners = by_corners.get(block.element.corners)
            face = next(
                (one for one in block.element.faces if corners and set(one) == set(corners)), None
            )
            if face is not None and len(rows):
                found.append(Faces(block.element, face, block.connectivity[rows]))
    return found


def _of_elements(mesh: Mesh, outer: Sequence[Faces], chosen: Integers) -> list[Faces]:
    """Return those outer faces that belong to chosen elements."""
    found, first = [], 0
    for block in mesh.blocks:
        rows = chosen[(chosen >= first) & (chosen < first + len(block.connectivity))] - first
        first += len(block.connectivity)
        mine = {tuple(row) for row in block.connectivity[rows].tolist()}
        for faces in outer:
            if faces.kind is block.element:
                inside = np.array(
                    [tuple(row) in mine for row in faces.connectivity.tolist()], dtype=bool
                )
                if inside.any():
                    found.append(Faces(faces.kind, faces.corners, faces.connectivity[inside]))
    return found


def _nodes_of(groups: Sequence[Faces]) -> Integers:
    """Return the nodes of faces."""
    return np.unique(
        np.concatenate(
            [
                np.zeros(0, dtype=np.int64),
                *(faces.connectivity[:, faces.has_node].ravel() for faces in groups),
            ]
        )
    )


def _mean_edge(mesh: Mesh, groups: Sequence[Faces]) -> float:
    """Return the mean length of the edges of faces."""
    lengths = []
    for faces in groups:
        at = mesh.nodes[faces.connectivity[:, list(faces.corners)]]
        lengths.append(np.linalg.norm(at - np.roll(at, 1, axis=1), axis=2).ravel())
    return float(np.concatenate(lengths).mean())
