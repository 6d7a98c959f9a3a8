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
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State

NODES = 12
"""More would make the eigenvectors of the integration matrix too ill-conditioned, fewer the stretches too short."""


@dataclass(frozen=True)
class Spectrum:
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

    `modes`, `rigid`: where the modes and the rigid motions are among the coordinates. `shapes`: of the modes outside the contacts and, if
    any is inside, of those inside (1 or 2, c, m), and `pairs`: the products of these for each two contacts (1 or 2, c, c, m).
    `with_local`: which massless elements are in series with which contacts (c, k), and `local_mobility`: their mobilities there
    [m/(N s)]. `kind`: what has to be the same for systems that are computed together.
    """

    def __init__(self, system: LinearSystem, contacts: Sequence[int]) -> None:
        rows, first = list(contacts), int(system.rigid.sum())
        assert system.rigid[:first].all()  # rigid motions come first
        self.rigid, self.modes = slice(0, first), slice(first, None)
        self.frequency_squared, self.damping = system.angular_frequency[self.modes] ** 2, system.damping[self.modes]
        outer, inner = (part[rows][:, self.modes] for part in (system.outer, system.inner))
        self.inside = bool(inner.any())
        self.shapes = np.stack([outer, inner] if self.inside else [outer])
        self.pairs = np.ascontiguousarray(self.shapes[:, :, None] * self.shapes[:, None])
        self.rate, self.with_local = system.rate, system.with_local[rows]
        self.local_mobility = self.with_local * system.mobility
        self.kind = (system.number, first, len(rows), len(self.rate), self.inside)


class Seen:
    """A system as some of its contacts see it.

    `of`: its modes, which several systems may share. `rigid`: shapes of its rigid motions (c, r), and `rigid_pairs`: the sums of their
    products [1/kg] (c, c). `gravity` [m/s^2], `offset` [m] and `mass` [kg] (c,): as those of the system. `touched`: which rigid motions
    move the contacts (n,).
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
    """B systems of one kind, as c of their contacts see them, and their states at the start of a stretch.

    `rigid_pairs` [1/kg] (B, c, c), `gravity` [m/s^2] (B, c). `start`: with a leading axis of B. `displacement`, `velocity`: of the modes
    (B, m). `outer_rate`, `inner_rate`: rates of the surfaces there, outside and inside the contacts, without those of massless elements,
    which are in `begun_rate` [m/s], and `approach` [m] (B, c). What belongs to the modes has a leading axis of B, or of one if they are
    the same.
    """

    def __init__(self, seen: Sequence[Seen], start: Sequence[State]) -> None:
        first, self.seen = seen[0].of, seen
        self.modes, self.rigid, self.inside = first.modes, first.rigid, first.inside
        distinct = seen[:1] if all(one.of is first for one in seen) else seen

        def of_modes(name: str) -> Floats:
            return np.array([getattr(one.of, name) for one in distinct])

        self.frequency_squared, self.damping = of_modes("frequency_squared"), of_modes("damping")
        self.shapes, self.pairs = of_modes("shapes"), of_modes("pairs")
        self.rate, self.with_local, self.local_mobility = of_modes("rate"), of_modes("with_local"), of_modes("local_mobility")
        self.massless = bool(len(first.rate))
        self.rigid_pairs, self.gravity = np.array([one.rigid_pairs for one in seen]), np.array([one.gravity for one in seen])
        place, speed = np.array([one.displacement for one in start]), np.array([one.velocity for one in start])
        self.start = State(place, speed, np.array([one.local for one in start]))
        self.displacement, self.velocity = place[:, self.modes], speed[:, self.modes]
        rigid = np.array([one.rigid for one in seen])
        self.outer_rate = _times(rigid, speed[:, self.rigid]) + _times(self.shapes[:, 0], self.velocity)
        self.inner_rate = _times(self.shapes[:, -1], self.velocity) if self.inside else np.zeros_like(self.outer_rate)
        self.begun_rate = self.outer_rate - _times(self.with_local, self.start.local * self.rate)
        sunk = _times(rigid, place[:, self.rigid]) + _times(self.shapes.sum(axis=1), self.displacement)
        self.approach = np.array([one.offset for one in seen]) + sunk + _times(self.with_local, self.start.local)

    def impedance(self, sigma: Complex) -> Complex:
        """Return 1 + 2 zeta omega sigma + omega^2 sigma^2 of each mode, for sigma (B, H): (B, m, H)."""
        found = self.frequency_squared[:, :, None] * sigma[:, None]
        found += self.damping[:, :, None]
        found *= sigma[:, None]
        found += 1.0
        return np.asarray(found)

    def drive(self, at: Spectrum, length: Floats) -> Complex:
        """Return what drives each mode without contact forces, its motion at the start going on: (B, m, H)."""
        stiffness = self.frequency_squared * self.velocity
        pull = self.damping * self.velocity + self.frequency_squared * self.displacement
        return np.asarray(pull[:, :, None] * -at.constant - stiffness[:, :, None] * (length[:, None] * at.time)[:, None])


