"""Dotted keys of a case, such as "plate.size.thickness": their quantities, and tables
with other values at them.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any, get_args, get_origin

from vibroimpact.cases.fields.air import AirTable
from vibroimpact.cases.fields.contact import law_of
from vibroimpact.cases.fields.friction import check_friction_law
from vibroimpact.cases.fields.liquid import LiquidTable
from vibroimpact.cases.fields.local import LocalSection, MeasuredImpact
from vibroimpact.cases.fields.material import InlineMaterial, material_table
from vibroimpact.cases.fields.plate_motion import MotionTable
from vibroimpact.cases.fields.quantities import Quantity, quantity_among, quantity_of
from vibroimpact.cases.schema import SECTIONS
from vibroimpact.cases.sensor_keys import holds_sensor_keys, named_sensor, sensor_keys, split_key
from vibroimpact.contact.law import unit_of
from vibroimpact.contact.registry import find_contact_law, friction_laws
from vibroimpact.errors import InputError, choices, did_you_mean
from vibroimpact.materials import find_material
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range

_PLACES = {
    "position": ("x", "y"),
    "velocity": ("x", "y", "z"),
    "spin": ("x", "y", "z"),
    "size": ("length", "width", "thickness"),
    "direction": ("x", "y", "z"),
}
"""Names of the numbers of a list, such as x in "drop.position.x"."""

_AT_REST = {"position": 2, "velocity": 3, "spin": 3}
"""Lists that a case need not have, of zeros then, and how many."""

_DAMPING = Quantity("", "damping ratio", Range(at_least=0))

_OPEN = ("supports", "mesh", "damping", "reduction")
"""Tables of a body whose inner keys are validated by the reader of the case."""


def quantity_keys(table: Mapping[str, Any]) -> dict[str, Quantity | None]:
    """Return the keys of a case that can be swept with their quantities; None for a key that is not
    a quantity.

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
        known = dict(
            sensor_keys({"sensors": [named_sensor(table.get("sensors"), split_key(table, key)[1])]})
        )
    else:
        known = quantity_keys(table)
    if key in known:
        return known[key]
    body, _, rest = key.partition(".")
    if body in ("sphere", "plate") and rest.partition(".")[0] in _OPEN:
        return None
    if body == "contact":
        _check_law_is_named(table, "contact.law")
        if rest.startswith("friction."):
            _check_law_is_named(table, "contact.friction.law")
    words = (
        "no such key is swept; it must be one of [sphere], [plate], [drop], [contact], [run] "
        f'or of a sensor, such as "{_like(key, known)}"'
    )
    raise InputError(f"{words}.{did_you_mean(key, known)}")


def _check_law_is_named(table: Mapping[str, Any], key: str) -> None:
    """Check that there is a law at a key of a case: the other keys of its table depend on it."""
    inside: Any = table
    for part in key.split("."):
        inside = inside.get(part) if isinstance(inside, dict) else None
    if inside is None:
        raise InputError(
            f"the case has no {key}, on which the keys of its table depend; "
            "give it the name of a law"
        )


