"""Compiled functions equal the interpreted ones."""

from __future__ import annotations

import numpy as np

from vibroimpact.compiled import compiled, force_coefficients, force_function
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley


@compiled(lambda t: t.real(t.integer, t.force, t.vector))
def work(steps, force, coefficients):
    total = 0.0
    for step in range(steps):
        static, dissipative = force(1e-4 * step, 1.0, 2.0, coefficients)
        total += static + dissipative
    return total


def test_a_law_is_called_by_value() -> None:
    law = HuntCrossley(stiffness=1e9, restitution=0.6)
    static, dissipative = law.forces(1e-4 * np.arange(10), np.ones(10), 2.0 * np.ones(10))
    found = work(10, force_function(HuntCrossley), force_coefficients(law))
    assert abs(found / sum(static + dissipative) - 1.0) < 1e-14
