r"""One step of the contact of two rigid bodies: explicit, of order 8, in a variable in which the
motion is smooth.

Such a contact has one coordinate, the indentation. With s, the root of the indentation above that
of release in which the force is smooth,

.. math::

    \frac{ds}{d\tau} = v,\quad \frac{dv}{d\tau} = n s^{n-1} a(s^n, v),\quad \frac{dt}{d\tau} = n
    s^{n-1}

is smooth from touch to release (Sundman's time), where v is the rate of the indentation and a its
second derivative. A step that ends where the root, or the rate, has a given value takes that for
its variable (M. Henon, Physica D 5, 1982, 412-414), and is exact there. The motion within a step is
that at the end of a shorter one. Where damping is so strong that such steps become minute, they are
implicit.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Matrix
from vibroimpact.compiled import compiled, energies_at, force_at
from vibroimpact.dynamics.core.dormand_prince import (
    ERROR_OF_ORDER_3,
    ERROR_OF_ORDER_5,
    STAGE_WEIGHTS,
    STAGES,
)
from vibroimpact.dynamics.core.line_records import Advance, Line, LineState
from vibroimpact.dynamics.core.line_stiff import advance_implicitly

BY_FLOW, BY_ROOT, BY_RATE, FREE, IMPLICIT = range(5)
"""Variables of a step: Sundman's time; the root of the indentation; its rate; FREE: time, without a
contact force, in closed form; IMPLICIT: time, where damping is strong.
"""

_TINY = 1e-300
_ASIDE = 1e-6  # of the span: step of finite differences


@compiled
def root_of(line: Line, delta: float) -> float:
    """Return the root of the indentation above that of release, in which the force is smooth."""
    root = math.sqrt(max(delta - line.release, 0.0))
    if line.root == 2:
        return root
    return math.sqrt(root)  # line.root is 4


@compiled
def advance(line: Line, variable: int, begun: LineState, length: float, stages: Matrix) -> Advance:
    """Return the state after a step, with an estimate of its error.

    Parameters
    ----------
    line : Line
        The two bodies and their law.
    variable : int
        The variable of the step.
    begun : LineState
        Where it begins.
    length : float
        Its length in the variable.
    stages : array, shape (4, 13)
        Room for the derivatives at the stages.
    """
    gravity = line.gravity
    if variable == FREE:
        delta = begun.delta + length * (begun.rate + 0.5 * gravity * length)
        return Advance(
            LineState(begun.time + length, delta, begun.rate + gravity * length, begun.lost),
            0.0,
            0.0,
            0.0,
        )
    if variable == IMPLICIT:
        return advance_implicitly(line, begun, length)
    force = force_at(line.force)
    per_mass = 1.0 / line.mass
    is_square = line.root == 2
    begun_root = root_of(line, begun.delta)
    root = begun_root
    rate = begun.rate
    delta = begun.delta
    whole = 0.0
    least = np.inf
    # the last stage is the end of the step, whose derivatives the error estimate takes as well
    for stage in range(STAGES + 1):
        by_root = 0.0
        by_rate = 0.0
        for before in range(min(stage, STAGES)):
            by_root += STAGE_WEIGHTS[stage, before] * stages[0, before]
            by_rate += STAGE_WEIGHTS[stage, before] * stages[1, before]
        root = begun_root + length * by_root
        rate = begun.rate + length * by_rate
        # delta - release = s^n, of which n s^(n - 1) is the slope
        square = root * root
        if is_square:
            slope = 2.0 * root
            delta = line.release + square
        else:
            slope = 4.0 * square * root
            delta = line.release + square * square
        static, dissipative = force(delta, rate, line.speed, line.coefficients)
        whole = static + dissipative
        least = min(least, whole)
        change = slope * (gravity - whole * per_mass)
        # Henon: all derivatives by tau are divided by that of the variable, ds or dv/d tau
        pace = 1.0
        if variable == BY_ROOT:
            pace = 1.0 / rate
        elif variable == BY_RATE:
            pace = 1.0 / change
        # of s, v, t and the energy that damping takes
        stages[0, stage] = rate * pace
        stages[1, stage] = change * pace
        stages[2, stage] = slope * pace
        stages[3, stage] = dissipative * rate * slope * pace
    time = 0.0
    lost = 0.0
    for stage in range(STAGES):
        time += STAGE_WEIGHTS[STAGES, stage] * stages[2, stage]
        lost += STAGE_WEIGHTS[STAGES, stage] * stages[3, stage]
    error = 0.0
    for quantity in range(4):
        fifth = 0.0
        third = 0.0
        for stage in range(STAGES + 1):
            fifth += ERROR_OF_ORDER_5[stage] * stages[quantity, stage]
            third += ERROR_OF_ORDER_3[stage] * stages[quantity, stage]
        scale = line.root_scale
        if quantity == 1:
            scale = line.speed_scale
        elif quantity == 2:
            scale = line.time_scale
        elif quantity == 3:
            scale = line.energy_scale
        # the estimate of DOP853, E5^2/sqrt(E5^2 + 0.01 E3^2), which goes with the eighth power of
        # the length
        both = math.sqrt(fifth * fifth + 0.01 * third * third) * scale
        error = max(error, abs(length) * fifth * fifth / (both + _TINY))
    after = LineState(begun.time + length * time, delta, rate, begun.lost + length * lost)
    if not np.isfinite(after.time + delta + rate + after.lost + error) or (
        variable == BY_FLOW and root < 0.0
    ):
        error = np.inf
    return Advance(after, error, least, whole)


@compiled
def force_of(line: Line, state: LineState) -> float:
    """Return the force of the formula of the law [N], which may pull; it ends at the
    indentation of release.
    """
    static, dissipative = force_at(line.force)(
        max(state.delta, line.release), state.rate, line.speed, line.coefficients
    )
    return float(static + dissipative)


@compiled
def energies_of(line: Line, delta: float) -> tuple[float, float]:
    """Return the energy that the law stores, and the plastic work since its memory [J],
    at an indentation [m].
    """
    elastic, plastic = energies_at(line.energies)(max(delta, line.release), line.coefficients)
    return elastic, plastic


@compiled
def force_trend(line: Line, state: LineState, force: float) -> float:
    """Return the rate of change of the force [N/s]; `force`: its value [N]."""
    # central difference along the motion: delta changes with v, v with its acceleration
    function = force_at(line.force)
    acceleration = line.gravity - force / line.mass
    aside = _ASIDE * line.span
    before = max(state.delta - aside * state.rate, line.release)
    static, dissipative = function(
        before, state.rate - aside * acceleration, line.speed, line.coefficients
    )
    after = max(state.delta + aside * state.rate, line.release)
    later_static, later_dissipative = function(
        after, state.rate + aside * acceleration, line.speed, line.coefficients
    )
    return float((later_static + later_dissipative - static - dissipative) / (2.0 * aside))
