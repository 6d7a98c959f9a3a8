"""Lowest modes of a system from its static solver: block Lanczos iteration without restarts.

Solving for a block of right-hand sides costs a third of solving for each, as the factors are read
once. A block also resolves multiple eigenvalues, of which a single vector finds one eigenvector
only.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats
from vibroimpact.errors import ComputationError

_BLOCK = 10  # vectors of a block
TOLERANCE = 1e-9
"""Residual of a mode relative to its static response.

The relative error of the eigenvalue is the square of it.
"""

_EQUAL = 1e-6  # relative difference below which eigenvalues count as equal
_GROWTH = 1.05  # of the space between two tests of convergence
_MAX_SPACE = 60  # largest dimension of the space, over the number of modes plus one block
_DEPENDENT = 1e-13  # of the largest squared norm: directions of a block below it are rounding
_CHECK_BLOCKS = 4  # of the iteration that searches for missed modes


def lowest_modes(
    respond: Callable[[Floats], Floats],
    mass: csr_array,
    number: int,
    progress: Callable[[float], None],
    tolerance: float = TOLERANCE,
) -> tuple[Floats, Floats]:
    r"""Return the lowest eigenvalues of K x = lambda M x, and their eigenvectors.

    Parameters
    ----------
    respond : callable
        Static solver, K^-1: from loads (n, loads) to responses.
    mass : sparse array, shape (n, n)
        M, symmetric and positive semidefinite.
    number : int
        Number of modes, much smaller than n.
    progress : callable
        Called with the estimated progress, from 0 to 1.
    tolerance : float
        Residual of each mode relative to its static response.

    Returns
    -------
    values : array, shape (number,)
        Eigenvalues, ascending.
    vectors : array, shape (n, number)
        Eigenvectors, orthonormal with respect to M.

    Raises
    ------
    ComputationError
        If the iteration does not converge.

    Notes
    -----
    Block Lanczos of :math:`K^{-1} M` in the inner product of M, fully reorthogonalised (R. G.
    Grimes, J. G. Lewis and H. D. Simon, SIAM J. Matrix Anal. Appl. 15:228, 1994). When all modes
    have converged, a short iteration from other random vectors, orthogonal to those found, searches
    for missed modes, as eigenvalues may have a higher multiplicity than a block has columns.
    """
    values = np.zeros(0)
    vectors = np.zeros((mass.shape[0], 0))
    random = np.random.default_rng(1)
    wanted = number
    while True:
        krylov = _Krylov(respond, mass, vectors, random)
        next_test = wanted  # size of the space at which convergence is tested
        while not krylov.exhausted:
            if krylov.size >= next_test:
                if krylov.converged(tolerance) >= wanted:
                    break
                next_test = int(_GROWTH * krylov.size)
            if krylov.size > _MAX_SPACE * (wanted + _BLOCK):
                raise ComputationError(
                    f"the {number} lowest modes could not be found: the iteration does not converge"
                )
            krylov.grow()
            # about how large the space will be
            progress(min(0.99, krylov.size / (2.5 * number + 6.0 * _BLOCK)))
        new_values, new_vectors = krylov.modes(wanted)
        values = np.concatenate([values, new_values])
        vectors = np.concatenate([vectors, new_vectors], axis=1)
        lowest = np.argsort(values)[:number]
        values = values[lowest]
        vectors = vectors[:, lowest]

        check = _Krylov(respond, mass, vectors, random)
        for _ in range(_CHECK_BLOCKS):
            check.grow()
        if check.exhausted or check.modes(1)[0][0] > (1.0 - _EQUAL) * values[-1]:
            progress(1.0)
            return values, vectors
        wanted = 1  # of the modes that were missed, and then another check


class _Krylov:
    """A block Krylov space in the M-orthogonal complement of known modes."""

    def __init__(
        self,
        respond: Callable[[Floats], Floats],
        mass: csr_array,
        known: Floats,
        random: np.random.Generator,
    ) -> None:
        self._respond = respond
        self._mass = mass
        self._known = known
        self._known_momenta = mass @ known
        # vectors of the space and their products with M, with room for more columns
        self._vector_storage = np.empty((mass.shape[0], 4 * _BLOCK), order="F")
        self._momentum_storage = np.empty((mass.shape[0], 4 * _BLOCK), order="F")
        self.size = 0
        """Dimension of the space."""
        self._projected = np.zeros((0, 0))  # K^-1 M on the space
        self._last = np.zeros((0, 0))  # coefficients of the last response in the newest block
        self.exhausted = False
        """Whether the space is invariant, so that it cannot grow."""
        start = respond(mass @ random.standard_normal((mass.shape[0], _BLOCK)))
        self._add(self._orthogonalised(start)[0])

    @property
    def _vectors(self) -> Floats:
        """The basis of the space, orthonormal in M."""
        return self._vector_storage[:, : self.size]

    @property
    def _momenta(self) -> Floats:
        """Products of the basis with M."""
        return self._momentum_storage[:, : self.size]

    def grow(self) -> None:
        """Add the orthonormalised response to the last block."""
        if self.exhausted:
            return
        last_block = slice(self.size - self._width, self.size)
        earlier = slice(0, self.size - self._width)
        response, coefficients = self._orthogonalised(self._respond(self._momenta[:, last_block]))
        projected = np.zeros((self.size, self.size))
        projected[earlier, earlier] = self._projected[earlier, earlier]
        projected[:, last_block] = coefficients
        projected[last_block] = coefficients.T
        self._projected = projected
        self._add(response)

    def modes(self, number: int) -> tuple[Floats, Floats]:
        """Return the lowest Ritz values of the space, ascending, and their vectors."""
        from scipy.linalg import eigh  # imported late: modes that are stored do not need it

        size = len(self._projected)
        # eigenvalues of K^-1 M: the largest are those of the lowest modes
        responses, coefficients = eigh(
            self._projected, subset_by_index=[max(0, size - number), size - 1]
        )
        return 1.0 / responses[::-1], self._vectors[:, :size] @ coefficients[:, ::-1]

    def converged(self, tolerance: float) -> int:
        """Return the number of lowest modes that have converged, without a gap."""
        from scipy.linalg import eigh

        size = len(self._projected)
        if not size:
            return 0
        responses, coefficients = eigh(self._projected)
        # what the newest block, which is not yet in the projection, adds to each response
        residuals = np.linalg.norm(self._last @ coefficients[size - self._last.shape[1] :], axis=0)
        unconverged = (residuals > tolerance * np.abs(responses))[::-1]
        if not unconverged.any():
            return int(size)
        return int(unconverged.argmax())

    def _orthogonalised(self, block: Floats) -> tuple[Floats, Floats]:
        """Return a block orthogonalised against the space and the known modes.

        Its coefficients in the space are returned too.
        """
        # classical Gram-Schmidt in the inner product of M
        total = np.zeros((self.size, block.shape[1]))
        for _ in range(2):  # twice, against rounding
            block = block - self._known @ (self._known_momenta.T @ block)
            coefficients = self._momenta.T @ block
            block = block - self._vectors @ coefficients
            total += coefficients
        return block, total

    def _add(self, block: Floats) -> None:
        """Add a block to the space, orthonormal in M and without dependent directions."""
        # orthonormal by the eigenvectors of the Gram matrix B^T M B
        momenta = self._mass @ block
        squares, directions = np.linalg.eigh(block.T @ momenta)
        independent = squares > _DEPENDENT * max(squares[-1], 1e-300)
        norms = np.sqrt(squares[independent])
        scaled_directions = directions[:, independent] / norms
        self._last = (directions[:, independent] * norms).T
        self._width = int(independent.sum())
        self.exhausted = not self._width
        new_size = self.size + self._width
        self._vector_storage = self._with_room(self._vector_storage, new_size)
        self._momentum_storage = self._with_room(self._momentum_storage, new_size)
        self._vector_storage[:, self.size : new_size] = block @ scaled_directions
        self._momentum_storage[:, self.size : new_size] = momenta @ scaled_directions
        self.size = new_size

    def _with_room(self, storage: Floats, columns: int) -> Floats:
        """Return a storage of at least so many columns, with the present ones."""
        if columns <= storage.shape[1]:
            return storage
        larger = np.empty((len(storage), 2 * columns), order="F")
        larger[:, : self.size] = storage[:, : self.size]
        return larger
