"""Dotted keys of a case, such as "plate.size.thickness".

There are their quantities, and tables with other values at them.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from dataclasses import Field, fields
from typing import Any, get_args, get_origin

from pydantic.fields import FieldInfo

from vibroimpact.cases.fields.contact import law_of
from vibroimpact.cases.fields.friction import check_friction_law
from vibroimpact.cases.fields.local import LocalSection
from vibroimpact.cases.fields.material import InlineMaterial, material_table
from vibroimpact.cases.fields.plate_motion import MotionTable
from vibroimpact.cases.fields.quantities import Quantity, quantity_among, quantity_of
from vibroimpact.cases.fields.section import Section
from vibroimpact.cases.sections.schema import SECTIONS
from vibroimpact.cases.sections.sensor_keys import (
    holds_sensor_keys,
    named_sensor,
    sensor_keys,
    split_key,
)
from vibroimpact.contact.friction.registry import friction_laws
from vibroimpact.contact.law import unit_of
from vibroimpact.contact.registry import find_contact_law
from vibroimpact.errors import InputError, choices, did_you_mean
from vibroimpact.materials import find_material
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range

_DEFAULT_ZEROS = ("position", "velocity", "spin")
"""Lists that a case need not have, of zeros then."""

_DAMPING = Quantity("", "damping ratio", Range(at_least=0))

_OPEN = ("supports", "mesh", "damping", "reduction")
"""Tables of a body whose inner keys are validated by the reader of the case."""


def quantity_keys(table: Mapping[str, Any]) -> dict[str, Quantity | None]:
    """Return the keys of a case that can be swept, with their quantities.

    None for a key that is not a quantity.

    Parameters
    ----------
    table : mapping
        The case, with the structure of a TOML case file; its contact law determines the keys of
        [contact].

    Examples
    --------
    >>> keys = quantity_keys({"contact": {"law": "hertz"}})
    >>> (
    ...     keys["sphere.radius"].unit,
    ...     keys["contact.stiffness"].unit,
    ...     keys["drop.position.x"].unit,
    ...     keys["plate.model"],
    ... )
    ('m', 'N/m^1.5', 'm', None)
    """
    return dict(_keys(table))


def find_quantity(table: Mapping[str, Any], key: str) -> Quantity | None:
    """Return the quantity of a key of a case; None if it is not a quantity.

    Raises
    ------
    InputError
        If there is no such key, or it can't be swept.
    """
    if key.startswith("sensors."):
        sensor = named_sensor(table.get("sensors"), split_key(table, key)[1])
        quantities = dict(sensor_keys({"sensors": [sensor]}))
    else:
        quantities = quantity_keys(table)
    if key in quantities:
        return quantities[key]
    body, _, rest = key.partition(".")
    if body in ("sphere", "plate") and rest.partition(".")[0] in _OPEN:
        return None
    if body == "contact":
        _check_law_is_named(table, "contact.law")
        if rest.startswith("friction."):
            _check_law_is_named(table, "contact.friction.law")
    raise InputError(
        "no such key is swept; it must be one of [sphere], [plate], [drop], [contact], [run] "
        f'or of a sensor, such as "{_similar(key, quantities)}".{did_you_mean(key, quantities)}'
    )


def _check_law_is_named(table: Mapping[str, Any], key: str) -> None:
    """Check that there is a law at a key of a case: the other keys of its table depend on it."""
    value: Any = table
    for name in key.split("."):
        if not isinstance(value, dict):
            value = None
            break
        value = value.get(name)
    if value is None:
        raise InputError(
            f"the case has no {key}, on which the keys of its table depend; "
            "give it the name of a law"
        )


def check_laws(table: Mapping[str, Any]) -> None:
    """Check the names of the contact law and the friction law of a case.

    Its keys depend on them. They may be missing.

    Raises
    ------
    InputError
        If there is none with such a name.
    """
    contact = table.get("contact", {})
    try:
        if contact != {} and not (isinstance(contact, dict) and "law" not in contact):
            law_of(contact)
        if isinstance(contact, dict) and "friction" in contact:
            check_friction_law(contact["friction"])
    except InputError as error:
        raise InputError(error.message, f"contact.{error.key}".rstrip(".")) from None


def _similar(key: str, known: Mapping[str, object]) -> str:
    """Return a known key of the same section as another one."""
    section = key.partition(".")[0]
    return next((name for name in known if name.startswith(f"{section}.")), "sphere.radius")


def holds_keys(key: str) -> bool:
    """Return whether a dotted key is that of a section or a table with keys that can be swept.

    Examples
    --------
    >>> holds_keys("sphere.material"), holds_keys("sphere.radius")
    (True, False)
    """
    section, _, field = key.partition(".")
    return holds_sensor_keys(key) or (
        section in (*SECTIONS, "contact") and field in ("", "material", *_TABLES, *_COMPONENTS)
    )


def with_values(
    table: Mapping[str, Any], values: Mapping[str, Any], done: str = "swept"
) -> dict[str, Any]:
    """Return the case with values at dotted keys.

    A named material is written out where one of its properties changes.

    Parameters
    ----------
    table : mapping
        The case, with the structure of a TOML case file.
    values : mapping
        The values by dotted key.
    done : str, default "swept"
        What is done to the keys, for messages.

    Raises
    ------
    InputError
        If there is nothing at a key to be changed.

    Examples
    --------
    >>> with_values(
    ...     {"drop": {"position": [0.0, 0.0]}}, {"drop.position.y": 0.1, "sphere.radius": "5 mm"}
    ... )
    {'drop': {'position': [0.0, 0.1]}, 'sphere': {'radius': '5 mm'}}
    """
    changed = copy.deepcopy(dict(table))
    # a material before its properties
    for key, value in sorted(values.items(), key=lambda item: item[0].count(".")):
        *path, last = split_key(changed, key)
        holder = _holder(changed, path, done)
        components = _COMPONENTS.get(path[-1], ()) if path else ()
        if not holder and last in components:
            raise InputError(
                f"it is missing, so that it has no {last} that could be {done}; give all of it",
                ".".join(path),
            )
        if isinstance(holder, list) and components:
            _set_component(holder, components, last, value, path)
        elif isinstance(holder, dict):
            holder[last] = value
        elif components:
            raise InputError(
                f"{quoted(holder)} has no {last} that could be {done}; give a list of "
                f"{', '.join(components)}",
                ".".join(path),
            )
        else:
            raise InputError(
                f"{quoted(holder)} is not a table, so that it has no {last}", ".".join(path)
            )
    return changed


def _holder(case: dict[str, Any], path: list[str], done: str) -> Any:
    """Return what holds the last part of a key: a table, a list, or what stands in its place.

    Tables that are missing are made, and so are lists of zeros.
    """
    holder: Any = case
    start = 0
    if path[1:] and path[0] == "sensors":
        holder = named_sensor(case.get("sensors"), path[1])
        start = 2
    for number, name in enumerate(path[start:], start):
        outer = holder
        if not isinstance(outer, dict):
            raise InputError(
                f"{quoted(outer)} is not a table, so that it has no {name}",
                ".".join(path[:number]),
            )
        is_last = number == len(path) - 1
        missing: Any = {}
        if name in _DEFAULT_ZEROS and is_last:
            missing = [0.0] * len(_COMPONENTS[name])
        holder = outer.setdefault(name, missing)
        if name in ("air", "liquid") and isinstance(holder, bool):
            holder = outer[name] = {}
        if name == "material" and isinstance(holder, str):
            holder = outer[name] = _material_numbers(holder, done, ".".join(path))
    return holder


def _material_numbers(name: str, done: str, key: str) -> dict[str, Any]:
    """Return the numbers of a named material; it is a different one now, without the name."""
    table = material_table(find_material(name))
    if isinstance(table, str):
        raise InputError(f"{quoted(name)} has no numbers that could be {done}", key)
    return {property_: number for property_, number in table.items() if property_ != "name"}


def _set_component(
    numbers: list[Any], components: tuple[str, ...], name: str, value: Any, path: list[str]
) -> None:
    """Set a component of a list of numbers, in place, by its name."""
    if name not in components:
        raise InputError(
            f"there is no {name}; it takes {choices(components, name)}", ".".join(path)
        )
    if len(numbers) != len(components):
        raise InputError(
            f"{quoted(numbers)} does not have the right number of values; it takes "
            f"{', '.join(components)}",
            ".".join(path),
        )
    numbers[components.index(name)] = value


def _keys(table: Mapping[str, Any]) -> Iterator[tuple[str, Quantity | None]]:
    """Yield the keys of a case that can be swept, with their quantities."""
    for name, section in SECTIONS.items():
        yield name, None
        for field, info in section.model_fields.items():
            yield from _keys_of_field(f"{name}.{field}", field, info)
    yield "contact", None
    yield "contact.law", None
    contact = table.get("contact")
    if isinstance(contact, dict) and isinstance(contact.get("law"), str):
        yield from _keys_of_laws(contact)
    for field, info in LocalSection.model_fields.items():
        yield from _keys_of_field(f"contact.{field}", field, info)


def _keys_of_field(key: str, field: str, info: FieldInfo) -> Iterator[tuple[str, Quantity | None]]:
    """Yield the key of a field of a section, and those of the list or table that it takes."""
    components = _elements(info.annotation)
    if components:
        yield key, None
        for quantity in components:
            yield f"{key}.{quantity.meaning}", quantity
    elif field == "damping":
        yield key, _DAMPING
    else:
        yield key, quantity_of(info)
    table = InlineMaterial if field == "material" else _table_in(info)
    if table is None:
        return
    for inner_key, inner in table.model_fields.items():
        is_list = bool(_elements(inner.annotation))
        if (field, inner_key) != ("material", "name"):
            yield f"{key}.{inner_key}", None if is_list else quantity_of(inner)


def _keys_of_laws(contact: Mapping[str, Any]) -> Iterator[tuple[str, Quantity | None]]:
    """Yield the keys of the contact law of a case, and of its friction law, if it has one."""
    exponent = contact.get("exponent", 1.5)
    for item in fields(find_contact_law(contact["law"])):
        yield f"contact.{item.name}", _quantity_of_parameter(item, unit_of(item, exponent))
    friction = contact.get("friction")
    name = friction.get("law") if isinstance(friction, dict) else None
    if isinstance(name, str) and name in friction_laws():
        yield "contact.friction.law", None
        for item in fields(friction_laws()[name]):
            quantity = _quantity_of_parameter(item, item.metadata["unit"])
            yield f"contact.friction.{item.name}", quantity


def _quantity_of_parameter(item: Field[Any], unit: str) -> Quantity:
    """Return the quantity of a parameter of a law."""
    return Quantity(unit, item.metadata["meaning"], item.metadata["range"])


def _elements(annotation: Any) -> tuple[Quantity, ...]:
    """Return the quantities of the elements of a tuple type, which may be optional; none of any
    other type.
    """
    return next(
        (
            tuple(filter(None, (quantity_among((element,)) for element in get_args(option))))
            for option in (annotation, *get_args(annotation))
            if get_origin(option) is tuple
        ),
        (),
    )


def _table_in(info: FieldInfo) -> type[Section] | None:
    """Return the section of the table that a field takes; None if it takes none."""
    options = (info.annotation, *get_args(info.annotation))
    return next(
        (option for option in options if isinstance(option, type) and issubclass(option, Section)),
        None,
    )


_WITH_KEYS: tuple[type[Section], ...] = (*SECTIONS.values(), LocalSection, MotionTable)
_FIELDS = [(name, info) for section in _WITH_KEYS for name, info in section.model_fields.items()]

_COMPONENTS = {
    name: tuple(quantity.meaning for quantity in components)
    for name, info in _FIELDS
    if (components := _elements(info.annotation))
}
"""Names of the numbers of a list, such as x in "drop.position.x"."""

_TABLES = {name for name, info in _FIELDS if _table_in(info) is not None}
"""Keys that take a table with keys that can be swept."""
