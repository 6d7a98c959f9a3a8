"""The motion in a phase of a contact that was solved in the phase plane, as a function of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Legendre

from vibroimpact.arrays import Bools, Floats
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.phase_plane.phase import PlanePath, PlanePhase

_STEPS = 4


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

    def elapsed(self) -> list[Legendre]:
        """Return the time between the deep end of each segment and y, of one drop [s]."""
        return [pace.integ(lbnd=0.0) for pace in self._series(-self.rule.indentation_slope(self.levels) / np.sqrt(self.squares))]

    def grid(self) -> Floats:
        """Return times since the start at which the motion of one drop is well resolved [s]."""
        y, begin, times = np.linspace(0.0, 1.0, 61), 0.0, []
        for elapsed in self.elapsed():
            times.append(begin + elapsed(y))
            begin = float(times[-1][-1])
        since = np.unique(np.concatenate(times))
        if self.name == "compression":
            since = since[-1] - since[::-1]
        return np.append(since[since < self.duration[0]], self.duration[0])

    def at(self, time: Floats, encounter: Encounter) -> tuple[Floats, Floats, Floats]:
        """Return indentation [m], its rate [m/s] and the energy dissipated since the start [J] of one drop at times since then [s]."""
        rule, levels, compressing = self.rule, self.levels, self.name == "compression"
        sign, slope = 1.0 if compressing else -1.0, rule.indentation_slope(levels)
        velocity = sign * rule.factor * np.sqrt(self.squares)
        static, dissipative = encounter.law.forces(rule.indentations(levels), velocity, encounter.approach_speed)
        losses = [power.integ(lbnd=0.0) for power in self._series(-sign * dissipative * rule.factor * slope)]
        rates = self._series(2.0 * (encounter.gravity - (static + dissipative) / encounter.mass) * slope)
        squares = self._series(self.squares)

        elapsed = self.elapsed()
        lengths = np.array([float(one(1.0)) for one in elapsed])
        ends = np.cumsum(lengths)
        since = np.clip(ends[-1] - time if compressing else time, 0.0, ends[-1])  # time from or to the deep end
        segments = np.minimum(np.searchsorted(ends, since), rule.segments - 1)
        delta, square, lost = (np.empty_like(since) for _ in range(3))
        spent = 0.0
        for number in range(rule.segments):
            here, touches = segments == number, rule.touches and number == rule.segments - 1
            y = _place(elapsed[number], since[here] - (ends[number] - lengths[number]), rule.root if touches else 1)
            shape, factor = rule.shape_at(np.full(len(y), number), y)
            delta[here] = levels[number + 1, 0] + (levels[number, 0] - levels[number + 1, 0]) * shape
            if number == 0 and rule.turns:
                square[here] = factor**2 * squares[0](y)
            else:
                begun = self.ends[number - 1, 0] if number else self.begun[0]
                square[here] = begun + rates[number].integ(lbnd=0.0)(y)
            lost[here] = spent + losses[number](y)
            spent += float(losses[number](1.0))
        rate = np.sqrt(np.maximum(square, 0.0))
        return (delta, rate, spent - lost) if compressing else (delta, -rate, lost)

    def _series(self, values: Floats) -> list[Legendre]:
        """Return the interpolating polynomials in y of values at the nodes (S N, 1), one per segment."""
        return [Legendre(self.rule.coefficients @ part[:, 0], domain=[0.0, 1.0]) for part in self.rule.split(values)]


def _place(elapsed: Legendre, since: Floats, root: int) -> Floats:
    """Return y in a segment at times since its deep end [s], by Newton's method in a root of the remaining time."""
    pace, length, grid = elapsed.deriv(), float(elapsed(1.0)), np.linspace(0.0, 1.0, 65)

    def remaining(time: Floats) -> Floats:
        return np.maximum(length - time, 0.0) ** (1.0 / root)

    wanted = remaining(since)
    y = np.interp(-wanted, -remaining(elapsed(grid)), grid)
    for _ in range(_STEPS):
        now = remaining(elapsed(y))
        with np.errstate(all="ignore"):
            step = (now - wanted) * root * now ** (root - 1) / pace(y)
        y = np.clip(y + np.where(np.isfinite(step), step, 0.0), 0.0, 1.0)
    return np.where(wanted > 0.0, y, 1.0)
