"""Calls of a contact law in series with a quasi-static compliance, from compiled code.

The law's force is given by the address of a C function, so that one compiled core serves all laws; in plain Python it is the function.
"""

from __future__ import annotations

import math
from typing import Any

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled, force_at

_LEAST_RADIUS = 1e-9
_STEP = 1e-7  # relative step of finite differences
_TINY = 1e-300
_CONVERGED = 1e-8  # relative Newton step, after which the next would be below rounding
_MOST_ITERATIONS = 60


@compiled(lambda t: t.tuple(t.real, t.real)(t.vector, t.real))
def series_indentation(series: Floats, force: float) -> tuple[float, float]:
    """Return the indentation of a compliance in series [m] at a force [N], and its derivative [m/N].

    `series` (7,): C, 1/(E R), c0, c1, c2, c3 and F_R of `contact.quasi_static.QuasiStatic`.
    """
    linear = series[0]
    unit = series[1]
    if unit == 0.0:
        return force * linear, linear
    x = max((abs(force) / series[6]) ** (1.0 / 3.0), _LEAST_RADIUS)
    logarithm = math.log(x)
    factor = series[2] + series[3] * logarithm + x * (series[4] + series[5] * x)
    slope = series[2] + series[3] * (logarithm + 1.0 / 3.0) + x * (4.0 / 3.0 * series[4] + 5.0 / 3.0 * series[5] * x)
    return force * (linear + unit * factor), linear + unit * slope


@compiled(lambda t: t.boolean(t.vector))
def is_in_series(series: Floats) -> bool:
    """Is there a compliance in series?"""
    return bool(series[0] != 0.0 or series[1] != 0.0)


@compiled(lambda t: t.real(t.address, t.vector, t.real, t.real, t.vector, t.real))
def indentation_at(law: Any, coefficients: Floats, speed: float, release: float, series: Floats, approach: float) -> float:
    """Return the indentation of a law [m] at an approach of the surfaces [m], at least that of release, to 1e-8 of it."""
    if not is_in_series(series):
        return max(approach, release)
    force = force_at(law)
    delta = max(approach, release)
    low = release
    for _ in range(_MOST_ITERATIONS):
        step = _STEP * (abs(delta) + _TINY)
        static, _ = force(delta, 0.0, speed, coefficients)
        deeper, _ = force(delta + step, 0.0, speed, coefficients)
        yielded, compliance = series_indentation(series, static)
        slope = 1.0 + compliance * (deeper - static) / step
        excess = delta + yielded - approach
        if excess < 0.0:
            low = delta
        if not slope > 0.0:
            return delta
        nearer = delta - excess / slope
        if nearer < release:
            nearer = release
        if nearer < low:
            nearer = 0.5 * (low + delta)
        change = abs(nearer - delta)
        delta = nearer
        if change <= _CONVERGED * abs(delta) + _TINY:
            break
    return delta


@compiled(lambda t: t.void(t.address, t.vector, t.real, t.real, t.vector, t.vector, t.vector, t.matrix))
def linearise(
    law: Any, coefficients: Floats, speed: float, release: float, series: Floats, delta: Floats, rate: Floats, linear: Floats
) -> None:
    """Write forces, approach and derivatives of a law at N nodes into `linear` (7, N).

    Rows: static and dissipative force [N]; approach of the surfaces [m]; derivative of the approach by the indentation [-]; of the static
    force by it [N/m]; of the dissipative force by it [N/m] and by the rate [N s/m]. By finite differences; constant beyond release.
    """
    deepest = 0.0
    fastest = 0.0
    for node in range(len(delta)):
        deepest = max(deepest, abs(max(delta[node], release)))
        fastest = max(fastest, abs(rate[node]))
    step = _STEP * (deepest + _TINY)
    faster = _STEP * (fastest + _TINY)
    force = force_at(law)
    in_series = is_in_series(series)
    for node in range(len(delta)):
        held = delta[node] > release
        reached = max(delta[node], release)
        static, dissipative = force(reached, rate[node], speed, coefficients)
        stiffness = 0.0
        by_delta = 0.0
        if held:
            deeper_static, deeper_dissipative = force(reached + step, rate[node], speed, coefficients)
            stiffness = (deeper_static - static) / step
            by_delta = (deeper_dissipative - dissipative) / step
        _, faster_dissipative = force(reached, rate[node] + faster, speed, coefficients)
        approach = delta[node]
        slope = 1.0
        if in_series:
            yielded, compliance = series_indentation(series, static)
            approach += yielded
            slope += compliance * stiffness
        linear[0, node] = static
        linear[1, node] = dissipative
        linear[2, node] = approach
        linear[3, node] = slope
        linear[4, node] = stiffness
        linear[5, node] = by_delta
        linear[6, node] = (faster_dissipative - dissipative) / faster
