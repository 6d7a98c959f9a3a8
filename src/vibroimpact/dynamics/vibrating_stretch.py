r"""A stretch of contact of bodies that vibrate, solved at once on the nodes of Radau collocation.

The unknowns are the contact forces at the nodes. All else is linear in them: collocation integrates by a matrix
Q, and with its eigenvalues :math:`\lambda_k` the oscillators are seen only through their receptance at the complex
frequencies :math:`1/\sigma_k`, :math:`\sigma_k = h \lambda_k`,

.. math:: G(\sigma) = \sum_i \frac{\chi_i^2 \sigma^2}{1 + 2 \zeta_i \omega_i \sigma + \omega_i^2 \sigma^2}

so that their number hardly counts. Radau collocation is stable however stiff an oscillator is: one that is much
faster than the stretch follows the force, and one that is not is integrated with order 2 N - 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats, Map, Rule, collocation_rule
from vibroimpact.dynamics.local import Linearised, LocalContact
from vibroimpact.dynamics.oscillators import Oscillators, State

Complex = NDArray[np.complex128]

NODES = 12
"""More would make the eigenvectors of the integration matrix too ill-conditioned, fewer the stretches too short."""

_SWEEPS = 25
_UNIT = np.eye(NODES)
_CONVERGED, _STALLED = 1e-13, 1e-11
_ROUNDING = 2e-14  # of the energy of the oscillators, which may be much more than that of a soft touch


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


@dataclass(frozen=True)
class VibratingStretch:
    """A solved stretch of one drop.

    `length`: how long it lasts [s]. `start`: the state then. `static`, `dissipative`: parts of the force at the nodes [N].
    `approach`, `rate`: of the surfaces [m], and what the dashpot of the law feels [m/s], at its start and at the nodes
    (N + 1,). `solved`: whether Newton's method converged. `broken`: what is lost at its end, as a sticking contact breaks [J].
    """

    around: Surroundings
    local: LocalContact
    spectrum: Spectrum
    length: float
    start: State
    static: Floats
    dissipative: Floats
    approach: Floats
    rate: Floats
    solved: bool
    broken: float = 0.0

    @property
    def force(self) -> Floats:
        """The force at the nodes [N]."""
        return self.static + self.dissipative

    @property
    def duration(self) -> Floats:
        """How long it lasts [s], as an array of one."""
        return np.array([self.length])

    def take(self, drops: NDArray[np.bool_]) -> VibratingStretch:
        """Return itself: it is of one drop."""
        return self

    @property
    def rule(self) -> Rule:
        """Nodes and time map."""
        return self.spectrum.rule

    @cached_property
    def accelerations(self) -> tuple[Floats, Floats]:
        """Accelerations of the oscillators (N, n), and rates of the massless elements (N, k), at the nodes."""
        of, at, sigma = self.around.oscillators, self.spectrum, self.length * self.spectrum.values
        force, static = ((at.inverse @ part)[:, None] for part in (self.force, self.static))
        drive = _own_drive(of, at, self.length, self.start) - of.outer * force - (of.shape - of.outer) * static
        oscillators = at.vectors @ (drive / impedance_of(of, sigma))
        massless = -of.mobility * force - at.constant[:, None] * (of.rate * self.start.local)
        return np.asarray(oscillators.real), np.asarray((at.vectors @ (massless / (1.0 + of.rate * sigma[:, None]))).real)

    @cached_property
    def velocities(self) -> Floats:
        """Velocities of the oscillators at the nodes (N, n)."""
        return np.asarray(self.start.velocity + self.length * (self.rule.integral @ self.accelerations[0]))

    @property
    def closing(self) -> Floats:
        """Rate of the approach of the surfaces, the oscillators inside the contact included, at the start and the nodes (N + 1,)."""
        of = self.around.oscillators
        if not of.inside.any():
            return self.rate
        return self.rate + np.concatenate([self.start.velocity[None], self.velocities]) @ (of.shape - of.outer)

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (T,)."""
        start, h, across, gravity = self.start, self.length, np.asarray(time), self.around.gravity
        integral, (accelerations, massless) = h * self.rule.integral_to(self._x(time)), self.accelerations
        pull = -self.force / self.around.mass
        return State(
            start.approach + across * (start.speed + 0.5 * gravity * across) + integral @ (h * (self.rule.integral @ pull)),
            start.speed + gravity * across + integral @ pull,
            start.displacement + integral @ self.velocities,
            start.velocity + integral @ accelerations,
            start.local + integral @ massless,
        )

    @cached_property
    def end(self) -> State:
        """The state at the end."""
        start, h, last = self.start, self.length, self.rule.integral[-1]
        gained, (_, massless) = self.rule.integral @ self.force, self.accelerations
        gravity, mass = self.around.gravity, self.around.mass
        return State(
            start.approach + h * (start.speed + 0.5 * gravity * h) - h * h * (last @ gained) / mass,
            start.speed + gravity * h - h * gained[-1] / mass,
            start.displacement + h * (last @ self.velocities),
            self.velocities[-1],
            start.local + h * (last @ massless),
        )

    def motion(self, x: Floats) -> tuple[Floats, Floats]:
        """Return approach [m], at least that of release, and rate [m/s] of the surfaces at x in [0, 1]."""
        weights = self.rule.weights(np.asarray(x, dtype=float)).T
        return np.maximum(weights @ self.approach, self.local.release_level), weights @ self.rate

    def force_at(self, x: Floats) -> Floats:
        """Return the contact force, clipped where the law may not pull [N], at x in [0, 1]."""
        static, dissipative = self.local.forces(*self.motion(x))
        force = static + dissipative
        return np.asarray(force if self.local.law.tension == "kept" else np.maximum(force, 0.0))

    def indentation_at(self, x: Floats) -> Floats:
        """Return the approach of the sphere's centre to the surface of the body below [m] at x in [0, 1]."""
        return np.asarray(self.rule.weights(np.asarray(x, dtype=float)).T @ self._indentations)

    @cached_property
    def _indentations(self) -> Floats:
        """The same at the start and at the nodes, (N + 1,)."""
        of, start, h, rule = self.around.oscillators, self.start, self.length, self.rule
        velocity = start.speed - h / self.around.mass * (rule.integral @ self.force) + self.velocities @ of.below
        gravity = 0.5 * self.around.gravity * (h * rule.time) ** 2
        begun = float(of.indentation(start))
        return np.append(begun, begun + h * (rule.integral @ velocity) + gravity)

    @cached_property
    def powers(self) -> Floats:
        """What is lost at the nodes [W], (N, n + 1): in each oscillator; last, in the law and the massless elements."""
        of = self.around.oscillators
        contact = self.dissipative * self.rate[1:] + (self.accelerations[1] ** 2 / of.mobility).sum(axis=1)
        return np.concatenate([of.damping * self.velocities**2, contact[:, None]], axis=1)

    @cached_property
    def lost(self) -> Floats:
        """What is lost over the stretch, with what is at its end [J], (n + 1,) as in `powers`."""
        lost = self.length * (self.rule.integral[-1] @ self.powers)
        lost[-1] += self.broken
        return np.asarray(lost)

    def lost_by(self, time: Floats) -> Floats:
        """Return what is lost since the start [J] at times since then [s], (T, n + 1) as in `powers`."""
        return np.asarray(self.length * self.rule.integrate(self._x(time), self.powers))

    def forget(self) -> None:
        """Let go of the motion of the oscillators at the nodes, which is found again when it is asked for."""
        for name in ("accelerations", "velocities", "powers", "_indentations"):
            self.__dict__.pop(name, None)

    def _x(self, time: Floats) -> Floats:
        return self.rule.unmap_time(np.asarray(time) / self.length)

    @property
    def roughness(self) -> float:
        """The last Legendre coefficients of the force, beside what matters: with the square of it the error at the end goes."""
        force = self.around.mass * np.abs(self.rate).max() / self.length
        return float(self.rule.tail(self.force[:, None], np.array([force]))[0])

    def resolved(self, tolerance: float, speed: float) -> bool:
        """Is it solved, and its error within a relative tolerance, for motions of about a speed [m/s]?

        Two measures that know nothing of each other: the roughness of the force, and the balance of energy.
        """
        if not (self.solved and self.roughness**2 <= tolerance):
            return False
        lost = float(self.lost.sum())
        begun, done = self.local.work(np.maximum(self.approach[[0, -1]], self.local.release_level))
        gain = mechanical_energy(self.around, self.end) + done - mechanical_energy(self.around, self.start) - begun
        rounding = _ROUNDING * float(sum(part.sum() for part in self.around.oscillators.energies(self.start)))
        return bool(abs(gain + lost) <= 0.03 * tolerance * self.around.mass * speed**2 + rounding)


