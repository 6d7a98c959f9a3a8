r"""How surfaces at contacts move through a stretch of some length, as the nodes of Radau collocation see what moves there.

Collocation integrates by a matrix Q, and with its eigenvalues :math:`\lambda_k` the modes are seen only through the receptances
between contacts at the complex frequencies :math:`1/\sigma_k`, :math:`\sigma_k = h \lambda_k`,

.. math:: G_{cd}(\sigma) = \sum_i \frac{\chi_{ci} \chi_{di} \sigma^2}{1 + 2 \zeta_i \omega_i \sigma + \omega_i^2 \sigma^2}

so that their number hardly counts. Radau collocation is stable however stiff a mode is: one that is much faster than the stretch
follows the force, and one that is not is integrated with order 2 N - 1. Of rigid motions it is :math:`h^2 Q^2 \sum \chi_c \chi_d`.

All is done for B systems at once that have the same modes. Arrays of the nodes of all c contacts are (B, M), M = c N, those of the modes
(m, B, H), where H counts the eigenvalues, of each conjugate pair one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats, Map, Rule, collocation_rule
from vibroimpact.dynamics.linear_system import LinearSystem, State

Complex = NDArray[np.complex128]

NODES = 12
"""More would make the eigenvectors of the integration matrix too ill-conditioned, fewer the stretches too short."""


@dataclass(frozen=True)
class Spectrum:
    """A collocation rule with the eigenvalues of its integration matrix, of each conjugate pair one (H,).

    `constant`, `time`: these in its eigenvectors (H,). `inward` (N, 2 H): to the eigenvectors, real and imaginary parts side by side;
    `outward` (2 H, N) and `filters` (2 H, N N): from there back to the nodes, of values and of what is diagonal there.
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
        return _rows_times(values, self.inward).view(np.complex128)

    def to_nodes(self, values: Complex) -> Floats:
        """Return the same the other way."""
        return _rows_times(values.view(np.float64), self.outward)

    def matrices(self, values: Complex) -> Floats:
        """Return the matrices from nodes to nodes (..., N, N) of what is diagonal in the eigenvectors (..., H)."""
        return _rows_times(values.view(np.float64), self.filters).reshape(*values.shape[:-1], NODES, NODES)


@cache
def spectrum(time_map: Map, root: int) -> Spectrum:
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
    return Spectrum(
        rule,
        values,
        np.asarray(inverse.sum(axis=1), dtype=np.complex128),
        np.asarray(inverse @ rule.time, dtype=np.complex128),
        back.reshape(-1, NODES).T.copy(),
        parts.reshape(NODES, -1).T.copy(),
        np.stack([filters.real, -filters.imag], axis=1).reshape(2 * len(half), -1),
    )


class ModesSeen:
    """The modes and massless elements of a system as some of its contacts see them.

    `modes`, `rigid`: where the modes and the rigid motions are among the coordinates. `outer`, `inner`: shapes of the modes outside and
    inside the contacts (m, c); `inside`: whether any of the latter is not zero. `shapes`: of both, or of the former alone if no mode is
    inside (1 or 2, c, m), and `pairs`: the products of these for each two contacts (1 or 2, c, c, m). `with_local`: which massless
    elements are in series with which contacts (k, c), and `local_mobility`: the mobilities of these [m/(N s)] (k, c).
    """

    def __init__(self, system: LinearSystem, contacts: Sequence[int]) -> None:
        rows, first = list(contacts), int(system.rigid.sum())
        parted = bool(system.rigid[:first].all())  # slices are quicker
        self.modes = slice(first, None) if parted else system.vibrating
        self.rigid = slice(0, first) if parted else system.rigid
        self.frequency_squared, self.damping = (part[self.modes, None] for part in (system.angular_frequency**2, system.damping))
        self.outer, self.inner = (np.ascontiguousarray(part[rows][:, self.modes].T) for part in (system.outer, system.inner))
        self.inside = bool(self.inner.any())
        both = np.stack([self.outer, self.inner] if self.inside else [self.outer])
        self.shapes = np.ascontiguousarray(both.swapaxes(1, 2))
        self.pairs = np.ascontiguousarray((both[:, :, :, None] * both[:, :, None, :]).transpose(0, 2, 3, 1))
        self.rate = system.rate[:, None]
        self.with_local = system.with_local[rows].T
        self.local_mobility = self.with_local * system.mobility[:, None]

    def impedance(self, sigma: Complex) -> Complex:
        """Return 1 + 2 zeta omega sigma + omega^2 sigma^2 of each mode, for sigma (B, H): (m, B, H)."""
        found = self.frequency_squared[:, :, None] * sigma
        found += self.damping[:, :, None]
        found *= sigma
        found += 1.0
        return np.asarray(found)

    def drive(self, at: Spectrum, length: Floats, displacement: Floats, velocity: Floats) -> Complex:
        """Return what drives each mode without contact forces, its motion at the start (m, B) going on: (m, B, H)."""
        stiffness = self.frequency_squared * velocity
        pull = self.damping * velocity + self.frequency_squared * displacement
        return np.asarray(pull[:, :, None] * -at.constant - stiffness[:, :, None] * (length[:, None] * at.time))

    @staticmethod
    def summed(shapes: Floats, values: Complex) -> Complex:
        """Return sums of values (m, B, H) by shapes (..., m): (..., B, H)."""
        number, *shape = values.shape
        flat = values.view(np.float64).reshape(number, 2 * math.prod(shape))
        return (shapes.reshape(math.prod(shapes.shape[:-1]), number) @ flat).view(np.complex128).reshape(*shapes.shape[:-1], *shape)


