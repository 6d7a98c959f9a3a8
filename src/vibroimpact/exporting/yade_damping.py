"""The damping that YADE is told for a restitution: its laws never pull."""

from __future__ import annotations

import math
from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.kelvin_voigt import damping_ratio_from_restitution
from vibroimpact.contact.laws.tsuji import Tsuji
from vibroimpact.dynamics.restitution import law_achieving
from vibroimpact.exporting.contact_parameters import clipped_dashpot


@dataclass(frozen=True, kw_only=True)
class ClippedTsuji(Tsuji):
    """Tsuji's law without tension, as in YADE."""

    tension = "cut"  # type: ignore[assignment]

    def closed_form_restitution(self, mass: Array, speed: Array) -> None:
        """Return None: no closed form; the law is integrated."""


def yade_damping(
    stiffness: float, exponent: float, restitution: float, mass: float, speed: float
) -> float:
    """Return betan of YADE's Mindlin law [-], or the dashpot of the linear law [N s/m], with a
    restitution at a speed [m/s].

    Examples
    --------
    >>> round(yade_damping(5e8, 1.5, 0.7, mass=0.09, speed=3.0), 3)
    0.112
    """
    if exponent == 1.0:
        return clipped_dashpot(stiffness, exponent, restitution, mass, speed)
    clipped = ClippedTsuji(stiffness=stiffness, restitution=restitution, effective_mass=mass)
    # YADE refers the damping ratio to the tangent stiffness 3/2 K sqrt(delta)
    return math.sqrt(5.0 / 6.0) * float(
        damping_ratio_from_restitution(law_achieving(clipped, restitution, mass, speed).restitution)
    )
