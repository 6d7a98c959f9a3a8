"""The [contact] section: the name of a contact law, and the parameters of that law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import Field, dataclass, fields
from typing import Any, TypeAlias

from vibroimpact.cases.fields.by_speed import by_speed_schema, read_by_speed
from vibroimpact.cases.fields.friction import FrictionTable, friction_schema, read_friction
from vibroimpact.cases.fields.local import LocalSection
from vibroimpact.cases.fields.quantities import quantity_schema, read_quantity
from vibroimpact.cases.fields.section import read_table
from vibroimpact.cases.fields.size_limits import MOST_OF_A_LIST, check_count
from vibroimpact.contact.law import ContactLaw, unit_of
from vibroimpact.contact.registry import contact_laws, find_contact_law
from vibroimpact.contact.speed_function import BySpeed, SpeedFunction, SpeedTable
from vibroimpact.errors import InputError, choices, listed
from vibroimpact.quoting import quoted

Parameter: TypeAlias = float | tuple[float, ...] | BySpeed
"""The value of a parameter of a contact law.

It is a number, one per impact, or a function of the approach speed.
"""


@dataclass(frozen=True)
class ContactSection:
    """Name and parameters [SI] of a contact law, local deformation, and friction.

    `local` is how the law is combined with the local deformation of elastic bodies.

    A tuple has one value per impact; its last value holds for all later impacts. A parameter may be
    a function of the approach speed.
    """

    law: str
    parameters: Mapping[str, Parameter]
    local: LocalSection = LocalSection()
    friction: FrictionTable | None = None


def read_contact(value: Any) -> ContactSection:
    """Return the validated [contact] section.

    Raises
    ------
    InputError
        If the law or a parameter is unknown, or a value can't be read or lies outside its range.
    """
    if isinstance(value, ContactSection):
        return value
    law = law_of(value)
    items = {item.name: item for item in fields(law)}
    # the SI unit of a stiffness depends on the exponent of the law
    usual_exponent = items["exponent"].default if "exponent" in items else 1.0
    exponent = value.get("exponent", usual_exponent)
    parameters: dict[str, Parameter] = {}
    for key, stated in value.items():
        if key in ("law", "friction") or key in LocalSection.model_fields:
            continue
        if key not in items:
            known = [*items, *LocalSection.model_fields, "friction"]
            raise InputError(
                f"unknown key {quoted(key)}; {law.name} takes {choices(known, key, 'schema')}", key
            )
        try:
            parameters[key] = _read_parameter(stated, items[key], exponent)
        except InputError as error:
            raise InputError(error.message, key) from None
    local = {key: value[key] for key in LocalSection.model_fields if key in value}
    friction = None
    if "friction" in value:
        friction = read_friction(value["friction"])
    return ContactSection(law.name, parameters, read_table(LocalSection, local), friction)


def _read_parameter(value: Any, item: Field[Any], exponent: Any) -> Parameter:
    """Return a parameter of a law: a number, a list of them, or a function of the speed.

    Raises
    ------
    InputError
        If it can't be read, or lies outside its range.
    """
    unit = unit_of(item, exponent)
    allowed = item.metadata["range"]
    if isinstance(value, list):
        if not value:
            raise InputError(
                "the list is empty; it must have one value per impact, the last of "
                "which holds for all later ones"
            )
        check_count(len(value), MOST_OF_A_LIST, "values")
        return tuple(read_quantity(number, unit, allowed) for number in value)
    if not isinstance(value, dict):
        return read_quantity(value, unit, allowed)
    if varies_with_speed(item):
        return read_by_speed(value, unit, allowed)
    reason = "it follows from the bodies"
    if item.metadata["memory"]:
        reason = "it is the state before the first impact"
    elif item.name == "exponent":
        reason = "it is an exponent"
    raise InputError(
        f"{reason}, and can't be a function of the approach speed; give a number, or a "
        "list with one value per impact"
    )


def varies_with_speed(item: Field[Any]) -> bool:
    """Return whether a parameter may be a function of the approach speed.

    It may not if it follows from the bodies, is a state, or is an exponent.
    """
    return not (item.metadata["from_pair"] or item.metadata["memory"] or item.name == "exponent")


def in_table(value: Parameter) -> Any:
    """Return the value of a parameter as the table of a case has it."""
    if isinstance(value, (SpeedFunction, SpeedTable)):
        return value.table()
    if isinstance(value, tuple):
        return list(value)
    return value


def law_of(value: Any) -> type[ContactLaw]:
    """Return the law of a [contact] section that is not validated yet.

    Raises
    ------
    InputError
        If it is no table, or names no law.
    """
    known_laws = listed(contact_laws(), command="laws")
    if not isinstance(value, dict):
        raise InputError(
            f"{quoted(value)} is not a table with the name of a law and its parameters; "
            f"there are {known_laws}"
        )
    if "law" not in value:
        raise InputError(f'it needs law = "...", one of {known_laws}')
    if not isinstance(value["law"], str):
        raise InputError(
            f"{quoted(value['law'])} is not the name of a law; there are {known_laws}", "law"
        )
    try:
        return find_contact_law(value["law"])
    except InputError as error:
        raise InputError(error.message, "law") from None


def contact_schema() -> dict[str, Any]:
    """Return the JSON schema of the [contact] section: one alternative per law."""
    local = {**LocalSection.model_json_schema()["properties"], "friction": friction_schema()}
    return {
        "description": "the contact law and its parameters",
        "oneOf": [_law_schema(law, local) for law in contact_laws().values()],
    }


def law_schema() -> dict[str, Any]:
    """Return the JSON schema of a law and its parameters: one alternative per law.

    The keys of `LocalSection` are not among them.
    """
    return {"oneOf": [_law_schema(law, {}) for law in contact_laws().values()]}


def _law_schema(law: type[ContactLaw], more: Mapping[str, Any]) -> dict[str, Any]:
    """Return the JSON schema of a law and its parameters, and of more keys."""
    properties: dict[str, Any] = {
        "law": {"const": law.name, "description": f"{law.equation} ({law.source})"},
        **more,
    }
    for item in fields(law):
        number = quantity_schema(item.metadata["unit"], item.metadata["meaning"])
        forms = [number, {"type": "array", "items": number, "minItems": 1}]
        if varies_with_speed(item):
            forms += by_speed_schema(item.metadata["unit"], item.metadata["meaning"])
        properties[item.name] = {"anyOf": forms, "description": number["description"]}
    return {
        "type": "object",
        "properties": properties,
        "required": ["law"],
        "additionalProperties": False,
    }
