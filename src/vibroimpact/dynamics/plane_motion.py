"""The motion on a way that was solved in the phase plane, at any time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.plane_way import PlaneWay

_STEPS = 4


@dataclass(frozen=True)
class PlaneMotion:
    """A way through the indentation, or as much of it as lasts `duration` [s] (b,)."""

    way: PlaneWay
    duration: Floats

    def take(self, drops: NDArray[np.bool_]) -> PlaneMotion:
        """Return the motion of the drops under a mask."""
        return self if drops.all() else PlaneMotion(self.way.pick(np.flatnonzero(drops)), self.duration[drops])

    @property
    def start(self) -> float:
        """The indentation at which it starts, of one drop [m]."""
        return float(self.way.levels[-1 if self.way.direction == "in" else 0, 0])

    def grid(self) -> Floats:
        """Return times since its start that draw the motion of one drop well [s]."""
        way, y = self.way, np.linspace(0.0, 1.0, 61)
        begins = np.cumsum(way.durations[:, 0]) - way.durations[:, 0]
        since = np.unique(np.concatenate([begin + _antiderivative(way, way.pace, number)(y) for number, begin in enumerate(begins)]))
        if way.direction == "in":
            since = since[-1] - since[::-1]
        return np.append(since[since < self.duration[0]], self.duration[0])

    def at(self, time: Floats, encounter: Encounter) -> tuple[Floats, Floats, Floats]:
        """Return indentation [m], its rate [m/s] and the loss since the start [J] of one drop at times since then [s]."""
        way, rule, whole = self.way, self.way.rule, float(self.way.durations.sum())
        coming = way.direction == "in"
        since = np.clip(whole - time if coming else time, 0.0, whole)  # to or from the deep end
        ends = np.cumsum(way.durations[:, 0])
        segments = np.minimum(np.searchsorted(ends, since), rule.segments - 1)
        delta, square, lost = (np.empty_like(since) for _ in range(3))
        acceleration = encounter.gravity - way.force / encounter.mass
        spans = (way.levels[:-1] - way.levels[1:])[:, None]
        by_y = 2.0 * acceleration * (spans * rule.split(rule.slope)).reshape(-1, 1)  # dw/dy over f
        begun, spent = way.begun[0], 0.0
        for number in range(rule.segments):
            here, losses = segments == number, _antiderivative(way, way.loss, number)
            y = self._place(number, since[here] - (ends[number] - way.durations[number, 0]))
            shape, factor = rule.shape_at(np.full(len(y), number), y)
            delta[here] = way.levels[number + 1, 0] + spans[number, 0, 0] * shape
            if number == 0 and rule.turns:
                square[here] = factor**2 * legendre.legval(2.0 * y - 1.0, rule.coefficients @ rule.split(way.squares)[0, :, 0])
            else:
                square[here] = begun + _antiderivative(way, by_y, number)(y)
            begun, lost[here] = way.ends[number, 0], spent + losses(y)
            spent += float(losses(np.ones(1))[0])
        velocity = np.sqrt(np.maximum(square, 0.0))
        return (delta, velocity, spent - lost) if coming else (delta, -velocity, lost)

    def _place(self, segment: int, since: Floats) -> Floats:
        """Return the y of a segment at times since its deep end [s], by Newton's method in a root of the time that is left."""
        way, rule = self.way, self.way.rule
        elapsed = _antiderivative(way, way.pace, segment)
        pace = rule.coefficients @ rule.split(way.pace)[segment, :, 0]
        root = rule.root if rule.touches and segment == rule.segments - 1 else 1
        whole, grid = float(elapsed(np.ones(1))[0]), np.linspace(0.0, 1.0, 65)

        def left(time: Floats) -> Floats:
            return np.maximum(whole - time, 0.0) ** (1.0 / root)

        wanted = left(since)
        y = np.interp(-wanted, -left(elapsed(grid)), grid)
        for _ in range(_STEPS):
            now = left(elapsed(y))
            with np.errstate(all="ignore"):
                step = (now - wanted) * root * now ** (root - 1) / legendre.legval(2.0 * y - 1.0, pace)
            y = np.clip(y + np.where(np.isfinite(step), step, 0.0), 0.0, 1.0)
        return np.where(wanted > 0.0, y, 1.0)


def _antiderivative(way: PlaneWay, values: Floats, segment: int) -> Callable[[Floats], Floats]:
    """Return the integral over y from the deep end of a segment, of values at the nodes (S N, 1)."""
    series = legendre.legint(way.rule.coefficients @ way.rule.split(values)[segment, :, 0], lbnd=-1) / 2.0
    return lambda y: np.asarray(legendre.legval(2.0 * y - 1.0, series))
