"""Forces and motion of one contact through a stretch, at the nodes of Radau collocation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.collocation import Rule
from vibroimpact.dynamics.vibrating.local import LocalContact


@dataclass(frozen=True)
class ContactHistory:
    """Forces and motion of one contact through a stretch.

    `number`: number of the contact in the system. `static`, `dissipative`: parts of its force at
    the nodes [N] (N,). At the start and at the nodes (N + 1,): `approach` of the surfaces [m],
    `rate` at the dashpot of the law and `closing`, the whole rate of the approach [m/s], and
    `delta`, the indentation of the law [m]. `work`: increase of the energy stored by the law and of
    the plastic work [J]. `dissipated`: work of the dissipative force [J]. `separation_loss`: stored
    energy that is lost at the end, as when a sticking contact breaks [J].
    """

    number: int
    local: LocalContact
    rule: Rule
    static: Floats
    dissipative: Floats
    approach: Floats
    rate: Floats
    closing: Floats
    delta: Floats
    work: float
    dissipated: float
    separation_loss: float = 0.0

    @property
    def force(self) -> Floats:
        """Contact force at the nodes [N]."""
        return self.static + self.dissipative

    @property
    def power(self) -> Floats:
        """Power of the dissipative force at the nodes [W]."""
        return self.dissipative * self.rate[1:]

    def law_force_at(self, x: Floats) -> Floats:
        """Return the force of the law before clipping [N] at x in [0, 1]."""
        weights = self.rule.weights(np.asarray(x, dtype=float)).T
        static, dissipative = self.local.forces_at_indentation(
            weights @ self.delta, weights @ self.rate
        )
        return np.asarray(static + dissipative)

    def force_at(self, x: Floats) -> Floats:
        """Return the contact force [N] at x in [0, 1], at least zero where the law may not pull."""
        force = self.law_force_at(x)
        if self.local.law.tension == "kept":
            return force
        return np.maximum(force, 0.0)
