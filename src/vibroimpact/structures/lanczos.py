"""The modes that respond most to a static solver: block Lanczos iteration without restarts.

A block of right sides costs a third of as many single ones, as the factors are read once for all of them; and a block sees
equal modes, to which a single vector is blind.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats
from vibroimpact.errors import ComputationError

_BLOCK = 10
TOLERANCE = 1e-9
"""Of a mode's own response: the residual that is left of it. The eigenvalue is off by the square of that."""

_EQUAL = 1e-6  # relative: eigenvalues so near are those of one multiple mode
_PATIENCE = 1.05  # how much longer it is made before it is asked again
_LONGEST = 60  # how many times as long as the number of modes the iteration may become
_DEPENDENT = 1e-13  # of the largest: a direction of a block that is smaller adds nothing but rounding
_LOOK = 4  # blocks of the search for what was missed


def lowest_modes(
    respond: Callable[[Floats], Floats], mass: csr_array, number: int, progress: Callable[[float], None], tolerance: float = TOLERANCE
) -> tuple[Floats, Floats]:
    r"""Return the lowest eigenvalues of K x = lambda M x, and their vectors.

    Parameters
    ----------
    respond : callable
        From loads (n, loads) to static responses, K^-1.
    mass : sparse array, shape (n, n)
        M, symmetric and not negative.
    number : int
        How many, much fewer than n.
    progress : callable
        Called with a number from 0 to 1.
    tolerance : float
        Residual that is left of each mode's response, as a part of it.

    Returns
    -------
    values : array, shape (number,)
        Ascending.
    vectors : array, shape (n, number)
        Orthonormal in M.

    Raises
    ------
    ComputationError
        If the iteration does not converge.

    Notes
    -----
    Block Lanczos of :math:`K^{-1} M` in the inner product of M, fully reorthogonalised (R. G. Grimes, J. G. Lewis and H. D.
    Simon, SIAM J. Matrix Anal. Appl. 15:228, 1994). When all have converged, a short iteration from other random vectors,
    orthogonal to those found, looks for modes that were missed: more equal ones than a block has columns.
    """
    values, vectors = np.zeros(0), np.zeros((mass.shape[0], 0))
    random = np.random.default_rng(1)
    wanted = number
    while True:
        krylov = _Krylov(respond, mass, vectors, random)
        enough = wanted
        while not krylov.whole:
            if krylov.size >= enough:
                if krylov.converged(tolerance) >= wanted:
                    break
                enough = int(_PATIENCE * krylov.size)
            if krylov.size > _LONGEST * (wanted + _BLOCK):
                raise ComputationError(f"the {number} lowest modes could not be found: the iteration does not converge")
            krylov.grow()
            progress(min(0.99, krylov.size / (2.5 * number + 6.0 * _BLOCK)))
        found, shapes = krylov.modes(wanted)
        order = np.argsort(np.concatenate([values, found]))[:number]
        values, vectors = np.concatenate([values, found])[order], np.concatenate([vectors, shapes], axis=1)[:, order]
        look = _Krylov(respond, mass, vectors, random)
        for _ in range(_LOOK):
            look.grow()
        if look.whole or look.modes(1)[0][0] > (1.0 - _EQUAL) * values[-1]:
            progress(1.0)
            return values, vectors
        wanted = 1


class _Krylov:
    """A Krylov space of blocks, beside modes that are known already."""

    def __init__(self, respond: Callable[[Floats], Floats], mass: csr_array, known: Floats, random: np.random.Generator) -> None:
        self._respond, self._mass = respond, mass
        self._known, self._known_momenta = known, mass @ known
        self._room = [np.empty((mass.shape[0], 4 * _BLOCK), order="F") for _ in range(2)]  # for vectors, and for their momenta
        self.size = 0
        """How many dimensions the space has."""
        self._projected = np.zeros((0, 0))  # of the response to the space's own loads
        self._last = np.zeros((0, 0))  # what the last response has beside the space
        self.whole = False
        start = respond(mass @ random.standard_normal((mass.shape[0], _BLOCK)))
        self._add(self._cleaned(start)[0])

    @property
    def _vectors(self) -> Floats:
        return self._room[0][:, : self.size]

    @property
    def _momenta(self) -> Floats:
        return self._room[1][:, : self.size]

    def grow(self) -> None:
        """Add the responses to the last block."""
        if self.whole:
            return
        columns = slice(self.size - self._width, self.size)
        response, coefficients = self._cleaned(self._respond(self._momenta[:, columns]))
        size = self.size
        projected = np.zeros((size, size))
        projected[: columns.start, : columns.start] = self._projected[: columns.start, : columns.start]
        projected[:, columns] = coefficients
        projected[columns] = coefficients.T
        self._projected = projected
        self._add(response)

    def modes(self, number: int) -> tuple[Floats, Floats]:
        """Return the lowest eigenvalues in the space, ascending, and their vectors."""
        size = len(self._projected)
        responses, turned = eigh(self._projected, subset_by_index=[max(0, size - number), size - 1])
        return 1.0 / responses[::-1], self._vectors[:, :size] @ turned[:, ::-1]

    def converged(self, tolerance: float) -> int:
        """Return how many of the lowest modes have converged."""
        size = len(self._projected)
        if not size:
            return 0
        responses, turned = eigh(self._projected)
        left = np.linalg.norm(self._last @ turned[size - self._last.shape[1] :], axis=0)
        unsettled = (left > tolerance * np.abs(responses))[::-1]
        return int(unsettled.argmax()) if unsettled.any() else int(size)

    def _cleaned(self, block: Floats) -> tuple[Floats, Floats]:
        """Return a block without what it has of the space and of the modes known, and its coefficients in the space."""
        total = np.zeros((self.size, block.shape[1]))
        for _ in range(2):  # once more, for what rounding left
            block = block - self._known @ (self._known_momenta.T @ block)
            coefficients = self._momenta.T @ block
            block = block - self._vectors @ coefficients
            total += coefficients
        return block, total

    def _add(self, block: Floats) -> None:
        momenta = self._mass @ block
        squares, turned = np.linalg.eigh(block.T @ momenta)
        keep = squares > _DEPENDENT * max(squares[-1], 1e-300)
        scale = turned[:, keep] / np.sqrt(squares[keep])
        self._last = (turned[:, keep] * np.sqrt(squares[keep])).T
        self._width = int(keep.sum())
        self.whole = not self._width
        end = self.size + self._width
        for index, more in enumerate((block @ scale, momenta @ scale)):
            if end > self._room[index].shape[1]:
                larger = np.empty((len(block), 2 * end), order="F")
                larger[:, : self.size] = self._room[index][:, : self.size]
                self._room[index] = larger
            self._room[index][:, self.size : end] = more
        self.size = end
