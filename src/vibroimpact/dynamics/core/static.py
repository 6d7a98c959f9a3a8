"""The indentation of a contact law under a constant force."""

from __future__ import annotations

import math

from vibroimpact.arrays import Integers, Vector
from vibroimpact.compiled import Address, compiled, energies_at, force_at

_FIRST = 1e-6  # m
_TOLERANCE = 1e-14  # relative
_MOST_STEPS = 30
_NEAREST = 1e-9  # m: first upper bound beyond release
_MOST_BOUNDS = 200  # each of them four times as far
_MOST_HALVINGS = 200


@compiled
def static_indentation(
    addresses: Integers, coefficients: Vector, release: float, weight: float
) -> float:
    """Return the indentation at which the static force of a law equals a weight [m].

    By iteration with the local exponent of the work, which is exact after one step for a power law;
    where that does not converge, by bisection. A weight of zero is reached at release, or beyond if
    the law pulls there.

    Parameters
    ----------
    addresses : array of int, shape (4,)
        The functions of the law.
    coefficients : array, shape (K,)
        Its coefficients.
    release : float
        Its indentation at release [m].
    weight : float
        The force [N].
    """
    force = force_at(addresses[0])
    energies = energies_at(addresses[1])
    if weight <= 0.0:
        static, _ = force(release, 0.0, 1.0, coefficients)
        if not static < weight:
            return release
        return bisected_indentation(addresses[0], coefficients, release, weight)
    delta = release + _FIRST
    for _ in range(_MOST_STEPS):
        static, _ = force(delta, 0.0, 1.0, coefficients)
        elastic, plastic = energies(delta, coefficients)
        work = elastic + plastic
        if not (0.0 < static < math.inf and 0.0 < work < delta * static):
            break
        # force ~ delta^(p - 1), with the exponent p = delta F/work of the work
        step = (weight / static) ** (1.0 / (delta * static / work - 1.0))
        delta *= step
        if abs(step - 1.0) < _TOLERANCE:
            if delta > release:
                return float(delta)
            break
    return bisected_indentation(addresses[0], coefficients, release, weight)


@compiled
def bisected_indentation(
    address: Address, coefficients: Vector, release: float, weight: float
) -> float:
    """Return what `static_indentation` does, by bisection up to neighbouring numbers; `address`: of
    the force.
    """
    force = force_at(address)
    low = release
    high = low + _NEAREST
    for _ in range(_MOST_BOUNDS):
        static, _ = force(high, 0.0, 1.0, coefficients)
        if not static < weight:
            break
        low = high
        high = release + 4.0 * (high - release)
    for _ in range(_MOST_HALVINGS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        static, _ = force(middle, 0.0, 1.0, coefficients)
        if static < weight:
            low = middle
        else:
            high = middle
    return high
