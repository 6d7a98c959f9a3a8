"""Model reduction: Craig-Bampton and residual attachment bases, and projection on a basis."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.mirrored import MirroredSystem
from vibroimpact.structures.modes import Eigenmodes, ElasticSystem, Progress

_RIGID = 1e-6  # of the norm of a column: below, the elastic part of it is rounding
# of the largest eigenvalue of the Gram matrix: smaller ones are dependent columns
_DEPENDENT = 1e-10


def craig_bampton(
    stiffness: csr_array,
    mass: csr_array,
    interface: Sequence[int] | Integers,
    number: int,
    order: Integers | None = None,
    rigid: Floats | None = None,
    progress: Progress | None = None,
) -> Floats:
    r"""Return the Craig-Bampton basis: constraint modes and fixed-interface modes.

    Parameters
    ----------
    stiffness, mass : sparse arrays, shape (n, n)
        Of the free degrees of freedom.
    interface : sequence of int
        Degrees of freedom of the interface.
    number : int
        Number of fixed-interface modes, >= 0.
    order : int array, shape (n,), optional
        Elimination order.
    rigid : array, shape (n, r), optional
        Rigid motions; those that a fixed interface permits are the rigid motions of the interior.
    progress : callable, optional
        As in `ElasticSystem.modes`.

    Returns
    -------
    array, shape (n, interface + number)
        :math:`[\Psi, \Phi]` with :math:`\Psi = [I; -K_{ii}^{-1} K_{ib}]`, one static shape for a
        unit displacement of each interface degree of freedom, and :math:`\Phi` the lowest
        eigenvectors of the interior.

    Raises
    ------
    InputError
        If the interface is empty, or the interior has fewer modes.

    Notes
    -----
    R. R. Craig and M. C. C. Bampton, AIAA J. 6:1313, 1968. The static response to loads on the
    interface is exact.

    Examples
    --------
    >>> chain = csr_array(np.diag([2.0, 2.0, 1.0]) - np.eye(3, k=1) - np.eye(3, k=-1))
    >>> craig_bampton(chain, csr_array(np.eye(3)), [2], 0).ravel().round(6).tolist()
    [0.333333, 0.666667, 1.0]
    """
    size = stiffness.shape[0]
    if order is None:
        order = np.arange(size)
    boundary = np.unique(np.asarray(interface, dtype=np.int64))
    if not len(boundary):
        raise InputError(
            "Craig and Bampton's reduction needs at least one interface degree of freedom"
        )
    inside = np.setdiff1d(np.arange(size), boundary)
    number_inside = np.full(size, -1)
    number_inside[inside] = np.arange(len(inside))
    inside_order = number_inside[order]
    permitted = _rigid_with_fixed(rigid, boundary)
    if permitted is not None:
        permitted = permitted[inside]
    interior = ElasticSystem(
        stiffness[inside][:, inside],
        mass[inside][:, inside],
        permitted,
        inside_order[inside_order >= 0],
    )
    # constraint modes, of unit displacements of the interface: -K_ii^-1 K_ib; then fixed-interface
    # normal modes
    basis = np.zeros((size, len(boundary) + number))
    basis[boundary, np.arange(len(boundary))] = 1.0
    coupling = stiffness[inside][:, boundary].toarray()
    basis[inside, : len(boundary)] = -interior.static(coupling)
    if number:
        basis[inside, len(boundary) :] = interior.modes(number, progress).shapes
    return basis


def attachment_modes(
    elastic: ElasticSystem | MirroredSystem, modes: Eigenmodes, loads: Floats
) -> Floats:
    """Return the residual attachment modes: the static response that truncated modes lack.

    Parameters
    ----------
    elastic : ElasticSystem or MirroredSystem
        The system.
    modes : Eigenmodes
        Lowest modes of the system.
    loads : array, shape (n, loads)
        Unit loads.

    Notes
    -----
    R. H. MacNeal, Comput. Struct. 1:581, 1971; for a free system the response is that with inertia
    relief.
    """
    # of each mode under a static load: phi^T f/omega^2
    amplitudes = (modes.shapes.T @ loads) / modes.angular_frequencies[:, None] ** 2
    return np.asarray(elastic.static(loads) - modes.shapes @ amplitudes)


def projected(
    stiffness: csr_array, mass: csr_array, basis: Floats, rigid: Floats | None = None
) -> Eigenmodes:
    """Return the modes of a system projected on a basis.

    Parameters
    ----------
    stiffness, mass : sparse arrays, shape (n, n)
        Matrices of the system.
    basis : array, shape (n, m)
        Basis; its columns may be linearly dependent.
    rigid : array, shape (n, r), optional
        Rigid motions of unit modal mass, to which the modes are made orthogonal.

    Returns
    -------
    Eigenmodes
        As many as the basis has independent columns.

    Examples
    --------
    >>> chain = csr_array(np.diag([2.0, 2.0, 1.0]) - np.eye(3, k=1) - np.eye(3, k=-1))
    >>> modes = projected(chain, csr_array(np.eye(3)), np.array([[1.0], [2.0], [3.0]]))
    >>> round(float(modes.angular_frequencies[0] ** 2), 6)  # Rayleigh's quotient
    0.214286
    """
    from scipy.linalg import eigh  # imported late: modes that are stored do not need it

    initial_norms = _norms(basis, mass)
    if rigid is not None and rigid.shape[1]:
        rigid_part = rigid @ (rigid.T @ (mass @ basis))
        basis = basis - rigid_part
    norms = _norms(basis, mass)
    is_elastic = norms > _RIGID * initial_norms  # without columns that are rigid motions
    basis = basis[:, is_elastic] / norms[is_elastic]

    # an orthonormal basis, without dependent columns
    gram_values, directions = eigh(basis.T @ (mass @ basis))
    independent = gram_values > _DEPENDENT * gram_values[-1]
    scales = np.sqrt(gram_values[independent])
    basis = basis @ (directions[:, independent] / scales)

    # Rayleigh and Ritz: K_r c = omega^2 M_r c
    reduced_stiffness = basis.T @ (stiffness @ basis)
    reduced_mass = basis.T @ (mass @ basis)
    squares, coefficients = eigh(reduced_stiffness, reduced_mass)
    frequencies = np.sqrt(np.maximum(squares, 0.0))  # of rounding errors none
    return Eigenmodes(frequencies, basis @ coefficients)


def _norms(basis: Floats, mass: csr_array) -> Floats:
    """Return the norms of the columns of a basis with respect to the mass."""
    return np.asarray(np.sqrt(np.einsum("ij,ij->j", basis, mass @ basis)))


def _rigid_with_fixed(rigid: Floats | None, boundary: Integers) -> Floats | None:
    """Return the rigid motions with a fixed interface, (n, r); None if no motions are given."""
    if rigid is None or not rigid.shape[1]:
        return None
    scaled = rigid / np.abs(rigid).max(axis=0)
    # combinations of the motions that leave the interface at rest: the null space there
    _, singular_values, combinations = np.linalg.svd(scaled[boundary], full_matrices=True)
    least = 1e-9 * max(singular_values.max(initial=0.0), 1e-300)
    rank = int((singular_values > least).sum())
    return np.asarray(scaled @ combinations[rank:].T)
