"""The motion on a way that was solved in the phase plane, at any time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from vibroimpact.arrays import Bools, Floats
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.plane_rule import PlaneRule
from vibroimpact.dynamics.plane_way import Direction, PlaneWay

_STEPS = 4


@dataclass(frozen=True)
class PlaneMotion:
    """What a history keeps of a `PlaneWay` of some drops, or of as much of it as lasts `duration` [s] (b,).

    All else follows from the law, and is computed when it is asked for.
    """

    rule: PlaneRule
    direction: Direction
    levels: Floats
    begun: Floats
    squares: Floats
    ends: Floats
    duration: Floats

    @classmethod
    def of(cls, way: PlaneWay, duration: Floats) -> PlaneMotion:
        """Return the motion on a way that lasts some time [s]."""
        return cls(way.rule, way.direction, way.levels, way.begun, way.squares, way.ends, duration)

    def take(self, drops: Bools) -> PlaneMotion:
        """Return the motion of the drops under a mask."""
        if drops.all():
            return self
        arrays = (self.levels, self.begun, self.squares, self.ends, self.duration)
        return PlaneMotion(self.rule, self.direction, *(array[..., drops] for array in arrays))

    @property
    def start(self) -> float:
        """The indentation at which it starts, of one drop [m]."""
        return float(self.levels[-1 if self.direction == "in" else 0, 0])

    @property
    def stretch(self) -> Floats:
        """The derivative of the indentation by y over f, at the nodes of each segment, of one drop [m] (S, N)."""
        return np.asarray((self.levels[:-1] - self.levels[1:]) * self.rule.split(self.rule.slope)[:, :, 0])

    def elapsed(self) -> list[Callable[[Floats], Floats]]:
        """Return the time to or from the deep end of each segment as functions of y, of one drop [s]."""
        pace = -self.stretch / np.sqrt(self.rule.split(self.squares)[:, :, 0])
        return [_integral(self.rule, values) for values in pace]

    def grid(self) -> Floats:
        """Return times since its start that draw the motion of one drop well [s]."""
        y, begin, times = np.linspace(0.0, 1.0, 61), 0.0, []
        for elapsed in self.elapsed():
            times.append(begin + elapsed(y))
            begin = float(times[-1][-1])
        since = np.unique(np.concatenate(times))
        if self.direction == "in":
            since = since[-1] - since[::-1]
        return np.append(since[since < self.duration[0]], self.duration[0])

    def at(self, time: Floats, encounter: Encounter) -> tuple[Floats, Floats, Floats]:
        """Return indentation [m], its rate [m/s] and the loss since the start [J] of one drop at times since then [s]."""
        rule, stretch, coming = self.rule, self.stretch, self.direction == "in"
        spans = self.levels[:-1] - self.levels[1:]
        shape, factor, squares = (rule.split(part)[:, :, 0] for part in (rule.shape, rule.factor, self.squares))
        velocity = factor * np.sqrt(squares) * (1.0 if coming else -1.0)
        static, dissipative = encounter.law.forces(self.levels[1:] + spans * shape, velocity, encounter.approach_speed)
        loss = dissipative * factor * stretch * (-1.0 if coming else 1.0)
        by_y = 2.0 * (encounter.gravity - (static + dissipative) / encounter.mass) * stretch

        elapsed = self.elapsed()
        lengths = np.array([float(function(np.ones(1))[0]) for function in elapsed])
        ends = np.cumsum(lengths)
        since = np.clip(ends[-1] - time if coming else time, 0.0, ends[-1])  # to or from the deep end
        segments = np.minimum(np.searchsorted(ends, since), rule.segments - 1)
        delta, square, lost = (np.empty_like(since) for _ in range(3))
        spent = 0.0
        for number in range(rule.segments):
            here, losses = segments == number, _integral(rule, loss[number])
            y = self._place(number, elapsed[number], lengths[number], since[here] - (ends[number] - lengths[number]))
            place, f = rule.shape_at(np.full(len(y), number), y)
            delta[here] = self.levels[number + 1, 0] + spans[number, 0] * place
            if number == 0 and rule.turns:
                square[here] = f**2 * legendre.legval(2.0 * y - 1.0, rule.coefficients @ squares[0])
            else:
                begun = self.ends[number - 1, 0] if number else self.begun[0]
                square[here] = begun + _integral(rule, by_y[number])(y)
            lost[here] = spent + losses(y)
            spent += float(losses(np.ones(1))[0])
        rate = np.sqrt(np.maximum(square, 0.0))
        return (delta, rate, spent - lost) if coming else (delta, -rate, lost)

    def _place(self, segment: int, elapsed: Callable[[Floats], Floats], length: float, since: Floats) -> Floats:
        """Return the y of a segment at times since its deep end [s], by Newton's method in a root of the time that is left."""
        rule, grid = self.rule, np.linspace(0.0, 1.0, 65)
        pace = rule.coefficients @ (-self.stretch[segment] / np.sqrt(rule.split(self.squares)[segment, :, 0]))
        root = rule.root if rule.touches and segment == rule.segments - 1 else 1

        def left(time: Floats) -> Floats:
            return np.maximum(length - time, 0.0) ** (1.0 / root)

        wanted = left(since)
        y = np.interp(-wanted, -left(elapsed(grid)), grid)
        for _ in range(_STEPS):
            now = left(elapsed(y))
            with np.errstate(all="ignore"):
                step = (now - wanted) * root * now ** (root - 1) / legendre.legval(2.0 * y - 1.0, pace)
            y = np.clip(y + np.where(np.isfinite(step), step, 0.0), 0.0, 1.0)
        return np.where(wanted > 0.0, y, 1.0)


def _integral(rule: PlaneRule, values: Floats) -> Callable[[Floats], Floats]:
    """Return the integral over y from the deep end of a segment, of values at its nodes (N,)."""
    series = legendre.legint(rule.coefficients @ values, lbnd=-1) / 2.0
    return lambda y: np.asarray(legendre.legval(2.0 * y - 1.0, series))
