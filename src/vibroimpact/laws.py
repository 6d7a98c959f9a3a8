"""The contact laws by their names, with those of other packages.

>>> import vibroimpact as vi
>>> law = vi.laws.Flores(stiffness=5e8, restitution=0.7)
>>> round(float(vi.achieved_restitution(law, mass=0.09, speed=3.0)), 3)
0.683
"""

from __future__ import annotations

from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.registry import contact_laws
from vibroimpact.registry import class_named


def __getattr__(name: str) -> type[ContactLaw]:
    return class_named(contact_laws(), name, __name__)


def __dir__() -> list[str]:
    return sorted(law.__name__ for law in contact_laws().values())
