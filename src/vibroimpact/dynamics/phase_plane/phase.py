"""A way through the indentation solved at once in the phase plane: the way in, whose depth is sought, or the way out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.contact.static import static_work
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.collocation import PlaneRule

Direction = Literal["in", "out"]

_FEW = 0.5  # the part of the drops that goes on alone rather than let all of them wait
_LEAST = 1e-13  # rounding


@dataclass(frozen=True)
class PlanePath:
    """The speed over the indentation on a way of B drops: all else follows from it and the law.

    `levels`: indentations at the ends of its segments from the deepest on [m] (S + 1, B). `begun`: w at the deep end (B,), `squares`: u at
    the nodes of `rule` (S N, B), `ends`: w at the shallow ends of the segments [m^2/s^2] (S, B).
    """

    rule: PlaneRule
    direction: Direction
    levels: Floats
    begun: Floats
    squares: Floats
    ends: Floats


@dataclass(frozen=True)
class PlaneWay(PlanePath):
    """A way of B drops as it was solved; arrays are (S N, B) at the nodes, or (B,).

    `force`, `dissipative`: at the nodes [N]. `pace`: time by y, at the nodes [s]. `durations`: of the segments [s] (S, B). `dissipated`
    [J]. `tail`: the last terms of acceleration and pace, relative to what they make. `solved`: to the tolerance?
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
        """How long it takes [s]."""
        return np.asarray(self.durations.sum(axis=0))

    @property
    def loss(self) -> Floats:
        """The energy lost by y, at the nodes [J] (S N, B)."""
        sign = -1.0 if self.direction == "in" else 1.0
        return np.asarray(self.dissipative * (sign * self.rule.factor * self.rule.stretch(self.levels)))

    def of(self, values: Floats, segment: Indices) -> Floats:
        """Return values at the nodes (S N, B) of one segment a drop, (N, B)."""
        return values if self.rule.segments == 1 else self.rule.split(values)[segment, :, np.arange(values.shape[-1])].T

    def at(self, segment: Indices, y: Floats) -> tuple[Floats, Floats]:
        """Return indentation [m] and w [m^2/s^2] at y (B,) of one segment a drop."""
        column, (shape, factor) = np.arange(len(y)), self.rule.shape_at(segment, y)
        low = self.levels[segment + 1, column]
        square = (self.rule.weights_at(y) * self.of(self.squares, segment)).sum(axis=0)
        return low + (self.levels[segment, column] - low) * shape, factor * factor * square

    def grown(self, segment: Indices, y: Floats, *values: Floats) -> list[Floats]:
        """Return what values by y at the nodes (S N, B) each make between the deep end and y (B,) of one segment a drop."""
        weights, column = self.rule.weights_at(y), np.arange(len(y))
        return [np.asarray((weights * self.rule.grown(one)[segment, :-1, column].T).sum(axis=0)) for one in values]

    def put(self, drops: Indices, other: PlaneWay) -> None:
        """Take over the ways of some drops."""
        for name, values in vars(self).items():
            if isinstance(values, np.ndarray):
                values[..., drops] = getattr(other, name)


