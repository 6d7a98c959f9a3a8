"""What a law does without motion: the indentation that carries a weight, and that stores an energy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.pair import Array
from vibroimpact.contact.roots import find_root


def static_indentation(law: CompliantLaw, weight: Array) -> Array:
    """Return the indentation [m] at which the static force carries a weight [N].

    Exact for a power law; for others the force at the result is within 1e-12 of the weight.

    Examples
    --------
    >>> from vibroimpact.contact.laws.hertz import Hertz
    >>> float(static_indentation(Hertz(stiffness=1e6), 8.0).round(9))
    0.0004
    """
    weight = np.asarray(weight, dtype=float)
    return _solve(law, lambda delta: _force(law, delta), lambda delta: weight, lambda delta: _exponent(law, delta) - 1.0, 1e-14)


def free_depth(law: CompliantLaw, energy: Array, weight: Array) -> Array:
    """Return how deep the contact would get if its damping took nothing [m], to 1e-3.

    Parameters
    ----------
    law : CompliantLaw
        The law.
    energy : array
        Kinetic energy at first touch [J], > 0.
    weight : array
        A constant force that presses, and adds its own work [N].
    """
    touch = law.touch_level
    return _solve(
        law, lambda delta: _work(law, delta), lambda delta: energy + weight * (delta - touch), lambda delta: _exponent(law, delta), 1e-3
    )


def _force(law: CompliantLaw, delta: Array) -> Array:
    return law.forces(delta, np.zeros_like(delta), np.ones_like(delta))[0]


def _work(law: CompliantLaw, delta: Array) -> Array:
    return law.elastic_energy(delta) + law.plastic_work(delta)


def _exponent(law: CompliantLaw, delta: Array) -> Array:
    """Return the power of the indentation with which the work locally goes."""
    return delta * _force(law, delta) / _work(law, delta)


def _solve(
    law: CompliantLaw, function: Callable[[Array], Array], wanted: Callable[[Array], Array], power: Callable[[Array], Array], within: float
) -> Array:
    """Return the indentation at which a rising function of it has the value that is wanted.

    Steps by the local power are exact at once for a power law; where they lead astray, a bracket is found.
    """
    nothing = np.zeros_like(wanted(np.zeros(1)))
    release = law.release_level + nothing
    delta, idle = release + 1e-6, wanted(release) <= 0.0
    with np.errstate(all="ignore"):
        for _ in range(30):
            step = (wanted(delta) / function(delta)) ** (1.0 / power(delta))
            delta = delta * np.where(idle, 1.0, step)
            settled = np.abs(step - 1.0) < within
            if np.all(settled | idle | ~np.isfinite(delta)):
                break
        lost = ~(settled & (delta > release)) & (~idle | (function(release) < wanted(release)))
        if np.any(lost):
            low, high = release, release + 1e-9
            for _ in range(60):
                short = ~(function(high) > wanted(high))
                if not np.any(short & lost):
                    break
                low, high = np.where(short, high, low), np.where(short, release + 4.0 * (high - release), high)
            delta = np.where(lost, find_root(lambda at: function(at) - wanted(at), low, high, tolerance=within), delta)
    return np.asarray(np.where(lost | ~idle, delta, release))
