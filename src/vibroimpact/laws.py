"""Contact laws by the names of their classes, with those of other packages; their restitution.

>>> import vibroimpact as vi
>>> law = vi.laws.Flores(stiffness=5e8, restitution=0.7)
>>> round(float(vi.laws.achieved_restitution(law, mass=0.09, speed=3.0)), 3)
0.683
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.contact.registry import contact_laws, find_contact_law
from vibroimpact.contact.speed_function import SpeedFunction, SpeedTable
from vibroimpact.dynamics.restitution import (
    achieved_restitution,
    integrated_restitution,
    law_achieving,
)
from vibroimpact.registry import class_named

if TYPE_CHECKING:
    from vibroimpact.law_comparison.comparison import Comparison, compare_laws
    from vibroimpact.law_comparison.ranking import Ranking, rank_laws
    from vibroimpact.law_sheets.curves import law_chart

__all__ = [
    "Comparison",
    "ContactLaw",
    "QuasiStatic",
    "Ranking",
    "SpeedFunction",
    "SpeedTable",
    "achieved_restitution",
    "compare_laws",
    "contact_laws",
    "find_contact_law",
    "integrated_restitution",
    "law_achieving",
    "law_chart",
    "rank_laws",
]

_WITH_CASES = {
    "Comparison": "vibroimpact.law_comparison.comparison",
    "Ranking": "vibroimpact.law_comparison.ranking",
    "compare_laws": "vibroimpact.law_comparison.comparison",
    "rank_laws": "vibroimpact.law_comparison.ranking",
    "law_chart": "vibroimpact.law_sheets.curves",
}
"""Names whose modules load the schema of cases, which a law by its name does not need."""


def __getattr__(name: str) -> Any:
    if name in _WITH_CASES:
        return getattr(import_module(_WITH_CASES[name]), name)
    return class_named(contact_laws(), name, __name__)


def __dir__() -> list[str]:
    return sorted([*__all__, *(law.__name__ for law in contact_laws().values())])
