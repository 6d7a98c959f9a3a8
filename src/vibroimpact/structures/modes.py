"""Undamped modes of a held or free structure, by shift-invert Lanczos, its rigid motions kept apart; and static response."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import qr
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.structures.factor import BYTES, Factors, check_room
from vibroimpact.structures.lanczos import TOLERANCE, lowest_modes

_DENSE = 400  # degrees of freedom up to which a dense solver is quicker
_SPACE = 3.0  # vectors that the iteration keeps, and as many of their momenta, for each mode
_MOST = 0.4  # of the degrees of freedom: more modes than this of a mesh mean nothing, and Lanczos' method gains nothing
_CARRIED = 1e-3  # of a load: how much of it may be left when the stiffness is far from singular
_INVERSE_STEPS = 4
_ROUNDING = 2e-15  # of the highest frequency squared: a lowest one below this is none

Progress = Callable[[float], None]


@dataclass(frozen=True)
class Eigenmodes:
    """Angular frequencies and shapes.

    Parameters
    ----------
    angular_frequencies : array, shape (modes,)
        [rad/s], ascending.
    shapes : array, shape (dofs, modes)
        One column a mode, of unit modal mass [kg^-1/2].
    """

    angular_frequencies: Floats
    shapes: Floats


class Elastic:
    """What an elastic system does at low frequencies: its statics, once factorised, and from them its modes.

    Parameters
    ----------
    stiffness, mass : sparse arrays, shape (n, n)
        Symmetric.
    rigid : array, shape (n, r), optional
        The rigid motions, which the stiffness does not resist.
    order : int array, shape (n,), optional
        An elimination order.

    Raises
    ------
    ComputationError
        If the system can move without resistance otherwise than by its rigid motions.

    Notes
    -----
    A system that is free has no inverse. Held still at as many degrees of freedom as it has rigid motions, it has one, and
    loads that the inertia of a rigid acceleration balances are carried without reactions there, wherever they are. So the
    modes of a free body come out exactly orthogonal to its rigid motions, and no shift has to be guessed.

    Examples
    --------
    >>> chain = csr_array(np.diag([1.0, 2.0, 1.0]) - np.eye(3, k=1) - np.eye(3, k=-1))
    >>> modes = Elastic(chain, csr_array(np.eye(3)), np.ones((3, 1))).modes(2)
    >>> (modes.angular_frequencies**2).round(12).tolist()
    [1.0, 3.0]
    """

    def __init__(self, stiffness: csr_array, mass: csr_array, rigid: Floats | None = None, order: Integers | None = None) -> None:
        number = stiffness.shape[0]
        self.stiffness, self.mass = stiffness, mass
        self.order = np.arange(number) if order is None else order
        motions = np.zeros((number, 0)) if rigid is None else rigid
        if motions.shape[1]:
            lower = np.linalg.cholesky(motions.T @ (mass @ motions))
            motions = np.asarray(np.linalg.solve(lower, motions.T).T, dtype=np.float64)
        self.rigid = motions
        """The rigid motions, of unit modal mass."""
        self._momentum = mass @ motions
        held = qr(motions.T, pivoting=True, mode="r")[1][: motions.shape[1]] if motions.shape[1] else np.zeros(0, dtype=int)
        self._free = np.setdiff1d(np.arange(number), held)
        place = np.full(number, -1)
        place[self._free] = np.arange(len(self._free))
        inner = place[self.order]
        matrix = stiffness[self._free][:, self._free] if len(held) else stiffness
        self._factors = Factors(csr_array(matrix), inner[inner >= 0])
        self._heavy = mass.diagonal() > 0.0  # not so the slopes of a thin plate
        self._refuse_mechanisms()

    @property
    def size(self) -> float:
        """About how many bytes it takes."""
        return self._factors.size + BYTES * float(self.stiffness.nnz + self.mass.nnz)

    def static(self, load: Floats) -> Floats:
        """Return the static response to loads, shape (n,) or (n, loads).

        Where the system is free the load is balanced by the inertia of the rigid acceleration that it causes, and the
        response has no rigid part.
        """
        balanced = load - self._momentum @ (self.rigid.T @ load)
        response = np.zeros_like(balanced)
        response[self._free] = self._factors.solve(balanced[self._free])
        return np.asarray(response - self.rigid @ (self._momentum.T @ response))

    def modes(self, number: int, progress: Progress | None = None, tolerance: float = TOLERANCE) -> Eigenmodes:
        """Return the lowest modes, rigid motions left out.

        Parameters
        ----------
        number : int
            How many, >= 1.
        progress : callable, optional
            Called with a number from 0 to 1 that estimates how much is done.
        tolerance : float, optional
            Residual that is left of the shapes; the frequencies are off by its square.

        Raises
        ------
        InputError
            If the mesh has not so many.
        ComputationError
            If the iteration does not converge.
        """
        size, most = self.stiffness.shape[0], most_modes(self.mass, self.rigid.shape[1])
        if not 1 <= number <= most:
            raise InputError(
                f"{number} modes are not to be had from {size} degrees of freedom; it must be from 1 to {most}"
                + ("" if number < 1 else ", or the elements smaller")
            )
        if size <= _DENSE:
            return self._dense(number)
        check_room(16.0 * size * _SPACE * number, f"{number} modes of {size} degrees of freedom need")
        values, shapes = lowest_modes(self.static, self.mass, number, progress or (lambda part: None), tolerance)
        return Eigenmodes(np.sqrt(values), shapes)

    def count_below(self, angular_frequency: float) -> int:
        """Return how many modes lie below an angular frequency [rad/s], rigid motions left out, without computing them."""
        shifted = self.stiffness - angular_frequency**2 * self.mass
        return int(Factors(csr_array(shifted), self.order).negative_pivots()) - int(self.rigid.shape[1])

    def _refuse_mechanisms(self) -> None:
        """Raise if loads are not carried, and the lowest frequency, found by inverse iteration, is no more than rounding."""
        shape = np.random.default_rng(0).standard_normal(self.stiffness.shape[0])
        load = self.mass @ shape
        left = self.stiffness @ self.static(load) - load + self._momentum @ (self.rigid.T @ load)
        if np.linalg.norm(left) <= _CARRIED * np.linalg.norm(load):
            return
        highest = (self.stiffness.diagonal()[self._heavy] / self.mass.diagonal()[self._heavy]).max()
        for _ in range(_INVERSE_STEPS):
            shape = self.static(self.mass @ shape)
            shape /= np.sqrt(shape @ (self.mass @ shape))
        if not shape @ (self.stiffness @ shape) > _ROUNDING * highest:
            raise ComputationError(
                "the stiffness matrix is singular: part of the body can move without resistance, as a hinge does; "
                "look for elements that share only an edge or a node"
            )

    def _dense(self, number: int) -> Eigenmodes:
        """Solve in full; the mass may be singular, as that of a thin plate is, and so may the stiffness, but not both."""
        inertia, axes = np.linalg.eigh(self.mass.toarray())
        root = axes * np.sqrt(np.maximum(inertia, 0.0))
        response = self.static(root)
        responses, turned = np.linalg.eigh(root.T @ response)
        lowest = slice(-1, -number - 1, -1)
        return Eigenmodes(1.0 / np.sqrt(responses[lowest]), response @ (turned[:, lowest] / responses[lowest]))


def most_modes(mass: csr_array, rigid: int) -> int:
    """Return how many modes of a system mean anything, of which so many motions are rigid."""
    most = int(np.count_nonzero(mass.diagonal() > 0.0)) - rigid
    return most if mass.shape[0] <= _DENSE else int(_MOST * most)
