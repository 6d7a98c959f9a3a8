"""Undamped elastic modes and static response of a held or free structure.

They follow from the factorised stiffness, the modes by Lanczos iteration.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.structures.finite_elements.factor import BYTES_PER_ENTRY, Factors
from vibroimpact.structures.finite_elements.free_memory import check_memory
from vibroimpact.structures.lanczos import TOLERANCE, lowest_modes

_DENSE = 400  # degrees of freedom up to which a dense eigenvalue solver is faster
_SPACE = 3.0  # vectors of the iteration per mode, each stored with its product with the mass
# of the degrees of freedom: higher modes of a mesh are meaningless, and Lanczos iteration has no
# advantage
_MOST = 0.4
# relative residual of a static solution below which the stiffness is far from singular
_CARRIED = 1e-3
_INVERSE_STEPS = 4
_ROUNDING = 2e-15  # of the highest squared frequency: a lowest one below this is zero

Progress = Callable[[float], None]
"""Called with the estimated progress, from 0 to 1."""


@dataclass(frozen=True)
class Eigenmodes:
    """Angular frequencies and mode shapes.

    Parameters
    ----------
    angular_frequencies : array, shape (modes,)
        [rad/s], ascending.
    shapes : array, shape (dofs, modes)
        One column per mode, of unit modal mass [kg^-1/2].
    """

    angular_frequencies: Floats
    shapes: Floats


class ElasticSystem:
    """Statics and modes of an undamped elastic system, from one factorisation of its stiffness.

    Parameters
    ----------
    stiffness, mass : sparse arrays, shape (n, n)
        Symmetric matrices.
    rigid : array, shape (n, r), optional
        Rigid motions, a basis of the null space of the stiffness.
    order : int array, shape (n,), optional
        Elimination order of the factorisation.

    Raises
    ------
    ComputationError
        If the stiffness is singular beyond the rigid motions: the system has a mechanism.

    Notes
    -----
    The stiffness of a free system is singular. Constrained at as many degrees of freedom as it has
    rigid motions, it is not, and loads balanced by the inertia of the rigid acceleration cause no
    reactions there. Modes of a free body are therefore exactly orthogonal to its rigid motions, and
    no shift has to be chosen.

    Examples
    --------
    >>> chain = csr_array(np.diag([1.0, 2.0, 1.0]) - np.eye(3, k=1) - np.eye(3, k=-1))
    >>> modes = ElasticSystem(chain, csr_array(np.eye(3)), np.ones((3, 1))).modes(2)
    >>> (modes.angular_frequencies**2).round(12).tolist()
    [1.0, 3.0]
    """

    def __init__(
        self,
        stiffness: csr_array,
        mass: csr_array,
        rigid: Floats | None = None,
        order: Integers | None = None,
    ) -> None:
        size = stiffness.shape[0]
        if rigid is None:
            rigid = np.zeros((size, 0))
        self.stiffness = stiffness
        self.mass = mass
        self.order = np.arange(size) if order is None else order
        self.rigid = of_unit_mass(rigid, mass)
        """Rigid motions of unit modal mass."""
        self._momentum = mass @ self.rigid
        constrained = _constrained_dofs(self.rigid)
        self._free = np.setdiff1d(np.arange(size), constrained)
        free_number = np.full(size, -1)
        free_number[self._free] = np.arange(len(self._free))
        free_order = free_number[self.order]
        matrix = stiffness
        if len(constrained):
            matrix = stiffness[self._free][:, self._free]
        self._factors = Factors(csr_array(matrix), free_order[free_order >= 0])
        self._heavy = mass.diagonal() > 0.0  # the slopes of a thin plate have no inertia
        self._refuse_mechanisms()

    @property
    def size(self) -> float:
        """Approximate memory [bytes]."""
        return self._factors.size + BYTES_PER_ENTRY * float(self.stiffness.nnz + self.mass.nnz)

    def static(self, load: Floats) -> Floats:
        """Return the static response to loads, shape (n,) or (n, loads).

        In a free system the load is balanced by the inertia of the rigid acceleration (inertia
        relief), and the response has no rigid component.
        """
        # f - M R R^T f: the inertia of the rigid acceleration R R^T f is taken away
        balanced = load - self._momentum @ (self.rigid.T @ load)
        response = np.zeros_like(balanced)
        response[self._free] = self._factors.solve(balanced[self._free])
        return np.asarray(response - self.rigid @ (self._momentum.T @ response))

    def modes(
        self, number: int, progress: Progress | None = None, tolerance: float = TOLERANCE
    ) -> Eigenmodes:
        """Return the lowest elastic modes, without rigid motions.

        Parameters
        ----------
        number : int
            Number of modes, >= 1.
        progress : callable, optional
            Called with the estimated progress, from 0 to 1.
        tolerance : float, optional
            Relative residual of the shapes; the relative error of the frequencies is its square.

        Raises
        ------
        InputError
            If the mesh does not have as many, or the memory does not suffice.
        ComputationError
            If the iteration does not converge.
        """
        size = self.stiffness.shape[0]
        most = max_modes(self.mass, self.rigid.shape[1])
        if not 1 <= number <= most:
            remedies = []
            if most > 0:
                remedies.append(f"ask for 1 to {most}")
            if number > most:
                remedies.append("use smaller elements")
            raise InputError(
                f"{number} modes are not to be had from {size} degrees of freedom; "
                f"{' or '.join(remedies)}"
            )
        if size <= _DENSE:
            return self._dense(number)
        check_memory(
            16.0 * size * _SPACE * number, f"{number} modes of {size} degrees of freedom need"
        )
        values, shapes = lowest_modes(
            self.static, self.mass, number, progress or (lambda part: None), tolerance
        )
        return Eigenmodes(np.sqrt(values), shapes)

    def count_below(self, angular_frequency: float) -> int:
        """Return the number of elastic modes below an angular frequency [rad/s].

        It follows from the signs of the pivots.
        """
        shifted = self.stiffness - angular_frequency**2 * self.mass
        factors = Factors(csr_array(shifted), self.order)
        return int(factors.negative_pivots()) - int(self.rigid.shape[1])

    def _refuse_mechanisms(self) -> None:
        """Raise if part of the system can move without resistance.

        Then a static solution has a large residual, and the lowest frequency, by inverse iteration,
        is zero up to rounding.
        """
        shape = np.random.default_rng(0).standard_normal(self.stiffness.shape[0])
        load = self.mass @ shape
        rigid_load = self._momentum @ (self.rigid.T @ load)
        residual = self.stiffness @ self.static(load) - load + rigid_load
        if np.linalg.norm(residual) <= _CARRIED * np.linalg.norm(load):
            return
        squared_frequencies = (
            self.stiffness.diagonal()[self._heavy] / self.mass.diagonal()[self._heavy]
        )
        for _ in range(_INVERSE_STEPS):
            shape = self.static(self.mass @ shape)
            shape /= np.sqrt(shape @ (self.mass @ shape))
        lowest = shape @ (self.stiffness @ shape)
        if not lowest > _ROUNDING * squared_frequencies.max():
            raise ComputationError(
                "the stiffness matrix is singular: part of the body can move without "
                "resistance, as a hinge does, or all of it can on "
                "springs that are next to none; look for such springs, for elements that "
                "share only an edge or a node, or for equations "
                "between nodes that lie apart: replace these by *TIE, or by one RBE2 of all "
                "the nodes, which turn with the body"
            )

    def _dense(self, number: int) -> Eigenmodes:
        """Return the lowest modes by a dense solver.

        The mass may be singular, as that of a thin plate, or the stiffness, but not both.
        """
        masses, axes = np.linalg.eigh(self.mass.toarray())
        # M = root root^T, and root^T K^-1 root has the inverse squared frequencies as eigenvalues
        root = axes * np.sqrt(np.maximum(masses, 0.0))
        response = self.static(root)
        responses, coefficients = np.linalg.eigh(root.T @ response)
        lowest = slice(-1, -number - 1, -1)
        return Eigenmodes(
            1.0 / np.sqrt(responses[lowest]),
            response @ (coefficients[:, lowest] / responses[lowest]),
        )


def of_unit_mass(motions: Floats, mass: csr_array) -> Floats:
    """Return a basis of motions, (n, r), that is orthonormal with respect to the mass."""
    if not motions.shape[1]:
        return motions
    lower = np.linalg.cholesky(motions.T @ (mass @ motions))
    return np.asarray(np.linalg.solve(lower, motions.T).T, dtype=np.float64)


def _constrained_dofs(rigid: Floats) -> Integers:
    """Return as many degrees of freedom as there are rigid motions, which prevent these."""
    from scipy.linalg import qr  # imported late: modes that are stored do not need it

    if not rigid.shape[1]:
        return np.zeros(0, dtype=int)
    _, pivots = qr(rigid.T, pivoting=True, mode="r")
    return np.asarray(pivots[: rigid.shape[1]])


def max_modes(mass: csr_array, rigid: int) -> int:
    """Return the largest number of elastic modes that may be computed of a system.

    `rigid` is its number of rigid motions.
    """
    most = int(np.count_nonzero(mass.diagonal() > 0.0)) - rigid
    if mass.shape[0] <= _DENSE:
        return most
    return int(_MOST * most)
