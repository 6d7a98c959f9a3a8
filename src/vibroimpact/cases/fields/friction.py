"""The [contact.friction] table: the name of a friction law, and the parameters of that law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from vibroimpact.cases.fields.quantities import quantity_schema, read_quantity
from vibroimpact.contact.friction.registry import find_friction_law, friction_laws
from vibroimpact.errors import InputError, choices, did_you_mean
from vibroimpact.quoting import quoted

NO_FRICTION = "none"


@dataclass(frozen=True)
class FrictionTable:
    """Name and parameters [SI] of a friction law."""

    law: str
    parameters: Mapping[str, float]


def read_friction(value: Any) -> FrictionTable | None:
    """Return the validated [contact.friction] table; None for the law "none".

    Raises
    ------
    InputError
        If the law or a parameter is unknown, or a value can't be read or lies outside its range.
    """
    check_friction_law(value)
    # "none" may have what others take: so a law can be switched off, or swept
    if value["law"] == NO_FRICTION:
        laws = list(friction_laws().values())
    else:
        laws = [find_friction_law(value["law"])]
    known = {item.name: item for law in laws for item in fields(law)}
    parameters = {}
    for key, given in value.items():
        if key == "law":
            continue
        if key not in known:
            raise InputError(
                f"unknown key {quoted(key)}; {value['law']} takes {choices(known, key)}",
                f"friction.{key}",
            )
        try:
            parameters[key] = read_quantity(
                given, known[key].metadata["unit"], known[key].metadata["range"]
            )
        except InputError as error:
            raise InputError(error.message, f"friction.{key}") from None
    if value["law"] == NO_FRICTION:
        return None
    return FrictionTable(value["law"], parameters)


def check_friction_law(value: Any) -> None:
    """Check that a [contact.friction] table names a friction law.

    Raises
    ------
    InputError
        If it is no table, or names none.
    """
    names = [NO_FRICTION, *friction_laws()]
    known_laws = ", ".join(f'"{name}"' for name in names)  # "there are none" would be misread
    if not isinstance(value, dict):
        raise InputError(
            f"{quoted(value)} is not a table with the name of a friction "
            f"law; there are {known_laws}",
            "friction",
        )
    if "law" not in value:
        raise InputError(f'it needs law = "...", one of {known_laws}', "friction")
    if not isinstance(value["law"], str):
        raise InputError(
            f"{quoted(value['law'])} is not the name of a friction law; there are {known_laws}",
            "friction.law",
        )
    if value["law"] not in names:
        message = (
            f"there is no friction law {quoted(value['law'])}; there are "
            f"{known_laws}.{did_you_mean(value['law'], names)}"
        )
        raise InputError(message, "friction.law")


def friction_schema() -> dict[str, Any]:
    """Return the JSON schema of the [contact.friction] table: one alternative per law."""
    none: dict[str, Any] = {
        "type": "object",
        "properties": {"law": {"const": NO_FRICTION}},
        "required": ["law"],
    }
    alternatives = [none]
    for law in friction_laws().values():
        properties: dict[str, Any] = {
            "law": {"const": law.name, "description": f"{law.equation} ({law.source})"}
        }
        properties |= {
            item.name: quantity_schema(item.metadata["unit"], item.metadata["meaning"])
            for item in fields(law)
        }
        alternatives.append(
            {
                "type": "object",
                "properties": properties,
                "required": ["law"],
                "additionalProperties": False,
            }
        )
    return {"description": "the friction law and its parameters", "oneOf": alternatives}
