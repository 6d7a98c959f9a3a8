"""Dotted keys of sensors, by their names: "sensors.a1.position.x"."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, get_args

from pydantic.fields import FieldInfo

from vibroimpact.cases.fields.instruments import quantity_in_unit
from vibroimpact.cases.fields.item_labels import item_label
from vibroimpact.cases.fields.quantities import Quantity, quantity_of
from vibroimpact.cases.fields.section import Section, read_table
from vibroimpact.cases.schema import SensorSection
from vibroimpact.errors import InputError, choices
from vibroimpact.quoting import quoted

_NUMBERS = {
    "position": {part: Quantity("m", f"place of the sensor, {part}") for part in "xy"},
    "direction": {part: Quantity("", f"{part} of its direction") for part in "xyz"},
}
"""The lists of numbers that a sensor has."""


def sensors_of(table: Mapping[str, Any]) -> dict[str, SensorSection]:
    """Return the sensors of a case by name, each validated by itself.

    Parameters
    ----------
    table : mapping
        The case, with the structure of a TOML case file.

    Raises
    ------
    InputError
        If one is not valid.
    """
    entries = _entries(table)
    found = {}
    for number, entry in enumerate(entries):
        try:
            found[entry["name"]] = read_table(SensorSection, entry)
        except InputError as error:
            raise InputError(
                error.message, f"{item_label('sensors', entries, number)}.{error.key}".rstrip(".")
            ) from None
    return found


def sensor_keys(table: Mapping[str, Any]) -> Iterator[tuple[str, Quantity | None]]:
    """Yield the keys of the sensors of a case with their quantities; None for a key that is not a
    quantity.

    Examples
    --------
    >>> keys = dict(
    ...     sensor_keys(
    ...         {
    ...             "sensors": [
    ...                 {"name": "a1", "position": [0, 0], "accelerometer": {"sensitivity": 0.01}}
    ...             ]
    ...         }
    ...     )
    ... )
    >>> (
    ...     keys["sensors.a1.position.x"].unit,
    ...     keys["sensors.a1.accelerometer.noise"].unit,
    ...     keys["sensors.a1.amplifier.noise"].unit,
    ... )
    ('m', 'm/s^2', 'V')
    """
    for name, sensor in sensors_of(table).items():
        unit = sensor.sensor().unit.replace("2", "^2")
        for field, info in SensorSection.model_fields.items():
            if field == "name":
                continue
            key = f"sensors.{name}.{field}"
            yield key, None if field in _NUMBERS else quantity_of(info)
            yield from (
                (f"{key}.{part}", quantity) for part, quantity in _NUMBERS.get(field, {}).items()
            )
            for part, of_part in _fields(info).items():
                yield f"{key}.{part}", quantity_of(of_part) or quantity_in_unit(of_part, unit)


def holds_sensor_keys(key: str) -> bool:
    """Return whether a dotted key is that of a table of sensors, or in one, that contains keys that
    can be swept.

    Examples
    --------
    >>> (
    ...     holds_sensor_keys("sensors.a1.accelerometer"),
    ...     holds_sensor_keys("sensors.a1.rate"),
    ...     holds_sensor_keys("plate"),
    ... )
    (True, False, False)
    """
    first, *rest = key.split(".")
    if first != "sensors" or len(rest) > 2:
        return False
    return (
        len(rest) < 2
        or rest[1] in _NUMBERS
        or (
            rest[1] in SensorSection.model_fields
            and bool(_fields(SensorSection.model_fields[rest[1]]))
        )
    )


def split_key(table: Mapping[str, Any], key: str) -> list[str]:
    """Return the parts of a dotted key; the name of a sensor, which may have dots itself, is one of
    them.

    Examples
    --------
    >>> (
    ...     split_key({"sensors": [{"name": "a.1"}]}, "sensors.a.1.position.x"),
    ...     split_key({}, "plate.size.thickness"),
    ... )
    (['sensors', 'a.1', 'position', 'x'], ['plate', 'size', 'thickness'])
    """
    names = sorted((entry["name"] for entry in _entries(table)), key=len, reverse=True)
    name = next((name for name in names if key.startswith(f"sensors.{name}.")), None)
    return (
        key.split(".")
        if name is None
        else ["sensors", name, *key.removeprefix(f"sensors.{name}.").split(".")]
    )


def named_sensor(sensors: Any, name: str) -> dict[str, Any]:
    """Return the table of a sensor by its name.

    Raises
    ------
    InputError
        If there is none.
    """
    entries = _entries({"sensors": sensors})
    names = [entry["name"] for entry in entries]
    if name in names:
        return entries[names.index(name)]
    names = [known for known in names if known]
    words = f"there are {choices(names, name)}" if names else "the case has none with a name"
    raise InputError(f"there is no sensor called {quoted(name)}; {words}")


def _fields(info: FieldInfo) -> dict[str, FieldInfo]:
    """Return the fields of the table that a field of a sensor takes; none if it takes no table."""
    kinds = (
        kind
        for kind in get_args(info.annotation)
        if isinstance(kind, type) and issubclass(kind, Section)
    )
    return next((kind.model_fields for kind in kinds), {})


def _entries(table: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the tables of the sensors that have names."""
    entries = table.get("sensors")
    if not isinstance(entries, list):
        return []
    return [
        entry for entry in entries if isinstance(entry, dict) and isinstance(entry.get("name"), str)
    ]
