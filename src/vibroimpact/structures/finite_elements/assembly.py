"""Vectorised assembly of element matrices.

Shape functions are taken at the quadrature points of all elements, and element matrices summed over
pairs of nodes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from scipy.sparse import bsr_array, csr_array

from vibroimpact.arrays import Floats
from vibroimpact.structures.finite_elements.geometry import jacobians
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh

_CHUNK_NUMBERS = 4_000_000  # in the largest array of a chunk of elements, to limit the memory


def scaled_shapes(mesh: Mesh, block: ElementBlock) -> Iterator[tuple[Floats, Floats]]:
    """Yield the shape functions and their gradients times sqrt(dV), chunk by chunk of elements.

    They are taken at the quadrature points.

    Yields
    ------
    values : array, shape (elements, points, nodes)
        N sqrt(dV), so that `values.T @ values` of an element is the integral of N_a N_b.
    gradients : array, shape (dimension, elements, points, nodes)
        Derivatives of N along each axis, times sqrt(dV).
    """
    element = block.element
    points, weights = element.quadrature()
    values, reference_gradients = element.basis(points)
    # products of all pairs of nodes at all points are the largest array of an element
    numbers_per_element = values.shape[1] * values.size
    chunk_size = max(1, _CHUNK_NUMBERS // numbers_per_element)
    for start in range(0, len(block.connectivity), chunk_size):
        elements = block.connectivity[start : start + chunk_size]
        nodes = mesh.nodes[elements, : element.dimension]
        jacobian = jacobians(nodes, reference_gradients)
        # dV = w det J, and dN/dx = J^-1 dN/dxi
        root = np.sqrt(weights * np.linalg.det(jacobian))
        gradients = np.linalg.inv(jacobian) @ reference_gradients * root[:, :, None, None]
        by_axis = gradients.transpose(2, 0, 1, 3)
        yield values * root[:, :, None], np.ascontiguousarray(by_axis)


def pair_assembly(
    mesh: Mesh,
) -> tuple[Callable[[Sequence[Floats]], Floats], Callable[[Floats], csr_array]]:
    """Return functions that sum element matrices over pairs of nodes, and make a sparse matrix.

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
    number_of_nodes = len(mesh.nodes)
    # a pair of nodes as one number: row times the number of nodes, plus column
    pair_numbers = []
    for block in mesh.blocks:
        nodes = block.connectivity.astype(np.int64)  # the square of the number of nodes must fit
        pair_numbers.append((nodes[:, :, None] * number_of_nodes + nodes[:, None, :]).ravel())
    pairs = np.concatenate(pair_numbers)
    order = np.argsort(pairs, kind="stable")
    ordered = pairs[order]
    starts = np.flatnonzero(np.concatenate([[True], ordered[1:] != ordered[:-1]]))
    distinct = ordered[starts]
    columns = distinct % number_of_nodes
    row_starts = np.searchsorted(distinct, np.arange(number_of_nodes + 1) * number_of_nodes)

    def summed(chunks: Sequence[Floats]) -> Floats:
        entries = np.concatenate([chunk.ravel() for chunk in chunks])
        return np.asarray(np.add.reduceat(entries[order], starts))

    def matrix(blocks: Floats) -> csr_array:
        size = number_of_nodes * blocks.shape[1]
        return bsr_array((blocks, columns, row_starts), shape=(size, size)).tocsr()

    return summed, matrix


def node_adjacency(mesh: Mesh) -> csr_array:
    """Return the pattern of nodes that share an element, as a sparse matrix (nodes, nodes)."""
    summed, matrix = pair_assembly(mesh)
    ones = []
    for block in mesh.blocks:
        elements, nodes = block.connectivity.shape
        ones.append(np.ones((elements, nodes, nodes)))
    return matrix(summed(ones)[:, None, None])


def isotropic(product: Floats, lame: float, mu: float) -> Floats:
    """Return the stiffness blocks of pairs of nodes of an isotropic material.

    Parameters
    ----------
    product : array, shape (d, d, pairs)
        G_ij, the integrals of dN_a/dx_i dN_b/dx_j, with the axes i and j first.
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