class Receptance:
    """How the surfaces at c contacts move through stretches of B lengths: without contact forces, and by forces at the N nodes.

    `approach` [m], `rate` outside the contacts and `closing`, that of the whole approach [m/s], (B, M), without contact forces.
    `by_force`, `rate_by`: by how much forces take back the first two, and `by_static`, `closing_by_static` what static ones take back
    besides of the approach and of its rate, (B, M, M); the last two are None where no coordinate lies inside the contacts.
    """

    def __init__(self, systems: Together, at: Spectrum, length: Floats) -> None:
        self.systems, self.at, self.length = systems, at, length
        of, rule = systems, at.rule
        self.sigma = length[:, None] * at.values
        sigma = self.sigma[:, None, None]  # (B, 1, 1, H)
        self.admittance = 1.0 / of.impedance(self.sigma)
        self.responses = of.drive(at, length)
        self.responses *= self.admittance
        self.driven = summed(of.shapes, self.responses)  # (B, 1 or 2, c, H)
        self.moved = sigma * self.driven
        self.massless = 1.0 / (1.0 + of.rate[:, :, None] * self.sigma[:, None])
        if of.massless:
            pulled = self.massless * (of.rate * of.start.local)[:, :, None]
            self.moved[:, 0] -= at.constant * summed(of.with_local, pulled)
        whole_moved = sigma[:, 0] * self.moved.sum(axis=1)
        by_modes = at.to_nodes(np.concatenate([self.moved, whole_moved[:, None]], axis=1))  # (B, 2 or 3, c, N)
        time = (length[:, None] * rule.time)[:, None]
        gravity = of.gravity[:, :, None] * time
        rate = closing = of.outer_rate[:, :, None] + gravity + by_modes[:, 0]
        if of.inside:
            closing = rate + (of.inner_rate[:, :, None] + by_modes[:, 1])
        whole = (of.outer_rate + of.inner_rate)[:, :, None] + 0.5 * gravity
        approach = of.approach[:, :, None] + time * whole + by_modes[:, -1]
        size = of.gravity.shape[1] * NODES
        self.rate, self.closing, self.approach = rate.reshape(-1, size), closing.reshape(-1, size), approach.reshape(-1, size)
        self.squares = summed(of.pairs, self.admittance)  # (B, 1 or 2, c, c, H)
        rates, wide = sigma[:, None] * self.squares, sigma[:, None]
        if of.massless:
            rates[:, 0] += _on_diagonal(summed(of.local_mobility, self.massless))
        self.rates = rates[:, 0]
        rates[:, 1:] *= wide
        parts = np.concatenate([wide * rates[:, :1], rates, wide * self.squares[:, 1:]], axis=1)
        found = at.matrices(parts).transpose(1, 0, 2, 4, 3, 5)  # (2 or 4, B, c, N, c, N)
        rigid, across = of.rigid_pairs[:, :, None, :, None], length[:, None, None, None, None]
        found[0] += rigid * (across * across) * rule.integral_twice[:, None]
        found[1] += rigid * across * rule.integral[:, None]
        matrices = found.reshape(len(found), -1, size, size)
        self.by_force, self.rate_by = matrices[:2]
        self.by_static: Floats | None = matrices[2] if of.inside else None
        self.closing_by_static: Floats | None = matrices[3] if of.inside else None

    def by_length(self, force: Floats, static: Floats) -> tuple[Floats, Floats, Floats]:
        """Return how approach, rate and closing rate at the nodes change with the length, under forces there [N]: (B, M) each."""
        of, at, rule, values = self.systems, self.at, self.at.rule, self.at.values
        shape, of_each, sigma = force.shape, (len(force), -1, NODES), self.sigma[:, None, None]
        pushed = at.to_eigenvectors(force.reshape(of_each))  # (B, c, H)
        growth = 2.0 * of.frequency_squared[:, :, None] * self.sigma[:, None] + of.damping[:, :, None]  # of the impedance with sigma
        softer = growth * self.admittance
        drive = values * softer * self.responses
        softer *= -self.admittance
        drive += (of.frequency_squared * of.velocity)[:, :, None] * at.time * self.admittance
        driven, squares = -summed(of.shapes, drive), summed(of.pairs, softer)
        rates = self.squares[:, 0] + sigma * squares[:, 0]
        moved = values * self.driven + sigma * driven
        if of.massless:
            slower = self.massless**2
            pulled = slower * (of.rate**2 * of.start.local)[:, :, None]
            moved[:, 0] += at.constant * values * summed(of.with_local, pulled)
            rates -= _on_diagonal(summed(of.local_mobility, slower * of.rate[:, :, None]))
        across = sigma[:, 0]
        whole = values * self.moved.sum(axis=1) + across * moved.sum(axis=1) - values * _met(self.rates + sigma * rates, pushed)
        moved[:, 0] -= values * _met(rates, pushed)
        if of.inside:
            statically = at.to_eigenvectors(static.reshape(of_each))
            whole -= values * _met(2.0 * sigma * self.squares[:, 1] + sigma * sigma * squares[:, 1], statically)
            moved[:, 1] -= values * _met(self.squares[:, 1] + sigma * squares[:, 1], statically)
        by_modes = at.to_nodes(np.concatenate([moved, whole[:, None]], axis=1))
        gravity, long = of.gravity[:, :, None], self.length[:, None, None]
        speed = (of.outer_rate + of.inner_rate)[:, :, None]
        heavy = of.rigid_pairs @ force.reshape(of_each)
        rate = gravity * rule.time + by_modes[:, 0] - heavy @ rule.integral.T
        approach = rule.time * (speed + gravity * long * rule.time) + by_modes[:, -1] - 2.0 * long * (heavy @ rule.integral_twice.T)
        closing = rate + by_modes[:, 1] if of.inside else rate
        return approach.reshape(shape), rate.reshape(shape), closing.reshape(shape)