def solve_way(
    encounter: Encounter,
    rule: PlaneRule,
    direction: Direction,
    levels: Floats,
    squares: Floats,
    tolerance: float,
    sweeps: int,
    begun: Floats | None = None,
) -> PlaneWay:
    r"""Solve a way of B drops through the indentation by Newton's method, each drop on its own.

    With d the defect of w, the linearised equation for its correction e is a scalar one, and solved by quadrature:

    .. math:: e = d + M \int_0^y \frac{J d}{M} dz,\qquad M = \exp \int_0^y J\, dz,\qquad J = -\frac{d\delta}{dy}\, \frac{F_d}{m w}

    for a dissipative force F_d that goes with the rate, as nearly all do; for others it takes more sweeps. On the way in
    the logarithm of the first segment is corrected beside it, so that w at first touch is the square of the approach speed.

    Parameters
    ----------
    encounter : Encounter
        The impact.
    rule : PlaneRule
        Nodes and matrices.
    direction : {"in", "out"}
        Which way.
    levels : array, shape (S + 1, B)
        Indentations at the ends of the segments, from the deepest [m], which is a guess on the way in, to the shallow end.
    squares : array, shape (S N, B)
        A guess of u at the nodes.
    tolerance : float
        Relative error allowed, of the approach speed.
    sweeps : int
        How often to improve at most.
    begun : array, shape (B,), optional
        w at the deep end, where the motion does not turn there.
    """
    law, mass, gravity, speed = encounter.law, encounter.mass, encounter.gravity, encounter.approach_speed
    touch, per_mass, coming = speed * speed, -2.0 / mass, direction == "in"
    signed = rule.factor if coming else -rule.factor
    close = max(0.1 * tolerance, _LEAST) * touch
    static_power, loss_power = _powers(encounter, levels) if coming else (touch, touch)
    gravity, first = 2.0 * gravity, rule.number  # as the square of the speed changes with twice the acceleration
    for sweep in range(sweeps + 1):
        stretch, delta = rule.stretch(levels), rule.indentations(levels)
        velocity = np.sqrt(squares)
        velocity *= signed
        static, dissipative = law.forces(delta, velocity, speed)
        force = static + dissipative
        rate = force * per_mass
        rate += gravity
        rate *= stretch
        reached = rule.summed(rate)
        if begun is not None:
            reached += begun
        ends = reached[:, -1].copy()
        defect = reached[:, :-1].reshape(squares.shape)
        defect -= squares
        missing = touch - ends[-1] if coming else np.zeros_like(touch)
        apart = np.maximum(np.maximum(defect.max(axis=0), -defect.min(axis=0)), np.abs(missing))
        settled = apart <= close
        if sweep == sweeps or np.count_nonzero(~settled) <= _FEW * len(settled):
            break
        by_square = dissipative * stretch
        by_square /= squares
        by_square *= 0.5 * per_mass
        growth = rule.grown(by_square * rule.per_node)
        np.exp(growth, out=growth)
        shrunk = (1.0 / growth[:, :-1]).reshape(squares.shape)
        by_square *= defect
        by_square *= shrunk
        change = rule.summed(by_square)
        change *= growth
        defect += change[:, :-1].reshape(squares.shape)
        if coming:  # what a longer first segment changes, by the powers with which the forces grow
            part = (delta[:first] - levels[1]) / (delta[:first] - levels[-1]) if rule.segments > 1 else 1.0
            longer = static[:first] * (per_mass * (1.0 + static_power * part))
            longer += (per_mass * (1.0 + loss_power * part)) * dissipative[:first]
            longer += gravity
            longer *= stretch[:first]
            longer *= shrunk[:first]
            if rule.segments > 1:
                longer = np.concatenate([longer, np.zeros_like(rate[first:])])
            by_depth = rule.summed(longer)
            by_depth *= growth
            span, whole = levels[0] - levels[1], levels[0] - levels[-1]
            deeper = np.clip((missing - change[-1, -1]) / by_depth[-1, -1], -0.5, 0.35 * whole / span)
            defect += (deeper * by_depth[:, :-1]).reshape(squares.shape)
            levels = np.concatenate([(levels[1] + span * np.where(deeper > 0.0, 1.0 + deeper, np.exp(deeper)))[None], levels[1:]])
        squares = np.maximum(squares + defect, 0.1 * squares)
    pace = -stretch / np.sqrt(squares)
    durations = rule.weights @ rule.split(pace)
    tail = np.maximum(_last(rule, rate) / touch, 2.0 * _last(rule, pace) / durations.sum(axis=0))
    # the ends are off by the square of the last terms, what lies between by a small part of them
    solved = settled & (tail <= min(tolerance**0.5, 3e3 * tolerance))
    work = rule.factor * stretch
    if coming:  # all of the static work must be there, or the depth is off
        done = -(rule.weights @ rule.split(static * work)).sum(axis=0)
        solved &= np.abs(done - static_work(law, levels[0])) <= 0.05 * tolerance * mass * touch
    lost = (rule.weights @ rule.split(dissipative * work)).sum(axis=0) * (-1.0 if coming else 1.0)
    begun = np.zeros_like(touch) if begun is None else begun
    found = PlaneWay(rule, direction, levels, begun, squares, ends, force, dissipative, pace, durations, lost, tail, solved)
    late = np.flatnonzero(~settled)
    if late.size and sweep < sweeps:
        some = encounter.pick(late), rule, direction, levels[:, late], squares[:, late], tolerance, sweeps - sweep
        found.put(late, solve_way(*some, begun[late]))
    return found


def _last(rule: PlaneRule, values: Floats) -> Floats:
    return np.asarray(np.abs(rule.last @ rule.split(values)).max(axis=(0, 1)))


def _powers(encounter: Encounter, levels: Floats) -> tuple[Floats, Floats]:
    """Return the powers of the indentation with which the static and the dissipative force grow, half way up the deepest segment."""
    forces, speed = encounter.law.forces, encounter.approach_speed
    at = [levels[1] + part * (levels[0] - levels[1]) for part in (0.5, 0.55)]
    before, after = (forces(delta, 0.7 * speed, speed) for delta in at)
    wider = np.log((at[1] - levels[-1]) / (at[0] - levels[-1]))
    powers = [np.log(late / early) / wider for early, late in zip(before, after, strict=True)]
    return powers[0], np.where(before[1] > 0.0, powers[1], 0.0)
