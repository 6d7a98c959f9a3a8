r"""How surfaces at contacts move through a stretch of some length, as the nodes of Radau collocation see what moves there.

Collocation integrates by a matrix Q, and with its eigenvalues :math:`\lambda_k` the modes are seen only through the receptances
between contacts at the complex frequencies :math:`1/\sigma_k`, :math:`\sigma_k = h \lambda_k`,

.. math:: G_{cd}(\sigma) = \sum_i \frac{\chi_{ci} \chi_{di} \sigma^2}{1 + 2 \zeta_i \omega_i \sigma + \omega_i^2 \sigma^2}

so that their number hardly counts. Radau collocation is stable however stiff a mode is: one that is much faster than the stretch
follows the force, and one that is not is integrated with order 2 N - 1. Of rigid motions it is :math:`h^2 Q^2 \sum \chi_c \chi_d`.

All is done for B systems at once that have as many modes. Arrays of the nodes of all c contacts are (B, M), M = c N, those of the modes
(B, m, H), where H counts the eigenvalues, of each conjugate pair one. Products are taken system by system, so that the digits of one do not
depend on which others it is computed with.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.dynamics.collocation import Map, Rule, collocation_rule
from vibroimpact.dynamics.linear_equations import stacked_matvec
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State

NODES = 12
"""More would make the eigenvectors of the integration matrix too ill-conditioned, fewer the stretches too short."""


@dataclass(frozen=True)
class RadauEigenbasis:
    """A collocation rule with the eigenvalues of its integration matrix, of each conjugate pair one (H,).

    `constant`, `time`: a constant of one, and time, in the eigenvectors (H,). `inward` (N, 2 H): to the eigenvectors, real and imaginary
    parts side by side; `outward` (2 H, N) and `filters` (2 H, N N): from there back to the nodes, of values and of what is diagonal there.
    """

    rule: Rule
    values: Complex
    constant: Complex
    time: Complex
    inward: Floats
    outward: Floats
    filters: Floats

    def to_eigenvectors(self, values: Floats) -> Complex:
        """Return values at the nodes (..., N) in the eigenvectors (..., H)."""
        return _rows_matmul(values, self.inward).view(np.complex128)

    def to_nodes(self, values: Complex) -> Floats:
        """Return the same the other way."""
        return _rows_matmul(values.view(np.float64), self.outward)

    def matrices(self, values: Complex) -> Floats:
        """Return the matrices from nodes to nodes (..., N, N) of what is diagonal in the eigenvectors (..., H)."""
        return _rows_matmul(values.view(np.float64), self.filters).reshape(*values.shape[:-1], NODES, NODES)


@cache
def radau_eigenbasis(time_map: Map, root: int) -> RadauEigenbasis:
    """Return the spectrum of a rule."""
    rule = collocation_rule(NODES, time_map, root)
    values, vectors = np.linalg.eig(rule.integral)
    half = np.flatnonzero(values.imag >= 0.0)
    values, paired = values[half].astype(np.complex128), values[half].imag > 0.0
    vectors = np.where(paired, 2.0, 1.0) * vectors[:, half]  # a pair is twice the real part of one
    parts = np.stack([vectors.real, -vectors.imag], axis=2)  # (N, H, 2)
    there = np.stack([np.ones_like(paired), paired], axis=1)
    back = np.zeros((len(half), 2, NODES))
    back[there] = np.linalg.inv(parts[:, there])  # of the real matrix, so that there and back is nothing but rounding
    inverse = back[:, 0] + 1j * back[:, 1]
    filters = (vectors.T[:, :, None] * inverse[:, None, :]).reshape(len(half), -1)
    return RadauEigenbasis(
        rule,
        values,
        np.asarray(inverse.sum(axis=1), dtype=np.complex128),
        np.asarray(inverse @ rule.time, dtype=np.complex128),
        back.reshape(-1, NODES).T.copy(),
        parts.reshape(NODES, -1).T.copy(),
        np.stack([filters.real, -filters.imag], axis=1).reshape(2 * len(half), -1),
    )


class ContactModes:
    """The modes and massless elements of a system as some of its contacts see them.

    `modes`, `rigid`: where the modes and the rigid motions are among the coordinates. `shapes`: of the modes outside the contacts and, if
    any is inside, of those inside (1 or 2, c, m), and `pairs`: the products of these for each two contacts (1 or 2, c, c, m).
    `with_local`: which massless elements are in series with which contacts (c, k), and `local_mobility`: their mobilities there
    [m/(N s)]. `kind`: what has to be the same for systems that are computed together.
    """

    def __init__(self, system: LinearSystem, contacts: Sequence[int]) -> None:
        rows, first = list(contacts), int(system.rigid.sum())
        assert system.rigid[:first].all()  # rigid motions come first
        self.rigid_slice, self.mode_slice = slice(0, first), slice(first, None)
        self.frequency_squared, self.damping = system.angular_frequency[self.mode_slice] ** 2, system.damping[self.mode_slice]
        outer, inner = (part[rows][:, self.mode_slice] for part in (system.outer_shape, system.inner_shape))
        self.inside = bool(inner.any())
        self.shapes = np.stack([outer, inner] if self.inside else [outer])
        self.pairs = np.ascontiguousarray(self.shapes[:, :, None] * self.shapes[:, None])
        self.rate, self.local_incidence = system.rate, system.local_incidence[rows]
        self.local_mobility = self.local_incidence * system.mobility
        self.kind = (system.number, first, len(rows), len(self.rate), self.inside)


class ContactView:
    """A system as some of its contacts see it.

    `of`: its modes, which several systems may share. `rigid`: shapes of its rigid motions (c, r), and `rigid_pairs`: the sums of their
    products [1/kg] (c, c). `gravity` [m/s^2], `offset` [m] and `mass` [kg] (c,): as those of the system. `touched`: which rigid motions
    move the contacts (n,).
    """

    def __init__(self, system: LinearSystem, contacts: Sequence[int], modes: ContactModes) -> None:
        rows = list(contacts)
        self.system, self.contacts, self.modes = system, rows, modes
        self.rigid_shapes = system.shape[rows][:, modes.rigid_slice]
        self.rigid_pairs, self.gravity, self.offset = self.rigid_shapes @ self.rigid_shapes.T, system.gravity[rows], system.offset[rows]
        self.active_rigid = system.rigid_shape[rows].any(axis=0)
        self.mass = system.mass[rows]

    @cached_property
    def without_load(self) -> ContactView:
        """The same without gravity and gaps, as differences between two motions feel it."""
        system = self.system
        return ContactView(replace(system, offset=np.zeros_like(system.offset), load=np.zeros_like(system.load)), self.contacts, self.modes)


def contact_view(system: LinearSystem, contacts: Iterable[int]) -> ContactView:
    """Return a system as some of its contacts see it; made once."""
    numbers = tuple(contacts)
    if numbers not in system.views:
        if numbers not in system.shared_modes:
            system.shared_modes[numbers] = ContactModes(system, numbers)
        system.views[numbers] = ContactView(system, numbers, system.shared_modes[numbers])
    found: ContactView = system.views[numbers]
    return found


class StackedSystems:
    """B systems of one kind, as c of their contacts see them, and their states at the start of a stretch.

    `rigid_pairs` [1/kg] (B, c, c), `gravity` [m/s^2] (B, c). `start`: with a leading axis of B. `displacement`, `velocity`: of the modes
    (B, m). `outer_rate`, `inner_rate`: rates of the surfaces there, outside and inside the contacts, without those of massless elements,
    which are in `begun_rate` [m/s], and `approach` [m] (B, c). What belongs to the modes has a leading axis of B, or of one if they are
    the same.
    """

    def __init__(self, views: Sequence[ContactView], start: Sequence[State]) -> None:
        first, self.views = views[0].modes, views
        self.mode_slice, self.rigid_slice, self.inside = first.mode_slice, first.rigid_slice, first.inside
        distinct = views[:1] if all(one.modes is first for one in views) else views

        def of_modes(name: str) -> Floats:
            return np.array([getattr(one.modes, name) for one in distinct])

        self.frequency_squared, self.damping = of_modes("frequency_squared"), of_modes("damping")
        self.shapes, self.pairs = of_modes("shapes"), of_modes("pairs")
        self.rate, self.local_incidence, self.local_mobility = of_modes("rate"), of_modes("local_incidence"), of_modes("local_mobility")
        self.massless = bool(len(first.rate))
        self.rigid_pairs, self.gravity = np.array([one.rigid_pairs for one in views]), np.array([one.gravity for one in views])
        place, speed = np.array([one.displacement for one in start]), np.array([one.velocity for one in start])
        self.start = State(place, speed, np.array([one.local for one in start]))
        self.displacement, self.velocity = place[:, self.mode_slice], speed[:, self.mode_slice]
        rigid = np.array([one.rigid_shapes for one in views])
        self.outer_rate = stacked_matvec(rigid, speed[:, self.rigid_slice]) + stacked_matvec(self.shapes[:, 0], self.velocity)
        self.inner_rate = stacked_matvec(self.shapes[:, -1], self.velocity) if self.inside else np.zeros_like(self.outer_rate)
        self.begun_rate = self.outer_rate - stacked_matvec(self.local_incidence, self.start.local * self.rate)
        sunk = stacked_matvec(rigid, place[:, self.rigid_slice]) + stacked_matvec(self.shapes.sum(axis=1), self.displacement)
        self.approach = np.array([one.offset for one in views]) + sunk + stacked_matvec(self.local_incidence, self.start.local)

    def impedance(self, sigma: Complex) -> Complex:
        """Return 1 + 2 zeta omega sigma + omega^2 sigma^2 of each mode, for sigma (B, H): (B, m, H)."""
        found = self.frequency_squared[:, :, None] * sigma[:, None]
        found += self.damping[:, :, None]
        found *= sigma[:, None]
        found += 1.0
        return np.asarray(found)

    def drive(self, basis: RadauEigenbasis, length: Floats) -> Complex:
        """Return what drives each mode without contact forces, its motion at the start going on: (B, m, H)."""
        stiffness = self.frequency_squared * self.velocity
        pull = self.damping * self.velocity + self.frequency_squared * self.displacement
        return np.asarray(pull[:, :, None] * -basis.constant - stiffness[:, :, None] * (length[:, None] * basis.time)[:, None])


class Receptance:
    """How the surfaces at c contacts move through stretches of B lengths: without contact forces, and by forces at the N nodes.

    `approach` [m], `rate` outside the contacts and `closing`, that of the whole approach [m/s], (B, M), without contact forces.
    `by_force`, `rate_by`: by how much forces take back the first two, and `by_static`, `closing_by_static` what static ones take back
    besides of the approach and of its rate, (B, M, M); the last two are None where no coordinate lies inside the contacts.
    """

    def __init__(self, systems: StackedSystems, basis: RadauEigenbasis, length: Floats) -> None:
        self.systems, self.basis, self.length = systems, basis, length
        rule = basis.rule
        self.sigma = length[:, None] * basis.values
        sigma = self.sigma[:, None, None]  # (B, 1, 1, H)
        self.admittance = 1.0 / systems.impedance(self.sigma)
        self.responses = systems.drive(basis, length)
        self.responses *= self.admittance
        self.driven = sum_modes(systems.shapes, self.responses)  # (B, 1 or 2, c, H)
        self.moved = sigma * self.driven
        self.massless = 1.0 / (1.0 + systems.rate[:, :, None] * self.sigma[:, None])
        if systems.massless:
            pulled = self.massless * (systems.rate * systems.start.local)[:, :, None]
            self.moved[:, 0] -= basis.constant * sum_modes(systems.local_incidence, pulled)
        whole_moved = sigma[:, 0] * self.moved.sum(axis=1)
        by_modes = basis.to_nodes(np.concatenate([self.moved, whole_moved[:, None]], axis=1))  # (B, 2 or 3, c, N)
        time = (length[:, None] * rule.time)[:, None]
        gravity = systems.gravity[:, :, None] * time
        rate = closing = systems.outer_rate[:, :, None] + gravity + by_modes[:, 0]
        if systems.inside:
            closing = rate + (systems.inner_rate[:, :, None] + by_modes[:, 1])
        whole = (systems.outer_rate + systems.inner_rate)[:, :, None] + 0.5 * gravity
        approach = systems.approach[:, :, None] + time * whole + by_modes[:, -1]
        size = systems.gravity.shape[1] * NODES
        self.rate, self.closing, self.approach = rate.reshape(-1, size), closing.reshape(-1, size), approach.reshape(-1, size)
        self.squares = sum_modes(systems.pairs, self.admittance)  # (B, 1 or 2, c, c, H)
        rates, wide = sigma[:, None] * self.squares, sigma[:, None]
        if systems.massless:
            rates[:, 0] += _on_diagonal(sum_modes(systems.local_mobility, self.massless))
        self.rates = rates[:, 0]
        rates[:, 1:] *= wide
        parts = np.concatenate([wide * rates[:, :1], rates, wide * self.squares[:, 1:]], axis=1)
        found = basis.matrices(parts).transpose(1, 0, 2, 4, 3, 5)  # (2 or 4, B, c, N, c, N)
        rigid, across = systems.rigid_pairs[:, :, None, :, None], length[:, None, None, None, None]
        found[0] += rigid * (across * across) * rule.integral_twice[:, None]
        found[1] += rigid * across * rule.integral[:, None]
        matrices = found.reshape(len(found), -1, size, size)
        self.approach_by_force, self.rate_by_force = matrices[:2]
        self.approach_by_static: Floats | None = matrices[2] if systems.inside else None
        self.closing_by_static: Floats | None = matrices[3] if systems.inside else None

    def by_length(self, force: Floats, static: Floats) -> tuple[Floats, Floats, Floats]:
        """Return how approach, rate and closing rate at the nodes change with the length, under forces there [N]: (B, M) each."""
        systems, basis, rule, values = self.systems, self.basis, self.basis.rule, self.basis.values
        shape, of_each, sigma = force.shape, (len(force), -1, NODES), self.sigma[:, None, None]
        pushed = basis.to_eigenvectors(force.reshape(of_each))  # (B, c, H)
        growth = (
            2.0 * systems.frequency_squared[:, :, None] * self.sigma[:, None] + systems.damping[:, :, None]
        )  # of the impedance with sigma
        softer = growth * self.admittance
        drive = values * softer * self.responses
        softer *= -self.admittance
        drive += (systems.frequency_squared * systems.velocity)[:, :, None] * basis.time * self.admittance
        driven, squares = -sum_modes(systems.shapes, drive), sum_modes(systems.pairs, softer)
        rates = self.squares[:, 0] + sigma * squares[:, 0]
        moved = values * self.driven + sigma * driven
        if systems.massless:
            slower = self.massless**2
            pulled = slower * (systems.rate**2 * systems.start.local)[:, :, None]
            moved[:, 0] += basis.constant * values * sum_modes(systems.local_incidence, pulled)
            rates -= _on_diagonal(sum_modes(systems.local_mobility, slower * systems.rate[:, :, None]))
        across = sigma[:, 0]
        whole = values * self.moved.sum(axis=1) + across * moved.sum(axis=1) - values * _complex_matvec(self.rates + sigma * rates, pushed)
        moved[:, 0] -= values * _complex_matvec(rates, pushed)
        if systems.inside:
            statically = basis.to_eigenvectors(static.reshape(of_each))
            whole -= values * _complex_matvec(2.0 * sigma * self.squares[:, 1] + sigma * sigma * squares[:, 1], statically)
            moved[:, 1] -= values * _complex_matvec(self.squares[:, 1] + sigma * squares[:, 1], statically)
        by_modes = basis.to_nodes(np.concatenate([moved, whole[:, None]], axis=1))
        gravity, long = systems.gravity[:, :, None], self.length[:, None, None]
        speed = (systems.outer_rate + systems.inner_rate)[:, :, None]
        heavy = systems.rigid_pairs @ force.reshape(of_each)
        rate = gravity * rule.time + by_modes[:, 0] - heavy @ rule.integral.T
        approach = rule.time * (speed + gravity * long * rule.time) + by_modes[:, -1] - 2.0 * long * (heavy @ rule.integral_twice.T)
        closing = rate + by_modes[:, 1] if systems.inside else rate
        return approach.reshape(shape), rate.reshape(shape), closing.reshape(shape)


def sum_modes(shapes: Floats, values: Complex) -> Complex:
    """Return modal values (B, m, H) summed with shapes (B or 1, ..., m) as weights, (B, ..., H)."""
    size, number = values.shape[0], values.shape[1]
    rows = shapes.reshape(len(shapes), math.prod(shapes.shape[1:-1]), number)
    return (rows @ values.view(np.float64)).view(np.complex128).reshape(size, *shapes.shape[1:-1], values.shape[2])


def _rows_matmul(values: Floats, matrix: Floats) -> Floats:
    """Return values (B, ..., I) times a matrix (I, J), in one product a system, (B, ..., J)."""
    return (values.reshape(len(values), -1, len(matrix)) @ matrix).reshape(*values.shape[:-1], matrix.shape[1])


def _on_diagonal(values: Complex) -> Complex:
    """Return matrices (B, c, c, H) of values on their diagonals (B, c, H)."""
    return np.asarray(values[:, None] * np.eye(values.shape[1])[:, :, None])


def _complex_matvec(matrices: Complex, values: Complex) -> Complex:
    """Return matrices (B, c, c, H) times values (B, c, H)."""
    return np.asarray((matrices * values[:, None]).sum(axis=2))
