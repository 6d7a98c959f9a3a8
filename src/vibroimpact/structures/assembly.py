"""Vectorised assembly: shape functions at the quadrature points of all elements, and sums
of element matrices over pairs of nodes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from scipy.sparse import bsr_array, csr_array

from vibroimpact.arrays import Floats
from vibroimpact.structures.geometry import jacobians
from vibroimpact.structures.mesh import ElementBlock, Mesh

_CHUNK = 4_000_000  # numbers in the largest array of a chunk of elements, to limit the memory


def scaled_shapes(mesh: Mesh, block: ElementBlock) -> Iterator[tuple[Floats, Floats]]:
    """Yield the shape functions and their gradients at the quadrature points times sqrt(dV), chunk
    by chunk of elements.

    Yields
    ------
    values : array, shape (elements, points, nodes)
        N sqrt(dV), so that `values.T @ values` of an element is the integral of N_a N_b.
    gradients : array, shape (dimension, elements, points, nodes)
        Derivatives of N along each axis, times sqrt(dV).
    """
    points, weights = block.element.quadrature()
    values, slopes = block.element.basis(points)
    size = max(1, _CHUNK // (values.shape[1] * values.size))
    for start in range(0, len(block.connectivity), size):
        at = mesh.nodes[block.connectivity[start : start + size], : block.element.dimension]
        jacobian = jacobians(at, slopes)
        root = np.sqrt(weights * np.linalg.det(jacobian))
        gradients = np.linalg.inv(jacobian) @ slopes * root[:, :, None, None]
        yield values * root[:, :, None], np.ascontiguousarray(gradients.transpose(2, 0, 1, 3))


def pair_assembly(
    mesh: Mesh,
) -> tuple[Callable[[Sequence[Floats]], Floats], Callable[[Floats], csr_array]]:
    """Return functions that sum element matrices over pairs of nodes, and that make a sparse matrix
    of such sums.

    Returns
    -------
    summed : callable
        From element matrices (elements, nodes, nodes), in chunks in the order of the mesh, to one
        number per pair of nodes.
    matrix : callable
        From blocks, shape (pairs, n, n), to a sparse matrix with n degrees of freedom per node.

    Notes
    -----
    Pairs are sorted once, so that each sum is one `np.add.reduceat` and all matrices of a mesh have
    the same pattern.
    """
    number = len(mesh.nodes)
    # the square of the number of nodes must fit
    wide = [block.connectivity.astype(np.int64) for block in mesh.blocks]
    pairs = np.concatenate(
        [(nodes[:, :, None] * number + nodes[:, None, :]).ravel() for nodes in wide]
    )
    order = np.argsort(pairs, kind="stable")
    key = pairs[order]
    starts = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
    found = key[starts]
    columns, pointer = found % number, np.searchsorted(found, np.arange(number + 1) * number)

    def summed(chunks: Sequence[Floats]) -> Floats:
        return np.asarray(
            np.add.reduceat(np.concatenate([chunk.ravel() for chunk in chunks])[order], starts)
        )

    def matrix(blocks: Floats) -> csr_array:
        size = number * blocks.shape[1]
        return bsr_array((blocks, columns, pointer), shape=(size, size)).tocsr()

    return summed, matrix


def node_adjacency(mesh: Mesh) -> csr_array:
    """Return the adjacency of nodes that share an element, as the pattern of a sparse
    matrix (nodes, nodes).
    """
    summed, matrix = pair_assembly(mesh)
    ones = [
        np.ones((*block.connectivity.shape, block.connectivity.shape[1])) for block in mesh.blocks
    ]
    return matrix(summed(ones)[:, None, None])


def isotropic(product: Floats, lame: float, mu: float) -> Floats:
    """Return the stiffness blocks of pairs of nodes of an isotropic material, from the integrals of
    dN_a/dx_i dN_b/dx_j.

    Parameters
    ----------
    product : array, shape (d, d, pairs)
        The integrals, with the axes i and j first.
    lame, mu : float
        Lame's first parameter (in two dimensions that of plane stress) and the shear modulus [Pa].

    Returns
    -------
    array, shape (pairs, d, d)
        lambda G_ij + mu G_ji + mu delta_ij tr G.
    """
    trace = mu * np.trace(product)
    stiffness = lame * product + mu * product.transpose(1, 0, 2)
    for axis in range(len(product)):
        stiffness[axis, axis] += trace
    return np.ascontiguousarray(stiffness.transpose(2, 0, 1))