def summed(shapes: Floats, values: Complex) -> Complex:
    """Return modal values (B, m, H) summed with shapes (B or 1, ..., m) as weights, (B, ..., H)."""
    size, number = values.shape[0], values.shape[1]
    rows = shapes.reshape(len(shapes), math.prod(shapes.shape[1:-1]), number)
    return (rows @ values.view(np.float64)).view(np.complex128).reshape(size, *shapes.shape[1:-1], values.shape[2])


def _rows_times(values: Floats, matrix: Floats) -> Floats:
    """Return values (B, ..., I) times a matrix (I, J), in one product a system, (B, ..., J)."""
    return (values.reshape(len(values), -1, len(matrix)) @ matrix).reshape(*values.shape[:-1], matrix.shape[1])


def _times(matrices: Floats, values: Floats) -> Floats:
    """Return matrices (B or 1, c, m) times values (B, m), (B, c)."""
    return np.asarray((matrices @ values[:, :, None])[:, :, 0])


def _on_diagonal(values: Complex) -> Complex:
    """Return matrices (B, c, c, H) of values on their diagonals (B, c, H)."""
    return np.asarray(values[:, None] * np.eye(values.shape[1])[:, :, None])


def _met(matrices: Complex, values: Complex) -> Complex:
    """Return matrices (B, c, c, H) times values (B, c, H)."""
    return np.asarray((matrices * values[:, None]).sum(axis=2))
