"""Implicit steps of the contact of two rigid bodies, where damping is so strong that explicit ones
become minute.

Such bodies creep at a rate at which all forces nearly balance. The steps are those of the Radau IIA
method of order 5 in time (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, second
edition, Springer 1996, section IV.5); the error is that between one step and two of half the
length.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.compiled import compiled, force_at
from vibroimpact.dynamics.core.line_records import Advance, Line, LineState
from vibroimpact.dynamics.core.linear import solve_in_place

_R = math.sqrt(6.0)
_WEIGHTS = np.array(
    [
        [(88.0 - 7.0 * _R) / 360.0, (296.0 - 169.0 * _R) / 1800.0, (-2.0 + 3.0 * _R) / 225.0],
        [(296.0 + 169.0 * _R) / 1800.0, (88.0 + 7.0 * _R) / 360.0, (-2.0 - 3.0 * _R) / 225.0],
        [(16.0 - _R) / 36.0, (16.0 + _R) / 36.0, 1.0 / 9.0],
    ]
)
"""Weights of the stages in each stage; the last stage is the end of the step."""

_MOST_ITERATIONS = 20
_CONVERGED = 1e-3  # of the error allowed
_ASIDE = 1e-7  # relative step of finite differences
_OF_ERROR = 31.0  # one step has 32 times the error of two of half its length


@compiled
def advance_implicitly(line: Line, begun: LineState, length: float) -> Advance:
    """Return the state after a step of a length of time [s], made in two halves, with an
    estimate of its error.
    """
    whole = implicit_step(line, begun, length)
    half = implicit_step(line, begun, 0.5 * length)
    after = implicit_step(line, half.state, 0.5 * length)
    # Richardson: what one step and two halves differ by is 31 errors of the halves
    depth_scale = _OF_ERROR * line.speed_scale * line.span
    speed_scale = _OF_ERROR * line.speed_scale
    energy_scale = _OF_ERROR * line.energy_scale
    error = whole.error + half.error + after.error
    error += abs(whole.state.delta - after.state.delta) / depth_scale
    error += abs(whole.state.rate - after.state.rate) / speed_scale
    error += abs(whole.state.lost - after.state.lost) / energy_scale
    if not np.isfinite(error):
        error = np.inf
    least_force = min(half.least_force, after.least_force)
    return Advance(after.state, error, least_force, after.force)


@compiled
def implicit_step(line: Line, begun: LineState, length: float) -> Advance:
    """Return the state after one step; its error is infinite if Newton's method does not
    converge, else zero.
    """
    force = force_at(line.force)
    rate = np.full(3, begun.rate)
    delta = np.empty(3)
    acceleration = np.empty(3)
    by_delta = np.empty(3)
    by_rate = np.empty(3)
    lost = np.empty(3)
    matrix = np.empty((3, 3))
    right = np.empty((3, 1))
    least = np.inf
    last = 0.0
    error = np.inf
    for _ in range(_MOST_ITERATIONS):
        least = np.inf
        for stage in range(3):
            # delta_i = delta_0 + h sum_j A_ij v_j
            moved = 0.0
            for other in range(3):
                moved += _WEIGHTS[stage, other] * rate[other]
            delta[stage] = max(begun.delta + length * moved, line.release)
            static, dissipative = force(delta[stage], rate[stage], line.speed, line.coefficients)
            deeper = _ASIDE * (abs(delta[stage]) + line.speed_scale * line.span)
            faster = _ASIDE * (abs(rate[stage]) + line.speed_scale)
            deeper_static, deeper_dissipative = force(
                delta[stage] + deeper, rate[stage], line.speed, line.coefficients
            )
            faster_static, faster_dissipative = force(
                delta[stage], rate[stage] + faster, line.speed, line.coefficients
            )
            last = static + dissipative
            least = min(least, last)
            acceleration[stage] = line.gravity - last / line.mass
            by_delta[stage] = (last - deeper_static - deeper_dissipative) / (deeper * line.mass)
            by_rate[stage] = (last - faster_static - faster_dissipative) / (faster * line.mass)
            lost[stage] = dissipative * rate[stage]
        # Newton's method for v_i = v_0 + h sum_j A_ij a(delta_j, v_j), whose Jacobian is
        # I - h A da/dv - h^2 A (da/d delta) A
        for stage in range(3):
            reached = begun.rate
            for other in range(3):
                reached += length * _WEIGHTS[stage, other] * acceleration[other]
                change = length * _WEIGHTS[stage, other] * by_rate[other]
                for through in range(3):
                    change += (
                        length
                        * length
                        * _WEIGHTS[stage, through]
                        * by_delta[through]
                        * _WEIGHTS[through, other]
                    )
                matrix[stage, other] = -change
            matrix[stage, stage] += 1.0
            right[stage, 0] = reached - rate[stage]
        solve_in_place(matrix, right)
        change = 0.0
        for stage in range(3):
            rate[stage] += right[stage, 0]
            change = max(change, abs(right[stage, 0]))
        if not np.isfinite(change):
            break
        if change <= _CONVERGED * line.speed_scale:
            error = 0.0
            break
    # the last stage of a Radau IIA method is the end of the step
    moved = 0.0
    dissipated = 0.0
    for stage in range(3):
        moved += _WEIGHTS[2, stage] * rate[stage]
        dissipated += _WEIGHTS[2, stage] * lost[stage]
    delta_end = begun.delta + length * moved
    lost_end = begun.lost + length * dissipated
    state = LineState(begun.time + length, delta_end, rate[2], lost_end)
    return Advance(state, error, least, last)
