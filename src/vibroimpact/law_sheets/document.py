"""What `laws --json` prints: the description of a contact law in plain text, with the
numbers of its parameters.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, fields
from typing import Any

from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.friction.registry import friction_laws
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.registry import contact_laws
from vibroimpact.law_sheets.text import ParameterText, asked_and_achieved, law_text, plain_paragraph


def laws_document() -> dict[str, Any]:
    """Return the descriptions of all contact and friction laws by name."""
    every = (("laws", contact_laws()), ("friction_laws", friction_laws()))
    return {kind: {name: law_document(law) for name, law in laws.items()} for kind, laws in every}


def law_document(law: type[ContactLaw | FrictionLaw]) -> dict[str, Any]:
    """Return the description of a contact or friction law.

    Parameters
    ----------
    law : type of ContactLaw or FrictionLaw
        The law's class.

    Examples
    --------
    >>> from vibroimpact.contact.registry import find_contact_law
    >>> document = law_document(find_contact_law("flores"))
    >>> (
    ...     document["loss_parameters"],
    ...     [(one["name"], one["unit"], one["default"]) for one in document["parameters"]][:2],
    ... )
    ('restitution', [('stiffness', 'N/m^n', 'from the materials'), ('exponent', '', 1.5)])
    """
    text = law_text(law)
    numbers = {
        item.name: item.default for item in fields(law) if isinstance(item.default, (int, float))
    }
    pairs = []
    if issubclass(law, ContactLaw):
        pairs = asked_and_achieved(law)
    return {
        **asdict(text),
        "title": plain_paragraph(text.title),
        **{
            part: [plain_paragraph(paragraph) for paragraph in getattr(text, part)]
            for part in ("body", "notes", "references", "raises")
        },
        "parameters": _parameters(text.parameters, numbers),
        "state": _parameters(text.state, numbers),
        "restitution": [
            {"restitution_asked": asked, "restitution_achieved": achieved}
            for asked, achieved in pairs
        ],
    }


def _parameters(
    parameters: Iterable[ParameterText], numbers: dict[str, float]
) -> list[dict[str, Any]]:
    """Return parameters as mappings; a default is a number, or else words on where it
    comes from.
    """
    return [
        {
            **asdict(parameter),
            "meaning": plain_paragraph(parameter.meaning),
            "default": numbers.get(parameter.name, parameter.default),
        }
        for parameter in parameters
    ]
