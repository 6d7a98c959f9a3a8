r"""What vibrates behind a contact, as the nodes of Radau collocation see it through a stretch of some length.

Collocation integrates by a matrix Q, and with its eigenvalues :math:`\lambda_k` the oscillators are seen only through their
receptance at the complex frequencies :math:`1/\sigma_k`, :math:`\sigma_k = h \lambda_k`,

.. math:: G(\sigma) = \sum_i \frac{\chi_i^2 \sigma^2}{1 + 2 \zeta_i \omega_i \sigma + \omega_i^2 \sigma^2}

so that their number hardly counts. Radau collocation is stable however stiff an oscillator is: one that is much
faster than the stretch follows the force, and one that is not is integrated with order 2 N - 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats, Map, Rule, collocation_rule
from vibroimpact.dynamics.oscillators import Oscillators, State

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


@dataclass(frozen=True)
class Surroundings:
    """What surrounds the contact of one drop: the sphere's mass [kg], gravity [m/s^2], and what vibrates."""

    mass: float
    gravity: float
    oscillators: Oscillators


class Receptance:
    """How the surfaces at a contact move through a stretch of some length: without contact force, and by forces at the nodes.

    `approach` [m], `rate` outside the contact and `closing`, that of the whole approach [m/s], (N,), without contact force. `by_force`,
    `rate_by`: by how much forces take back the first two, and `by_static`, `closing_by_static` what static ones take back besides of the
    approach and of its rate, (N, N).
    """

    def __init__(self, around: Surroundings, at: Spectrum, length: float, start: State) -> None:
        self.around, self.at, self.length, self.start = around, at, length, start
        of, rule, vectors, inverse = around.oscillators, at.rule, at.vectors, at.inverse
        self.sigma = sigma = length * at.values
        self.admittance = 1.0 / impedance_of(of, sigma)
        self.responses = own_drive(of, at, length, start) * self.admittance
        self.massless = 1.0 / (1.0 + of.rate * sigma[:, None])
        self.driven = self.responses @ of.by_side  # outside the contact, inside
        yielding = -at.constant * (self.massless @ (of.rate * start.local))
        self.squares = self.admittance @ of.squares_by_side
        time = length * rule.time
        outer, inner = start.speed + start.velocity @ of.outer, start.velocity @ (of.shape - of.outer)
        self.outside, self.inside = outside, inside = sigma * self.driven[:, 0] + yielding, sigma * self.driven[:, 1]
        self.rate = outer + around.gravity * time + (vectors @ outside).real
        self.closing = self.rate + (inner + (vectors @ inside).real)
        self.approach = (
            of.approach(start) + time * (outer + inner + 0.5 * around.gravity * time) + (vectors @ (sigma * (outside + inside))).real
        )
        self.rates = sigma * self.squares[:, 0] + self.massless @ of.mobility
        parts = (sigma * self.rates, self.rates, sigma * sigma * self.squares[:, 1], sigma * self.squares[:, 1])
        self.by_force, self.rate_by, self.by_static, self.closing_by_static = (((vectors * part) @ inverse).real for part in parts)
        self.by_force += length * length / around.mass * rule.integral_twice
        self.rate_by += length / around.mass * rule.integral

    def by_length(self, force: Floats, static: Floats) -> tuple[Floats, Floats, Floats]:
        """Return how approach, rate and closing rate at the nodes change with the length [m/s, m/s^2], under forces there [N] (N,)."""
        of, at, start, sigma, rule = self.around.oscillators, self.at, self.start, self.sigma, self.at.rule
        pushed, statically = at.inverse @ force, at.inverse @ static
        growth = of.damping + 2.0 * of.angular_frequency**2 * sigma[:, None]  # of the impedance with sigma
        softer = -growth * self.admittance**2
        squares = softer @ of.squares_by_side
        of_stiffness = of.angular_frequency**2 * start.velocity
        drive = -at.time[:, None] * of_stiffness * self.admittance - at.values[:, None] * growth * self.admittance * self.responses
        driven = drive @ of.by_side
        slower = self.massless**2
        yielding = at.constant * at.values * (slower @ (of.rate**2 * start.local))
        rates = self.squares[:, 0] + sigma * squares[:, 0] - slower @ (of.mobility * of.rate)
        outside_by = at.values * self.driven[:, 0] + sigma * driven[:, 0] + yielding - at.values * rates * pushed
        inside_by = at.values * self.driven[:, 1] + sigma * driven[:, 1]
        whole = at.values * (self.outside + self.inside) + sigma * (
            at.values * self.driven.sum(axis=1) + sigma * driven.sum(axis=1) + yielding
        )
        whole = whole - at.values * (self.rates + sigma * rates) * pushed
        whole = whole - at.values * (2.0 * sigma * self.squares[:, 1] + sigma * sigma * squares[:, 1]) * statically
        inside_by = inside_by - at.values * (self.squares[:, 1] + sigma * squares[:, 1]) * statically
        gravity, mass, length = self.around.gravity, self.around.mass, self.length
        speed = float(start.speed + start.velocity @ of.shape)
        rate = gravity * rule.time + (at.vectors @ outside_by).real - rule.integral @ force / mass
        closing = rate + (at.vectors @ inside_by).real
        approach = rule.time * (speed + gravity * length * rule.time) + (at.vectors @ whole).real
        return approach - 2.0 * length / mass * (rule.integral_twice @ force), rate, closing


def own_drive(of: Oscillators, at: Spectrum, length: float, start: State) -> Complex:
    """Return what drives each oscillator without contact force, in the eigenvectors (N, n): its motion at the start, going on."""
    stiffness = of.angular_frequency**2
    pull = of.damping * start.velocity + stiffness * start.displacement
    return np.asarray(-at.constant[:, None] * pull - (length * at.time)[:, None] * (stiffness * start.velocity))


def impedance_of(of: Oscillators, sigma: Complex) -> Complex:
    """Return 1 + 2 zeta omega sigma + omega^2 sigma^2 of each oscillator, (N, n)."""
    column = sigma[:, None]
    return np.asarray(1.0 + column * (of.damping + of.angular_frequency**2 * column))
