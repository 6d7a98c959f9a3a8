"""The largest indentation of impacts without damping, from their balance of energy."""

from __future__ import annotations

import math

from vibroimpact.arrays import Integers, Matrix, Vector
from vibroimpact.compiled import compiled, energies_at, force_at
from vibroimpact.dynamics.core.line_events import narrowed, secant_of
from vibroimpact.dynamics.core.line_records import Bracket

_WITHIN = 1e-3  # relative: it is a scale, and a first estimate
_FIRST = 1e-6  # m
_MOST_STEPS = 30
_NEAREST = 1e-9  # m: first upper bound of the indentation beyond that at touch
_MOST_BOUNDS = 60  # each of them four times as far
_MOST_ITERATIONS = 60


@compiled
def static_work_of(addresses: Integers, coefficients: Vector, delta: float) -> float:
    """Return the work of the static force of a law since touch [J]; `addresses`: of its
    functions.
    """
    elastic, plastic = energies_at(addresses[1])(delta, coefficients)
    return float(elastic + plastic)


@compiled
def undamped_depth(
    addresses: Integers, coefficients: Vector, touch: float, energy: float, weight: float
) -> float:
    """Return the largest indentation of an impact without damping [m], to a relative 1e-3.

    By iteration with the local exponent of the work, which is exact after one step for a power law;
    where that does not converge, within bounds.

    Parameters
    ----------
    addresses : array of int, shape (4,)
        The functions of the law.
    coefficients : array, shape (K,)
        Its coefficients.
    touch : float
        Its indentation at touch [m].
    energy : float
        Kinetic energy at touch [J], > 0.
    weight : float
        A constant force in the direction of the indentation [N], whose work adds to the energy.
    """
    force = force_at(addresses[0])
    depth = _FIRST
    for _ in range(_MOST_STEPS):
        work = static_work_of(addresses, coefficients, touch + depth)
        static, _ = force(touch + depth, 0.0, 1.0, coefficients)
        brought = energy + weight * depth
        if not (0.0 < work < math.inf and 0.0 < static < math.inf and brought > 0.0):
            break
        # work ~ depth^p has the exponent p = depth F/work
        change = (brought / work) ** (work / (depth * static))
        depth *= change
        if abs(change - 1.0) < _WITHIN:
            return float(touch + depth)
    return bounded_depth(addresses, coefficients, touch, energy, weight)


@compiled
def bounded_depth(
    addresses: Integers, coefficients: Vector, touch: float, energy: float, weight: float
) -> float:
    """Return what `undamped_depth` does, by the secant within bounds; at the last bound
    where there is none, as without a force.
    """
    low = 0.0
    high = _NEAREST
    low_value = -energy
    high_value = static_work_of(addresses, coefficients, touch + high) - weight * high - energy
    for _ in range(_MOST_BOUNDS):
        if high_value > 0.0:
            break
        low = high
        low_value = high_value
        high *= 4.0
        high_value = static_work_of(addresses, coefficients, touch + high) - weight * high - energy
    if not high_value > 0.0:
        return touch + high
    bracket = Bracket(low, high, low_value, high_value, 0)
    for _ in range(_MOST_ITERATIONS):
        middle = secant_of(bracket)
        if bracket.high - bracket.low <= _WITHIN * bracket.high or middle in (
            bracket.low,
            bracket.high,
        ):
            break
        value = static_work_of(addresses, coefficients, touch + middle) - weight * middle - energy
        if value == 0.0:
            return touch + middle
        bracket = narrowed(bracket, middle, value)
    return touch + secant_of(bracket)


@compiled
def write_undamped_depths(
    addresses: Integers,
    coefficients: Matrix,
    touch: Vector,
    energy: Vector,
    weight: Vector,
    depths: Vector,
) -> None:
    """Write the largest indentations of B impacts without damping [m] (B,); the other
    arguments as in `undamped_depth`, for each.
    """
    for drop in range(len(depths)):
        depths[drop] = undamped_depth(
            addresses, coefficients[drop], touch[drop], energy[drop], weight[drop]
        )
