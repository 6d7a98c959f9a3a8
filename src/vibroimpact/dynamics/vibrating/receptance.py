r"""Motion of the surfaces at contacts through a stretch of given length, reduced to the nodes of Radau collocation.

Collocation integrates by a matrix Q. In its eigenbasis, with eigenvalues :math:`\lambda_k`, the modes enter only through the receptances
between contacts at the complex frequencies :math:`1/\sigma_k`, :math:`\sigma_k = h \lambda_k`,

.. math:: G_{cd}(\sigma) = \sum_i \frac{\chi_{ci} \chi_{di} \sigma^2}{1 + 2 \zeta_i \omega_i \sigma + \omega_i^2 \sigma^2}

so that the number of unknowns does not depend on the number of modes. Radau collocation is stable for any stiffness: a mode much faster
than the stretch follows the force quasi-statically, a slower one is integrated with order 2 N - 1. For rigid motions the receptance is
:math:`h^2 Q^2 \sum \chi_c \chi_d`.

All arrays hold B systems with equal numbers of modes. Arrays over the nodes of all c contacts are (B, M), M = c N; arrays over the modes
are (B, m, H), with H eigenvalues, one of each conjugate pair. Products are taken system by system, so that the rounding of one does not
depend on the others.
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

NODES_PER_STRETCH = 12
"""Nodes of a stretch: with more the eigenvectors of the integration matrix are too ill-conditioned, with fewer the stretches are too short.
"""


@dataclass(frozen=True)
class RadauEigenbasis:
    """A collocation rule and the eigendecomposition of its integration matrix, with one eigenvalue of each conjugate pair (H,).

    `values`: the eigenvalues. `constant`, `time`: the function one and the time in the eigenbasis (H,). `forward` (N, 2 H): from nodal
    values to the eigenbasis, real and imaginary parts interleaved; `inverse` (2 H, N): back to nodal values; `filters` (2 H, N N): from a
    diagonal operator in the eigenbasis to its matrix on nodal values.
    """

    rule: Rule
    values: Complex
    constant: Complex
    time: Complex
    forward: Floats
    inverse: Floats
    filters: Floats

    def to_eigenvectors(self, values: Floats) -> Complex:
        """Return nodal values (..., N) in the eigenbasis (..., H)."""
        return _rows_matmul(values, self.forward).view(np.complex128)

    def to_nodes(self, values: Complex) -> Floats:
        """Return the nodal values (..., N) of coefficients in the eigenbasis (..., H)."""
        return _rows_matmul(values.view(np.float64), self.inverse)

    def matrices(self, values: Complex) -> Floats:
        """Return the matrices (..., N, N) on nodal values of operators that are diagonal in the eigenbasis (..., H)."""
        return _rows_matmul(values.view(np.float64), self.filters).reshape(*values.shape[:-1], NODES_PER_STRETCH, NODES_PER_STRETCH)


@cache
def radau_eigenbasis(time_map: Map, root: int) -> RadauEigenbasis:
    """Return the eigenbasis of the Radau rule under a time map."""
    rule = collocation_rule(NODES_PER_STRETCH, time_map, root)
    values, vectors = np.linalg.eig(rule.integral)
    half = np.flatnonzero(values.imag >= 0.0)
    values, paired = values[half].astype(np.complex128), values[half].imag > 0.0
    vectors = np.where(paired, 2.0, 1.0) * vectors[:, half]  # the sum of a conjugate pair is twice the real part of one
    parts = np.stack([vectors.real, -vectors.imag], axis=2)  # (N, H, 2)
    kept = np.stack([np.ones_like(paired), paired], axis=1)
    back = np.zeros((len(half), 2, NODES_PER_STRETCH))
    back[kept] = np.linalg.inv(parts[:, kept])  # inverse of the real matrix, so that a round trip is exact to rounding
    inverse = back[:, 0] + 1j * back[:, 1]
    filters = (vectors.T[:, :, None] * inverse[:, None, :]).reshape(len(half), -1)
    return RadauEigenbasis(
        rule,
        values,
        np.asarray(inverse.sum(axis=1), dtype=np.complex128),
        np.asarray(inverse @ rule.time, dtype=np.complex128),
        back.reshape(-1, NODES_PER_STRETCH).T.copy(),
        parts.reshape(NODES_PER_STRETCH, -1).T.copy(),
        np.stack([filters.real, -filters.imag], axis=1).reshape(2 * len(half), -1),
    )


class ContactModes:
    """The modes and massless elements of a system, restricted to some of its contacts.

    `mode_slice`, `rigid_slice`: places of the modes and of the rigid motions among the coordinates. `shapes`: of the modes outside the
    contacts and, if any is inside, of those inside (1 or 2, c, m), and `pairs`: their products for each two contacts (1 or 2, c, c, m).
    `local_incidence`: which massless elements are in series with which contacts (c, k), and `local_mobility`: their mobilities there
    [m/(N s)]. `kind`: key that systems must share to be stacked.
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
        self.kind = (system.number, first, len(rows), len(self.rate), self.inside, system.driven)


