"""Figure 9: the meshes of the sphere and the plate."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Facets, Line, Mark, Outline, Points
from vibroimpact.paper.printed import printed
from vibroimpact.paper.runs import Runs
from vibroimpact.report.projection import VIEWER, light_on, projected
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.surface import Faces, outer_faces

_FINE = 6
"""Subdivisions of each side of a curved face."""
_ABOVE = np.array([0.0, 0.0, 1.0])
# value of a shape function at a generic point of a face, from which on its node belongs to the face
_ON_FACE = 1e-9


class _Body(NamedTuple):
    """A body of the model, and the printed sizes of its mesh: names of printed values,
    and of the objects that they count.
    """

    name: str
    printed: tuple[tuple[str, str], ...]


_SPHERE = _Body("sphere", (("mesh.sphere.elements", "elements"), ("mesh.sphere.nodes", "nodes")))
_PLATE = _Body("plate", (("mesh.plate.elements", "elements"),))


def mesh_chart(runs: Runs) -> Chart:
    """Return a picture of the meshes of the bodies of Type 3, with their computed and printed
    sizes.

    Parameters
    ----------
    runs : Runs
        The simulations.
    """
    meshes = {body: runs.problem("type3").models[body.name].mesh for body in (_SPHERE, _PLATE)}
    panels = tuple(_panel(body, mesh) for body, mesh in meshes.items())
    sizes = (
        f"the {body.name} {_size_text(mesh)} (printed: {_printed_size_text(body)})"
        for body, mesh in meshes.items()
    )
    return Chart(
        "fig9",
        "Figure 9: the meshes",
        (panels,),
        f"The meshes used here: {'; '.join(sizes)}. Dots are nodes.",
    )


def _size_text(mesh: Mesh) -> str:
    orders = sorted({len(block.connectivity[0]) for block in mesh.blocks})
    nodes = " and ".join(map(str, orders))
    return f"{mesh.number_of_elements} elements of {nodes} nodes each, {len(mesh.nodes)} nodes"


def _printed_size_text(body: _Body) -> str:
    return ", ".join(f"{printed(name).text} {what}" for name, what in body.printed)


def _panel(body: _Body, mesh: Mesh) -> Panel:
    """Return a view of a mesh: its surface, edges and nodes; a flat mesh is viewed from above."""
    title = body.name.capitalize()
    if mesh.is_flat:
        marks = _from_above(mesh)
        title = f"{title}, from above"
    else:
        marks = _from_aside(mesh)
    return Panel(Axis("x", "m"), Axis("y", "m"), marks, title, picture=True)


def _from_above(mesh: Mesh) -> tuple[Mark, ...]:
    """Return the marks of a flat, rectangular mesh of quadrilaterals."""
    left, front = mesh.nodes[:, :2].min(axis=0)
    right, back = mesh.nodes[:, :2].max(axis=0)
    outline = Outline(np.array([left, right, right, left]), np.array([front, front, back, back]))
    edges = [
        _surface(group, mesh.nodes[group.connectivity], _edges(1).reshape(-1, 2))[0]
        for group in outer_faces(mesh)
    ]
    lines = [_interrupted(places.reshape(-1, 2, 3)[..., :2]) for places in edges]
    return outline, _line(lines), _dots([mesh.nodes[:, :2]])


def _from_aside(mesh: Mesh) -> tuple[Mark, ...]:
    """Return the marks of the visible outer faces of a mesh, all quadrilaterals, which
    may be curved.
    """
    cells = _cells()
    facets = []
    light = []
    edges = []
    nodes = []
    for group in outer_faces(mesh):
        node_positions = mesh.nodes[group.connectivity]
        _, normals = _surface(group, node_positions, cells.mean(axis=1))
        visible = normals @ VIEWER > 0.0
        corners, _ = _surface(group, node_positions, cells.reshape(-1, 2))
        corners = corners.reshape(len(node_positions), len(cells), 4, 3)
        facets.append(projected(corners[visible]))
        light.append(light_on(normals[visible]))
        edges.append(_visible_edges(group, node_positions))
        # only the shape functions of nodes on the face are nonzero at a generic point of it
        values, *_ = group.shape_functions(np.array([[0.31, 0.43]]))
        on_face = np.abs(values[0]) > _ON_FACE
        visible_faces = visible.reshape(len(node_positions), -1).all(axis=1)
        visible_nodes = node_positions[visible_faces][:, on_face]
        nodes.append(projected(visible_nodes.reshape(-1, 3)))
    return Facets(np.concatenate(facets), np.concatenate(light)), _line(edges), _dots(nodes)


def _cells() -> Floats:
    """Return the corners of the cells of a divided face in its local coordinates, (cells, 4, 2)."""
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    return np.array(
        [(np.array([i, j]) + corners) / _FINE for i in range(_FINE) for j in range(_FINE)]
    )


def _visible_edges(group: Faces, node_positions: Floats) -> Floats:
    """Return the edges of faces in the picture, with gaps where they face away, (points, 2)."""
    edges, normals = _surface(group, node_positions, _edges(_FINE).reshape(-1, 2))
    edges[normals @ VIEWER < 0.0] = np.nan
    return _interrupted(projected(edges).reshape(-1, _FINE + 1, 2))


def _edges(fine: int) -> Floats:
    """Return points along the four edges of a face in its local coordinates, (4, fine + 1, 2)."""
    step = np.linspace(0.0, 1.0, fine + 1)
    return np.array(
        [
            [(t, 0.0) for t in step],
            [(1.0, t) for t in step],
            [(t, 1.0) for t in step],
            [(0.0, t) for t in step],
        ]
    )


def _interrupted(lines: Floats) -> Floats:
    """Return lines (lines, points, 2) as one with gaps, (points, 2)."""
    gaps = np.full_like(lines[:, :1], np.nan)
    return np.concatenate([lines, gaps], axis=1).reshape(-1, 2)


def _line(parts: list[Floats]) -> Line:
    x, y = np.concatenate(parts).T
    return Line(np.ascontiguousarray(x), np.ascontiguousarray(y), role="edge")


def _dots(parts: list[Floats]) -> Points:
    x, y = np.unique(np.concatenate(parts).round(9), axis=0).T
    return Points(np.ascontiguousarray(x), np.ascontiguousarray(y), role="edge")


def _surface(group: Faces, node_positions: Floats, local: Floats) -> tuple[Floats, Floats]:
    """Return points on each face and the unit normals there, (faces, points, 3), from the
    positions of its nodes and local coordinates.
    """
    values, derivatives = group.shape_functions(local)
    points = np.einsum("qk,eki->eqi", values, node_positions)
    tangents = np.einsum("qak,eki->aeqi", derivatives, node_positions)
    normals = np.cross(tangents[0], tangents[1])
    return points, normals / np.linalg.norm(normals, axis=-1, keepdims=True)
