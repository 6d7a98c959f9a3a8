"""Indentation of a contact law under a constant force."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.roots import find_root

_TOLERANCE = 1e-14  # relative, of the indentation
_MOST_STEPS = 30
_MOST_EXTENSIONS = 60  # of a bracket, by factors of four from one nanometre


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

    def excess(delta: Array) -> Array:
        return _static_force(law, delta) - weight

    release_level = law.release_level + np.zeros_like(weight)
    delta = release_level + 1e-6
    is_unloaded = weight <= 0.0
    with np.errstate(all="ignore"):
        # fixed-point iteration with the local exponent: exact after one step for a power law
        has_converged = np.zeros(np.shape(delta), dtype=bool)
        for _ in range(_MOST_STEPS):
            force = _static_force(law, delta)
            step = (weight / force) ** (1.0 / _local_exponent(law, delta, force))
            # elements that have converged stay, whatever the others still need
            delta = delta * np.where(is_unloaded | has_converged, 1.0, step)
            has_converged |= np.abs(step - 1.0) < _TOLERANCE
            if np.all(has_converged | is_unloaded | ~np.isfinite(delta)):
                break
        has_failed = ~(has_converged & (delta > release_level))
        if np.any(has_failed):
            # a weight of zero or less is reached at release, or beyond if the law pulls there
            has_failed &= ~is_unloaded | (excess(release_level) < 0.0)
        if np.any(has_failed):
            low, high = _bracket(excess, release_level, has_failed)
            root = find_root(excess, low, high, tolerance=_TOLERANCE)
            delta = np.where(has_failed, root, delta)
    return np.asarray(np.where(has_failed | ~is_unloaded, delta, release_level))


def _static_force(law: CompliantLaw, delta: Array) -> Array:
    """Return the force at rest [N]."""
    return law.forces(delta, np.zeros_like(delta), np.ones_like(delta))[0]


def _local_exponent(law: CompliantLaw, delta: Array, force: Array) -> Array:
    """Return an estimate of d ln F / d ln delta: the n of a power law with this force and work."""
    return delta * force / static_work(law, delta) - 1.0


def _bracket(
    excess: Callable[[Array], Array], low: Array, has_failed: Array
) -> tuple[Array, Array]:
    """Return brackets of the roots of an increasing function, extended by factors of four.

    Parameters
    ----------
    excess : callable
        The function, of an indentation [m].
    low : array
        Indentations below the roots [m], from which the brackets are extended.
    has_failed : bool array
        The elements that need a bracket.
    """
    start = low
    high = start + 1e-9
    for _ in range(_MOST_EXTENSIONS):
        is_short = ~(excess(high) > 0.0)
        if not np.any(is_short & has_failed):
            break
        low = np.where(is_short, high, low)
        high = np.where(is_short, start + 4.0 * (high - start), high)
    return low, high


def static_work(law: CompliantLaw, delta: Array) -> Array:
    """Return the integral of the static force from `touch_level` [J].

    It is the sum of elastic energy and plastic work.
    """
    if law.yields:
        return law.elastic_energy(delta) + law.plastic_work(delta)
    return law.elastic_energy(delta)
