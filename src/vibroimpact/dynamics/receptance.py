r"""How surfaces at contacts move through a stretch of some length, as the nodes of Radau collocation see what moves there.

Collocation integrates by a matrix Q, and with its eigenvalues :math:`\lambda_k` the modes are seen only through the receptances
between contacts at the complex frequencies :math:`1/\sigma_k`, :math:`\sigma_k = h \lambda_k`,

.. math:: G_{cd}(\sigma) = \sum_i \frac{\chi_{ci} \chi_{di} \sigma^2}{1 + 2 \zeta_i \omega_i \sigma + \omega_i^2 \sigma^2}

so that their number hardly counts. Radau collocation is stable however stiff a mode is: one that is much faster than the stretch
follows the force, and one that is not is integrated with order 2 N - 1. Of rigid motions it is :math:`h^2 Q^2 \sum \chi_c \chi_d`.
"""

from __future__ import annotations

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
    """A collocation rule with the eigenvalues of its integration matrix; constants and the time in its eigenvectors."""

    rule: Rule
    values: Complex
    vectors: Complex
    inverse: Complex
    constant: Complex
    time: Complex


@cache
def spectrum(time_map: Map, root: int) -> Spectrum:
    """Return the spectrum of a rule."""
    rule = collocation_rule(NODES, time_map, root)
    values, vectors = np.linalg.eig(rule.integral)
    inverse = np.linalg.inv(vectors)
    return Spectrum(rule, values, vectors, inverse, inverse.sum(axis=1), np.asarray(inverse @ rule.time, dtype=np.complex128))


class Seen:
    """A system as some of its contacts see it: the modes apart from the rigid motions, and products of shapes.

    `modes`: where they are among the coordinates. `outer`, `inner`: their shapes outside and inside the contacts (modes, c), and
    `outer_pairs`, `inner_pairs`: the products of these for each two contacts (modes, c c). `rigid`: which rigid motions move the contacts
    (n,), and `rigid_pairs`: the sums of the products of theirs [1/kg] (c, c). `local_mobility`: of the massless elements (k, c).
    """

    def __init__(self, system: LinearSystem, contacts: Sequence[int]) -> None:
        rows, first = list(contacts), int(system.rigid.sum())
        modes = slice(first, None) if system.rigid[:first].all() else system.vibrating  # a slice is quicker
        self.system, self.contacts, self.modes = system, rows, modes
        self.frequency_squared, self.damping = system.angular_frequency[modes] ** 2, system.damping[modes]
        self.shape, self.whole_outer, self.whole_inner = system.shape[rows], system.outer[rows], system.inner[rows]
        self.outer, self.inner = self.whole_outer[:, modes].T, self.whole_inner[:, modes].T
        self.outer_pairs, self.inner_pairs = (
            (part[:, :, None] * part[:, None, :]).reshape(len(part), len(rows) ** 2) for part in (self.outer, self.inner)
        )
        rigid = system.of_rigid[rows]
        self.rigid = rigid.any(axis=0)
        self.rigid_pairs, self.gravity, self.offset = rigid @ rigid.T, system.gravity[rows], system.offset[rows]
        self.with_local = system.with_local[rows].T
        self.local_mobility = self.with_local * system.mobility[:, None]
        self.local = bool(self.with_local.any())

    @cached_property
    def without_load(self) -> Seen:
        """The same without gravity and gaps, as differences between two motions feel it."""
        system = self.system
        return Seen(replace(system, offset=np.zeros_like(system.offset), load=np.zeros_like(system.load)), self.contacts)


def seen_by(system: LinearSystem, contacts: Iterable[int]) -> Seen:
    """Return a system as some of its contacts see it; made once."""
    numbers = tuple(contacts)
    if numbers not in system.views:
        system.views[numbers] = Seen(system, numbers)
    found: Seen = system.views[numbers]
    return found


