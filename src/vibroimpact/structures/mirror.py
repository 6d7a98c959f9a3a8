"""Planes in which a held structure is its own mirror image, and the parts into which they divide its motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.spatial import cKDTree

from vibroimpact.arrays import Floats, Integers
from vibroimpact.structures.supports.constraints import HeldStructure

_NEAR = 1e-9  # of the body's extent: nodes no farther apart are mirror images
_ALIKE = 1e-10  # relative: how far a mirrored stiffness or mass may differ, by rounding
_REPEATS = 2  # random motions with which that is tried
_PLATE_AXES = np.array([[-1, 1, 1, -1, 1], [1, -1, 1, 1, -1], [1, 1, -1, -1, -1]])  # of u, v, w and the slopes, by axis


@dataclass(frozen=True)
class Mirror:
    """A mirror image of motions: degree of freedom i of the image is `sign[i]` times degree of freedom `source[i]`.

    Parameters
    ----------
    axis : int
        The normal of the plane: 0, 1 or 2.
    source, sign : array, shape (free,)
        On the degrees of freedom that are left free.
    """

    axis: int
    source: Integers
    sign: Floats

    def of(self, motion: Floats) -> Floats:
        """Return the mirror image of a motion (free,)."""
        return np.asarray(self.sign * motion[self.source])


def mirrors_of(held: HeldStructure) -> list[Mirror]:
    """Return the mirror planes of a held structure through its middle, normal to x, y or z.

    They are found from the nodes, and tried on stiffness and mass, so that whatever holds or loads the structure is seen. The middle
    plane of plate elements is one if nothing couples their bending to their stretching.

    Parameters
    ----------
    held : HeldStructure
        The structure.
    """
    found = (_mirror(held, axis) for axis in range(3))
    return [mirror for mirror in found if mirror is not None and _commutes(held, mirror)]


def _mirror(held: HeldStructure, axis: int) -> Mirror | None:
    """Return the mirror normal to an axis if each free degree of freedom has an image that is free."""
    mesh = held.structure.mesh
    per_node, size = mesh.dofs_per_node, held.structure.stiffness.shape[0]
    if held.free.max(initial=-1) >= size:  # of bodies that hold it, whose images are not known
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
    """Is the mirror image of the forces that a motion takes those of its mirror image?"""
    scale = 1.0 / np.sqrt(held.stiffness.diagonal())
    random = np.random.default_rng(0)
    for _ in range(_REPEATS):
        motion = scale * random.standard_normal(len(scale))
        for matrix in (held.stiffness, held.mass):
            forces = matrix @ motion
            off = np.linalg.norm(scale * (mirror.of(forces) - matrix @ mirror.of(motion)))
            if not off <= _ALIKE * np.linalg.norm(scale * forces):
                return False
    return True


def symmetric_parts(held: HeldStructure, mirrors: Sequence[Mirror]) -> list[csr_array]:
    """Return bases of the motions that are their own mirror images, or the opposite, in each of the planes.

    Parameters
    ----------
    held : HeldStructure
        The structure.
    mirrors : sequence of Mirror
        Its mirror planes.

    Returns
    -------
    list of sparse array, shape (free, part)
        A basis for each combination of signs, of orthonormal columns, with the elimination order of the structure; all together span
        the free motions, and neither stiffness nor mass couples two of them. Combinations without motions are left out.
    """
    size = len(held.free)
    sources, signs = [np.arange(size)], [np.ones(size)]
    counts = [np.zeros(0, dtype=int)]  # which mirrors each product of mirrors has
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
        values = np.concatenate([np.prod([parities[one] for one in count]) * sign[kept] for sign, count in zip(signs, counts, strict=True)])
        basis = csr_array(coo_array((values, (rows, np.tile(columns, len(sources)))), shape=(size, len(kept))))
        norms = np.sqrt(np.asarray((basis.multiply(basis)).sum(axis=0)).ravel())
        there = np.flatnonzero(norms > 0.5)  # on a plane some motions have no such part
        if len(there):
            parts.append(csr_array(basis[:, there].multiply(1.0 / norms[there])))
    return parts


def _in_first_part(held: HeldStructure, mirrors: Sequence[Mirror]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return which free degrees of freedom lie on the upper side of all mirror planes, or on them."""
    nodes = held.structure.mesh.nodes
    inside = np.ones(len(nodes), dtype=bool)
    for mirror in mirrors:
        at = nodes[:, mirror.axis]
        inside &= at >= 0.5 * (at.min() + at.max()) - _NEAR * np.ptp(nodes, axis=0).max()
    return np.asarray(inside[held.free // held.structure.mesh.dofs_per_node])