def mechanical_energy(around: Surroundings, state: State) -> float:
    """Return kinetic, potential and strain energy [J] of a state, without what the contact law holds."""
    of = around.oscillators
    sphere = around.mass * (0.5 * state.speed**2 - around.gravity * state.approach)
    return float(sphere + sum(part.sum() for part in of.energies(state)) + of.local_energy(state))


def solve_vibrating(
    around: Surroundings,
    local: LocalContact,
    time_map: Map,
    length: float,
    start: State,
    forces: tuple[Floats, Floats] | None = None,
) -> VibratingStretch:
    """Solve the motion through a stretch of contact of given length [s]; a guess of both parts of the force makes it quicker."""
    of, at, floor = around.oscillators, spectrum(time_map, local.law.root), local.release_level
    rule = at.rule
    impedance = impedance_of(of, length * at.values)
    free_approach, free_rate = unforced(of, at, length, start, around.gravity, impedance)
    by_force, rate_by, by_static = receptance(around, at, length, impedance)
    begun, begun_rate = max(float(of.approach(start)), floor), float(of.outer_rates(start))
    if forces is None:  # that at the start goes on, and what the motion under it gives
        static, dissipative = (np.full(NODES, float(part)) for part in local.forces(np.array(begun), np.array(begun_rate)))
        approach = np.maximum(free_approach - by_force @ (static + dissipative) - by_static @ static, floor)
        static, dissipative = local.forces(approach, free_rate - rate_by @ (static + dissipative))
    else:
        static, dissipative = forces
    scale = around.mass * (np.abs(free_rate).max() / length + around.gravity)
    solved, before, guess = False, np.inf, None
    for _ in range(_SWEEPS):
        force = static + dissipative
        approach, rate = free_approach - by_force @ force - by_static @ static, free_rate - rate_by @ force
        now = local.linearised(np.maximum(approach, floor), rate, guess)
        guess = now.delta
        jacobian, _ = force_jacobian(now, approach > floor, by_force, rate_by, by_static)
        try:
            change = np.linalg.solve(jacobian, np.concatenate([static - now.static, dissipative - now.dissipative]))
        except np.linalg.LinAlgError:
            break
        static, dissipative = static - change[:NODES], dissipative - change[NODES:]
        size = float(np.abs(change).max()) / (scale + float(np.abs(static).max()))
        solved = size < _CONVERGED or (size < _STALLED and size > 0.3 * before)
        if solved or not np.isfinite(size):
            break
        before = size
    force = static + dissipative
    approach, rate = free_approach - by_force @ force - by_static @ static, free_rate - rate_by @ force
    if of.mobility.size:  # a dashpot takes up a jump of the force at once
        begun_rate = float(rule.interpolate(np.zeros(1), rate)[0])
    return VibratingStretch(
        around, local, at, length, start, static, dissipative, np.append(begun, approach), np.append(begun_rate, rate), solved
    )


