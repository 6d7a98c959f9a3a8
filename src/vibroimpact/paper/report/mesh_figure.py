"""Figure 9: the meshes of the sphere and the plate."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection

from vibroimpact.arrays import Floats
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.runs import Runs
from vibroimpact.report.layout import WIDTH, new_figure
from vibroimpact.report.projection import TILT, TURN, project
from vibroimpact.report.style import INK
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.surface import Faces, outer_faces

_HEIGHT, _FOOT, _HEAD, _LEFT, _GAP = 4.2, 0.55, 0.3, 0.2, 0.3
"""Height of the figure, and margins below, above, left of and between the two views [in]."""
_SPHERE_WIDTH = 2.9
"""Width of the view of the sphere [in]."""
_FINE = 6
"""Subdivisions of each side of a curved face."""
_VIEW = np.array([-np.sin(TURN) * np.cos(TILT), -np.cos(TURN) * np.cos(TILT), np.sin(TILT)])
"""Unit vector towards the viewer."""
_LIGHT = np.array([-0.35, -0.45, 0.82])
_DARK, _BRIGHT = np.array([0.42, 0.52, 0.62]), np.array([0.93, 0.95, 0.97])


Projection = Callable[[Floats, Floats, Floats], tuple[Floats, Floats]]


class _Body(NamedTuple):
    """A body of the model, and the printed sizes of its mesh: names of printed values, and of the objects that they count."""

    name: str
    printed: tuple[tuple[str, str], ...]


_SPHERE = _Body("sphere", (("mesh.sphere.elements", "elements"), ("mesh.sphere.nodes", "nodes")))
_PLATE = _Body("plate", (("mesh.plate.elements", "elements"),))


def draw_meshes(runs: Runs) -> Drawing:
    """Draw the meshes of the bodies of Type 3, with their computed and printed sizes.

    Parameters
    ----------
    runs : Runs
        The simulations.
    """
    models = runs.problem("type3").models
    plate_width = WIDTH - 2.0 * _LEFT - _GAP - _SPHERE_WIDTH
    figure = new_figure(_HEIGHT)
    high = _HEIGHT - _FOOT - _HEAD
    for body, left, width in ((_SPHERE, _LEFT, _SPHERE_WIDTH), (_PLATE, _LEFT + _SPHERE_WIDTH + _GAP, plate_width)):
        mesh = models[body.name].mesh
        axes = figure.add_axes((left / WIDTH, _FOOT / _HEIGHT, width / WIDTH, high / _HEIGHT))
        _draw_mesh(axes, mesh)
        middle = (left + 0.5 * width) / WIDTH
        above = body.name.capitalize() + (", from above" if mesh.is_flat else "")
        figure.text(middle, 1.0 - 0.24 / _HEIGHT, above, ha="center", fontsize=9.5)
        figure.text(middle, 0.34 / _HEIGHT, _size_text(mesh), ha="center", fontsize=8.5)
        figure.text(middle, 0.13 / _HEIGHT, f"printed: {_printed_size_text(body)}", ha="center", fontsize=8.5, color="#555555")
    sizes = (f"the {body.name} {_size_text(models[body.name].mesh)} (printed: {_printed_size_text(body)})" for body in (_SPHERE, _PLATE))
    return Drawing(figure, "Figure 9: the meshes", f"The meshes used here: {'; '.join(sizes)}. Dots are nodes.")


def _size_text(mesh: Mesh) -> str:
    orders = {len(block.connectivity[0]) for block in mesh.blocks}
    of = " and ".join(str(nodes) for nodes in sorted(orders))
    return f"{mesh.number_of_elements} elements of {of} nodes each, {len(mesh.nodes)} nodes"


def _printed_size_text(body: _Body) -> str:
    return ", ".join(f"{printed(name).text} {what}" for name, what in body.printed)


def _draw_mesh(axes: Axes, mesh: Mesh) -> None:
    """Draw the visible outer faces, all quadrilaterals, with their edges and nodes; a flat mesh is viewed from above."""
    projection, view, fine = (_from_above, np.array([0.0, 0.0, 1.0]), 1) if mesh.is_flat else (project, _VIEW, _FINE)
    step = np.linspace(0.0, 1.0, fine + 1)
    edges = np.array([[(t, 0.0) for t in step], [(1.0, t) for t in step], [(t, 1.0) for t in step], [(0.0, t) for t in step]])
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    cells = np.array([(np.array([i, j]) + corners) / fine for i in range(fine) for j in range(fine)])
    for group in outer_faces(mesh):
        at = mesh.nodes[group.connectivity]
        place, normal = _surface(group, at, cells.mean(axis=1))
        visible = normal @ view > 0.0
        lit = np.clip(normal[visible] @ _LIGHT / np.linalg.norm(_LIGHT), 0.0, 1.0)[:, None]
        place = _surface(group, at, cells.reshape(-1, 2))[0].reshape(len(at), len(cells), 4, 3)[visible]
        colours = _DARK + (_BRIGHT - _DARK) * lit
        pieces = PolyCollection(
            list(_projected(projection, place)), facecolors=colours, edgecolors="face", linewidths=0.3, rasterized=fine > 1
        )
        axes.add_collection(pieces)
        place, normal = _surface(group, at, edges.reshape(-1, 2))
        place[normal @ view < 0.0] = np.nan
        lines = _projected(projection, place).reshape(-1, fine + 1, 2)
        axes.add_collection(LineCollection(list(lines), colors=INK, linewidths=0.5))
        # only the shape functions of nodes on the face are nonzero at a generic point of it
        on_face = np.abs(group.shape_functions(np.array([[0.31, 0.43]]))[0][0]) > 1e-9
        nodes = at[visible.reshape(len(at), -1).all(axis=1)][:, on_face].reshape(-1, 3)
        axes.plot(*projection(*nodes.T), "o", color=INK, markersize=1.3, markeredgewidth=0.0, rasterized=True)
    axes.autoscale_view()
    axes.margins(0.01)
    axes.set_axis_off()
    axes.set_aspect("equal")


def _surface(group: Faces, at: Floats, local: Floats) -> tuple[Floats, Floats]:
    """Return points on each face and the unit normals there, (faces, points, 3), from node and local coordinates."""
    values, slopes = group.shape_functions(local)
    along = np.einsum("qak,eki->aeqi", slopes, at)
    normal = np.cross(along[0], along[1])
    return np.einsum("qk,eki->eqi", values, at), normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def _projected(projection: Projection, points: Floats) -> Floats:
    """Return the projection of points (..., 3), (..., 2)."""
    return np.stack(projection(*np.moveaxis(points, -1, 0)), axis=-1)


def _from_above(x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats]:
    return x, y
