"""Quantity fields: a number in SI, or a string with a unit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, get_args

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from vibroimpact.errors import InputError
from vibroimpact.ranges import Range
from vibroimpact.shown import shown
from vibroimpact.units.reading import to_si

SMALLEST, LARGEST = 1e-50, 1e50
"""Range of the magnitude of a nonzero quantity in SI, within which squares and products neither overflow nor underflow."""


def read_quantity(value: Any, unit: str, allowed: Range) -> float:
    """Return the value of a quantity in SI after checking its range.

    Raises
    ------
    InputError
        If it can't be read, or lies outside its range.

    Examples
    --------
    >>> read_quantity("25 mm", "m", Range(above=0))
    0.025
    """
    number = to_si(value, unit)
    if number and not SMALLEST <= abs(number) <= LARGEST:
        limits = f"from {SMALLEST:g} to {LARGEST:g} {unit}".rstrip()
        raise InputError(f"{shown(value)} is beyond what can be computed; a magnitude that is not 0 lies {limits}")
    allowed.check(number, unit, f'"{value}"' if isinstance(value, str) else str(value))
    return number


@dataclass(frozen=True)
class Quantity:
    """Annotation of a quantity field with its SI unit, meaning and range, from which pydantic validates it and makes its JSON schema."""

    unit: str
    meaning: str
    allowed: Range = Range()

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(lambda value: read_quantity(value, self.unit, self.allowed))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return quantity_schema(self.unit, self.meaning)


def quantity_schema(unit: str, description: str) -> dict[str, Any]:
    """Return the JSON schema of a quantity."""
    if not unit:
        return {"type": "number", "description": description}
    gravity = ', in which "g" is standard gravity, 9.80665 m/s^2' if unit in ("m/s^2", "V s^2/m") else ""
    return {"type": ["number", "string"], "description": f"{description} [{unit}]; a string carries its own unit{gravity}"}


def quantity_of(info: FieldInfo) -> Quantity | None:
    """Return the quantity of a field of a section; None if it is not one."""
    return quantity_among((info.annotation, *info.metadata))


def quantity_among(annotations: tuple[Any, ...]) -> Quantity | None:
    """Return the first quantity among annotations or nested in them."""
    for annotation in annotations:
        found = (
            annotation
            if isinstance(annotation, Quantity)
            else quantity_among((*get_args(annotation), *getattr(annotation, "__metadata__", ())))
        )
        if found is not None:
            return found
    return None
