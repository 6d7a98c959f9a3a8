"""The compression or the restitution phase of a contact, collocated as a whole in the phase plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.contact.static import static_work
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.collocation import PlaneRule

PhaseName = Literal["compression", "restitution"]

_FEW = 0.5  # of the drops: when no more than these have not converged, they are iterated apart, and the others are left as they are
_ROUNDING = 1e-13


@dataclass(frozen=True)
class PlanePath:
    """Speed over indentation in one phase of the contacts of B drops, from which all else follows by the contact law.

    `levels`: indentations at the ends of the segments, from the deepest on [m] (S + 1, B). `begun`: w at the deep end (B,), `squares`: u
    at the nodes of `rule` (S N, B), `ends`: w at the shallow ends of the segments [m^2/s^2] (S, B).
    """

    rule: PlaneRule
    name: PhaseName
    levels: Floats
    begun: Floats
    squares: Floats
    ends: Floats


@dataclass(frozen=True)
class PlanePhase(PlanePath):
    """Solution of one phase of the contacts of B drops; arrays are (S N, B) at the nodes, or (B,).

    `force`, `dissipative`: contact force and its dissipative part at the nodes [N]. `pace`: dt/dy at the nodes [s]. `durations`: of the
    segments [s] (S, B). `dissipated`: energy [J]. `tail`: the last Legendre coefficients of acceleration and pace, relative to their
    integrals. `solved`: whether the Newton iteration converged and the tail meets the tolerance.
    """

    force: Floats
    dissipative: Floats
    pace: Floats
    durations: Floats
    dissipated: Floats
    tail: Floats
    solved: Bools

    @property
    def duration(self) -> Floats:
        """Return the duration [s]."""
        return np.asarray(self.durations.sum(axis=0))

    @property
    def loss(self) -> Floats:
        """Return the derivative of the dissipated energy by y at the nodes [J] (S N, B)."""
        sign = -1.0 if self.name == "compression" else 1.0
        return np.asarray(self.dissipative * (sign * self.rule.factor * self.rule.indentation_slope(self.levels)))

    def of(self, values: Floats, segment: Indices) -> Floats:
        """Return the values at the nodes of one segment per drop (N, B), of values at all nodes (S N, B)."""
        return values if self.rule.segments == 1 else self.rule.split(values)[segment, :, np.arange(values.shape[-1])].T

    def at(self, segment: Indices, y: Floats) -> tuple[Floats, Floats]:
        """Return indentation [m] and w [m^2/s^2] at y (B,) in one segment per drop."""
        column, (shape, factor) = np.arange(len(y)), self.rule.shape_at(segment, y)
        low = self.levels[segment + 1, column]
        square = (self.rule.weights_at(y) * self.of(self.squares, segment)).sum(axis=0)
        return low + (self.levels[segment, column] - low) * shape, factor * factor * square

    def integrals(self, segment: Indices, y: Floats, *values: Floats) -> list[Floats]:
        """Return the integral from the deep end to y (B,) in one segment per drop, of each of several integrands at the nodes (S N, B)."""
        weights, column = self.rule.weights_at(y), np.arange(len(y))
        return [np.asarray((weights * self.rule.cumulative(one)[segment, :-1, column].T).sum(axis=0)) for one in values]

    def put(self, drops: Indices, other: PlanePhase) -> None:
        """Replace the solutions of some drops."""
        for name, values in vars(self).items():
            if isinstance(values, np.ndarray):
                values[..., drops] = getattr(other, name)


def solve_phase(
    encounter: Encounter,
    rule: PlaneRule,
    name: PhaseName,
    levels: Floats,
    squares: Floats,
    tolerance: float,
    sweeps: int,
    begun: Floats | None = None,
) -> PlanePhase:
    r"""Solve one phase of the contacts of B drops by Newton's method, each drop on its own.

    With d the residual of w, the linearised equation for its correction e is scalar, and is solved by quadrature:

    .. math:: e = d + M \int_0^y \frac{J d}{M} dz,\qquad M = \exp \int_0^y J\, dz,\qquad J = -\frac{d\delta}{dy}\, \frac{F_d}{m w}

    for a dissipative force F_d proportional to the indentation rate, as nearly all are; for others it takes more iterations. In
    compression, where the largest indentation is unknown, the logarithm of the first segment's length is corrected as well, so that w at
    first touch is the square of the approach speed.

    Parameters
    ----------
    encounter : Encounter
        The impact.
    rule : PlaneRule
        Nodes and matrices.
    name : {"compression", "restitution"}
        The phase.
    levels : array, shape (S + 1, B)
        Indentations at the ends of the segments [m], from the deepest, which is an estimate in compression, to the shallowest.
    squares : array, shape (S N, B)
        An estimate of u at the nodes.
    tolerance : float
        Relative error allowed, of the approach speed.
    sweeps : int
        Largest number of iterations.
    begun : array, shape (B,), optional
        w at the deep end, where the speed is not zero there.
    """
    law, mass, gravity, speed = encounter.law, encounter.mass, encounter.gravity, encounter.approach_speed
    touch, per_mass, compressing = speed * speed, -2.0 / mass, name == "compression"
    signed = rule.factor if compressing else -rule.factor
    close = max(0.1 * tolerance, _ROUNDING) * touch
    static_power, loss_power = _powers(encounter, levels) if compressing else (touch, touch)
    gravity, first = 2.0 * gravity, rule.number  # as the square of the speed changes with twice the acceleration
    for sweep in range(sweeps + 1):
        slope, delta = rule.indentation_slope(levels), rule.indentations(levels)
        velocity = np.sqrt(squares)
        velocity *= signed
        static, dissipative = law.forces(delta, velocity, speed)
        force = static + dissipative
        rate = force * per_mass
        rate += gravity
        rate *= slope
        reached = rule.cumulative_square(rate)
        if begun is not None:
            reached += begun
        ends = reached[:, -1].copy()
        defect = reached[:, :-1].reshape(squares.shape)
        defect -= squares
        missing = touch - ends[-1] if compressing else np.zeros_like(touch)
        apart = np.maximum(np.maximum(defect.max(axis=0), -defect.min(axis=0)), np.abs(missing))
        settled = apart <= close
        if sweep == sweeps or np.count_nonzero(~settled) <= _FEW * len(settled):
            break
        by_square = dissipative * slope
        by_square /= squares
        by_square *= 0.5 * per_mass
        growth = rule.cumulative(by_square * rule.per_node)
        np.exp(growth, out=growth)
        shrunk = (1.0 / growth[:, :-1]).reshape(squares.shape)
        by_square *= defect
        by_square *= shrunk
        change = rule.cumulative_square(by_square)
        change *= growth
        defect += change[:, :-1].reshape(squares.shape)
        if compressing:  # derivative by the length of the first segment, with forces taken as powers of the indentation
            part = (delta[:first] - levels[1]) / (delta[:first] - levels[-1]) if rule.segments > 1 else 1.0
            longer = static[:first] * (per_mass * (1.0 + static_power * part))
            longer += (per_mass * (1.0 + loss_power * part)) * dissipative[:first]
            longer += gravity
            longer *= slope[:first]
            longer *= shrunk[:first]
            if rule.segments > 1:
                longer = np.concatenate([longer, np.zeros_like(rate[first:])])
            by_depth = rule.cumulative_square(longer)
            by_depth *= growth
            span, whole = levels[0] - levels[1], levels[0] - levels[-1]
            deeper = np.clip((missing - change[-1, -1]) / by_depth[-1, -1], -0.5, 0.35 * whole / span)
            defect += (deeper * by_depth[:, :-1]).reshape(squares.shape)
            levels = np.concatenate([(levels[1] + span * np.where(deeper > 0.0, 1.0 + deeper, np.exp(deeper)))[None], levels[1:]])
        squares = np.maximum(squares + defect, 0.1 * squares)
    pace = -slope / np.sqrt(squares)
    durations = rule.weights @ rule.split(pace)
    tail = np.maximum(_last(rule, rate) / touch, 2.0 * _last(rule, pace) / durations.sum(axis=0))
    # collocation at Gauss nodes converges at the ends with the square of the last coefficient, in between with the coefficient
    solved = settled & (tail <= min(tolerance**0.5, 3e3 * tolerance))
    work = rule.factor * slope
    if compressing:  # the static work must add up, or the depth is wrong
        done = -(rule.weights @ rule.split(static * work)).sum(axis=0)
        solved &= np.abs(done - static_work(law, levels[0])) <= 0.05 * tolerance * mass * touch
    lost = (rule.weights @ rule.split(dissipative * work)).sum(axis=0) * (-1.0 if compressing else 1.0)
    begun = np.zeros_like(touch) if begun is None else begun
    found = PlanePhase(rule, name, levels, begun, squares, ends, force, dissipative, pace, durations, lost, tail, solved)
    late = np.flatnonzero(~settled)
    if late.size and sweep < sweeps:
        some = encounter.pick(late), rule, name, levels[:, late], squares[:, late], tolerance, sweeps - sweep
        found.put(late, solve_phase(*some, begun[late]))
    return found


def _last(rule: PlaneRule, values: Floats) -> Floats:
    """Return the largest of the last two Legendre coefficients over all segments (B,)."""
    return np.asarray(np.abs(rule.last @ rule.split(values)).max(axis=(0, 1)))


def _powers(encounter: Encounter, levels: Floats) -> tuple[Floats, Floats]:
    """Return the exponents with which static and dissipative force grow with the indentation, in the middle of the deepest segment."""
    forces, speed = encounter.law.forces, encounter.approach_speed
    at = [levels[1] + part * (levels[0] - levels[1]) for part in (0.5, 0.55)]
    before, after = (forces(delta, 0.7 * speed, speed) for delta in at)
    wider = np.log((at[1] - levels[-1]) / (at[0] - levels[-1]))
    powers = [np.log(late / early) / wider for early, late in zip(before, after, strict=True)]
    return powers[0], np.where(before[1] > 0.0, powers[1], 0.0)
