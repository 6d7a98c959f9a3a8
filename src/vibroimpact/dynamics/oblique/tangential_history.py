"""The history of one contact whose friction is elastic, as the core follows it."""

from __future__ import annotations

from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.dynamics.core.tangential_history import TangentialHistory, fresh_history


def tangential_history(law: CompliantFriction, largest_force: float) -> TangentialHistory:
    """Return the history of one contact before first touch.

    Parameters
    ----------
    law : CompliantFriction
        Of one drop.
    largest_force : float
        About the largest normal force that will come [N].
    """
    growing, shrinking = law.stretching
    return fresh_history(
        law.slips_at_rim,
        float(growing),
        float(shrinking),
        float(law.effective_modulus),
        float(law.effective_shear_modulus),
        float(law.effective_radius),
        float(law.coefficient),
        largest_force,
    )
