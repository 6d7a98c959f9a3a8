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
# signs of u, v, w and the two slopes in a reflection, by the normal of the plane
_PLATE_SIGNS = np.array([[-1, 1, 1, -1, 1], [1, -1, 1, 1, -1], [1, 1, -1, -1, -1]])


@dataclass(frozen=True)
class Mirror:
    """Reflection of motions in a plane.

    Degree of freedom i of the image is `sign[i]` times degree of freedom `source[i]`.

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
    """Return the mirror planes of a held structure.

    They go through the middle of its bounding box, normal to x, y or z. Candidates follow from the
    nodes; stiffness and mass are then tested for the symmetry, which includes the supports. The
    middle plane of plate elements is a mirror plane if bending and stretching are uncoupled.

    Parameters
    ----------
    held : HeldStructure
        The structure.
    """
    candidates = (_mirror(held, axis) for axis in range(3))
    return [mirror for mirror in candidates if mirror is not None and _commutes(held, mirror)]


def _mirror(held: HeldStructure, axis: int) -> Mirror | None:
    """Return the reflection along an axis; None if a free degree of freedom has no free image."""
    mesh = held.structure.mesh
    per_node = mesh.dofs_per_node
    size = held.structure.stiffness.shape[0]
    # degrees of freedom of supporting bodies, which have no known images
    if held.free.max(initial=-1) >= size:
        return None
    image = _node_images(mesh.nodes, axis)
    if image is None:
        return None
    signs = np.where(np.arange(per_node) == axis, -1, 1)
    if mesh.is_flat:
        signs = _PLATE_SIGNS[axis]
    free_number = np.full(size, -1)  # of each degree of freedom among the free ones
    free_number[held.free] = np.arange(len(held.free))
    node, component = np.divmod(held.free, per_node)
    source = free_number[per_node * image[node] + component]
    if (source < 0).any():
        return None
    return Mirror(axis, source, signs[component].astype(float))


def _node_images(nodes: Floats, axis: int) -> Integers | None:
    """Return the node at the mirror image of each node; None unless each has one of its own."""
    from scipy.spatial import cKDTree  # imported late: modes that are stored do not need it

    reflected = nodes.copy()
    reflected[:, axis] = reflected[:, axis].min() + reflected[:, axis].max() - reflected[:, axis]
    distance, image = cKDTree(nodes).query(reflected)
    if distance.max() > _NEAR * np.ptp(nodes, axis=0).max() or len(np.unique(image)) < len(image):
        return None
    return np.asarray(image)


def _commutes(held: HeldStructure, mirror: Mirror) -> bool:
    """Return whether stiffness and mass commute with a reflection, tested on random motions."""
    scale = 1.0 / np.sqrt(held.stiffness.diagonal())
    random = np.random.default_rng(0)
    for _ in range(_REPEATS):
        motion = scale * random.standard_normal(len(scale))
        for matrix in (held.stiffness, held.mass):
            forces = matrix @ motion
            difference = mirror.reflect(forces) - matrix @ mirror.reflect(motion)
            if not np.linalg.norm(scale * difference) <= _ALIKE * np.linalg.norm(scale * forces):
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
    symmetries = _symmetries(size, mirrors)
    is_first = _in_first_part(held, mirrors)
    first_part = held.order[is_first[held.order]]
    rows = np.concatenate([symmetry.source[first_part] for symmetry in symmetries])
    columns = np.tile(np.arange(len(first_part)), len(symmetries))
    bases = []
    for parities in product((1.0, -1.0), repeat=len(mirrors)):
        # a motion of one degree of freedom, and its images with the signs of the parities
        values = np.concatenate(
            [
                np.prod([parities[number] for number in symmetry.mirrors])
                * symmetry.sign[first_part]
                for symmetry in symmetries
            ]
        )
        basis = csr_array(coo_array((values, (rows, columns)), shape=(size, len(first_part))))
        norms = np.sqrt(np.asarray((basis.multiply(basis)).sum(axis=0)).ravel())
        nonzero = np.flatnonzero(norms > 0.5)  # motions of nodes on a plane have one parity only
        if len(nonzero):
            bases.append(csr_array(basis[:, nonzero].multiply(1.0 / norms[nonzero])))
    return bases


@dataclass(frozen=True)
class _Symmetry:
    """A product of reflections; `source` and `sign` are as those of `Mirror`."""

    mirrors: tuple[int, ...]
    source: Integers
    sign: Floats


def _symmetries(size: int, mirrors: Sequence[Mirror]) -> list[_Symmetry]:
    """Return all products of mirrors, from the identity on."""
    symmetries = [_Symmetry((), np.arange(size), np.ones(size))]
    for number, mirror in enumerate(mirrors):
        symmetries += [
            _Symmetry(
                (*symmetry.mirrors, number),
                symmetry.source[mirror.source],
                mirror.sign * symmetry.sign[mirror.source],
            )
            for symmetry in symmetries
        ]
    return symmetries


def _in_first_part(
    held: HeldStructure, mirrors: Sequence[Mirror]
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return a mask of the free degrees of freedom on or above all mirror planes."""
    nodes = held.structure.mesh.nodes
    tolerance = _NEAR * np.ptp(nodes, axis=0).max()
    is_above = np.ones(len(nodes), dtype=bool)
    for mirror in mirrors:
        positions = nodes[:, mirror.axis]
        is_above &= positions >= 0.5 * (positions.min() + positions.max()) - tolerance
    return np.asarray(is_above[held.free // held.structure.mesh.dofs_per_node])
