"""What one contact does through a stretch, as it was solved on the nodes of Radau collocation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.collocation import Rule
from vibroimpact.dynamics.vibrating.local import LocalContact


@dataclass(frozen=True)
class ContactHistory:
    """One contact through a stretch.

    `number`: which contact of the system. `static`, `dissipative`: parts of its force at the nodes [N] (N,). `approach`, `rate`: of
    the surfaces [m], and what the dashpot of the law feels [m/s], at the start and at the nodes (N + 1,). `delta`: the law's own
    indentation there [m]. `work`: by how much the energy that it stores, and has spent on plastic deformation, grows [J]. `dissipated`:
    what its law takes [J]. `broken`: what is lost at the end, as a sticking contact breaks [J].
    """

    number: int
    local: LocalContact
    rule: Rule
    static: Floats
    dissipative: Floats
    approach: Floats
    rate: Floats
    delta: Floats
    work: float
    dissipated: float
    separation_loss: float = 0.0

    @property
    def force(self) -> Floats:
        """The force at the nodes [N]."""
        return self.static + self.dissipative

    @property
    def power(self) -> Floats:
        """What its law takes at the nodes [W]."""
        return self.dissipative * self.rate[1:]

    def law_force_at(self, x: Floats) -> Floats:
        """Return the force that the law gives [N] at x in [0, 1], before any clip."""
        weights = self.rule.weights(np.asarray(x, dtype=float)).T
        static, dissipative = self.local.forces_at_indentation(weights @ self.delta, weights @ self.rate)
        return np.asarray(static + dissipative)

    def force_at(self, x: Floats) -> Floats:
        """Return the contact force, clipped where the law may not pull [N], at x in [0, 1]."""
        force = self.law_force_at(x)
        return force if self.local.law.tension == "kept" else np.maximum(force, 0.0)
