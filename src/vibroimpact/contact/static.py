"""Indentation of a contact law under a constant force."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.roots import find_root


def static_indentation(law: CompliantLaw, weight: Array) -> Array:
    """Return the indentation [m] at which the static force equals a weight [N].

    Exact for a power law; for others the relative error of the force is within 1e-12.

    Examples
    --------
    >>> from vibroimpact.contact.laws.hertz import Hertz
    >>> float(static_indentation(Hertz(stiffness=1e6), 8.0).round(9))
    0.0004
    """
    weight = np.asarray(weight, dtype=float)

    def force_and_power(delta: Array) -> tuple[Array, Array]:
        force = _force(law, delta)
        return force, delta * force / static_work(law, delta) - 1.0

    return _solve(force_and_power, lambda _: weight, law.release_level, 1e-14)


def _force(law: CompliantLaw, delta: Array) -> Array:
    return law.forces(delta, np.zeros_like(delta), np.ones_like(delta))[0]


def static_work(law: CompliantLaw, delta: Array) -> Array:
    """Return the integral of the static force from `touch_level` [J], the sum of elastic
    energy and plastic work.
    """
    return (
        law.elastic_energy(delta) + law.plastic_work(delta)
        if law.yields
        else law.elastic_energy(delta)
    )


def _solve(
    function: Callable[[Array], tuple[Array, Array]],
    wanted: Callable[[Array], Array],
    least: Array,
    within: float,
) -> Array:
    """Return the indentation, at least `least`, at which an increasing function of it has the value
    `wanted`.

    `function` returns the value and an estimate of the local exponent d ln(value) / d ln(delta):
    the iteration is exact after one step for a power law. Where it does not converge, the root is
    bracketed.
    """

    def excess(delta: Array) -> Array:
        return function(delta)[0] - wanted(delta)

    least = least + np.zeros_like(wanted(np.zeros(1)))
    delta, unloaded = least + 1e-6, wanted(least) <= 0.0
    with np.errstate(all="ignore"):
        # fixed-point iteration with the local exponent
        converged = np.zeros(np.shape(delta), dtype=bool)
        for _ in range(30):
            value, power = function(delta)
            step = (wanted(delta) / value) ** (1.0 / power)
            # whatever the others still need
            delta = delta * np.where(unloaded | converged, 1.0, step)
            converged |= np.abs(step - 1.0) < within
            if np.all(converged | unloaded | ~np.isfinite(delta)):
                break
        # where it failed, the bracket is extended by factors of four from `least` until it holds
        # the root
        failed = ~(converged & (delta > least))
        if np.any(failed):
            failed &= ~unloaded | (excess(least) < 0.0)
        if np.any(failed):
            low, high = least, least + 1e-9
            for _ in range(60):
                short = ~(excess(high) > 0.0)
                if not np.any(short & failed):
                    break
                low, high = (
                    np.where(short, high, low),
                    np.where(short, least + 4.0 * (high - least), high),
                )
            delta = np.where(failed, find_root(excess, low, high, tolerance=within), delta)
    return np.asarray(np.where(failed | ~unloaded, delta, least))
