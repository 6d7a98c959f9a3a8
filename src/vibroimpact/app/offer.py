"""What the live page offers: shipped cases, contact and friction laws, materials,
colours, and the length of messages.
"""

from __future__ import annotations

from dataclasses import fields
from functools import cache
from typing import Any

from vibroimpact.app.messages import LONGEST
from vibroimpact.cases.reader import shipped_cases
from vibroimpact.contact.friction.registry import friction_laws
from vibroimpact.contact.law import unit_of
from vibroimpact.contact.registry import contact_laws
from vibroimpact.law_sheets.plain_math import plain_text
from vibroimpact.law_sheets.text import law_text
from vibroimpact.materials import material_library
from vibroimpact.report.page import palette
from vibroimpact.units.display import multiple


@cache
def offer() -> dict[str, Any]:
    """Return what a window is told first, the same for each.

    Examples
    --------
    >>> found = offer()
    >>> [found["laws"]["hunt-crossley"]["parameters"][0][name] for name in ("name", "unit")]
    ['stiffness', 'N/m¹·⁵']
    """
    return {
        "cases": {
            name: title for name, title in shipped_cases().items() if name not in _OF_OTHER_COMMANDS
        },
        "laws": {name: _law(law) for name, law in contact_laws().items()},
        "friction": list(friction_laws()),
        "materials": list(material_library()),
        "palette": palette(),
        "longest": LONGEST,
    }


_OF_OTHER_COMMANDS = ("paper:sweep", "paper:calibration", "paper:full-damping-penetration")


def _law(law: Any) -> dict[str, Any]:
    text = law_text(law)
    exponent = 1.5
    units = {item.name: unit_of(item, exponent) for item in fields(law)}
    parameters = [
        {
            "name": one.name,
            "meaning": plain_text(one.meaning),
            "unit": multiple(units.get(one.name, one.unit), 1.0).unit,
            "allowed": one.allowed,
            "default": one.default,
        }
        for one in text.parameters
    ]
    return {"equation": text.equation, "parameters": parameters}
