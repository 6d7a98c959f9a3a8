"""The indentation under a weight that rests."""

from __future__ import annotations

import numpy as np

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.pair import Array


def static_indentation(law: CompliantLaw, weight: Array) -> Array:
    """Return the indentation [m] at which the elastic force carries a weight [N].

    Exact for a power law; for others the force at the result is within 1e-12 of the weight.

    Examples
    --------
    >>> from vibroimpact.contact.laws.hertz import Hertz
    >>> float(static_indentation(Hertz(stiffness=1e6), 8.0).round(9))
    0.0004
    """
    weight = np.asarray(weight, dtype=float)
    delta = np.full(weight.shape, 1e-6)
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(60):
            force, _dissipative = law.forces(delta, np.zeros_like(delta), np.ones_like(delta))
            exponent = force * delta / law.elastic_energy(delta) - 1.0
            step = (weight / force) ** (1.0 / exponent)
            delta = delta * step
            if np.all(np.abs(step - 1.0) < 1e-14) or not np.all(weight):
                break
    return np.where(weight > 0.0, delta, 0.0)