class ContactView:
    """A linear system reduced to some of its contacts.

    `modes`: its modes, which several systems may share. `rigid_shapes`: shapes of its rigid motions (c, r), and `rigid_pairs`: the sums of
    their products [1/kg] (c, c). `gravity` [m/s^2], `offset` [m] and `mass` [kg] (c,): as in the system. `active_rigid`: mask of the rigid
    motions that move the contacts (n,).
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
        """The same without gravity and gaps, for the difference of two motions."""
        system = self.system
        return ContactView(replace(system, offset=np.zeros_like(system.offset), load=np.zeros_like(system.load)), self.contacts, self.modes)


def contact_view(system: LinearSystem, contacts: Iterable[int]) -> ContactView:
    """Return a system reduced to some of its contacts; cached."""
    numbers = tuple(contacts)
    if numbers not in system.views:
        if numbers not in system.shared_modes:
            system.shared_modes[numbers] = ContactModes(system, numbers)
        system.views[numbers] = ContactView(system, numbers, system.shared_modes[numbers])
    found: ContactView = system.views[numbers]
    return found


class StackedSystems:
    """B systems of one kind, reduced to c of their contacts, with their states at the start of a stretch.

    `rigid_pairs` [1/kg] (B, c, c), `gravity` [m/s^2] (B, c). `start`: states with a leading axis of B. `displacement`, `velocity`: of the
    modes (B, m). At the start, (B, c): `outer_rate`, `inner_rate`: contributions of the coordinates outside and inside the contacts to the
    rate of the approach; `begun_rate`: the former with that of the massless elements [m/s]; `approach` [m]. Arrays of the modes have a
    leading axis of B, or of one if the systems share them.
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
        motion = stacked_matvec(rigid, place[:, self.rigid_slice]) + stacked_matvec(self.shapes.sum(axis=1), self.displacement)
        self.approach = np.array([one.offset for one in views]) + motion + stacked_matvec(self.local_incidence, self.start.local)

    def impedance(self, sigma: Complex) -> Complex:
        """Return 1 + 2 zeta omega sigma + omega^2 sigma^2 of each mode, for sigma (B, H): (B, m, H)."""
        found = self.frequency_squared[:, :, None] * sigma[:, None]
        found += self.damping[:, :, None]
        found *= sigma[:, None]
        found += 1.0
        return np.asarray(found)

    def drive(self, basis: RadauEigenbasis, length: Floats) -> Complex:
        """Return the spring and damper accelerations of each mode if it moved on at its initial velocity: (B, m, H)."""
        restoring_rate = self.frequency_squared * self.velocity
        restoring = self.damping * self.velocity + self.frequency_squared * self.displacement
        return np.asarray(restoring[:, :, None] * -basis.constant - restoring_rate[:, :, None] * (length[:, None] * basis.time)[:, None])


