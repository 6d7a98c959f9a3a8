"""Necessary conditions of rest, and the energy below which a sphere cannot leave its
indentation.
"""

from __future__ import annotations

import math

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.contact_records import Manner
from vibroimpact.dynamics.core.flight import (
    approach_of,
    energy_of_approach,
    rigid_rate,
)
from vibroimpact.dynamics.core.law import static_work, stored_energy
from vibroimpact.dynamics.core.records import Law, State, System

_REST_MARGIN = 0.5  # of the weight: largest variation of the force at rest


@compiled
def is_captured(system: System, law: Law, manner: Manner, state: State, delta: float) -> bool:
    """Is the energy too small to lift the sphere out of its indentation? Never so where a
    drive brings more.
    """
    if system.driven > 0:
        return False
    # the barrier is E(y) of `vibrating.contact_equilibrium` at release
    energy = energy_of_approach(system, state) + static_work(law, delta)
    weight = system.mass * system.gravity
    barrier = (
        stored_energy(law, law.release)
        - weight * law.release_level
        - 0.5 * system.compliance * weight * weight
    )
    least = 0.5 * system.mass * (manner.tolerance * manner.motion_speed) ** 2
    return energy < barrier + least


@compiled
def is_near_rest(system: System, law: Law, state: State, force: float) -> bool:
    """May a riding sphere be at rest? A necessary condition that needs no eigenvalues; where a
    plate is driven, always.

    The force must be close to the weight, and the speed low: the force decelerates and accelerates
    the sphere at no lower an angular frequency than that from the trace of the flexibility, on a
    contact with about the stiffness of force over indentation.
    """
    if system.driven > 0:
        return True
    weight = system.mass * system.gravity
    most = _REST_MARGIN * weight
    if weight == 0.0 or abs(force - weight) > most:
        return False
    # 1/w^2 of the lowest frequency is at most the sum of those of all: m/k of the contact and of
    # the compliances, and the trace for the modes
    overlap = max(approach_of(system, state)[0] - law.release_level, 0.0)
    on_springs = system.mass * (overlap / weight / _REST_MARGIN + system.compliance)
    slowest = 1.0 / math.sqrt(on_springs + system.flexibility)
    return system.mass * abs(rigid_rate(system, state)) * slowest < most
