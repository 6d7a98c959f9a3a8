"""Mode shapes of a solid body: its deformed surface, seen obliquely from above, coloured
by the displacement outwards.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Panel
from vibroimpact.charts.marks import Facets, Label, Line, Mark
from vibroimpact.modes.titles import mode_title
from vibroimpact.report.projection import TILT, TURN, project
from vibroimpact.structures.modal_model import ModalModel
from vibroimpact.structures.surface import outer_faces

_FACETS = 3000
"""Facets of the surface, if its faces are not more already."""

_MOST_DIVISIONS = 6
_MOST_DRAWN = 40_000
"""Facets of all shapes; a body with so many faces that it would have more is shown in
fewer modes.
"""

_EXAGGERATED = 0.12
"""Largest drawn displacement over the size of the body."""

_TWISTING = 0.05
"""Part of the largest displacement below which the displacement outwards is none."""

_OVERLAP = 0.01
"""Part by which the facets that are turned to the viewer are larger than the silhouette
of a body that is not convex.
"""

_AWAY = np.array([np.sin(TURN) * np.cos(TILT), np.cos(TURN) * np.cos(TILT), -np.sin(TILT)])
"""The direction of view."""


def solid_panels(model: ModalModel, number: int) -> list[Panel]:
    """Return the shapes of the first modes of a body.

    Parameters
    ----------
    model : ModalModel
        Its modes.
    number : int
        Number of modes, at most.
    """
    across, up, scale = (
        Axis("across", "m"),
        Axis("up", "m"),
        Axis("Displacement outwards, part of the largest"),
    )
    faces = _Surface(model)
    size = float(np.ptp(faces.corners, axis=(0, 1)).max())
    middle, rest = faces.corners.mean(axis=(0, 1)), _silhouette(faces.corners)
    panels = []
    for mode in range(min(number, max(1, _MOST_DRAWN // len(faces.corners)))):
        moved = faces.displacements(mode)
        most = float(np.linalg.norm(moved, axis=-1).max())
        shown = faces.corners + _EXAGGERATED * size / most * moved
        outward = faces.corners - middle
        outward /= np.maximum(np.linalg.norm(outward, axis=-1, keepdims=True), 1e-300)
        radial = np.einsum("fci,fci->fc", moved, outward).mean(axis=1)
        seen, order = _seen(shown)
        corners = _projected(shown[seen][order])
        marks: tuple[Mark, ...]
        if np.abs(radial).max() < _TWISTING * most:
            distance = np.linalg.norm(moved, axis=-1).mean(axis=1)[seen][order]
            marks = (
                Facets(corners, distance / most),
                Label(0.5, 0.0, "twisting", "below", corner=True),
            )
        else:
            marks = (
                Facets(
                    corners, radial[seen][order] / np.abs(radial).max(), diverging=True, scale=scale
                ),
            )
        panels.append(Panel(across, up, (*marks, *rest), mode_title(model, mode), picture=True))
    return panels


def _projected(corners: Floats) -> Floats:
    return np.stack(project(*np.moveaxis(corners, -1, 0)), axis=-1)


def _silhouette(corners: Floats) -> tuple[Line, ...]:
    """Return the silhouette of a convex body at rest; none of another one."""
    from scipy.spatial import ConvexHull

    seen, _ = _seen(corners)
    facets = _projected(corners[seen])
    hull = ConvexHull(facets.reshape(-1, 2))
    (a, b), (c, d) = (
        np.moveaxis(facets[:, end] - facets[:, start], -1, 0) for start, end in ((0, 2), (1, 3))
    )
    # facets hide others
    if 0.5 * float(np.abs(a * d - b * c).sum()) > (1.0 + _OVERLAP) * hull.volume:
        return ()
    x, y = facets.reshape(-1, 2)[np.append(hull.vertices, hull.vertices[0])].T
    return (Line(x, y, role="ghost"),)


def _seen(corners: Floats) -> tuple[Bools, Indices]:
    """Return which facets are turned to the viewer, and the order of these, the farthest first."""
    diagonals = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    seen: Bools = np.cross(*diagonals) @ _AWAY < 0.0
    return seen, np.argsort(-(corners[seen].mean(axis=1) @ _AWAY))


class _Surface:
    """The facets of the surface of a body, (facets, 4, 3), those of triangles with their
    last corner twice; and their displacements.
    """

    def __init__(self, model: ModalModel) -> None:
        self.model = model
        self.groups = outer_faces(model.mesh)
        faces = sum(len(group.connectivity) for group in self.groups)
        self.divisions = int(np.clip(np.sqrt(_FACETS / faces), 1, _MOST_DIVISIONS))
        self.corners = self._at(model.mesh.nodes)

    def displacements(self, mode: int) -> Floats:
        """Return the displacements of the corners of the facets in a mode."""
        return self._at(self.model.displacements(mode))

    def _at(self, values: Floats) -> Floats:
        """Return values at the nodes, (nodes, 3), at the corners of the facets."""
        parts = []
        for group in self.groups:
            cells = _cells(len(group.corners), self.divisions)
            weights = group.shape_functions(cells.reshape(-1, 2))[0]
            parts.append(
                np.einsum("qk,eki->eqi", weights, values[group.connectivity]).reshape(-1, 4, 3)
            )
        return np.concatenate(parts)


def _cells(corners: int, divisions: int) -> Floats:
    """Return the corners of the parts of a face in its coordinates, (parts, 4, 2).

    Examples
    --------
    >>> _cells(4, 1).tolist()
    [[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]]
    >>> len(_cells(3, 2))
    4
    """
    a, b = (
        side.ravel()
        for side in np.meshgrid(np.arange(divisions), np.arange(divisions), indexing="ij")
    )
    begin = np.stack([a, b], axis=1)[:, None]
    if corners == 4:
        return np.asarray(
            (begin + np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])) / divisions
        )
    lower = begin[a + b < divisions] + np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 1.0]])
    upper = begin[a + b < divisions - 1] + np.array(
        [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 1.0]]
    )
    return np.asarray(np.concatenate([lower, upper]) / divisions)
