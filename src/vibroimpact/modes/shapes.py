"""Figures of mode shapes: the vertical displacement of the upper side of a plate, the deformed surface of any other body."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from vibroimpact.arrays import Floats, Integers
from vibroimpact.report.layout import WIDTH
from vibroimpact.report.style import INK, style
from vibroimpact.structures.modal_model import ModalModel
from vibroimpact.structures.surface import Faces, outer_faces

_MOST = 12  # mode shapes in a figure
_COLUMNS = 4
_FINE = 4  # subdivisions of each side of a face
_FLAT = 0.25  # thickness over width below which a body is drawn as a plate
_EXAGGERATED = 0.12  # largest drawn displacement over the size of the body
_COLOURS = "RdBu_r"
_HEAD, _TITLE = 0.35, 0.3  # heights of the heading of the figure and of the title of each mode [in]
_AT_REST = 5e-3  # relative displacement below which a triangle counts as at rest, and has no nodal line


def draw_modes(model: ModalModel, name: str) -> Figure:
    """Draw the first modes of a body.

    Parameters
    ----------
    model : ModalModel
        The modes.
    name : str
        Name of the body, such as "plate".

    Returns
    -------
    matplotlib.figure.Figure
        Figure with up to twelve mode shapes.
    """
    number = min(_MOST, len(model.frequencies))
    columns = min(_COLUMNS, number)
    rows = -(-number // columns)
    extent = model.mesh.extent
    flat = model.mesh.is_flat or extent[2] < _FLAT * extent[:2].min()
    across = (WIDTH - 0.3) / columns
    height = across * (float(np.clip(extent[1] / extent[0], 0.3, 1.5)) if flat else 0.95) + _TITLE
    with style():
        figure = Figure(figsize=(WIDTH, rows * height + _HEAD))
        total = figure.get_figheight()
        figure.text(0.02, 1.0 - 0.2 / total, f"Modes of the {name}", fontweight="bold", color=INK)
        meaning = "red up, blue down, lines at rest" if flat else "red outwards, blue inwards; purple: how far it moves, twisting"
        figure.text(0.98, 1.0 - 0.2 / total, meaning, fontsize=8.0, color=INK, ha="right")
        points, values, triangles = _surface(model, flat)
        for index in range(number):
            left = 0.15 + (index % columns) * across
            lower = total - _HEAD - (index // columns + 1) * height
            place = (left / WIDTH, lower / total, (across - 0.12) / WIDTH, (height - _TITLE) / total)
            axes = figure.add_axes(place) if flat else figure.add_axes(place, projection="3d")
            (_draw_flat if flat else _draw_solid)(axes, points, values(index), triangles)
            title = f"{index + 1}: {_hertz(float(model.frequencies[index]))}"
            figure.text((left + 0.5 * (across - 0.12)) / WIDTH, (lower + height - _TITLE + 0.06) / total, title, fontsize=8.0, ha="center")
    return figure


def _hertz(frequency: float) -> str:
    return f"{frequency:.5g} Hz" if frequency < 1e4 else f"{frequency / 1e3:.5g} kHz"


def _surface(model: ModalModel, flat: bool) -> tuple[Floats, Callable[[int], Floats], Integers]:
    """Return points of the surface, a function for their displacements in a mode, and the triangles between them."""
    points, faces, triangles, start = [], [], [], 0
    for group in outer_faces(model.mesh):
        local, pattern = _lattice(len(group.corners))
        weights = group.shape_functions(local)[0]
        at = np.einsum("qk,eki->eqi", weights, model.mesh.nodes[group.connectivity])
        if flat and not model.mesh.is_flat:  # only the faces of the upper side
            upper = at[..., 2].min(axis=1) > model.mesh.nodes[:, 2].max() - 1e-6 * model.mesh.extent.max()
            group = Faces(group.kind, group.corners, group.connectivity[upper])
            at = at[upper]
        points.append(at.reshape(-1, 3))
        faces.append((group, weights))
        triangles.append((pattern[None] + len(local) * np.arange(len(at))[:, None, None]).reshape(-1, 3) + start)
        start += at.shape[0] * at.shape[1]

    def values(mode: int) -> Floats:
        moved = model.displacements(mode)
        return np.concatenate([np.einsum("qk,eki->eqi", weights, moved[group.connectivity]).reshape(-1, 3) for group, weights in faces])

    return np.concatenate(points), values, np.concatenate(triangles)


def _lattice(corners: int) -> tuple[Floats, Integers]:
    """Return a lattice of points on a face of the reference element, and the triangles between them."""
    step = np.arange(_FINE + 1)
    if corners == 4:
        a, b = (side.ravel() for side in np.meshgrid(step, step, indexing="ij"))
        inside = [(i, j) for i in range(_FINE) for j in range(_FINE)]
    else:
        a, b = np.array([(i, j) for i in step for j in step if i + j <= _FINE]).T
        inside = [(i, j) for i in range(_FINE) for j in range(_FINE - i)]
    number = {(int(i), int(j)): index for index, (i, j) in enumerate(zip(a, b, strict=True))}
    triangles = [[number[i, j], number[i + 1, j], number[i, j + 1]] for i, j in inside]
    triangles += [[number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]] for i, j in inside if (i + 1, j + 1) in number]
    return np.stack([a, b], axis=1) / _FINE, np.array(triangles)


def _draw_flat(axes: Axes, points: Floats, moved: Floats, triangles: Integers) -> None:
    """Draw the vertical displacement with its nodal lines; for an in-plane mode the magnitude of the displacement."""
    height = moved[:, 2]
    in_plane = np.abs(height).max() < 0.2 * np.linalg.norm(moved, axis=1).max()
    shown = np.linalg.norm(moved[:, :2], axis=1) if in_plane else height
    most = float(np.abs(shown).max()) or 1.0
    mesh = Triangulation(points[:, 0], points[:, 1], triangles)
    axes.tripcolor(
        mesh,
        shown,
        cmap="Purples" if in_plane else _COLOURS,
        vmin=0.0 if in_plane else -most,
        vmax=most,
        shading="gouraud",
        rasterized=True,
    )
    if not in_plane:
        mesh.set_mask((np.abs(height[triangles]) < _AT_REST * most).all(axis=1))
        axes.tricontour(mesh, height, levels=[0.0], colors=INK, linewidths=0.6)
    axes.set_aspect("equal")
    axes.set_axis_off()
    if in_plane:
        axes.text(0.5, 0.5, "in its plane", transform=axes.transAxes, ha="center", va="center", fontsize=8.0)


def _draw_solid(axes: Axes, points: Floats, moved: Floats, triangles: Integers) -> None:
    """Draw the deformed surface, coloured by the radial displacement; for a torsional mode by its magnitude."""
    size = float(np.ptp(points, axis=0).max())
    middle = points.mean(axis=0)
    shown = points + _EXAGGERATED * size / np.linalg.norm(moved, axis=1).max() * moved
    outward = points - middle
    outward /= np.maximum(np.linalg.norm(outward, axis=1, keepdims=True), 1e-300)
    distance = np.linalg.norm(moved, axis=1)
    colour = np.einsum("pi,pi->p", moved, outward)[triangles].mean(axis=1)
    torsional = np.abs(colour).max() < 0.05 * distance.max()
    if torsional:
        colour = distance[triangles].mean(axis=1)
    most = float(np.abs(colour).max())
    palette = colormaps["Purples" if torsional else _COLOURS](Normalize(0.0 if torsional else -most, most)(colour))
    axes.add_collection3d(Poly3DCollection(shown[triangles], facecolors=palette, edgecolors="none", rasterized=True))  # type: ignore[attr-defined]
    low, high = shown.min(axis=0), shown.max(axis=0)
    half = 0.5 * float((high - low).max())
    for set_limits, centre in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), 0.5 * (low + high), strict=True):  # type: ignore[attr-defined]
        set_limits(centre - half, centre + half)
    axes.set_box_aspect((1, 1, 1), zoom=1.3)  # type: ignore[call-arg, arg-type]
    axes.set_axis_off()
