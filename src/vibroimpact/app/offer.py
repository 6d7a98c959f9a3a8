"""What the live page offers: shipped cases, laws, materials, colours, exports, lengths."""

from __future__ import annotations

from dataclasses import fields
from functools import cache
from typing import Any

from vibroimpact.app.messages import LONGEST, LONGEST_FILE
from vibroimpact.cases.fields.elastic_body import ELASTIC_KEYS
from vibroimpact.cases.reader import shipped_cases
from vibroimpact.contact.friction.law import FrictionLaw, ImpulsiveFriction
from vibroimpact.contact.friction.registry import friction_laws
from vibroimpact.contact.law import unit_of
from vibroimpact.contact.registry import contact_laws
from vibroimpact.exporting.export_format import export_formats
from vibroimpact.law_sheets.plain_math import plain_text
from vibroimpact.law_sheets.text import law_text
from vibroimpact.materials import material_library
from vibroimpact.report.page import palette
from vibroimpact.signals.reading.record_files import FROM_MEMORY
from vibroimpact.units.display import multiple


@cache
def offer() -> dict[str, Any]:
    """Return what a window is told first, the same for each.

    Examples
    --------
    >>> stiffness = offer()["laws"]["hunt-crossley"]["parameters"][0]
    >>> stiffness["name"], stiffness["unit"]
    ('stiffness', 'N/m¹·⁵')
    """
    titles = shipped_cases()
    return {
        "cases": {name: titles[name] for name in titles if name not in _OF_OTHER_COMMANDS},
        "laws": {name: _law(law) for name, law in contact_laws().items()},
        "elastic_keys": list(ELASTIC_KEYS),
        "friction": list(friction_laws()),
        "impulsive_friction": [
            name for name, law in friction_laws().items() if issubclass(law, ImpulsiveFriction)
        ],
        "friction_coefficient": _FRICTION_COEFFICIENT,
        "materials": list(material_library()),
        "palette": palette(),
        "exports": {
            name: export_format.program for name, export_format in export_formats().items()
        },
        "endings": list(FROM_MEMORY),
        "longest": LONGEST,
        "longest_file": LONGEST_FILE,
    }


_OF_OTHER_COMMANDS = ("paper:sweep", "paper:calibration", "paper:full-damping-penetration")

_FRICTION_COEFFICIENT = next(
    field.metadata["example"] for field in fields(FrictionLaw) if field.name == "coefficient"
)
"""The coefficient with which friction begins."""

_HERTZ_EXPONENT = 1.5
"""Exponent of the indentation, on which units of stiffness depend."""


def _law(law: Any) -> dict[str, Any]:
    text = law_text(law)
    units = {field.name: unit_of(field, _HERTZ_EXPONENT) for field in fields(law)}
    parameters = [
        {
            "name": parameter.name,
            "meaning": plain_text(parameter.meaning),
            "unit": multiple(units.get(parameter.name, parameter.unit), 1.0).unit,
            "allowed": parameter.allowed,
            "default": parameter.default,
        }
        for parameter in text.parameters
    ]
    return {"equation": text.equation, "parameters": parameters}