class Receptance:
    """How the surfaces at c contacts move through a stretch of some length: without contact forces, and by forces at the N nodes.

    `approach` [m], `rate` outside the contacts and `closing`, that of the whole approach [m/s], (c, N), without contact forces.
    `by_force`, `rate_by`: by how much forces take back the first two, and `by_static`, `closing_by_static` what static ones take back
    besides of the approach and of its rate, (c N, c N).
    """

    def __init__(self, seen: Seen, at: Spectrum, length: float, start: State) -> None:
        self.seen, self.at, self.length, self.start = seen, at, length, start
        of, rule = seen.system, at.rule
        self.sigma = sigma = length * at.values
        self.admittance = 1.0 / impedance_of(seen, sigma)
        self.responses = own_drive(seen, at, length, start) * self.admittance
        self.driven_outer, self.driven_inner = self.responses @ seen.outer, self.responses @ seen.inner  # (N, c)
        time, column = length * rule.time, sigma[:, None]
        outer, inner = seen.whole_outer @ start.velocity, seen.whole_inner @ start.velocity
        outside, inside = column * self.driven_outer, column * self.driven_inner
        if seen.local:
            self.massless = 1.0 / (1.0 + of.rate * column)
            outside -= at.constant[:, None] * (self.massless @ (seen.with_local * (of.rate * start.local)[:, None]))
        self.outside, self.inside = outside, inside
        moved = at.vectors @ np.concatenate([outside, inside, column * (outside + inside)], axis=1)  # one product of all three
        by_modes = moved.real.T.reshape(3, -1, len(time))
        gravity = seen.gravity[:, None] * time
        self.rate = outer[:, None] + gravity + by_modes[0]
        self.closing = self.rate + (inner[:, None] + by_modes[1])
        begun = seen.offset + seen.shape @ start.displacement + start.local @ seen.with_local
        self.approach = begun[:, None] + time * ((outer + inner)[:, None] + 0.5 * gravity) + by_modes[2]
        size, square = len(outer), (len(sigma), len(outer), len(outer))
        self.outer_squares = (self.admittance @ seen.outer_pairs).reshape(square)
        self.inner_squares = (self.admittance @ seen.inner_pairs).reshape(square)
        wide = sigma[:, None, None]
        self.rates = wide * self.outer_squares
        if seen.local:
            self.rates += _on_diagonal(self.massless @ seen.local_mobility)
        parts = np.stack([wide * self.rates, self.rates, wide * wide * self.inner_squares, wide * self.inner_squares])
        # (4, c, c, N, N): from the eigenvectors back to the nodes
        matrices = np.matmul(at.vectors * parts.transpose(0, 2, 3, 1)[..., None, :], at.inverse).real
        rigid = seen.rigid_pairs[:, :, None, None] * length
        matrices[0] += rigid * (length * rule.integral_twice)
        matrices[1] += rigid * rule.integral
        whole = size * len(sigma)
        self.by_force, self.rate_by, self.by_static, self.closing_by_static = matrices.transpose(0, 1, 3, 2, 4).reshape(4, whole, whole)

    def by_length(self, force: Floats, static: Floats) -> tuple[Floats, Floats, Floats]:
        """Return how approach, rate and closing rate at the nodes change with the length, under forces there [N] (c, N): (c, N) each."""
        seen, at, start, sigma, rule = self.seen, self.at, self.start, self.sigma, self.at.rule
        of, column, values = seen.system, self.sigma[:, None], self.at.values[:, None]
        pushed, statically = at.inverse @ force.T, at.inverse @ static.T  # (N, c)
        growth = seen.damping + 2.0 * seen.frequency_squared * column  # of the impedance with sigma
        softer = -growth * self.admittance**2
        outer_squares, inner_squares = (
            (softer @ pairs).reshape(self.outer_squares.shape) for pairs in (seen.outer_pairs, seen.inner_pairs)
        )
        of_stiffness = seen.frequency_squared * start.velocity[seen.modes]
        drive = -at.time[:, None] * of_stiffness * self.admittance - values * growth * self.admittance * self.responses
        driven_outer, driven_inner = drive @ seen.outer, drive @ seen.inner
        wide, yielding = sigma[:, None, None], np.zeros_like(driven_outer)
        rates = self.outer_squares + wide * outer_squares
        if seen.local:
            slower = self.massless**2
            yielding = (at.constant * at.values)[:, None] * (slower @ (seen.with_local * (of.rate**2 * start.local)[:, None]))
            rates = rates - _on_diagonal((slower * of.rate) @ seen.local_mobility)
        outside_by = values * (self.driven_outer - _met(rates, pushed)) + column * driven_outer + yielding
        inside_by = values * self.driven_inner + column * driven_inner
        whole = values * (self.outside + self.inside) + column * (
            values * (self.driven_outer + self.driven_inner) + column * (driven_outer + driven_inner) + yielding
        )
        whole = whole - values * _met(self.rates + wide * rates, pushed)
        whole = whole - values * _met(2.0 * wide * self.inner_squares + wide * wide * inner_squares, statically)
        inside_by = inside_by - values * _met(self.inner_squares + wide * inner_squares, statically)
        length, gravity = self.length, seen.gravity[:, None]
        speed = (seen.shape @ start.velocity)[:, None]
        heavy = seen.rigid_pairs @ force
        rate = gravity * rule.time + (at.vectors @ outside_by).real.T - heavy @ rule.integral.T
        closing = rate + (at.vectors @ inside_by).real.T
        approach = rule.time * (speed + gravity * length * rule.time) + (at.vectors @ whole).real.T
        return approach - 2.0 * length * (heavy @ rule.integral_twice.T), rate, closing


def own_drive(seen: Seen, at: Spectrum, length: float, start: State) -> Complex:
    """Return what drives each mode without contact forces, in the eigenvectors (N, modes): its motion at the start, going on."""
    stiffness = seen.frequency_squared
    displacement, velocity = start.displacement[seen.modes], start.velocity[seen.modes]
    pull = seen.damping * velocity + stiffness * displacement
    return np.asarray(-at.constant[:, None] * pull - (length * at.time)[:, None] * (stiffness * velocity))


def impedance_of(seen: Seen, sigma: Complex) -> Complex:
    """Return 1 + 2 zeta omega sigma + omega^2 sigma^2 of each mode, (N, modes)."""
    column = sigma[:, None]
    return np.asarray(1.0 + column * (seen.damping + seen.frequency_squared * column))


def _on_diagonal(values: Complex) -> Complex:
    """Return matrices (N, c, c) of values on their diagonals (N, c)."""
    return np.asarray(values[:, :, None] * np.eye(values.shape[1]))


def _met(matrices: Complex, values: Complex) -> Complex:
    """Return matrices (N, c, c) times values (N, c)."""
    return np.asarray((matrices @ values[:, :, None])[:, :, 0])
