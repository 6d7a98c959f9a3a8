"""Mode shapes of a solid body: its deformed surface, seen obliquely from above.

It is coloured by the displacement outwards.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Panel
from vibroimpact.charts.marks import Facets, Label, Line, Mark
from vibroimpact.modes.tables import mode_title
from vibroimpact.report.projection import TILT, TURN, project
from vibroimpact.structures.finite_elements.surface import outer_faces
from vibroimpact.structures.modal_model import ModalModel

_FACETS = 3000
"""Facets of the surface, if its faces are not more already."""

_MOST_DIVISIONS = 6
_MOST_DRAWN = 40_000
"""Facets of all shapes; a body that would have more is shown in fewer modes."""

_DRAWN_DISPLACEMENT = 0.12
"""Largest drawn displacement over the size of the body."""

_TWISTING = 0.05
"""Part of the largest displacement below which the displacement outwards is none."""

_OVERLAP = 0.01
"""Part by which the facets turned to the viewer exceed the silhouette of a body with recesses."""

_VIEW_DIRECTION = np.array(
    [np.sin(TURN) * np.cos(TILT), np.cos(TURN) * np.cos(TILT), -np.sin(TILT)]
)
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
    surface = _Surface(model)
    size = float(np.ptp(surface.corners, axis=(0, 1)).max())
    outwards = surface.corners - surface.corners.mean(axis=(0, 1))
    outwards /= np.maximum(np.linalg.norm(outwards, axis=-1, keepdims=True), 1e-300)
    silhouette = _silhouette(surface.corners)
    most_modes = max(1, _MOST_DRAWN // len(surface.corners))
    # one object each, so that all panels share their ranges
    horizontal = Axis("across", "m")
    vertical = Axis("up", "m")
    scale = Axis("Displacement outwards, part of the largest")
    panels = []
    for mode in range(min(number, most_modes)):
        displacements = surface.displacements(mode)
        largest = float(np.linalg.norm(displacements, axis=-1).max())
        deformed = surface.corners + _DRAWN_DISPLACEMENT * size / largest * displacements
        marks = _shape_marks(deformed, displacements, outwards, largest, scale)
        panels.append(
            Panel(
                horizontal, vertical, (*marks, *silhouette), mode_title(model, mode), picture=True
            )
        )
    return panels


def _shape_marks(
    deformed: Floats, displacements: Floats, outwards: Floats, largest: float, scale: Axis
) -> list[Mark]:
    """Return the facets of a deformed body that are turned to the viewer.

    Parameters
    ----------
    deformed : array, shape (facets, 4, 3)
        Corners of the facets of the deformed body [m].
    displacements, outwards : array, shape (facets, 4, 3)
        Displacements at the corners [m], and unit vectors from the middle of the body to them.
    largest : float
        Largest displacement [m].
    scale : Axis
        Axis of the displacement outwards.
    """
    is_visible, order = _visible_facets(deformed)
    corners = _projected(deformed[is_visible][order])
    # displacement along the outward direction, mean of the corners of a facet
    radial = np.einsum("fci,fci->fc", displacements, outwards).mean(axis=1)
    largest_radial = np.abs(radial).max()
    if largest_radial < _TWISTING * largest:
        distance = np.linalg.norm(displacements, axis=-1).mean(axis=1)[is_visible][order]
        return [
            Facets(corners, distance / largest),
            Label(0.5, 0.0, "twisting", "below", corner=True),
        ]
    values = radial[is_visible][order] / largest_radial
    return [Facets(corners, values, diverging=True, scale=scale)]


def _projected(corners: Floats) -> Floats:
    """Return the corners (..., 3) as they are seen, (..., 2)."""
    return np.stack(project(*np.moveaxis(corners, -1, 0)), axis=-1)


def _silhouette(corners: Floats) -> tuple[Line, ...]:
    """Return the silhouette of a convex body at rest; none of another one."""
    from scipy.spatial import ConvexHull

    is_visible, _ = _visible_facets(corners)
    facets = _projected(corners[is_visible])
    points = facets.reshape(-1, 2)
    hull = ConvexHull(points)
    # the area of a quadrilateral is half the cross product of its diagonals
    first_x, first_y = (facets[:, 2] - facets[:, 0]).T
    second_x, second_y = (facets[:, 3] - facets[:, 1]).T
    twice_areas = np.abs(first_x * second_y - first_y * second_x)
    visible_area = 0.5 * float(twice_areas.sum())
    # the "volume" of a hull in the plane is its area; facets of a body with recesses hide others
    if visible_area > (1.0 + _OVERLAP) * hull.volume:
        return ()
    closed = np.append(hull.vertices, hull.vertices[0])
    x, y = points[closed].T
    return (Line(x, y, role="ghost"),)


def _visible_facets(corners: Floats) -> tuple[Bools, Indices]:
    """Return which facets are turned to the viewer, and the order of these, the farthest first."""
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    is_visible: Bools = normals @ _VIEW_DIRECTION < 0.0
    distance = corners[is_visible].mean(axis=1) @ _VIEW_DIRECTION
    return is_visible, np.argsort(-distance)


class _Surface:
    """The facets of the surface of a body, and their displacements.

    `corners` has the shape (facets, 4, 3); triangles have their last corner twice.
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
        at_corners = []
        for group in self.groups:
            cells = _cells(len(group.corners), self.divisions)
            weights = group.shape_functions(cells.reshape(-1, 2))[0]
            interpolated = np.einsum("qk,eki->eqi", weights, values[group.connectivity])
            at_corners.append(interpolated.reshape(-1, 4, 3))
        return np.concatenate(at_corners)


_SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
_LOWER_TRIANGLE = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 1.0]])
_UPPER_TRIANGLE = np.array([[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 1.0]])
"""Corners of the parts of a face, in steps from the lower left one."""


def _cells(corners: int, divisions: int) -> Floats:
    """Return the corners of the parts of a face in its coordinates, (parts, 4, 2).

    Examples
    --------
    >>> _cells(4, 1).tolist()
    [[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]]
    >>> len(_cells(3, 2))
    4
    """
    first_index, second_index = np.meshgrid(
        np.arange(divisions), np.arange(divisions), indexing="ij"
    )
    a = first_index.ravel()
    b = second_index.ravel()
    origin = np.stack([a, b], axis=1)[:, None]
    if corners == 4:
        return np.asarray((origin + _SQUARE) / divisions)
    # a triangular face: lower triangles up to its long side, upper ones between them
    lower = origin[a + b < divisions] + _LOWER_TRIANGLE
    upper = origin[a + b < divisions - 1] + _UPPER_TRIANGLE
    return np.asarray(np.concatenate([lower, upper]) / divisions)