def force_jacobian(
    now: Linearised, held: NDArray[np.bool_], by_force: Floats, rate_by: Floats, by_static: Floats
) -> tuple[Floats, tuple[Floats, Floats, Floats]]:
    """Return the Jacobian of the equations of both parts of the force at the nodes, (2 N, 2 N).

    And the derivatives of the static part by the approach, of the dissipative part by it, and by the rate, (N,): the first two are zero
    where the surfaces are not `held` together.
    """
    static_slope, slope, damping = now.static_by_approach * held, now.dissipative_by_approach * held, now.dissipative_by_rate
    stiff, damped = static_slope[:, None] * by_force, slope[:, None] * by_force + damping[:, None] * rate_by
    jacobian = np.block([[_UNIT + stiff + static_slope[:, None] * by_static, stiff], [damped + slope[:, None] * by_static, _UNIT + damped]])
    return jacobian, (static_slope, slope, damping)


def _own_drive(of: Oscillators, at: Spectrum, length: float, start: State) -> Complex:
    """Return what drives each oscillator without contact force, in the eigenvectors (N, n): its motion at the start, going on."""
    stiffness = of.angular_frequency**2
    pull = of.damping * start.velocity + stiffness * start.displacement
    return np.asarray(-at.constant[:, None] * pull - (length * at.time)[:, None] * (stiffness * start.velocity))


def unforced(of: Oscillators, at: Spectrum, length: float, start: State, gravity: float, impedance: Complex) -> tuple[Floats, Floats]:
    """Return the approach [m], and the rate outside the contact [m/s], at the nodes as they would be without contact force."""
    sigma, time = length * at.values, length * at.rule.time
    responses = _own_drive(of, at, length, start) / impedance
    massless = -at.constant * ((of.rate * start.local) / (1.0 + of.rate * sigma[:, None])).sum(axis=1)
    rate = float(start.speed + start.velocity @ of.outer) + gravity * time
    rate = rate + (at.vectors @ (sigma * (responses @ of.outer) + massless)).real
    approach = of.approach(start) + time * (start.speed + start.velocity @ of.shape + 0.5 * gravity * time)
    return np.asarray(approach + (at.vectors @ (sigma * (sigma * (responses @ of.shape) + massless))).real), rate


def receptance(around: Surroundings, at: Spectrum, length: float, impedance: Complex) -> tuple[Floats, Floats, Floats]:
    """Return by how much forces at the nodes take back the approach and the rate there, and static ones the approach, (N, N)."""
    of, sigma, mass = around.oscillators, length * at.values, around.mass
    squares = of.shape**2 / impedance
    rates = sigma * squares[:, ~of.inside].sum(axis=1) + (of.mobility / (1.0 + of.rate * sigma[:, None])).sum(axis=1)
    parts = (sigma * rates, rates, sigma * sigma * squares[:, of.inside].sum(axis=1))
    by_force, rate_by, by_static = (((at.vectors * part) @ at.inverse).real for part in parts)
    by_force += length * length / mass * at.rule.integral_twice
    return by_force, rate_by + length / mass * at.rule.integral, by_static


def impedance_of(of: Oscillators, sigma: Complex) -> Complex:
    """Return 1 + 2 zeta omega sigma + omega^2 sigma^2 of each oscillator, (N, n)."""
    column = sigma[:, None]
    return np.asarray(1.0 + column * (of.damping + of.angular_frequency**2 * column))
