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
from vibroimpact.structures.lagrange_shares import lagrange_shares
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.surface import Faces, Side, Spot, facing, place_of

_WAVE = 14.0
"""Steps of the grid of delays in the shortest period of the sound."""
_NODES = 6
"""Of Gauss's rule across a cell, which is no larger than the shortest wavelength and the
distance to the point.
"""
_MOST = 100_000
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
    >>> from vibroimpact.structures.plate_mesh import plate_mesh
    >>> mesh = plate_mesh((0.2, 0.1), 0.1)
    >>> lifted = np.tile([0.0, 0.0, 1.0, 0.0, 0.0], len(mesh.nodes))[None]
    >>> paths = sound_paths(mesh, Listener((0.0, 0.0), "upper", 10.0, 343.0, 1e-6), lifted)
    >>> round(float(paths.weights.sum()) * 2.0 * np.pi * 10.0, 5)  # far away, the area
    0.02
    """
    sign = 1.0 if listener.side == "upper" else -1.0
    groups = facing(mesh, listener.side)
    face_nodes = np.unique(np.concatenate([faces.connectivity.ravel() for faces in groups]))
    height = sign * (sign * mesh.nodes[face_nodes, 2]).max() + sign * listener.distance
    point = np.array([*place_of(mesh, listener.spot, listener.side), height])
    parts = [
        _of_cells(mesh, faces, cells, point, sign, listener)
        for faces, cells in _cells(mesh, groups, point, listener)
    ]
    first, last = (
        min(first for first, _ in parts),
        max(first + part.shape[0] for first, part in parts),
    )
    weights = np.zeros((len(shapes), last - first))
    for begin, part in parts:
        weights[:, begin - first : begin - first + part.shape[0]] += (part @ shapes.T).T
    return SoundPaths(first, listener.step, weights)


def _cells(
    mesh: Mesh, groups: list[Faces], point: Floats, listener: Listener
) -> Iterator[tuple[Faces, int]]:
    """Yield faces that are cut alike, with the number of cells along their sides."""
    wave = _WAVE * listener.step * listener.speed
    for faces in groups:
        corner = mesh.nodes[faces.connectivity]
        size = np.ptp(corner, axis=1).max(axis=1)
        apart = np.maximum(
            np.linalg.norm(corner.mean(axis=1) - point, axis=1) - size, listener.distance
        )
        cells = np.ceil(size / np.minimum(wave, apart)).astype(int)
        for number in np.unique(cells):
            found = faces.connectivity[cells == number]
            at_once = max(1, _MOST // (_NODES * int(number)) ** 2)
            for begin in range(0, len(found), at_once):
                yield Faces(faces.kind, faces.corners, found[begin : begin + at_once]), int(number)


def _of_cells(
    mesh: Mesh, faces: Faces, cells: int, point: Floats, sign: float, listener: Listener
) -> tuple[int, csr_array]:
    """Return the integral over faces as linear functions of the degrees of freedom,
    (delays, dofs), and the first delay in steps.
    """
    local, weight = _rule(len(faces.corners), cells)
    values, along = faces.shape_functions(local)  # (q, k), (q, 2, k)
    corner = mesh.nodes[faces.connectivity]  # (f, k, 3)
    tangent = np.einsum("qak,fki->fqai", along, corner)
    normal = np.cross(tangent[..., 0, :], tangent[..., 1, :]) * weight[:, None]
    normal *= sign * np.sign(normal[..., 2:])
    apart = np.linalg.norm(np.einsum("qk,fki->fqi", values, corner) - point, axis=2)
    flow = normal / (2.0 * np.pi * apart[..., None])  # (f, q, 3)
    delays, shares = lagrange_shares((apart / (listener.speed * listener.step)).ravel())
    first, rows = int(delays.min()), np.arange(delays.size) // delays.shape[1]
    spread = csr_array(coo_array((shares.ravel(), ((delays - first).ravel(), rows))))
    axes: Integers = np.array([2]) if mesh.is_flat else np.arange(3)
    seen = np.einsum("fqa,qk->fqka", flow[..., axes], values)
    columns = mesh.dofs_per_node * faces.connectivity[:, None, :, None] + axes
    points = np.broadcast_to(np.arange(apart.size).reshape(*apart.shape, 1, 1), seen.shape)
    shape = (apart.size, mesh.dofs_per_node * len(mesh.nodes))
    motion = csr_array(
        coo_array(
            (seen.ravel(), (points.ravel(), np.broadcast_to(columns, seen.shape).ravel())),
            shape=shape,
        )
    )
    return first, csr_array(spread @ motion)


def _rule(corners: int, cells: int) -> tuple[Floats, Floats]:
    """Return points and weights of Gauss's rule on cells of the unit square or triangle,
    (q, 2) and (q,).
    """
    nodes, weights = legendre.leggauss(_NODES)
    places = (np.arange(cells)[:, None] + 0.5 * (nodes + 1.0)).ravel() / cells
    weights = np.tile(0.5 * weights / cells, cells)
    a, b = (part.ravel() for part in np.meshgrid(places, places, indexing="ij"))
    weight = np.outer(weights, weights).ravel()
    if corners == 3:  # the square, with one side drawn together
        return np.stack([a, b * (1.0 - a)], axis=1), weight * (1.0 - a)
    return np.stack([a, b], axis=1), weight
