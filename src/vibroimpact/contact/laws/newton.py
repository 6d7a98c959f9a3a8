"""Newton's restitution: instantaneous impact."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.law import InstantaneousLaw
from vibroimpact.contact.parameters import parameter


@dataclass(frozen=True, kw_only=True)
class Newton(InstantaneousLaw):
    r"""Instantaneous impact of hard bodies (Newton 1687).

    Notes
    -----
    There is no force and no indentation; the restitution asked for is the one achieved. With e < 1
    a ball that is dropped
    from h onto a plate at rest comes to rest after :math:`\sqrt{2h/g}\,(1+e)/(1-e)` and infinitely
    many bounces.

    References
    ----------
    Newton, I. (1687). Philosophiae Naturalis Principia Mathematica, scholium to the laws of motion.

    Examples
    --------
    >>> Newton(restitution=0.5).separation_speed(4.0, mass=1.0)
    2.0
    """

    name = "newton"
    equation = "v+ = e v-"
    source = "Newton 1687, Principia, scholium to the laws of motion"

    restitution: Array = parameter(
        "coefficient of restitution e",
        detail="Coefficient of restitution :math:`e`.",
        example=0.7,
        at_least=0,
        at_most=1,
    )

    def separation_speed(self, approach_speed: Array, mass: Array) -> Array:
        """Return e times the approach speed [m/s]."""
        return self.restitution * approach_speed
