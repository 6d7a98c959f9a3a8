"""The contact force of a stretch as the input of linear systems: impulses and derivatives."""

from __future__ import annotations

import math
from functools import cache, lru_cache

import numpy as np
from numpy.polynomial import legendre

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

_NODES = 16
"""Nodes of Gauss's rule per panel."""
_RADIANS_PER_PANEL = 10.0
"""Radians of the fastest oscillation in a panel, which its nodes integrate to rounding."""
_SLOW = 3.0
"""Radians per stretch below which the nodes of the stretch itself integrate an oscillation."""
_DEGREE = 16
"""Degree of the polynomial of the force that is differentiated."""


def gauss_rule(radians: float) -> tuple[Floats, Floats]:
    """Return nodes on [0, 1] and weights of a rule that integrates oscillations.

    `radians`: their largest phase over [0, 1].
    """
    return _panels(max(1, math.ceil(radians / _RADIANS_PER_PANEL)))


@lru_cache(maxsize=64)
def _panels(number: int) -> tuple[Floats, Floats]:
    """Return the composite Gauss rule with a number of panels, cached."""
    nodes, weights = _gauss()
    nodes = (np.arange(number)[:, None] + 0.5 * (nodes + 1.0)).ravel() / number
    return nodes, np.tile(0.5 * weights / number, number)


@cache
def _gauss() -> tuple[Floats, Floats]:
    """Return Gauss's rule of a panel, on [-1, 1]."""
    return np.polynomial.legendre.leggauss(_NODES)


Pulses = tuple[Floats, Floats]
"""Times [s] and impulses [N s]."""


def pulses(
    stretch: VibratingStretch, force: Floats, fastest: float, until: Floats | None = None
) -> Pulses:
    """Return times since the start [s] and impulses [N s] that are equivalent to a force.

    They are so for a linear system.

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
    length = stretch.length
    rule = stretch.rule
    if until is None:
        if fastest * length < _SLOW:
            return length * rule.time, length * rule.integral[-1] * force
        times, impulses = _gauss_pulses(stretch, force, fastest, np.array([length]))
        return times[0], impulses[0]
    return _gauss_pulses(stretch, force, fastest, until)


def _gauss_pulses(stretch: VibratingStretch, force: Floats, fastest: float, ends: Floats) -> Pulses:
    """Return the pulses up to each of some times, by Gauss's rule, (T, nodes)."""
    length = stretch.length
    rule = stretch.rule
    begins = np.append(0.0, ends[:-1])
    longest = float((ends - begins).max(initial=0.0))
    nodes, weights = gauss_rule(rule.root * fastest * longest)  # bound of the slope of the time map
    x_begins = rule.unmap_time(begins / length)
    x_spans = rule.unmap_time(ends / length) - x_begins
    x = x_begins[:, None] + x_spans[:, None] * nodes
    force_at_nodes = rule.interpolate(x.ravel(), force).reshape(x.shape)
    durations = length * _slope(stretch, x)  # dt/dx
    impulses = durations * force_at_nodes * (x_spans[:, None] * weights)
    return length * rule.map_time(x), impulses


def force_derivatives(stretch: VibratingStretch, times: Floats) -> Floats:
    """Return the force and its first and second derivative at times [s], (3, T).

    Times are since the start; units are N, N/s and N/s^2. At the instant of touch the derivatives
    are those before it, zero: the second derivative of a Hertzian force is unbounded just after it.
    """
    # polynomial through the force at Chebyshev's points
    grid = 0.5 * (1.0 - np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1)))
    coefficients = np.linalg.solve(
        legendre.legvander(2.0 * grid - 1.0, _DEGREE), stretch.contacts[0].force_at(grid)
    )
    x = stretch.rule.unmap_time(times / stretch.length)
    # derivatives by x, which is mapped to [-1, 1]
    force, first, second = (
        legendre.legval(2.0 * x - 1.0, legendre.legder(coefficients, order)) * 2.0**order
        for order in range(3)
    )
    # derivatives by time: those of an inverse function
    slope = stretch.length * _slope(stretch, x)
    at_touch = slope <= 0.0
    slope = np.where(at_touch, 1.0, slope)
    curvature = stretch.length * _curvature(stretch, x)
    derivatives = np.stack([force, first / slope, (second - first * curvature / slope) / slope**2])
    derivatives[1:, at_touch] = 0.0
    return np.asarray(derivatives)


def _slope(stretch: VibratingStretch, x: Floats) -> Floats:
    """Return the derivative of the time map."""
    root = stretch.rule.root
    if stretch.rule.time_map == "touch":
        return np.asarray(root * x ** (root - 1))
    if stretch.rule.time_map == "release":
        return np.asarray(root * (1.0 - x) ** (root - 1))
    return np.ones_like(x)


def _curvature(stretch: VibratingStretch, x: Floats) -> Floats:
    """Return the second derivative of the time map."""
    root = stretch.rule.root
    time_map = stretch.rule.time_map
    if root == 1 or time_map == "inside":
        return np.zeros_like(x)
    if time_map == "touch":
        return np.asarray(root * (root - 1) * x ** (root - 2))
    return np.asarray(-root * (root - 1) * (1.0 - x) ** (root - 2))