def check_laws(table: Mapping[str, Any]) -> None:
    """Check the names of the contact law and the friction law of a case, on which its keys depend;
    they may be missing.

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


def _like(key: str, known: Mapping[str, object]) -> str:
    return next(
        (name for name in known if name.startswith(key.partition(".")[0] + ".")), "sphere.radius"
    )


def holds_keys(key: str) -> bool:
    """Return whether a dotted key is that of a section or a table that contains keys that can be
    swept.

    Examples
    --------
    >>> holds_keys("sphere.material"), holds_keys("sphere.radius")
    (True, False)
    """
    section, _, field = key.partition(".")
    return holds_sensor_keys(key) or (
        section in (*SECTIONS, "contact")
        and field in ("", "material", "motion", "air", "liquid", "measured", *_PLACES)
    )


def with_values(
    table: Mapping[str, Any], values: Mapping[str, Any], done: str = "swept"
) -> dict[str, Any]:
    """Return the case with values at dotted keys; a named material is written out where one of its
    properties changes.

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
    found = copy.deepcopy(dict(table))
    # a material before its properties
    for key, value in sorted(values.items(), key=lambda item: item[0].count(".")):
        *way, last = split_key(found, key)
        # parts of the key that are the way to a sensor
        named = 2 if way[1:] and way[0] == "sensors" else 0
        inside: Any = named_sensor(found.get("sensors"), way[1]) if named else found
        for number, part in enumerate(way[named:], named):
            holder = inside
            if not isinstance(inside, dict):
                raise InputError(
                    f"{quoted(inside)} is not a table, so that it has no {part}",
                    ".".join(way[:number]),
                )
            missing: Any = (
                [0.0] * _AT_REST[part] if part in _AT_REST and way[number:] == [part] else {}
            )
            inside = inside.setdefault(part, missing)
            if part in ("air", "liquid") and isinstance(inside, bool):
                inside = holder[part] = {}
            if isinstance(inside, str) and part == "material":
                written = material_table(find_material(inside))
                if isinstance(written, str):
                    raise InputError(
                        f"{quoted(inside)} has no numbers that could be {done}", ".".join(way)
                    )
                inside = holder[part] = {
                    name: number for name, number in written.items() if name != "name"
                }  # a different material now, without the name
        if not inside and last in _PLACES.get(way[-1], ()):
            raise InputError(
                f"it is missing, so that it has no {last} that could be {done}; give all of it",
                ".".join(way),
            )
        names = _PLACES.get(way[-1], ()) if way else ()
        if isinstance(inside, list) and last in names:
            if len(inside) != len(names):
                raise InputError(
                    f"{quoted(inside)} does not have the right number of values; it takes "
                    f"{', '.join(names)}",
                    ".".join(way),
                )
            inside[names.index(last)] = value
        elif isinstance(inside, list) and names:
            raise InputError(f"there is no {last}; it takes {choices(names, last)}", ".".join(way))
        elif isinstance(inside, dict):
            inside[last] = value
        elif names:
            raise InputError(
                f"{quoted(inside)} has no {last} that could be {done}; give a list of "
                f"{', '.join(names)}",
                ".".join(way),
            )
        else:
            raise InputError(
                f"{quoted(inside)} is not a table, so that it has no {last}", ".".join(way)
            )
    return found


def _keys(table: Mapping[str, Any]) -> Iterator[tuple[str, Quantity | None]]:
    for name, section in SECTIONS.items():
        yield name, None
        for field, info in section.model_fields.items():
            key = f"{name}.{field}"
            parts = _parts(info.annotation) if field in _PLACES else ()
            yield key, None if parts else _DAMPING if field == "damping" else quantity_of(info)
            yield from (
                (f"{key}.{place}", quantity_among((part,)))
                for place, part in zip(_PLACES.get(field, ()), parts, strict=True)
            )
            if field == "motion":
                for number, inner in MotionTable.model_fields.items():
                    yield f"{key}.{number}", None if number == "direction" else quantity_of(inner)
            if field == "air":
                yield from (
                    (f"{key}.{part}", quantity_of(inner))
                    for part, inner in AirTable.model_fields.items()
                )
            if field == "material":
                for number, inner in InlineMaterial.model_fields.items():
                    if number != "name":
                        yield f"{key}.{number}", quantity_among((inner.annotation, *inner.metadata))
    yield "contact", None
    yield "contact.law", None
    contact = table.get("contact")
    if isinstance(contact, dict) and isinstance(contact.get("law"), str):
        exponent = contact.get("exponent", 1.5)
        for item in fields(find_contact_law(contact["law"])):
            yield (
                f"contact.{item.name}",
                Quantity(unit_of(item, exponent), item.metadata["meaning"], item.metadata["range"]),
            )
        friction = contact.get("friction")
        if (
            isinstance(friction, dict)
            and isinstance(friction.get("law"), str)
            and friction["law"] in friction_laws()
        ):
            yield "contact.friction.law", None
            for item in fields(friction_laws()[friction["law"]]):
                metadata = item.metadata
                yield (
                    f"contact.friction.{item.name}",
                    Quantity(metadata["unit"], metadata["meaning"], metadata["range"]),
                )
    for field, info in LocalSection.model_fields.items():
        yield f"contact.{field}", quantity_of(info)
    for name, kind in (("liquid", LiquidTable), ("measured", MeasuredImpact)):
        yield from (
            (f"contact.{name}.{part}", quantity_of(inner))
            for part, inner in kind.model_fields.items()
        )


def _parts(annotation: Any) -> tuple[Any, ...]:
    """Return the annotations of the elements of a tuple type, which may be optional."""
    return next(
        get_args(option)
        for option in (annotation, *get_args(annotation))
        if get_origin(option) is tuple
    )
