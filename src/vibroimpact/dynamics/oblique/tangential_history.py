"""The history of one contact whose friction is elastic, as the core follows it."""

from __future__ import annotations

import numpy as np

from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.contact.pair import hertz_stiffness
from vibroimpact.dynamics.core.tangential_history import SPRINGS, TangentialHistory


def tangential_history(law: CompliantFriction, largest_force: float) -> TangentialHistory:
    """Return the history of one contact before first touch.

    Parameters
    ----------
    law : CompliantFriction
        Of one drop.
    largest_force : float
        About the largest normal force that will come [N], in whose contact the springs of a row are
        close enough to each other.

    Examples
    --------
    A spring of stiffness 2 G* a that is stretched until it slides:

    >>> import vibroimpact as vi
    >>> from vibroimpact.dynamics.core.tangential_history import history_after
    >>> moduli = {
    ...     "effective_modulus": 60e9,
    ...     "effective_shear_modulus": 50e9,
    ...     "effective_radius": 0.01,
    ... }
    >>> spring = tangential_history(
    ...     vi.friction.find_friction_law("mindlin")(coefficient=0.1, **moduli), 100.0
    ... )
    >>> for moved in (0.0, 1e-7, 1e-3):
    ...     spring = history_after(spring, 100.0, moved, 0.0)
    ...     print(round(float(spring.force[0]), 4))
    0.0
    2.3208
    10.0
    """
    growing, shrinking = law.stretching
    springs = SPRINGS if law.slips_at_rim else 0
    return TangentialHistory(
        at_rim=law.slips_at_rim,
        growing=float(growing),
        shrinking=float(shrinking),
        hertz=float(hertz_stiffness(law.effective_modulus, law.effective_radius)),
        radius=float(law.effective_radius),
        stiffness=2.0 * float(law.effective_shear_modulus),
        coefficient=float(law.coefficient),
        ratio=float(law.kappa),
        sliding_energy=float(law.sliding_energy),
        width=float(law.contact_radius(np.asarray(largest_force))) / SPRINGS,
        depth=0.0,
        stretch=np.zeros((2, springs)),
        force=np.zeros(2),
        slid=0.0,
    )
