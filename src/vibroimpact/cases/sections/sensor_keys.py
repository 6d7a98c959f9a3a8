"""Dotted keys of sensors, by their names: "sensors.a1.position.x"."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, get_args

from pydantic.fields import FieldInfo

from vibroimpact.cases.fields.instruments import quantity_in_unit
from vibroimpact.cases.fields.item_labels import item_label
from vibroimpact.cases.fields.quantities import Quantity, quantity_of
from vibroimpact.cases.fields.section import Section, read_table
from vibroimpact.cases.fields.sensor import SensorSection
from vibroimpact.errors import InputError, choices
from vibroimpact.quoting import quoted

_NUMBERS = {
    "position": {part: Quantity("m", f"position of the sensor, {part}") for part in "xy"},
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
    sensors = {}
    for number, entry in enumerate(entries):
        try:
            sensors[entry["name"]] = read_table(SensorSection, entry)
        except InputError as error:
            key = f"{item_label('sensors', entries, number)}.{error.key}".rstrip(".")
            raise InputError(error.message, key) from None
    return sensors


def sensor_keys(table: Mapping[str, Any]) -> Iterator[tuple[str, Quantity | None]]:
    """Yield the keys of the sensors of a case with their quantities.

    None for a key that is not a quantity.

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
            if field in _NUMBERS:
                yield key, None
                for axis, quantity in _NUMBERS[field].items():
                    yield f"{key}.{axis}", quantity
            else:
                yield key, quantity_of(info)
            # keys of the table of an instrument, some of which are in the unit of the output
            for inner_key, inner in _fields(info).items():
                yield f"{key}.{inner_key}", quantity_of(inner) or quantity_in_unit(inner, unit)


def holds_sensor_keys(key: str) -> bool:
    """Return whether a dotted key is that of a table of sensors that contains keys to sweep.

    It may be that of all sensors, of one, or of a table in one.

    Examples
    --------
    >>> (
    ...     holds_sensor_keys("sensors.a1.accelerometer"),
    ...     holds_sensor_keys("sensors.a1.rate"),
    ...     holds_sensor_keys("plate"),
    ... )
    (True, False, False)
    """
    section, *rest = key.split(".")
    if section != "sensors" or len(rest) > 2:
        return False
    if len(rest) < 2:
        return True
    field = rest[1]
    if field in _NUMBERS:
        return True
    return field in SensorSection.model_fields and bool(_fields(SensorSection.model_fields[field]))


def split_key(table: Mapping[str, Any], key: str) -> list[str]:
    """Return the parts of a dotted key.

    The name of a sensor, which may have dots itself, is one of them.

    Examples
    --------
    >>> (
    ...     split_key({"sensors": [{"name": "a.1"}]}, "sensors.a.1.position.x"),
    ...     split_key({}, "plate.size.thickness"),
    ... )
    (['sensors', 'a.1', 'position', 'x'], ['plate', 'size', 'thickness'])
    """
    # the longest name first, as one may begin with another
    for name in sorted((entry["name"] for entry in _entries(table)), key=len, reverse=True):
        prefix = f"sensors.{name}."
        if key.startswith(prefix):
            return ["sensors", name, *key.removeprefix(prefix).split(".")]
    return key.split(".")


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
    others = "the case has none with a name"
    if names:
        others = f"there are {choices(names, name)}"
    raise InputError(f"there is no sensor called {quoted(name)}; {others}")


def _fields(info: FieldInfo) -> dict[str, FieldInfo]:
    """Return the fields of the table that a field of a sensor takes; none if it takes no table."""
    for option in get_args(info.annotation):
        if isinstance(option, type) and issubclass(option, Section):
            return option.model_fields
    return {}


def _entries(table: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the tables of the sensors that have names."""
    entries = table.get("sensors")
    if not isinstance(entries, list):
        return []
    return [
        entry for entry in entries if isinstance(entry, dict) and isinstance(entry.get("name"), str)
    ]
