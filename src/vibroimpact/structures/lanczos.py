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

_BLOCK = 10
TOLERANCE = 1e-9
"""Residual of a mode relative to its static response; the relative error of the
eigenvalue is the square of it.
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
    values, vectors = np.zeros(0), np.zeros((mass.shape[0], 0))
    random = np.random.default_rng(1)
    wanted = number
    while True:
        krylov = _Krylov(respond, mass, vectors, random)
        enough = wanted
        while not krylov.exhausted:
            if krylov.size >= enough:
                if krylov.converged(tolerance) >= wanted:
                    break
                enough = int(_GROWTH * krylov.size)
            if krylov.size > _MAX_SPACE * (wanted + _BLOCK):
                raise ComputationError(
                    f"the {number} lowest modes could not be found: the iteration does not converge"
                )
            krylov.grow()
            progress(min(0.99, krylov.size / (2.5 * number + 6.0 * _BLOCK)))
        found, shapes = krylov.modes(wanted)
        order = np.argsort(np.concatenate([values, found]))[:number]
        values, vectors = (
            np.concatenate([values, found])[order],
            np.concatenate([vectors, shapes], axis=1)[:, order],
        )
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
        self._respond, self._mass = respond, mass
        self._known, self._known_momenta = known, mass @ known
        # storage of the vectors and of their products with M, enlarged when full
        self._room = [np.empty((mass.shape[0], 4 * _BLOCK), order="F") for _ in range(2)]
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
        return self._room[0][:, : self.size]

    @property
    def _momenta(self) -> Floats:
        return self._room[1][:, : self.size]

    def grow(self) -> None:
        """Add the orthonormalised response to the last block."""
        if self.exhausted:
            return
        columns = slice(self.size - self._width, self.size)
        response, coefficients = self._orthogonalised(self._respond(self._momenta[:, columns]))
        size = self.size
        projected = np.zeros((size, size))
        projected[: columns.start, : columns.start] = self._projected[
            : columns.start, : columns.start
        ]
        projected[:, columns] = coefficients
        projected[columns] = coefficients.T
        self._projected = projected
        self._add(response)

    def modes(self, number: int) -> tuple[Floats, Floats]:
        """Return the lowest Ritz values of the space, ascending, and their vectors."""
        from scipy.linalg import eigh  # imported late: modes that are stored do not need it

        size = len(self._projected)
        responses, turned = eigh(self._projected, subset_by_index=[max(0, size - number), size - 1])
        return 1.0 / responses[::-1], self._vectors[:, :size] @ turned[:, ::-1]

    def converged(self, tolerance: float) -> int:
        """Return the number of lowest modes that have converged, without a gap."""
        from scipy.linalg import eigh

        size = len(self._projected)
        if not size:
            return 0
        responses, turned = eigh(self._projected)
        left = np.linalg.norm(self._last @ turned[size - self._last.shape[1] :], axis=0)
        unconverged = (left > tolerance * np.abs(responses))[::-1]
        return int(unconverged.argmax()) if unconverged.any() else int(size)

    def _orthogonalised(self, block: Floats) -> tuple[Floats, Floats]:
        """Return a block orthogonalised against the space and the known modes, and its
        coefficients in the space.
        """
        total = np.zeros((self.size, block.shape[1]))
        for _ in range(2):  # twice, against rounding
            block = block - self._known @ (self._known_momenta.T @ block)
            coefficients = self._momenta.T @ block
            block = block - self._vectors @ coefficients
            total += coefficients
        return block, total

    def _add(self, block: Floats) -> None:
        """Add a block to the space, orthonormal in M and without dependent directions."""
        momenta = self._mass @ block
        squares, turned = np.linalg.eigh(block.T @ momenta)
        keep = squares > _DEPENDENT * max(squares[-1], 1e-300)
        scale = turned[:, keep] / np.sqrt(squares[keep])
        self._last = (turned[:, keep] * np.sqrt(squares[keep])).T
        self._width = int(keep.sum())
        self.exhausted = not self._width
        end = self.size + self._width
        for index, more in enumerate((block @ scale, momenta @ scale)):
            if end > self._room[index].shape[1]:
                larger = np.empty((len(block), 2 * end), order="F")
                larger[:, : self.size] = self._room[index][:, : self.size]
                self._room[index] = larger
            self._room[index][:, self.size : end] = more
        self.size = end