class Seen:
    """A system as some of its contacts see it.

    `of`: its modes, which several systems may share. `rigid`: shapes of its rigid motions (c, r), and `rigid_pairs`: the sums of their
    products [1/kg] (c, c). `gravity` [m/s^2], `offset` [m] (c,): as those of the system.
    """

    def __init__(self, system: LinearSystem, contacts: Sequence[int], of: ModesSeen) -> None:
        rows = list(contacts)
        self.system, self.contacts, self.of = system, rows, of
        self.rigid = system.shape[rows][:, of.rigid]
        self.rigid_pairs, self.gravity, self.offset = self.rigid @ self.rigid.T, system.gravity[rows], system.offset[rows]
        self.touched = system.of_rigid[rows].any(axis=0)
        self.mass = system.mass[rows]

    @cached_property
    def without_load(self) -> Seen:
        """The same without gravity and gaps, as differences between two motions feel it."""
        system = self.system
        return Seen(replace(system, offset=np.zeros_like(system.offset), load=np.zeros_like(system.load)), self.contacts, self.of)


def seen_by(system: LinearSystem, contacts: Iterable[int]) -> Seen:
    """Return a system as some of its contacts see it; made once."""
    numbers = tuple(contacts)
    if numbers not in system.views:
        if numbers not in system.shared:
            system.shared[numbers] = ModesSeen(system, numbers)
        system.views[numbers] = Seen(system, numbers, system.shared[numbers])
    found: Seen = system.views[numbers]
    return found


class Together:
    """B systems with the same modes, as the same of their contacts see them, and their states at the start of a stretch.

    `rigid_pairs` [1/kg] (B, c, c), `gravity` [m/s^2] and `offset` [m] (B, c). `start`: with a leading axis of B.
    """

    def __init__(self, seen: Sequence[Seen], start: Sequence[State]) -> None:
        of = seen[0].of
        self.of, self.seen = of, seen
        self.rigid_pairs = np.array([one.rigid_pairs for one in seen])
        self.gravity, self.offset = np.array([one.gravity for one in seen]), np.array([one.offset for one in seen])
        place, speed = np.array([one.displacement for one in start]), np.array([one.velocity for one in start])
        self.start = State(place, speed, np.array([one.local for one in start]))
        rigid = np.array([one.rigid for one in seen])
        of_rigid = rigid @ np.array([place[:, of.rigid].T, speed[:, of.rigid].T]).transpose(2, 1, 0)  # (B, c, 2)
        self.displacement, self.velocity = place[:, of.modes].T, speed[:, of.modes].T  # of the modes (m, B)
        pulled = self.start.local @ of.with_local
        yielding = (self.start.local * of.rate[:, 0]) @ of.with_local
        self.outer_rate = of_rigid[:, :, 1] + self.velocity.T @ of.outer  # of the surfaces, without contact force [m/s] (B, c)
        self.inner_rate = self.velocity.T @ of.inner
        self.begun_rate = self.outer_rate - yielding
        self.approach = self.offset + of_rigid[:, :, 0] + self.displacement.T @ (of.outer + of.inner) + pulled


