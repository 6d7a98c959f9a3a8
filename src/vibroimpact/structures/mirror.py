"""Mirror planes of a held structure, and bases of its symmetric and antisymmetric motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.sparse import coo_array, csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.structures.supports.constraints import HeldStructure

_NEAR = 1e-9  # of the body's extent: tolerance of the position of mirror images
_ALIKE = 1e-10  # relative tolerance of the symmetry of stiffness and mass, for rounding
_REPEATS = 2  # random motions of the test of symmetry
# Signs of u, v, w and the slopes in a reflection, by the normal of the plane
_PLATE_AXES = np.array([[-1, 1, 1, -1, 1], [1, -1, 1, 1, -1], [1, 1, -1, -1, -1]])


@dataclass(frozen=True)
class Mirror:
    """Reflection of motions: degree of freedom i of the image is `sign[i]` times degree of freedom
    `source[i]`.

    Parameters
    ----------
    axis : int
        Normal of the plane: 0, 1 or 2.
    source, sign : array, shape (free,)
        Of the free degrees of freedom.
    """

    axis: int
    source: Integers
    sign: Floats

    def reflect(self, motion: Floats) -> Floats:
        """Return the mirror image of a motion, (free,)."""
        return np.asarray(self.sign * motion[self.source])


def mirror_planes(held: HeldStructure) -> list[Mirror]:
    """Return the mirror planes of a held structure through the middle of its bounding box, normal
    to x, y or z.

    Candidates follow from the nodes; stiffness and mass are then tested for the symmetry, which
    includes the supports. The middle plane of plate elements is a mirror plane if bending and
    stretching are uncoupled.

    Parameters
    ----------
    held : HeldStructure
        The structure.
    """
    found = (_mirror(held, axis) for axis in range(3))
    return [mirror for mirror in found if mirror is not None and _commutes(held, mirror)]


def _mirror(held: HeldStructure, axis: int) -> Mirror | None:
    """Return the reflection along an axis, or None unless each free degree of freedom has
    a free image.
    """
    from scipy.spatial import cKDTree  # imported late: modes that are stored do not need it

    mesh = held.structure.mesh
    per_node, size = mesh.dofs_per_node, held.structure.stiffness.shape[0]
    # degrees of freedom of supporting bodies, which have no known images
    if held.free.max(initial=-1) >= size:
        return None
    nodes = mesh.nodes.copy()
    nodes[:, axis] = nodes[:, axis].min() + nodes[:, axis].max() - nodes[:, axis]
    apart, image = cKDTree(mesh.nodes).query(nodes)
    if apart.max() > _NEAR * np.ptp(mesh.nodes, axis=0).max() or len(np.unique(image)) < len(image):
        return None
    signs = _PLATE_AXES[axis] if mesh.is_flat else np.where(np.arange(per_node) == axis, -1, 1)
    place = np.full(size, -1)
    place[held.free] = np.arange(len(held.free))
    node, part = np.divmod(held.free, per_node)
    source = place[per_node * image[node] + part]
    return None if (source < 0).any() else Mirror(axis, source, signs[part].astype(float))


def _commutes(held: HeldStructure, mirror: Mirror) -> bool:
    """Return whether stiffness and mass commute with a reflection, tested on random motions."""
    scale = 1.0 / np.sqrt(held.stiffness.diagonal())
    random = np.random.default_rng(0)
    for _ in range(_REPEATS):
        motion = scale * random.standard_normal(len(scale))
        for matrix in (held.stiffness, held.mass):
            forces = matrix @ motion
            off = np.linalg.norm(scale * (mirror.reflect(forces) - matrix @ mirror.reflect(motion)))
            if not off <= _ALIKE * np.linalg.norm(scale * forces):
                return False
    return True


def symmetry_bases(held: HeldStructure, mirrors: Sequence[Mirror]) -> list[csr_array]:
    """Return bases of the motions that are even or odd in each mirror plane.

    Parameters
    ----------
    held : HeldStructure
        The structure.
    mirrors : sequence of Mirror
        Its mirror planes.

    Returns
    -------
    list of sparse array, shape (free, part)
        A basis of orthonormal columns for each combination of parities that has motions, in the
        elimination order of the structure. Together they span all free motions, and neither
        stiffness nor mass couples two of them.
    """
    size = len(held.free)
    sources, signs = [np.arange(size)], [np.ones(size)]
    counts = [np.zeros(0, dtype=int)]  # the mirrors that each product of mirrors consists of
    for number, mirror in enumerate(mirrors):
        for source, sign, count in list(zip(sources, signs, counts, strict=True)):
            sources.append(source[mirror.source])
            signs.append(mirror.sign * sign[mirror.source])
            counts.append(np.append(count, number))
    first = _in_first_part(held, mirrors)
    kept = held.order[first[held.order]]
    parts = []
    for parities in product((1.0, -1.0), repeat=len(mirrors)):
        columns = np.arange(len(kept))
        rows = np.concatenate([source[kept] for source in sources])
        values = np.concatenate(
            [
                np.prod([parities[one] for one in count]) * sign[kept]
                for sign, count in zip(signs, counts, strict=True)
            ]
        )
        basis = csr_array(
            coo_array((values, (rows, np.tile(columns, len(sources)))), shape=(size, len(kept)))
        )
        norms = np.sqrt(np.asarray((basis.multiply(basis)).sum(axis=0)).ravel())
        there = np.flatnonzero(norms > 0.5)  # motions of nodes on a plane have one parity only
        if len(there):
            parts.append(csr_array(basis[:, there].multiply(1.0 / norms[there])))
    return parts


def _in_first_part(
    held: HeldStructure, mirrors: Sequence[Mirror]
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return a mask of the free degrees of freedom on or above all mirror planes."""
    nodes = held.structure.mesh.nodes
    inside = np.ones(len(nodes), dtype=bool)
    for mirror in mirrors:
        at = nodes[:, mirror.axis]
        inside &= at >= 0.5 * (at.min() + at.max()) - _NEAR * np.ptp(nodes, axis=0).max()
    return np.asarray(inside[held.free // held.structure.mesh.dofs_per_node])
