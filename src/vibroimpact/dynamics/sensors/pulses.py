"""The contact force of a stretch as the input of linear systems: equivalent impulses by
quadrature, and its time derivatives.
"""

from __future__ import annotations

import math
from functools import cache, lru_cache

import numpy as np
from numpy.polynomial import legendre

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

_NODES, _TURN = 16, 10.0
"""Nodes of Gauss's rule per panel, and radians of the fastest oscillation in it: to rounding."""
_SLOW = 3.0
"""Radians per stretch below which the nodes of the stretch itself integrate an oscillation."""
_DEGREE = 16
"""Degree of the polynomial of the force that is differentiated."""


def gauss_rule(radians: float) -> tuple[Floats, Floats]:
    """Return nodes on [0, 1] and weights of a rule that integrates oscillations of up to
    so many radians there.
    """
    return _panels(max(1, math.ceil(radians / _TURN)))


@lru_cache(maxsize=64)
def _panels(number: int) -> tuple[Floats, Floats]:
    """Return the composite Gauss rule with a number of panels, cached."""
    nodes, weights = _gauss()
    places = (np.arange(number)[:, None] + 0.5 * (nodes + 1.0)).ravel() / number
    return places, np.tile(0.5 * weights / number, number)


@cache
def _gauss() -> tuple[Floats, Floats]:
    """Return Gauss's rule of a panel, on [-1, 1]."""
    return np.polynomial.legendre.leggauss(_NODES)


Pulses = tuple[Floats, Floats]
"""Times [s] and impulses [N s]."""


def pulses(
    stretch: VibratingStretch, force: Floats, fastest: float, until: Floats | None = None
) -> Pulses:
    """Return times since the start [s] and impulses [N s] that are equivalent to a force for a
    linear system.

    Parameters
    ----------
    stretch : VibratingStretch
        The stretch of contact.
    force : array, shape (N,)
        The force at its nodes [N].
    fastest : float
        Highest angular frequency to which the system responds [rad/s].
    until : array, shape (T,), optional
        Ascending times since the start [s]: the results are then (T, nodes), of the force between
        each and the previous one, or the start. By default they cover the whole stretch.
    """
    length, rule = stretch.length, stretch.rule
    if until is None and fastest * length < _SLOW:
        return length * rule.time, length * rule.integral[-1] * force
    ends = np.array([length]) if until is None else until
    begins = np.append(0.0, ends[:-1])
    longest = float((ends - begins).max(initial=0.0))
    nodes, weights = gauss_rule(rule.root * fastest * longest)  # bound of the slope of the time map
    begins, ends = rule.unmap_time(begins / length), rule.unmap_time(ends / length)
    x = begins[:, None] + (ends - begins)[:, None] * nodes
    there = rule.interpolate(x.ravel(), force).reshape(x.shape)
    times = length * rule.map_time(x)
    impulses = length * _slope(stretch, x) * there * ((ends - begins)[:, None] * weights)
    return (times[0], impulses[0]) if until is None else (times, impulses)


def force_derivatives(stretch: VibratingStretch, times: Floats) -> Floats:
    """Return the force [N] and its first and second derivative [N/s, N/s^2] at times since the
    start [s], (3, T).

    At the instant of touch the derivatives are those before it, zero: the second derivative of a
    Hertzian force is unbounded just after it.
    """
    grid = 0.5 * (1.0 - np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1)))
    coefficients = np.linalg.solve(
        legendre.legvander(2.0 * grid - 1.0, _DEGREE), stretch.contacts[0].force_at(grid)
    )
    x = stretch.rule.unmap_time(times / stretch.length)
    value, first, second = (
        legendre.legval(2.0 * x - 1.0, legendre.legder(coefficients, order)) * 2.0**order
        for order in range(3)
    )
    slope = stretch.length * _slope(stretch, x)
    still = slope <= 0.0
    slope = np.where(still, 1.0, slope)
    bend = stretch.length * _bend(stretch, x)
    derivatives = np.stack([value, first / slope, (second - first * bend / slope) / slope**2])
    derivatives[1:, still] = 0.0
    return np.asarray(derivatives)


def _slope(stretch: VibratingStretch, x: Floats) -> Floats:
    """Return the derivative of the time map."""
    root = stretch.rule.root
    if stretch.rule.time_map == "touch":
        return np.asarray(root * x ** (root - 1))
    if stretch.rule.time_map == "release":
        return np.asarray(root * (1.0 - x) ** (root - 1))
    return np.ones_like(x)


def _bend(stretch: VibratingStretch, x: Floats) -> Floats:
    """Return the second derivative of the time map."""
    root = stretch.rule.root
    if root == 1 or stretch.rule.time_map == "inside":
        return np.zeros_like(x)
    side = x if stretch.rule.time_map == "touch" else 1.0 - x
    sign = 1.0 if stretch.rule.time_map == "touch" else -1.0
    return np.asarray(sign * root * (root - 1) * side ** (root - 2))
