"""A stretch of contact, solved by Newton's method on the collocation equations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.dynamics.collocation import Rule, collocation_rule
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.linear_equations import stacked_inverse

Aim = Literal["duration", "turn", "indentation", "force"]
"""The end of a stretch: a given duration, or the point where the indentation rate is zero, the indentation has a
given level, or the contact force is zero."""

_CONVERGED = 1e-13
_STALLED = 1e-11  # accepted where rounding prevents further convergence
_SHARED_SWEEPS = 30
_REFRESHES = 5
_OWN_SWEEPS = 12


@dataclass(frozen=True)
class Stretch:
    """A solved stretch of contact of some drops; arrays are (N, b) at the nodes, or (b,).

    `duration`, `delta`, `velocity`: how long it lasts [s], indentation [m] and rate [m/s] at its start.
    `node_delta`, `node_velocity`, `node_acceleration`: the same at the nodes of `rule`.
    `dissipated`: energy lost [J]. `solved`: whether Newton's method converged.
    """

    rule: Rule
    duration: Floats
    delta: Floats
    velocity: Floats
    node_delta: Floats
    node_velocity: Floats
    node_acceleration: Floats
    dissipated: Floats
    solved: Bools

    def resolved(self, encounter: Encounter, tolerance: float) -> Bools:
        """Return whether the stretch is solved, with an error within a relative tolerance.

        Two measures that know nothing of each other: the last Legendre coefficients of the acceleration, with
        whose square the error at the end goes, and the balance of energy over the stretch.
        """
        mass, law = encounter.mass, encounter.law
        end_delta, end_velocity = np.maximum(self.node_delta[-1], encounter.floor), self.node_velocity[-1]
        gain = 0.5 * mass * (end_velocity - self.velocity) * (end_velocity + self.velocity)
        gain += law.elastic_energy(end_delta) - law.elastic_energy(self.delta) - mass * encounter.gravity * (end_delta - self.delta)
        gain += law.plastic_work(end_delta) - law.plastic_work(self.delta)
        scale = mass * encounter.speed_scale**2
        rounding = _rounding(encounter) * mass * np.abs(self.node_acceleration).max(axis=0)
        closes = np.abs(gain + self.dissipated) <= np.maximum(0.1 * tolerance * scale, rounding)
        # an acceleration too small to change the speed need not be resolved: of a creeping sphere it is rounding
        needed = np.abs(self.node_velocity).max(axis=0) / self.duration
        smooth = self.rule.tail(self.node_acceleration, needed) ** 2 <= tolerance
        return np.asarray(self.solved & (self.duration > 0.0) & closes & smooth)

    @property
    def begins_at(self) -> float:
        """Return the indentation at its start, of one drop [m]."""
        return float(self.delta[0])

    def grid(self) -> Floats:
        """Return times since the start at which the motion of one drop is well resolved [s]."""
        return np.asarray(self.duration[0] * self.rule.map_time(np.linspace(0.0, 1.0, 61)))

    def at(self, time: Floats, encounter: Encounter) -> tuple[Floats, Floats, Floats]:
        """Return indentation [m], its rate [m/s] and the energy dissipated since the start [J] of one drop at times since then [s]."""
        x = self.rule.unmap_time(time / self.duration[0])
        # the power is a product of two functions that N nodes resolve: it needs 2 N
        finer = collocation_rule(2 * len(self.rule.nodes), self.rule.time_map, self.rule.root)
        delta, velocity = self._motion(finer.nodes, encounter)
        _, dissipative = encounter.law.forces(delta, velocity, encounter.approach_speed)
        return *self._motion(x, encounter), self.duration[0] * finer.integrate(x, dissipative * velocity)

    def _motion(self, x: Floats, encounter: Encounter) -> tuple[Floats, Floats]:
        """Return the indentation [m] and its rate [m/s] of one drop at places x of the rule."""
        delta = self.delta[0] + self.duration[0] * self.rule.integrate(x, self.node_velocity[:, 0])
        velocity = self.velocity[0] + self.duration[0] * self.rule.integrate(x, self.node_acceleration[:, 0])
        return np.maximum(delta, encounter.floor), velocity

    def take(self, drops: Bools) -> Stretch:
        """Return the stretch of the drops under a mask."""
        if drops.all():
            return self
        return Stretch(
            self.rule,
            self.duration[drops],
            self.delta[drops],
            self.velocity[drops],
            self.node_delta[:, drops],
            self.node_velocity[:, drops],
            self.node_acceleration[:, drops],
            self.dissipated[drops],
            self.solved[drops],
        )


@dataclass
class WarmStart:
    """Starting values of Newton's method: the dimensionless unknowns, and the inverse Jacobian of a similar stretch.

    Impacts resemble the ones before: in units of its own speed and time scale, the solution of one is a
    good guess for the next, and so is its Jacobian.
    """

    unknowns: Floats
    """Accelerations at the nodes in `acceleration_unit`, and the duration as a part of its scale, (N + 1, B)."""
    inverse: Floats | None = None
    """Inverse Jacobian, (N + 1, N + 1); replaced by the last one that was used."""


def acceleration_unit(encounter: Encounter, velocity: Floats, duration: Floats) -> Floats:
    """Return the unit of the dimensionless accelerations [m/s^2], from a scale of the duration [s]."""
    return np.asarray(np.maximum(np.abs(velocity), encounter.speed_scale) / duration)


def solve_stretch(
    encounter: Encounter,
    rule: Rule,
    delta: Floats,
    velocity: Floats,
    duration: Floats,
    start: WarmStart,
    aim: Aim,
    level: Floats,
) -> Stretch:
    r"""Solve the motion of B drops through one stretch of contact.

    The unknowns are the accelerations at the N nodes and the duration, made dimensionless; the equations
    are :math:`a_i = g - F(\delta_i, \dot\delta_i)/m`, with :math:`\dot\delta` and :math:`\delta` from Radau
    collocation, and the `aim`. Newton's method uses the Jacobian of one drop for all of them, which costs
    one small inverse for the whole batch; the drops it does not bring home get Jacobians of their own.

    Parameters
    ----------
    encounter : Encounter
        The impact, of B drops.
    rule : Rule
        Nodes and time map.
    delta, velocity : array, shape (B,)
        Indentation [m] and its rate [m/s] at the start.
    duration : array, shape (B,)
        The duration [s], or a scale of it.
    start : WarmStart
        Guess of the unknowns and, where there is one, of the inverse Jacobian; gets the last one used.
    aim : {"duration", "turn", "indentation", "force"}
        What ends the stretch.
    level : array, shape (B,)
        The indentation [m] to end at, for that aim.
    """
    newton = _Newton(encounter, rule, delta, velocity, duration, aim, level)
    unknowns = start.unknowns.copy()
    solved = newton.improve_together(unknowns, start)
    left = np.flatnonzero(~solved)
    if left.size:
        alone = _Newton(encounter.take(left), rule, delta[left], velocity[left], duration[left], aim, level[left])
        own = start.unknowns[:, left]
        solved[left] = alone.improve_each(own)
        unknowns[:, left] = own
    node_delta, node_velocity = newton.motion(unknowns)
    accelerations = unknowns[:-1] * newton.acceleration_unit
    _, dissipative = encounter.law.forces(np.maximum(node_delta, encounter.floor), node_velocity, encounter.approach_speed)
    lasts = unknowns[-1] * duration
    lost = lasts * (rule.integral[-1] @ (dissipative * node_velocity))
    return Stretch(rule, lasts, delta, velocity, node_delta, node_velocity, accelerations, lost, solved)


class _Newton:
    """Newton's method for one call of `solve_stretch`: its units, residual and Jacobian."""

    def __init__(
        self, encounter: Encounter, rule: Rule, delta: Floats, velocity: Floats, duration: Floats, aim: Aim, level: Floats
    ) -> None:
        self.encounter, self.rule, self.aim = encounter, rule, aim
        self.delta, self.velocity, self.level, self.duration = delta, velocity, level, duration
        self.acceleration_unit = acceleration_unit(encounter, velocity, duration)
        self.speed_unit = self.acceleration_unit * duration
        self.length_unit = self.speed_unit * duration
        self.settled = np.maximum(_STALLED, _rounding(encounter) / self.length_unit)

    def motion(self, unknowns: Floats) -> tuple[Floats, Floats]:
        """Return indentation and rate at the nodes."""
        scale = unknowns[-1]
        velocity = self.rule.integral @ unknowns[:-1]
        velocity *= self.speed_unit * scale
        velocity += self.velocity
        delta = self.rule.integral @ velocity
        delta *= self.duration * scale
        delta += self.delta
        return delta, velocity

    def residual(self, unknowns: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return the residual, and the indentation, rate and acceleration it was made from."""
        delta, velocity = self.motion(unknowns)
        end = delta[-1].copy()
        np.maximum(delta, self.encounter.floor, out=delta)
        acceleration = self.encounter.acceleration(delta, velocity)
        residual = np.empty_like(unknowns)
        np.divide(acceleration, self.acceleration_unit, out=residual[:-1])
        np.subtract(unknowns[:-1], residual[:-1], out=residual[:-1])
        if self.aim == "turn":
            residual[-1] = velocity[-1] / self.speed_unit
        elif self.aim == "indentation":
            residual[-1] = (end - self.level) / self.length_unit
        elif self.aim == "force":
            residual[-1] = unknowns[-2] - self.encounter.gravity / self.acceleration_unit
        else:
            residual[-1] = 0.0
        return residual, delta, velocity, acceleration

    def improve_together(self, unknowns: Floats, start: WarmStart) -> Bools:
        """Iterate on `unknowns` in place with one Jacobian for all drops; return which drops have converged."""
        middle = unknowns.shape[1] // 2
        scale = 1.0 + np.abs(unknowns).max()
        change = np.full(unknowns.shape[1], np.inf)
        refreshes, stale = 0, start.inverse is None
        for _ in range(_SHARED_SWEEPS):
            residual, *motion = self.residual(unknowns)
            if start.inverse is None:
                start.inverse = stacked_inverse(self.jacobian(np.array([middle]), unknowns, *motion))[0]
            before, change = change, self.apply(unknowns, start.inverse @ residual) / scale
            worst = change.max()
            stalled = worst > 0.3 * before.max() and bool((change < self.settled).all())
            if worst < _CONVERGED or stalled or not worst < 1e12:
                break
            stale = stale or change[middle] > 0.03 * before[middle]
            if stale and change[middle] > 1e-7 and refreshes < _REFRESHES:
                start.inverse, refreshes, stale = None, refreshes + 1, False
            elif refreshes == _REFRESHES and not (change < 0.9 * before).any():
                break
        if not np.isfinite(change[middle]):
            start.inverse = None
        return np.asarray(change < self.settled)

    def improve_each(self, unknowns: Floats) -> Bools:
        """Iterate on `unknowns` in place with a Jacobian for each drop; return which drops have converged."""
        everyone = np.arange(unknowns.shape[1])
        change = np.full(unknowns.shape[1], np.inf)
        for _ in range(_OWN_SWEEPS):
            residual, *motion = self.residual(unknowns)
            inverse = stacked_inverse(self.jacobian(everyone, unknowns, *motion))
            change = self.apply(unknowns, np.einsum("bij,jb->ib", inverse, residual)) / (1.0 + np.abs(unknowns).max(axis=0))
            if not (change >= _CONVERGED).any():
                break
        return np.asarray(change < self.settled)

    @staticmethod
    def apply(unknowns: Floats, step: Floats) -> Floats:
        """Subtract a step in place, with the change of the duration limited to a factor of three; return the size of the unlimited step."""
        size = np.abs(step).max(axis=0)
        limit = unknowns[-1] * (2.0 / 3.0)
        np.minimum(step[-1], limit, out=step[-1])
        np.maximum(step[-1], -3.0 * limit, out=step[-1])
        unknowns -= step
        return np.asarray(size)

    def jacobian(self, drops: Indices, unknowns: Floats, delta: Floats, velocity: Floats, acceleration: Floats) -> Floats:
        """Return the Jacobian of the residual for some drops, (b, N + 1, N + 1)."""
        encounter, speed_unit, length_unit, unit = self.encounter, self.speed_unit, self.length_unit, self.acceleration_unit
        if len(drops) < len(speed_unit):
            encounter, speed_unit, length_unit, unit = encounter.take(drops), speed_unit[drops], length_unit[drops], unit[drops]
            unknowns, delta, velocity, acceleration = unknowns[:, drops], delta[:, drops], velocity[:, drops], acceleration[:, drops]
        delta_step, velocity_step = 1e-7 * (delta.max(axis=0) - encounter.floor) + 1e-300, 1e-7 * speed_unit
        by_delta = (encounter.acceleration(delta + delta_step, velocity) - acceleration) * (length_unit / unit / delta_step)
        by_velocity = (encounter.acceleration(delta, velocity + velocity_step) - acceleration) * (speed_unit / unit / velocity_step)

        number, scale = len(self.rule.nodes), unknowns[-1][:, None, None]
        integral, twice = self.rule.integral, self.rule.integral_twice
        velocity_by = np.empty((len(drops), number, number + 1))
        np.multiply(scale, integral, out=velocity_by[:, :, :-1])
        velocity_by[:, :, -1] = (integral @ unknowns[:-1]).T
        delta_by = np.empty_like(velocity_by)
        np.multiply(scale * scale, twice, out=delta_by[:, :, :-1])
        delta_by[:, :, -1] = (integral @ (velocity / speed_unit) + unknowns[-1] * (twice @ unknowns[:-1])).T

        jacobian = np.zeros((len(drops), number + 1, number + 1))
        jacobian[:, :-1] = -by_delta.T[:, :, None] * delta_by - by_velocity.T[:, :, None] * velocity_by
        jacobian[:, np.arange(number), np.arange(number)] += 1.0
        if self.aim == "turn":
            jacobian[:, -1] = velocity_by[:, -1]
        elif self.aim == "indentation":
            jacobian[:, -1] = delta_by[:, -1]
        elif self.aim == "force":
            jacobian[:, -1, -2] = 1.0
        else:
            jacobian[:, -1, -1] = 1.0
        return jacobian


def _rounding(encounter: Encounter) -> Floats:
    """Return the rounding error of indentations in a dent [m], which matters where the dent is deep and the touch slow."""
    return np.asarray(16.0 * np.finfo(float).eps * np.abs(encounter.floor))
