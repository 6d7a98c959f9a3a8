r"""Paths of sound from a face of a body to a point beyond it, by Rayleigh's integral.

The sound pressure that a face in a rigid plane baffle sends to a point is

.. math:: p(t) = \frac{\rho}{2 \pi} \int \frac{a_n(x, t - R / c)}{R}\,dS

with the density and the speed of sound of the air, the acceleration of the face along its outward
normal, and the distance R of its points (Lord Rayleigh, The Theory of Sound, vol. 2, 1878, section
278). The integral is taken by the delay R / c, on a grid of delays.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from scipy.sparse import coo_array, csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.structures.finite_elements.lagrange_shares import lagrange_shares
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.surface import Faces, Side, Spot, facing, place_of

_STEPS_PER_PERIOD = 14.0
"""Steps of the grid of delays in the shortest period of the sound."""
# of Gauss's rule across a cell, which is no larger than the shortest wavelength and the distance
# to the point
_NODES = 6
_MOST_POINTS = 100_000
"""Largest number of quadrature points that are taken at once."""


@dataclass(frozen=True)
class Listener:
    """A point beyond a face of a body, in air.

    Parameters
    ----------
    spot : tuple of two floats or str
        x and y [m], or the name of a set of nodes, for its centre.
    side : str
        The face that it hears: "upper" or "lower".
    distance : float
        Distance from the plane of that face [m], > 0.
    speed : float
        Speed of sound [m/s].
    step : float
        Step of the grid of delays [s]: the sound has periods of 14 or more of them.
    """

    spot: Spot
    side: Side
    distance: float
    speed: float
    step: float


@dataclass(frozen=True)
class SoundPaths:
    """Rayleigh's integral of each mode of a body, by delay.

    Parameters
    ----------
    first : int
        The first delay, in steps.
    step : float
        Step of the delays [s].
    weights : array, shape (modes, delays)
        Sound pressure over the density of the air and the modal acceleration as long before [m
        kg^-1/2].
    """

    first: int
    step: float
    weights: Floats

    @property
    def delays(self) -> Floats:
        """The delays [s]."""
        return np.asarray((self.first + np.arange(self.weights.shape[1])) * self.step)


def sound_paths(mesh: Mesh, listener: Listener, shapes: Floats) -> SoundPaths:
    """Return the paths of sound from a face of a body to a point.

    Parameters
    ----------
    mesh : Mesh
        The body.
    listener : Listener
        The point.
    shapes : array, shape (modes, dofs)
        Mode shapes on the degrees of freedom of the mesh.

    Raises
    ------
    InputError
        If the mesh has no set of that name.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
    >>> mesh = plate_mesh((0.2, 0.1), 0.1)
    >>> lifted = np.tile([0.0, 0.0, 1.0, 0.0, 0.0], len(mesh.nodes))[None]
    >>> paths = sound_paths(mesh, Listener((0.0, 0.0), "upper", 10.0, 343.0, 1e-6), lifted)
    >>> round(float(paths.weights.sum()) * 2.0 * np.pi * 10.0, 5)  # far away, the area
    0.02
    """
    groups = facing(mesh, listener.side)
    point = _listening_point(mesh, groups, listener)
    # parts of the integral: the first delay, and the pressures by delay and degree of freedom
    parts = [
        _integral_over_faces(mesh, faces, cells, point, listener)
        for faces, cells in _faces_by_cells(mesh, groups, point, listener)
    ]
    first = min(first for first, _ in parts)
    end = max(first + pressures.shape[0] for first, pressures in parts)
    weights = np.zeros((len(shapes), end - first))
    for part_first, pressures in parts:
        start = part_first - first
        weights[:, start : start + pressures.shape[0]] += (pressures @ shapes.T).T
    return SoundPaths(first, listener.step, weights)


def _outwards(listener: Listener) -> float:
    """Return the sign of z outwards from the face that a listener hears."""
    return 1.0 if listener.side == "upper" else -1.0


def _listening_point(mesh: Mesh, groups: list[Faces], listener: Listener) -> Floats:
    """Return the position of a listener [m], above the outermost node of the faces."""
    sign = _outwards(listener)
    face_nodes = np.unique(np.concatenate([faces.connectivity.ravel() for faces in groups]))
    height = sign * (sign * mesh.nodes[face_nodes, 2]).max() + sign * listener.distance
    return np.array([*place_of(mesh, listener.spot, listener.side), height])


def _faces_by_cells(
    mesh: Mesh, groups: list[Faces], point: Floats, listener: Listener
) -> Iterator[tuple[Faces, int]]:
    """Yield faces that are cut alike, with the number of cells along their sides."""
    shortest_wavelength = _STEPS_PER_PERIOD * listener.step * listener.speed
    for faces in groups:
        positions = mesh.nodes[faces.connectivity]
        size = np.ptp(positions, axis=1).max(axis=1)
        distance = np.maximum(
            np.linalg.norm(positions.mean(axis=1) - point, axis=1) - size, listener.distance
        )
        cells_along = np.ceil(size / np.minimum(shortest_wavelength, distance)).astype(int)
        for cells in np.unique(cells_along):
            connectivity = faces.connectivity[cells_along == cells]
            at_once = max(1, _MOST_POINTS // (_NODES * int(cells)) ** 2)
            for start in range(0, len(connectivity), at_once):
                chunk = connectivity[start : start + at_once]
                yield Faces(faces.kind, faces.corners, chunk), int(cells)


def _integral_over_faces(
    mesh: Mesh, faces: Faces, cells: int, point: Floats, listener: Listener
) -> tuple[int, csr_array]:
    """Return the first delay in steps, and the pressures over density by delay (delays, dofs).

    The pressures are those under a unit acceleration of each degree of freedom: Rayleigh's
    integral over the faces. Indices in the sums below are f of faces, q of quadrature points, k of
    nodes, and i of axes.
    """
    local, weights = _rule(len(faces.corners), cells)
    values, slopes = faces.shape_functions(local)  # (q, k), (q, 2, k)
    nodes = mesh.nodes[faces.connectivity]  # (f, k, 3)

    # dS n = dx/da x dx/db da db, turned outwards
    tangents = np.einsum("qak,fki->fqai", slopes, nodes)
    normals = np.cross(tangents[..., 0, :], tangents[..., 1, :])
    area = normals * weights[:, None]
    area *= _outwards(listener) * np.sign(area[..., 2:])

    # Rayleigh's integral: p/rho = sum of a_n dS/(2 pi R), delayed by R/c
    positions = np.einsum("qk,fki->fqi", values, nodes)
    distance = np.linalg.norm(positions - point, axis=2)
    factors = area / (2.0 * np.pi * distance[..., None])  # (f, q, 3)

    # the pressure of each quadrature point arrives between two steps of the grid of delays
    travel_steps = distance / (listener.speed * listener.step)
    delays, shares = lagrange_shares(travel_steps.ravel())
    first = int(delays.min())
    shares_per_point = delays.shape[1]
    quadrature_points = np.arange(delays.size) // shares_per_point
    coordinates = ((delays - first).ravel(), quadrature_points)
    arrival = csr_array(coo_array((shares.ravel(), coordinates)))
    pressures = _pressures(mesh, faces, factors, values)
    return first, csr_array(arrival @ pressures)


def _pressures(mesh: Mesh, faces: Faces, factors: Floats, values: Floats) -> csr_array:
    """Return the pressures that quadrature points send, by degree of freedom.

    Parameters
    ----------
    mesh : Mesh
        The body.
    faces : Faces
        Faces of it.
    factors : array, shape (faces, points, 3)
        Pressure per acceleration of a quadrature point along each axis.
    values : array, shape (points, nodes)
        Shape functions.
    """
    # the normals of plate elements are along z
    axes: Integers = np.array([2]) if mesh.is_flat else np.arange(3)
    pressures = np.einsum("fqi,qk->fqki", factors[..., axes], values)
    points = np.arange(factors[..., 0].size).reshape(*factors.shape[:2], 1, 1)
    rows = np.broadcast_to(points, pressures.shape)
    # the acceleration of a point is that of the nodes, by the shape functions
    dofs = mesh.dofs_per_node * faces.connectivity[:, None, :, None] + axes
    columns = np.broadcast_to(dofs, pressures.shape)
    shape = (points.size, mesh.dofs_per_node * len(mesh.nodes))
    return csr_array(coo_array((pressures.ravel(), (rows.ravel(), columns.ravel())), shape=shape))


def _rule(corners: int, cells: int) -> tuple[Floats, Floats]:
    """Return points (q, 2) and weights (q,) of Gauss's rule on cells of a reference face.

    The face is the unit square, or with three corners the unit triangle.
    """
    nodes, weights = legendre.leggauss(_NODES)
    positions = (np.arange(cells)[:, None] + 0.5 * (nodes + 1.0)).ravel() / cells
    line_weights = np.tile(0.5 * weights / cells, cells)
    a, b = (side.ravel() for side in np.meshgrid(positions, positions, indexing="ij"))
    square_weights = np.outer(line_weights, line_weights).ravel()
    if corners == 3:  # the square, with one side drawn together
        return np.stack([a, b * (1.0 - a)], axis=1), square_weights * (1.0 - a)
    return np.stack([a, b], axis=1), square_weights
