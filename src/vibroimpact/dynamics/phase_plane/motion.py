"""The motion in a phase of a contact that was solved in the phase plane, as a function of time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.phase import PlanePath, PlanePhase

_STEPS = 4
_BEFORE_END = 1.0 - 1e-9  # of the duration: a point later than this is its end, except for rounding


@dataclass(frozen=True)
class PlaneMotion(PlanePath):
    """The part of a `PlanePhase` that a history needs, over `duration` [s] (b,) from its start."""

    duration: Floats

    @classmethod
    def of(cls, phase: PlanePhase, duration: Floats) -> PlaneMotion:
        """Return the motion over the first `duration` [s] of a phase."""
        return cls(phase.rule, phase.name, phase.levels, phase.begun, phase.squares, phase.ends, duration)

    def take(self, drops: Bools) -> PlaneMotion:
        """Return the motion of the drops under a mask."""
        if drops.all():
            return self
        arrays = (self.levels, self.begun, self.squares, self.ends, self.duration)
        return PlaneMotion(self.rule, self.name, *(array[..., drops] for array in arrays))

    @property
    def begins_at(self) -> float:
        """Return the indentation at its start, of one drop [m]."""
        return float(self.levels[-1 if self.name == "compression" else 0, 0])

    def grid(self) -> Floats:
        """Return times since the start at which the motion of one drop is well resolved [s]."""
        elapsed = self.rule.integrals_of(self.pace)
        within = self.rule.weights_to_end(np.linspace(0.0, 1.0, 61)).T @ elapsed
        within[0] = 0.0  # where two segments meet there is one point, whatever the rounding
        since = np.unique(within + _sums_before(elapsed[-1]))
        if self.name == "compression":
            since = since[-1] - since[::-1]
        return np.append(since[since < _BEFORE_END * self.duration[0]], self.duration[0])

    def at(self, time: Floats, encounter: Encounter) -> tuple[Floats, Floats, Floats]:
        """Return indentation [m], its rate [m/s] and the energy dissipated since the start [J] of one drop at times since then [s]."""
        rule, levels, compressing, pace = self.rule, self.levels, self.name == "compression", self.pace
        sign, slope = self._sign, rule.indentation_slope(levels)
        static, dissipative = self.forces(encounter)
        losses = rule.integrals_of(-sign * dissipative * rule.factor * slope)
        squares = rule.integrals_of(2.0 * (encounter.gravity - (static + dissipative) / encounter.mass) * slope)
        squares += np.concatenate([self.begun, self.ends[:-1, 0]])
        if rule.turns:  # in the first segment w is y^2 u
            squares[:, 0] = rule.with_end(self.squares)[:, 0]

        elapsed = rule.integrals_of(pace)
        ends = np.cumsum(elapsed[-1])
        since = np.clip(ends[-1] - time if compressing else time, 0.0, ends[-1])  # time from or to the deep end
        segment = np.minimum(np.searchsorted(ends, since), rule.segments - 1)
        y = self._place(elapsed, pace, since - _sums_before(elapsed[-1])[segment], segment)
        shape, factor = rule.shape_at(segment, y)
        delta = levels[segment + 1, 0] + (levels[segment, 0] - levels[segment + 1, 0]) * shape
        square, lost = self._values([squares, losses], segment, y)
        rate = factor * np.sqrt(np.maximum(square, 0.0))
        lost = lost + _sums_before(losses[-1])[segment]
        return (delta, rate, losses[-1].sum() - lost) if compressing else (delta, -rate, lost)

    def forces(self, encounter: Encounter) -> tuple[Floats, Floats]:
        """Return the static and the dissipative part of the force at the nodes [N] (S N, b), before any clipping at zero."""
        velocity = self._sign * self.rule.factor * np.sqrt(self.squares)
        return encounter.law.forces(self.rule.indentations(self.levels), velocity, encounter.approach_speed)

    @property
    def _sign(self) -> float:
        """The direction of the indentation rate: 1 in compression, -1 in restitution."""
        return 1.0 if self.name == "compression" else -1.0

    @property
    def pace(self) -> Floats:
        """dt/dy at the nodes [s] (S N, b)."""
        return np.asarray(-self.rule.indentation_slope(self.levels) / np.sqrt(self.squares))

    def _values(self, series: Sequence[Floats], segment: Indices, y: Floats) -> list[Floats]:
        """Return the values at y (T,), each in a segment (T,), of quantities at the nodes and ends of the segments (N + 1, S)."""
        weights = self.rule.weights_to_end(y)
        return [np.asarray((weights * one[:, segment]).sum(axis=0)) for one in series]

    def _place(self, elapsed: Floats, pace: Floats, since: Floats, segment: Indices) -> Floats:
        """Return y at times since the deep end of a segment [s], by Newton's method in a root of the remaining time.

        `elapsed`: time from the deep end of each segment to its nodes and end [s], (N + 1, S); `pace`: dt/dy at all nodes [s], (S N, 1).
        """
        rule, grid = self.rule, np.linspace(0.0, 1.0, 65)
        roots = np.ones(rule.segments, dtype=int)
        if rule.touches:
            roots[-1] = rule.root
        length, root = elapsed[-1, segment], roots[segment]

        def remaining(time: Floats) -> Floats:
            return np.asarray(np.maximum(length - time, 0.0) ** (1.0 / root))

        wanted, y = remaining(since), np.empty_like(since)
        left = np.maximum(elapsed[-1] - rule.weights_to_end(grid).T @ elapsed, 0.0) ** (1.0 / roots)
        for number in range(rule.segments):
            here = segment == number
            y[here] = np.interp(-wanted[here], -left[:, number], grid)
        paces = rule.with_end(pace)
        for _ in range(_STEPS):
            time, slope = self._values([elapsed, paces], segment, y)
            now = remaining(time)
            with np.errstate(all="ignore"):
                step = (now - wanted) * root * now ** (root - 1) / slope
            y = np.clip(y + np.where(np.isfinite(step), step, 0.0), 0.0, 1.0)
        return np.where(wanted > 0.0, y, 1.0)


def _sums_before(values: Floats) -> Floats:
    """Return the sum of the values before each one."""
    return np.concatenate([[0.0], np.cumsum(values)[:-1]])
