"""Friction laws by the names of their classes, with those of other packages.

>>> import vibroimpact as vi
>>> vi.friction.Coulomb(coefficient=0.3).coefficient
0.3
"""

from __future__ import annotations

from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.friction.registry import find_friction_law, friction_laws
from vibroimpact.registry import class_named

__all__ = ["FrictionLaw", "find_friction_law", "friction_laws"]


def __getattr__(name: str) -> type[FrictionLaw]:
    return class_named(friction_laws(), name, __name__)


def __dir__() -> list[str]:
    return sorted([*__all__, *(law.__name__ for law in friction_laws().values())])