class Receptance:
    """How the surfaces at c contacts move through stretches of B lengths: without contact forces, and by forces at the N nodes.

    `approach` [m], `rate` outside the contacts and `closing`, that of the whole approach [m/s], (B, M), without contact forces.
    `by_force`, `rate_by`: by how much forces take back the first two, and `by_static`, `closing_by_static` what static ones take back
    besides of the approach and of its rate, (B, M, M); the last two are None where no coordinate lies inside the contacts.
    """

    def __init__(self, systems: Together, at: Spectrum, length: Floats) -> None:
        self.systems, self.at, self.length = systems, at, length
        of, rule, start = systems.of, at.rule, systems.start
        self.sigma = sigma = length[:, None] * at.values
        self.admittance = 1.0 / of.impedance(sigma)
        self.responses = of.drive(at, length, systems.displacement, systems.velocity)
        self.responses *= self.admittance
        self.driven = of.summed(of.shapes, self.responses)  # (1 or 2, c, B, H)
        self.moved = sigma * self.driven
        self.massless = 1.0 / (1.0 + of.rate[:, :, None] * sigma)
        if len(of.rate):
            pulled = self.massless * (of.rate * start.local.T)[:, :, None]
            self.moved[0] -= at.constant * of.summed(of.with_local.T, pulled)
        by_modes = at.to_nodes(np.concatenate([self.moved, [sigma * self.moved.sum(axis=0)]])).swapaxes(1, 2)  # (2 or 3, B, c, N)
        time = (length[:, None] * rule.time)[:, None]
        gravity = systems.gravity[:, :, None] * time
        rate = closing = systems.outer_rate[:, :, None] + gravity + by_modes[0]
        if of.inside:
            closing = rate + (systems.inner_rate[:, :, None] + by_modes[1])
        whole = (systems.outer_rate + systems.inner_rate)[:, :, None] + 0.5 * gravity
        approach = systems.approach[:, :, None] + time * whole + by_modes[-1]
        size = systems.gravity.shape[1] * NODES
        self.rate, self.closing, self.approach = rate.reshape(-1, size), closing.reshape(-1, size), approach.reshape(-1, size)
        self.squares = of.summed(of.pairs, self.admittance)  # (1 or 2, c, c, B, H)
        self.rates = sigma * self.squares
        if len(of.rate):
            self.rates[0] += _on_diagonal(of.summed(of.local_mobility.T, self.massless))
        self.rates[1:] *= sigma
        found = at.matrices(np.concatenate([sigma * self.rates[:1], self.rates, sigma * self.squares[1:]])).transpose(0, 3, 1, 4, 2, 5)
        rigid, across = systems.rigid_pairs[:, :, None, :, None], length[:, None, None, None, None]  # (..., B, c, N, c, N)
        found[0] += rigid * (across * across) * rule.integral_twice[:, None]
        found[1] += rigid * across * rule.integral[:, None]
        matrices = found.reshape(len(found), -1, size, size)
        self.by_force, self.rate_by = matrices[:2]
        self.by_static: Floats | None = matrices[2] if of.inside else None
        self.closing_by_static: Floats | None = matrices[3] if of.inside else None

    def by_length(self, force: Floats, static: Floats) -> tuple[Floats, Floats, Floats]:
        """Return how approach, rate and closing rate at the nodes change with the length, under forces there [N]: (B, M) each."""
        systems, at, sigma, rule = self.systems, self.at, self.sigma, self.at.rule
        shape, of_each = force.shape, (len(force), -1, NODES)
        of, values, start = systems.of, at.values, systems.start
        pushed = at.to_eigenvectors(force.reshape(of_each)).swapaxes(0, 1)  # (c, B, H)
        growth = 2.0 * of.frequency_squared[:, :, None] * sigma + of.damping[:, :, None]  # of the impedance with sigma
        softer = growth * self.admittance
        drive = values * softer * self.responses
        softer *= -self.admittance
        drive += (of.frequency_squared * systems.velocity)[:, :, None] * at.time * self.admittance
        driven, squares = -of.summed(of.shapes, drive), of.summed(of.pairs, softer)
        rates = self.squares[0] + sigma * squares[0]
        moved = values * self.driven + sigma * driven
        if len(of.rate):
            slower = self.massless**2
            pulled = slower * (of.rate**2 * start.local.T)[:, :, None]
            moved[0] += at.constant * values * of.summed(of.with_local.T, pulled)
            rates -= _on_diagonal(of.summed(of.local_mobility.T, slower * of.rate[:, :, None]))
        whole = values * self.moved.sum(axis=0) + sigma * moved.sum(axis=0) - values * _met(self.rates[0] + sigma * rates, pushed)
        moved[0] -= values * _met(rates, pushed)
        if of.inside:
            statically = at.to_eigenvectors(static.reshape(of_each)).swapaxes(0, 1)
            whole -= values * _met(2.0 * sigma * self.squares[1] + sigma * sigma * squares[1], statically)
            moved[1] -= values * _met(self.squares[1] + sigma * squares[1], statically)
        by_modes = at.to_nodes(np.concatenate([moved, [whole]])).swapaxes(1, 2)
        gravity, across = systems.gravity[:, :, None], self.length[:, None, None]
        speed = (systems.outer_rate + systems.inner_rate)[:, :, None]
        heavy = systems.rigid_pairs @ force.reshape(of_each)
        rate = gravity * rule.time + by_modes[0] - heavy @ rule.integral.T
        approach = rule.time * (speed + gravity * across * rule.time) + by_modes[-1] - 2.0 * across * (heavy @ rule.integral_twice.T)
        closing = rate + by_modes[1] if of.inside else rate
        return approach.reshape(shape), rate.reshape(shape), closing.reshape(shape)


def _rows_times(values: Floats, matrix: Floats) -> Floats:
    """Return values (..., I) times a matrix (I, J) in one product, (..., J)."""
    return (values.reshape(-1, len(matrix)) @ matrix).reshape(*values.shape[:-1], matrix.shape[1])


def _on_diagonal(values: Complex) -> Complex:
    """Return matrices (c, c, ...) of values on their diagonals (c, ...)."""
    return np.asarray(values[:, None] * np.eye(len(values))[:, :, None, None])


def _met(matrices: Complex, values: Complex) -> Complex:
    """Return matrices (c, c, B, H) times values (c, B, H)."""
    return np.asarray((matrices * values).sum(axis=1))