class Receptance:
    """Motion of the surfaces at c contacts through stretches of B lengths: without contact forces, and linear maps of the nodal forces.

    Without contact forces, (B, M): `approach` [m], its `rate` by coordinates outside the contacts, and `closing`, its whole rate [m/s].
    Maps (B, M, M) of nodal forces, to be subtracted: `approach_by_force`, `rate_by_force` of the forces, and `approach_by_static`,
    `closing_by_static` of their static parts; the last two act on coordinates inside the contacts and are None if there are none.
    """

    def __init__(self, systems: StackedSystems, basis: RadauEigenbasis, length: Floats) -> None:
        self.systems, self.basis, self.length = systems, basis, length
        rule = basis.rule
        self.sigma = length[:, None] * basis.values
        sigma = self.sigma[:, None, None]  # (B, 1, 1, H)
        self.admittance = 1.0 / systems.impedance(self.sigma)
        self.responses = systems.drive(basis, length)
        self.responses *= self.admittance
        self.modal_accelerations = sum_modes(systems.shapes, self.responses)  # (B, 1 or 2, c, H)
        self.modal_rates = sigma * self.modal_accelerations
        self.massless = 1.0 / (1.0 + systems.rate[:, :, None] * self.sigma[:, None])
        if systems.massless:
            relaxation = self.massless * (systems.rate * systems.start.local)[:, :, None]
            self.modal_rates[:, 0] -= basis.constant * sum_modes(systems.local_incidence, relaxation)
        modal_displacements = sigma[:, 0] * self.modal_rates.sum(axis=1)
        by_modes = basis.to_nodes(np.concatenate([self.modal_rates, modal_displacements[:, None]], axis=1))  # (B, 2 or 3, c, N)
        # rigid motions and initial velocities, in closed form
        time = (length[:, None] * rule.time)[:, None]
        gravity = systems.gravity[:, :, None] * time
        rate = closing = systems.outer_rate[:, :, None] + gravity + by_modes[:, 0]
        if systems.inside:
            closing = rate + (systems.inner_rate[:, :, None] + by_modes[:, 1])
        mean_rate = (systems.outer_rate + systems.inner_rate)[:, :, None] + 0.5 * gravity
        approach = systems.approach[:, :, None] + time * mean_rate + by_modes[:, -1]
        size = systems.gravity.shape[1] * NODES_PER_STRETCH
        self.rate, self.closing, self.approach = rate.reshape(-1, size), closing.reshape(-1, size), approach.reshape(-1, size)
        # accelerance, mobility (times sigma) and receptance (times sigma squared) between contacts in the eigenbasis, then on the nodes
        self.accelerance = sum_modes(systems.pairs, self.admittance)  # (B, 1 or 2, c, c, H)
        mobility, sigma_pairs = sigma[:, None] * self.accelerance, sigma[:, None]
        if systems.massless:
            mobility[:, 0] += _on_diagonal(sum_modes(systems.local_mobility, self.massless))
        self.mobility = mobility[:, 0]
        mobility[:, 1:] *= sigma_pairs
        parts = np.concatenate([sigma_pairs * mobility[:, :1], mobility, sigma_pairs * self.accelerance[:, 1:]], axis=1)
        found = basis.matrices(parts).transpose(1, 0, 2, 4, 3, 5)  # (2 or 4, B, c, N, c, N)
        rigid, across = systems.rigid_pairs[:, :, None, :, None], length[:, None, None, None, None]
        found[0] += rigid * (across * across) * rule.integral_twice[:, None]
        found[1] += rigid * across * rule.integral[:, None]
        matrices = found.reshape(len(found), -1, size, size)
        self.approach_by_force, self.rate_by_force = matrices[:2]
        self.approach_by_static: Floats | None = matrices[2] if systems.inside else None
        self.closing_by_static: Floats | None = matrices[3] if systems.inside else None

    def by_length(self, force: Floats, static: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the derivatives of approach, rate and closing rate at the nodes by the length, under nodal forces [N]: (B, M) each."""
        systems, basis, rule, values = self.systems, self.basis, self.basis.rule, self.basis.values
        shape, per_contact, sigma = force.shape, (len(force), -1, NODES_PER_STRETCH), self.sigma[:, None, None]
        force_there = basis.to_eigenvectors(force.reshape(per_contact))  # (B, c, H)
        impedance_slope = 2.0 * systems.frequency_squared[:, :, None] * self.sigma[:, None] + systems.damping[:, :, None]
        admittance_slope = impedance_slope * self.admittance
        drive = values * admittance_slope * self.responses
        admittance_slope *= -self.admittance
        drive += (systems.frequency_squared * systems.velocity)[:, :, None] * basis.time * self.admittance
        acceleration_slope, accelerance_slope = -sum_modes(systems.shapes, drive), sum_modes(systems.pairs, admittance_slope)
        mobility_slope = self.accelerance[:, 0] + sigma * accelerance_slope[:, 0]
        rate_slope = values * self.modal_accelerations + sigma * acceleration_slope
        if systems.massless:
            slower = self.massless**2
            relaxation = slower * (systems.rate**2 * systems.start.local)[:, :, None]
            rate_slope[:, 0] += basis.constant * values * sum_modes(systems.local_incidence, relaxation)
            mobility_slope -= _on_diagonal(sum_modes(systems.local_mobility, slower * systems.rate[:, :, None]))
        across = sigma[:, 0]
        displacement_slope = (
            values * self.modal_rates.sum(axis=1)
            + across * rate_slope.sum(axis=1)
            - values * _complex_matvec(self.mobility + sigma * mobility_slope, force_there)
        )
        rate_slope[:, 0] -= values * _complex_matvec(mobility_slope, force_there)
        if systems.inside:
            static_there = basis.to_eigenvectors(static.reshape(per_contact))
            displacement_slope -= values * _complex_matvec(
                2.0 * sigma * self.accelerance[:, 1] + sigma * sigma * accelerance_slope[:, 1], static_there
            )
            rate_slope[:, 1] -= values * _complex_matvec(self.accelerance[:, 1] + sigma * accelerance_slope[:, 1], static_there)
        by_modes = basis.to_nodes(np.concatenate([rate_slope, displacement_slope[:, None]], axis=1))
        gravity, length = systems.gravity[:, :, None], self.length[:, None, None]
        speed = (systems.outer_rate + systems.inner_rate)[:, :, None]
        rigid_acceleration = systems.rigid_pairs @ force.reshape(per_contact)
        rate = gravity * rule.time + by_modes[:, 0] - rigid_acceleration @ rule.integral.T
        approach = (
            rule.time * (speed + gravity * length * rule.time)
            + by_modes[:, -1]
            - 2.0 * length * (rigid_acceleration @ rule.integral_twice.T)
        )
        closing = rate + by_modes[:, 1] if systems.inside else rate
        return approach.reshape(shape), rate.reshape(shape), closing.reshape(shape)


def sum_modes(shapes: Floats, values: Complex) -> Complex:
    """Return the sums of modal values (B, m, H) over the modes, weighted by shapes (B or 1, ..., m): (B, ..., H)."""
    size, number = values.shape[0], values.shape[1]
    rows = shapes.reshape(len(shapes), math.prod(shapes.shape[1:-1]), number)
    return (rows @ values.view(np.float64)).view(np.complex128).reshape(size, *shapes.shape[1:-1], values.shape[2])


def _rows_matmul(values: Floats, matrix: Floats) -> Floats:
    """Return values (B, ..., I) times a matrix (I, J), with one product per system: (B, ..., J)."""
    return (values.reshape(len(values), -1, len(matrix)) @ matrix).reshape(*values.shape[:-1], matrix.shape[1])


def _on_diagonal(values: Complex) -> Complex:
    """Return diagonal matrices (B, c, c, H) from their diagonals (B, c, H)."""
    return np.asarray(values[:, None] * np.eye(values.shape[1])[:, :, None])


def _complex_matvec(matrices: Complex, values: Complex) -> Complex:
    """Return the products of matrices (B, c, c, H) and vectors (B, c, H)."""
    return np.asarray((matrices * values[:, None]).sum(axis=2))
